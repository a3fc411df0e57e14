// What the lab says: its messages over the scene, the same and more for a screen reader, the distances as two tones,
// and what newcomers are invited to do.

import { made, tell } from "../core/dom"
import { shown } from "../core/engine"
import { phrase, withoutNumbers, type Texts } from "../core/words"
import { withSigns } from "./icons"
import type { ServerEngine } from "../channel/channel"
import type { Command, StateMessage } from "../channel/messages"

const AGAIN = 8000 // [ms], least time between announcements that differ only in numbers
const REST = 1500 // [ms], least time between two announcements
const STAYS = 8000, PER_LETTER = 60 // [ms] that a notice stays, and more per letter, unless it is pointed at
const LOW = 220, OCTAVE = 25 // [Hz] of the tone without an error, and [mm] of error per octave above it
const LOUD = 0.08, SOON = 0.06 // loudness of a tone, and [s] in which it changes
const TONES = 100 // [ms] between changes of the tones
const CALM = matchMedia("(prefers-reduced-motion: reduce)")

const ACTS: Record<string, Command> = {
    slowly: { do: "ReplayBreakdown" },
    end: { do: "SelectPoint", index: null },
    reset: { do: "Reset" },
    earlier: { do: "UseEarlierSettings" },
}

export class Voice {
    readonly element = made("div", "")
    private readonly region = made("div", "")
    private readonly text = made("span", "")
    private readonly cross: HTMLButtonElement
    private readonly acts: Record<string, HTMLButtonElement>
    private readonly message: HTMLElement
    private readonly invited = made("div", "")
    private readonly act: HTMLButtonElement
    private readonly invitation: HTMLElement // what newcomers are invited to do
    private told = "" // a message that was closed or replaced by a summary does not come back
    private messages: number // shown so far: the same one may be shown again
    private summaries: number
    private stopped: string // the message of a stop that has been replayed, or had happened before
    private touches = 0
    private leaving = 0
    private wanted = ""
    private spokenAt = -AGAIN
    private waiting = 0
    private offered = ""
    private returns = false // whether the focus was in the invitation, and comes back with the next one
    private skipped = false

    constructor(private readonly engine: ServerEngine, private readonly texts: Texts, private readonly isUpright: () => boolean, private readonly ended: AbortSignal) {
        const { said, message, messages } = this.lab
        this.element.id = "op-said"
        this.region.id = "op-voice"
        this.region.setAttribute("aria-live", "polite")
        this.text.setAttribute("role", "status")
        this.messages = messages
        this.summaries = said.summaries
        this.stopped = said.replays ? message : ""
        this.acts = Object.fromEntries(Object.entries(ACTS).map(([name, command]) =>
            [name, this.button(name === "earlier" ? "op-act" : "op-quiet", "", () => engine.send(command))]))
        for (const [name, button] of Object.entries(this.acts)) button.dataset["name"] = name
        this.cross = this.button("op-cross", "\u00d7", () => (this.message.hidden = true))
        this.cross.ariaLabel = phrase(texts, "help.close")
        this.message = made("div", "op-over-scene", this.text, ...Object.values(this.acts), this.cross)
        this.message.id = "op-message"
        this.act = this.button("op-act", "", () => this.accept())
        const skip = this.button("op-quiet", phrase(texts, "invite.skip"), () => this.skip())
        this.invitation = made("div", "op-over-scene", this.invited, this.act, skip)
        this.invitation.id = "op-invitation"
        this.invited.ariaLive = "polite"
        this.invited.id = "op-invited"
        this.act.setAttribute("aria-describedby", this.invited.id)
        this.invited.tabIndex = -1
        this.message.hidden = this.invitation.hidden = true
        this.element.append(this.invitation, this.message, this.region)
        new DistanceTones(engine, ended)
        engine.on(change => change === "state" && this.show(), ended)
        ended.addEventListener("abort", () => this.element.remove())
        this.watchTouches()
        this.show()
    }

    /** Cover the scene. */
    place(left: number, top: number, width: number, height: number): void {
        Object.assign(this.element.style, { left: `${left}px`, top: `${top}px`, width: `${width}px`, height: `${height}px` })
    }

    private get lab(): StateMessage { return this.engine.lab! }

    private show(): void {
        const { message, level, messages, said } = this.lab
        if (message !== this.told || messages !== this.messages) {
            this.told = message
            this.messages = messages
            this.notify(message, level)
        }
        const labels: Record<string, string> = { earlier: said.earlier }
        if (said.stopped) Object.assign(labels, { slowly: phrase(this.texts, "breakdown.slowly"), reset: phrase(this.texts, "breakdown.reset") })
        if (level === "replay") labels["end"] = phrase(this.texts, "breakdown.end")
        for (const [name, button] of Object.entries(this.acts)) {
            tell(button, labels[name] ?? "")
            button.hidden = !labels[name]
        }
        if (said.summaries !== this.summaries) { // requested, so announced at once and also shown
            this.summaries = said.summaries
            clearTimeout(this.waiting)
            this.waiting = 0
            this.announce(said.summary)
            if (level !== "stop") this.notify(said.summary, "info")
        }
        this.wanted = said.voice
        if (this.wanted && !this.waiting) this.speak()
        this.replay()
        this.invite()
    }

