// Keeps the page connected, and says in words what is going on until everything is there. A page has two websockets:
// our own (channel.ts), which opens the lab, and then viser's, which a worker of viser's opens, for the robots' picture.
// Whatever ends one of them, it is opened again, and the other one goes on meanwhile; a page stays away only if the
// lab refuses it for good.

import { made, tell } from "../core/dom"
import type { ServerEngine } from "./channel"
import { sayToViser } from "./kept"

const OPENS = 40_000 // [ms] that a websocket may take to open; viser gives up after 5 s
const VISERS = 5000 // [ms] that a websocket may take to open, viser's own limit
const EACH = 1000 // [ms] until a lost picture is asked for again
const LONGEST = 30_000 // [ms], longest time between attempts to get the picture
const ASKS = 10_000 // [ms] without our websocket after which the page asks why it does not open, and between further questions
const REFUSALS = 4 // greetings in a row that are refused, after which the page stays away
const SLOW = 3000, MUCH = 0.75 // [ms] without a message, or with less than this share of the speed
const SLEPT = 20_000, WAKES = 10_000 // [ms] between two checks of a page that slept; without a message after that
const DEAD = 75_000, BUILDS = 150_000 // [ms] without a message, after which a connection counts as lost: with a lab, and without
const MISSED = 10_000 // [ms] for which the lab may not know of a picture that was there
const RELOADED = "onpath-reloaded" // key in the session: when the page was loaded again for another version of the lab
const ORIGIN = "Onpath-Origin" // asks whether pages of an origin may connect; see request_filter.py

/** What is going on; connect-… of the catalogues. */
type Cause = "opening" | "silent" | "blocked" | "offline" | "lost" | "building" | "waits" | "back" | "slow" | Picture | Final
type Picture = "loading" | "picture_back" | "no_webgl"
type Final = "forbidden" | "refused" | "version"
/** What viser's worker tells. */
interface Heard { type: string; versionMismatch?: boolean }
const CALM: readonly string[] = ["opening", "building", "waits", "back", "loading", "picture_back", "no_webgl"]

export class Connection {
    private readonly box = made("p", "op-notice")
    private wasThere = false
    private found: "silent" | "blocked" | null = null // why our websocket does not open
    private final: Final | null = null
    private asked = performance.now()
    private quiet = 0 // [ms] of checks without a message
    private late = 0 // [ms] of checks at which the lab is too slow
    private slept = false
    private checked = Date.now() // a page's own time may stand still while it sleeps
    private heard = 0

    /** `picture`: that of the robots, which viser draws; null on a page without it. */
    constructor(private readonly engine: ServerEngine, private readonly picture: PictureLink | null) {
        this.box.setAttribute("role", "status")
        if (picture) sayToViser(() => `${engine.page}.${picture.asked}`)
        for (const event of ["online", "focus", "pageshow"]) addEventListener(event, () => picture?.soon())
        document.addEventListener("visibilitychange", () => {
            this.quiet = 0
            picture?.soon()
        })
    }

    /** Open what is missing, and say what is; called repeatedly.
     * @param face whether our part of the page is shown */
    check(face: boolean): void {
        const now = performance.now(), date = Date.now(), gap = Math.max(date - this.checked, 0), { engine, picture } = this
        this.checked = date
        if (!this.final) engine.open()
        const isThere = engine.connected && face
        if (isThere) this.wasThere = true
        this.count(Math.min(gap, 1000), isThere)
        if (gap > SLEPT) [this.slept, this.quiet] = [true, 0]
        if (engine.outdated) this.reload()
        if (engine.refused >= REFUSALS) this.end("refused")
        if (!this.final && engine.isOpen && this.quiet > (this.slept ? WAKES : this.wasThere ? DEAD : BUILDS)) this.renew()
        if (!this.final && !engine.isOpen && now > this.asked + ASKS) {
            this.asked = now
            void this.ask()
        }
        if (engine.isOpen) {
            this.found = null
            this.asked = now
        }
        if (engine.connected && engine.lab && !this.final) picture?.check(now, engine.lab.scene)
        if (picture?.outdated) this.reload()
        this.say(this.cause(isThere))
        const { classList } = document.documentElement
        classList.toggle("op-lost", this.wasThere && !isThere)
        if (picture) classList.toggle("op-no-picture", !picture.isThere)
    }

    /** Count how long nothing has come, or too slowly; a page that stands still itself counts as one check. */
    private count(gap: number, isThere: boolean): void {
        const { engine } = this
        if (engine.heard !== this.heard) {
            this.heard = engine.heard
            this.quiet = 0
            this.slept = false
        } else if (engine.isOpen && (this.slept || !engine.waits) && document.visibilityState === "visible") this.quiet += gap
        const lab = isThere && engine.state.running ? engine.lab! : null
        this.late = lab && lab.achieved < MUCH * lab.rate ? this.late + gap : 0
    }

    private cause(isThere: boolean): Cause | null {
        const { engine, picture } = this
        if (this.final) return this.final
        if (!engine.isOpen) {
            if (!navigator.onLine && !/^(localhost|127\..*|\[::1\])$/.test(location.hostname)) return "offline"
            return this.found ?? (this.wasThere ? "lost" : "opening")
        }
        if (engine.waits) return "waits"
        if (!isThere) return this.wasThere ? "back" : "building"
        if (Math.max(this.quiet, this.late) > SLOW) return "slow"
        if (!picture) return null
        if (!webgl.works) return "no_webgl"
        return picture.isThere ? null : picture.wasThere ? "picture_back" : "loading"
    }

