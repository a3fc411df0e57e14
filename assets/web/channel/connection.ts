// Keeps the page connected, and says in words what is going on until everything is there. A page has two websockets:
// viser's, which a worker of viser's opens, and our own (channel.ts), for which viser's page brings a ticket. Whatever
// ends one of them, it is opened again; a page stays away only if the lab refuses it for good.

import { made, tell } from "../core/dom"
import type { RemoteEngine } from "./channel"

const OPENS = 40_000 // [ms] that viser's websocket may take to open; viser gives up after 5 s
const VISERS = 5000 // [ms], viser's own limit
const SOON = 100, EACH = 1000 // [ms] until a lost connection is opened again: at first, and then
const LONGEST = 30_000 // [ms] between connections that end before the page is there
const ASKS = 10_000 // [ms] between questions why viser's websocket does not open
const RENEWS = 3000 // [ms] that a page whose ticket was refused waits for another one
const REFUSALS = 4 // tickets in a row that are refused, after which the page stays away
const SLOW = 3000, MUCH = 0.75 // [ms] without a message, or with less than this share of the speed
const SLEPT = 20_000, WAKES = 10_000 // [ms] between two looks of a page that slept; without a message after that
const DEAD = 75_000, BUILDS = 150_000 // [ms] without a message, after which a connection counts as lost: with a page, and without
const RELOADED = "onpath-reloaded" // when a page was loaded anew for another version of the lab
const ORIGIN = "Onpath-Origin" // asks whether pages of an origin may connect; see request_filter.py

/** What is going on; connect-… of the catalogues. */
type Cause = "opening" | "silent" | "blocked" | "offline" | "lost" | "building" | "loading" | "back" | "slow" | Final
type Final = "forbidden" | "refused" | "version"
/** What viser's worker tells. */
interface Heard { type: string; versionMismatch?: boolean }
const CALM: readonly string[] = ["opening", "building", "loading", "back"]

/** Of browser_words.js, which comes before this script. */
declare const ownWords: { text(): Record<string, string>; language(): string }

export class Connection {
    private readonly box = made("p", "op-notice")
    private connect = () => {} // has the worker open viser's websocket anew
    private open = false
    private tries = 0 // that have failed, in a row
    private ended = 0 // connections in a row that ended before the page was there
    private again = 0 // timer
    private found: "silent" | "blocked" | null = null // why viser's websocket does not open
    private final: Final | null = null
    private asked = Date.now()
    private former = "" // the ticket before the last connection
    private ticket = ""
    private wasThere = false
    private quiet = 0 // [ms] of looks without a message
    private late = 0 // [ms] of looks at which the lab is too slow
    private slept = false
    private looked = Date.now()
    private heard = 0

    constructor(private readonly engine: RemoteEngine) {
        this.box.setAttribute("role", "status")
        this.followWorkers()
        for (const event of ["online", "focus", "pageshow"]) addEventListener(event, () => this.open || this.retry(SOON))
        document.addEventListener("readystatechange", () => this.look(false), { once: true }) // before viser's script begins
        document.addEventListener("visibilitychange", () => {
            this.quiet = 0
            if (!this.open) this.retry(SOON)
        })
    }

    /** Note the ticket of viser's page, and connect our own websocket with it, unless it is an earlier one. */
    page(ticket: string): void {
        this.ticket = ticket
        if (this.hasPage && !this.final) this.engine.open(ticket)
    }

    /** Whether viser's page has come since it was connected last. */
    private get hasPage(): boolean { return this.ticket !== "" && this.ticket !== this.former }

    /** Whether the lab itself says why there is no page: it is full, and the page waits for a place. */
    private get waits(): boolean { return !this.hasPage && document.querySelector(".mantine-Modal-content") !== null }

    /** Look what is missing, and say so; called repeatedly.
     * @param face whether our part of the page is shown */
    look(face: boolean): void {
        const now = Date.now(), gap = now - this.looked, { engine } = this
        this.looked = now
        const isThere = this.open && this.hasPage && engine.connected && face
        if (isThere) {
            this.wasThere = true
            this.tries = this.ended = 0
        }
        this.count(Math.min(gap, 1000), isThere)
        if (gap > SLEPT) [this.slept, this.quiet] = [true, 0]
        if (engine.outdated) this.reload()
        if (this.open && !this.final) this.check(now)
        if (!this.open && !this.final && now > this.asked + ASKS) {
            this.asked = now
            void this.ask()
        }
        this.say(this.cause(isThere))
        document.documentElement.classList.toggle("op-lost", this.wasThere && !isThere)
        document.documentElement.classList.toggle("op-back", this.wasThere && this.open && !this.hasPage)
    }

    /** Have the page made anew if its ticket is not valid, or nothing comes any more. */
    private check(now: number): void {
        const { refused } = this.engine
        if (this.hasPage && refused.ticket === this.ticket && now > refused.at + RENEWS) {
            if (refused.times < REFUSALS) this.renew()
            else this.end("refused")
        } else if (this.quiet > (this.slept ? WAKES : this.hasPage ? DEAD : BUILDS)) this.renew()
    }