    private notify(text: string, level: string): void {
        const { message } = this
        if (message.hidden || this.text.textContent !== text) this.text.textContent = text // else a screen reader repeats it
        message.dataset["level"] = level
        message.dataset["place"] = level === "replay" && this.isUpright() ? "top" : "bottom"
        message.hidden = text === ""
        clearTimeout(this.leaving)
        if (level === "info" || level === "warning") this.leave(STAYS + PER_LETTER * text.length)
    }

    /** Errors stay until they are over; other notices leave by themselves. */
    private leave(after: number): void {
        this.leaving = window.setTimeout(() => {
            if (this.message.matches(":hover, :focus-within")) this.leave(STAYS)
            else this.message.hidden = true
        }, after)
    }

    private speak(): void {
        this.waiting = 0
        const spoken = this.region.textContent ?? ""
        if (this.ended.aborted || this.wanted === spoken) return
        const left = this.spokenAt + (withoutNumbers(this.wanted) === withoutNumbers(spoken) ? AGAIN : REST) - performance.now()
        if (left > 0) this.waiting = window.setTimeout(() => this.speak(), left)
        else this.announce(this.wanted)
    }

    private announce(text: string): void {
        this.region.textContent = text
        this.spokenAt = performance.now()
    }

    /** When a robot has stopped, show its last moments once; but not under a finger, nor to users who ask for less motion. */
    private replay(): void {
        const { message, said: { replays } } = this.lab
        if (!replays || message === this.stopped || this.touches > 0) return
        this.stopped = message
        if (!CALM.matches) this.engine.send(ACTS["slowly"]!)
    }

    private watchTouches(): void {
        const options = { capture: true, signal: this.ended }
        addEventListener("pointerdown", () => (this.touches += 1), options)
        for (const kind of ["pointerup", "pointercancel"] as const)
            addEventListener(kind, () => {
                this.touches = Math.max(this.touches - 1, 0)
                setTimeout(() => !this.ended.aborted && this.replay())
            }, options)
    }

    private invite(): void {
        const { invitation } = this.lab.said
        if (invitation === this.offered) return
        this.offered = invitation
        const { activeElement } = document
        this.returns = this.invitation.contains(activeElement) || (this.returns && activeElement === document.body)
        this.invitation.hidden = this.skipped || invitation === ""
        if (this.invitation.hidden) return
        this.invited.replaceChildren(...withSigns(phrase(this.texts, `invite.${invitation}`)))
        this.act.hidden = !this.lab.said.act
        if (!this.act.hidden) tell(this.act, phrase(this.texts, `invite.${invitation}_button`))
        if (this.returns) (this.act.hidden ? this.invited : this.act).focus()
    }

    private accept(): void {
        const { act, invitation } = this.lab.said
        if (invitation === "lesson") this.skip()
        if (act) this.engine.send(act)
    }

    /** Users who skip the invitations are not asked again. */
    private skip(): void {
        this.skipped = this.invitation.hidden = true
        this.engine.send({ is: "skip" })
    }

    private button(name: string, text: string, act: () => void): HTMLButtonElement {
        const button = made("button", name, text)
        button.type = "button"
        button.addEventListener("click", event => {
            if (event.detail) button.blur() // pressed with the mouse: Space is for the lab again
            act()
        })
        return button
    }
}

/** The distances as two tones: the left robot's in the left ear, the right one's in the right. */
class DistanceTones {
    private context: AudioContext | null = null
    private voices: { tone: OscillatorNode; gain: GainNode }[] = []
    private due = 0

    constructor(private readonly engine: ServerEngine, ended: AbortSignal) {
        engine.on(() => this.play(), ended)
        for (const press of ["pointerdown", "keydown"]) addEventListener(press, () => this.wake(), { capture: true, signal: ended })
        ended.addEventListener("abort", () => void this.context?.close())
    }

    /** A tone rises by an octave in 25 mm, and is silent while the lab is paused. */
    private play(): void {
        const { engine } = this
        const on = engine.lab!.said.sounds
        if ((!on && !this.context) || performance.now() < this.due) return
        this.due = performance.now() + TONES
        if (!this.context) this.begin()
        this.wake()
        const now = this.context!.currentTime
        const loud = on && engine.state.running && engine.lab!.level !== "stop" ? LOUD : 0
        shown(engine).sides.forEach(({ distance }, i) => {
            const { tone, gain } = this.voices[i]!
            gain.gain.setTargetAtTime(loud, now, SOON)
            if (on) tone.frequency.setTargetAtTime(LOW * 2 ** Math.min((1e3 * distance) / OCTAVE, 4), now, SOON)
        })
    }

    private begin(): void {
        const context = (this.context = new AudioContext())
        this.voices = [-1, 1].map(side => {
            const tone = context.createOscillator(), gain = context.createGain(), pan = context.createStereoPanner()
            gain.gain.value = 0
            pan.pan.value = side
            tone.connect(gain).connect(pan).connect(context.destination)
            tone.start()
            return { tone, gain }
        })
    }

    /** Browsers allow sound only after the user has pressed something on the page. */
    private wake(): void {
        if (this.context?.state === "suspended") void this.context.resume()
    }
}