    private say(cause: Cause | null): void {
        const { box } = this
        if (!cause) return box.remove()
        const phrases = ownWords.text()
        if (box.dataset["cause"] !== cause || box.lang !== ownWords.language() || cause === "waits") {
            const text = cause === "waits" ? this.engine.waits : phrases[cause]!.replace("{origin}", location.origin)
            if (cause === "no_webgl" && phrases["course_url"]) {
                const link = made("a", "", phrases["course_link"]!)
                link.href = phrases["course_url"]
                box.replaceChildren(`${text} `, link)
            } else tell(box, text)
        }
        box.lang = ownWords.language()
        box.dataset["cause"] = cause
        box.classList.toggle("op-calm", CALM.includes(cause))
        if (!box.isConnected) document.body?.append(box)
    }

    /** Open both websockets again: they may have ended without our knowing. */
    private renew(): void {
        this.quiet = 0
        this.slept = false
        this.asked = performance.now()
        this.engine.close()
        this.engine.open()
        this.picture?.renew()
    }

    /** Ask the server why our websocket does not open: a browser does not tell. */
    private async ask(): Promise<void> {
        const headers = { [ORIGIN]: location.origin }
        try {
            const { status } = await fetch(location.pathname, { headers, cache: "no-store", signal: AbortSignal.timeout(OPENS) })
            if (status === 403 && !this.engine.isOpen) this.end("forbidden")
            this.found = status < 500 ? "blocked" : "silent"
        } catch {
            this.found = "silent"
        }
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
        if (Math.abs(Date.now() - last) > DEAD) location.reload()
    }

    private end(final: Final): void {
        this.final = final
        this.engine.close()
    }
}

/** The robots' picture: viser's websocket, and whether its page is there. It is asked for once the lab is there. */
export class PictureLink {
    /** Whether viser's page is of another version than its server. */
    outdated = false
    /** Whether the picture has been there. */
    wasThere = false
    /** How many times it has been asked for. */
    asked = 0
    private connect: (() => void) | null = null // has viser's worker open its websocket
    private state: "closed" | "opening" | "open" = "closed"
    private scene = 0 // the asking whose picture the lab draws
    private again = 0 // [ms], when it may be tried again
    private ended = 0 // attempts in a row that ended before the picture was there
    private came = false // whether the picture that was asked for last has been there
    private missed = 0 // [ms], since when the lab has not known of it

    constructor() {
        this.followWorkers()
    }

    /** Whether the lab draws it, in this page. */
    get isThere(): boolean { return this.state === "open" && this.asked === this.scene }

    /** Open viser's websocket if it is missing.
     * @param scene the asking whose picture the lab draws */
    check(now: number, scene: number): void {
        this.scene = scene
        if (this.isThere) {
            this.wasThere = this.came = true
            this.ended = 0
        }
        if (this.state === "closed" && this.connect && webgl.works && now > this.again) this.open(now)
        if (this.state !== "open" || this.isThere) this.missed = now
        if (now > this.missed + (this.came ? MISSED : BUILDS)) this.renew()
    }

    /** Try again at once if it is missing. */
    soon(): void {
        this.again = 0
    }

    /** Have viser's page built again. */
    renew(): void {
        if (this.state === "open") this.open(performance.now())
    }

    private open(now: number): void {
        this.state = "opening"
        this.asked++
        this.came = false
        this.missed = now
        this.connect!()
    }

    /** Follow the worker that holds viser's websocket, decide in viser's place when it connects, and let it be patient:
     * viser tries once a second, only in a window that has the focus, and each time gives up the attempt before. */
    private followWorkers(): void {
        const send = Worker.prototype.postMessage // oxlint-disable-line typescript/unbound-method
        const follow = (worker: Worker, begin: () => void) => {
            this.state = "closed"
            this.connect = () => {
                this.connect = () => send.call(worker, { type: "retry" })
                begin()
            }
            worker.addEventListener("message", ({ data }) => this.hear(data as Heard))
        }
        window.Worker = class extends Worker {
            constructor(url: string | URL, options?: WorkerOptions) {
                super(options?.type === "module" ? patient(url) : url, options)
            }
            override postMessage(message: unknown, how?: Transferable[] | StructuredSerializeOptions): void {
                const { type } = (message ?? {}) as { type?: unknown }
                if (type === "retry") return
                const post = () => super.postMessage(message, how as Transferable[])
                if (type === "set_server") follow(this, post)
                else post()
            }
        }
    }

    private hear({ type, versionMismatch }: Heard): void {
        if (type === "connected") {
            this.state = "open"
            this.missed = performance.now()
        } else if (type === "closed") {
            if (versionMismatch) this.outdated = true
            const after = this.ended++ ? Math.min(EACH * 2 ** (this.ended - 2), LONGEST) : 0
            this.state = "closed"
            this.again = performance.now() + after * (0.8 + 0.4 * Math.random()) // a whole class does not come at once
        }
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
