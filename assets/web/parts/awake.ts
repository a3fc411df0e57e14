// Keeps a phone's screen on. Browsers allow it only on encrypted pages, and end it when the page is hidden.

export class Awake {
    private held: WakeLockSentinel | null = null
    private wanted = false
    private last = Promise.resolve()

    /** Keep the screen on from now on, or no longer. One request after the other, so that none is left behind. */
    keep(wanted: boolean): Promise<void> {
        this.wanted = wanted
        return (this.last = this.last.then(() => this.follow()))
    }

    private async follow(): Promise<void> {
        const { held, wanted } = this, isHeld = Boolean(held && !held.released)
        if (!("wakeLock" in navigator) || wanted === isHeld) return
        try {
            if (wanted) this.held = await navigator.wakeLock.request("screen")
            else await held!.release()
        } catch {} // the phone saves its battery
    }
}