    /** Count how long nothing has come, or too slowly; a page that stands still itself counts as one look. */
    private count(gap: number, isThere: boolean): void {
        const { engine } = this
        if (engine.heard !== this.heard) {
            this.heard = engine.heard
            this.quiet = 0
            this.slept = false
        } else if (this.open && (this.slept || !this.waits) && document.visibilityState === "visible") this.quiet += gap
        const lab = isThere && engine.state.running ? engine.lab! : null
        this.late = lab && lab.achieved < MUCH * lab.rate ? this.late + gap : 0
    }

    private cause(isThere: boolean): Cause | null {
        if (this.final) return this.final
        if (!this.open) {
            if (!navigator.onLine && !/^(localhost|127\..*|\[::1\])$/.test(location.hostname)) return "offline"
            return this.found ?? (this.wasThere ? "lost" : "opening")
        }
        if (isThere) return Math.max(this.quiet, this.late) > SLOW ? "slow" : null
        if (this.waits) return null
        if (this.wasThere) return "back"
        return this.hasPage ? "loading" : "building"
    }

    private say(cause: Cause | null): void {
        const { box } = this
        if (!cause) return box.remove()
        tell(box, ownWords.text()[cause]!.replace("{origin}", location.origin))
        box.lang = ownWords.language()
        box.dataset["cause"] = cause
        box.classList.toggle("op-calm", CALM.includes(cause))
        if (!box.isConnected) document.body?.append(box)
    }

    /** Follow the worker that holds viser's websocket, decide in viser's place when it tries again, and let it be patient:
     * viser tries once a second, only in a window that has the focus, and each time gives up the attempt before. */
    private followWorkers(): void {
        const send = Worker.prototype.postMessage // oxlint-disable-line typescript/unbound-method
        const follow = (worker: Worker) => {
            this.connect = () => send.call(worker, { type: "retry" })
            worker.addEventListener("message", ({ data }) => this.hear(data as Heard))
        }
        window.Worker = class extends Worker {
            constructor(url: string | URL, options?: WorkerOptions) {
                super(options?.type === "module" ? patient(url) : url, options)
            }
            override postMessage(message: unknown, how?: Transferable[] | StructuredSerializeOptions): void {
                const { type } = (message ?? {}) as { type?: unknown }
                if (type === "retry") return
                if (type === "set_server") follow(this)
                super.postMessage(message, how as Transferable[])
            }
        }
    }

    private hear({ type, versionMismatch }: Heard): void {
        if (!this.hasPage) this.quiet = 0
        if (type === "connected") {
            clearTimeout(this.again)
            this.open = true
            this.found = null
            this.former = this.ticket
        } else if (type === "closed") {
            if (this.open) this.asked = Date.now()
            if (this.open && !this.hasPage) this.ended++
            this.open = false
            this.tries++
            if (versionMismatch) this.reload()
            this.retry(this.ended ? Math.min(EACH * 2 ** (this.ended - 1), LONGEST) : this.tries > 1 ? EACH : SOON)
        }
    }

    /** Open viser's websocket soon. A whole class does not come at once. */
    private retry(after: number): void {
        clearTimeout(this.again)
        if (!this.final) this.again = window.setTimeout(() => this.connect(), after * (0.8 + 0.4 * Math.random()))
    }

    /** Have viser's page made anew, with another ticket: it may have ended without our knowing. */
    private renew(): void {
        this.quiet = 0
        this.slept = this.open = false
        this.asked = Date.now()
        this.former = this.ticket
        this.connect()
    }

    /** Ask the server why viser's websocket does not open: a browser does not tell. */
    private async ask(): Promise<void> {
        const headers = { [ORIGIN]: location.origin }
        try {
            const { status } = await fetch(location.pathname, { headers, cache: "no-store", signal: AbortSignal.timeout(OPENS) })
            if (status === 403 && !this.open) this.end("forbidden")
            this.found = status < 500 ? "blocked" : "silent"
        } catch {
            this.found = "silent"
        }
        if (this.open) this.found = null
    }

    /** Load the page of the lab's present version, but not again and again. */
    private reload(): void {
        if (this.final) return
        let last = Date.now()
        try {
            last = Number(sessionStorage.getItem(RELOADED))
            sessionStorage.setItem(RELOADED, String(Date.now()))
        } catch {} // a browser without storage asks its user
        this.end("version")
        if (Date.now() - last > DEAD) location.reload()
    }

    private end(final: Final): void {
        clearTimeout(this.again)
        this.final = final
        this.engine.close()
    }
}

/** The address of a worker's script whose websocket may take longer to open. */
function patient(script: string | URL): string {
    const first = `const after = setTimeout; self.setTimeout = (act, ms, ...how) => after(act, ms === ${VISERS} ? ${OPENS} : ms, ...how)`
    return address(`import ${JSON.stringify(address(first))}; import ${JSON.stringify(String(script))}`)
}

function address(script: string): string {
    return URL.createObjectURL(new Blob([script], { type: "text/javascript" }))
}
