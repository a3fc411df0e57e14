// The engine of a page of the lab: its server simulates, and tells it through a websocket of the page's own.

import type { FormMessage } from "../core/form_data"
import { keepDraftsOf } from "../core/drafts"
import { logCurves, sampleAt, type Act, type Change, type Engine, type LogCurves, type PathShape, type RowData, type Sample, type SideSample, type SideText, type State, type Vector } from "../core/engine"
import { AT_JOINTS } from "../core/symbols"
import { Files } from "./files"
import { driversKey, keep, keepLab, kept, siteOf } from "./kept"
import { Outbox } from "./outbox"
import { RemoteSettings } from "./settings"
import {
    PROTOCOL, type Ask, type ClassMessage, type Command, type Compared, type CompareSheet, type DisplaySheet, type FrameMessage, type Hello, type HelpSheet, type Index, type KeepSheet,
    type LabMessage, type LawSheet, type LessonMessage, type LessonSheet, type Light, type MeasuredMessage, type PageMessage, type PathMessage,
    type RobotSheet, type SeatAnswer, type StateMessage, type RemoteMessage, type Told, type WallMessage, type WordsMessage,
} from "./messages"

const SECONDS = 60 // [s] of samples that are kept
const [TIME, LENGTH, ANGLE, FORCE] = [1e4, 1e5, 1e4, 1e2] // units per second, metre, radian, newton
const HEAD = 2 // numbers at the beginning of a row, before those of the robots
const PATIENCE = [0, 500, 1000, 2000] // [ms] until each attempt to connect again
const REFUSED = 4001 // websocket close code: the lab does not take the greeting
const OTHER_VERSION = 1002
const HANDED = 60 // [ms], least time between two requests for the past
const KEPT = ["labs", "teacher", "speaks", "sounds", "first_minute"]
const FIRST_SHAPE = 1.75 // width by height of the picture for which the lab's first camera is; see app/scene/stage.py
const SEES = 2000 // [ms] between messages that say that the page is drawn
const SETTLES = 400 // [ms] for which a local seek overrides the server's position

/** Where the numbers of a field are among those that a row has besides for each robot. */
type Fields = Map<string, { first: number; size: number; unit: number }>
type SheetName = Ask["what"]
/** What an open sheet is told without having asked for it just now. */
export type News = Compared | Told | SeatAnswer
type Answer = RobotSheet | LawSheet | CompareSheet | KeepSheet | LessonSheet | HelpSheet | DisplaySheet | Index

/** A path through points at evenly spaced θ from -π to π. */
class SampledPath implements PathShape {
    readonly lines: readonly (readonly Vector[])[]
    readonly strokes: readonly (readonly Vector[])[]
    readonly links: readonly (readonly Vector[])[]
    readonly closed: boolean
    readonly right: Vector
    readonly up: Vector
    private readonly points: readonly Vector[]

    constructor({ points, closed, raised, right, up }: Omit<PathMessage, "is">) {
        this.points = points.map(point => point.map(each => each / LENGTH))
        this.lines = [this.points]
        this.closed = closed
        const ends = [-Math.PI, ...raised.flat(), Math.PI]
        const parts = ends.slice(1).map((end, i) => this.between(ends[i]!, end))
        this.strokes = parts.filter((_, i) => i % 2 === 0)
        this.links = parts.filter((_, i) => i % 2 === 1)
        this.right = right
        this.up = up
    }

    private between(begin: number, end: number): readonly Vector[] {
        const count = this.points.length - 1, place = (theta: number) => ((theta + Math.PI) / (2 * Math.PI)) * count
        const inside = this.points.slice(Math.floor(place(begin)) + 1, Math.ceil(place(end)))
        return [this.at(begin), ...inside, this.at(end)]
    }

    /** The point at θ: a cubic through the four next points; an open path goes on along its end tangents. */
    at(theta: number): Vector {
        const { points, closed } = this
        const last = points.length - 1
        let place = ((theta + Math.PI) / (2 * Math.PI)) * last
        if (closed) place = ((place % last) + last) % last
        const begin = Math.min(Math.max(Math.floor(place), 0), last - 1)
        const t = place - begin
        const point = (i: number): Vector => {
            if (closed) return points[((i % last) + last) % last]!
            const inside = Math.min(Math.max(i, 0), last)
            const [end, next] = [points[inside]!, points[inside === i ? inside : inside - Math.sign(i)]!]
            return inside === i ? end : end.map((each, k) => 2 * each - next[k]!)
        }
        const [a, b, c, d] = [point(begin - 1), point(begin), point(begin + 1), point(begin + 2)]
        if (t < 0 || t > 1) return b.map((each, k) => each + t * (c[k]! - each))
        return b.map((each, k) => {
            const [before, after] = [(c[k]! - a[k]!) / 2, (d[k]! - each) / 2]
            const by = c[k]! - each
            return each + t * (before + t * (3 * by - 2 * before - after + t * (before + after - 2 * by)))
        })
    }
}

/** One robot in a row. */
class RowSide implements SideSample {
    readonly held: boolean
    readonly pulled: boolean

    constructor(
        private readonly engine: ServerEngine,
        private readonly row: readonly (number | null)[],
        private readonly first: number, // of its numbers
        private readonly p: number,
        private readonly side: number,
        private readonly fields: Fields,
        private readonly more: number, // the first of its numbers of these fields
        readonly straight: Vector | null,
    ) {
        this.held = Boolean(row[1]! & (1 << side))
        this.pulled = Boolean(row[1]! & (4 << side))
    }

    get distance(): number { return this.row[this.first]! / LENGTH }
    get closest(): Vector { return this.engine.route.at(this.row[this.first + 1]! / ANGLE) }
    get reference(): Vector | null {
        return this.engine.lab?.clocks[this.side] ? this.engine.route.at(this.row[this.first + 2]! / ANGLE) : null
    }
    get tip(): Vector { return this.part(3, LENGTH) }
    get force(): Vector { return this.part(3 + this.p, FORCE) }
    private part(at: number, unit: number): Vector {
        return this.numbers(this.first + at, this.p, unit)!
    }

    private numbers(begin: number, size: number, unit: number): Vector | null {
        const found = this.row.slice(begin, begin + size)
        return found.includes(null) ? null : found.map(each => each! / unit)
    }

    /** See `Engine.field`. */
    field(name: string): Vector | null {
        if (name === "distance") return [this.distance]
        if (name === "theta") return this.numbers(this.first + 1, 1, ANGLE)
        if (name === "theta_ref") return this.engine.lab?.clocks[this.side] ? this.numbers(this.first + 2, 1, ANGLE) : null
        if (name === "force") return this.force
        const found = this.fields.get(name)
        return found ? this.numbers(this.more + found.first, found.size, found.unit) : null
    }
}

export class ServerEngine implements Engine {
    /** What the lab is called and set to; null until it is known. */
    lab: StateMessage | null = null
    route = new SampledPath({ points: [[0, 0], [0, 0]], closed: false, raised: [], right: [1, 0], up: [0, 1] })
    /** Whether the page hears from its lab. */
    connected = false
    /** The number by which viser's websocket is known to be this page's. */
    readonly page = Array.from(crypto.getRandomValues(new Uint8Array(16)), each => each.toString(16).padStart(2, "0")).join("")
    /** The page's texts; null until they are known. */
    words: WordsMessage | null = null
    /** Why there is no lab yet; empty otherwise. */
    waits = ""
    /** How many messages it has heard, and connections opened. */
    heard = 0
    /** How many connections in a row were refused. */
    refused = 0
    /** Whether the lab is of another version. */
    outdated = false
    readonly files = new Files(message => this.send(message))
    /** Answers that are not stored yet. */
    readonly outbox = new Outbox(command => this.send(command), () => this.tell("lesson"))
    readonly settings = new RemoteSettings(message => this.send(message))
    /** The forms of the lab and of an open step; the lab tells them if it is asked. */
    readonly forms = new Map<FormMessage["place"], FormMessage>()
    private asksForm = false
    private readonly drives: string // key of the page that drives a plant
    /** The open step of a lesson, and what is measured in it; null until they are known. */
    lesson: LessonMessage | null = null
    measured: MeasuredMessage | null = null
    /** What a class's wall shows besides the robots; null until it is known, and on other pages. */
    wall: WallMessage | null = null
    /** What a class's remote control is told besides its form; null until it is known, and on other pages. */
    remote: RemoteMessage | null = null
    log: LogCurves | null = null
    /** The lab's place in a class; null until it is known. */
    seat: ClassMessage | null = null
    /** Whether the page has offered to join the class. */
    hasGreeted = false
    shape = FIRST_SHAPE // width of the picture over its height
    private samples: Sample[] = [] // the last one is the present
    private fields: Fields = new Map()
    private plotted: readonly string[] = [] // fields that are asked for
    private running = false
    private past: number | null = null
    private sought: { at: number | null; until: number } | null = null
    private pointed = "" // symbol of a lesson's text
    private symbol: Light["symbol"] = "" // whose lines are asked for
    private symbolLines: { symbol: string; lines: readonly Vector[][] } = { symbol: "", lines: [] }
    private sending = 0 // timer until the lab is told of it
    private socket: WebSocket | null = null
    private hasLab = false // whether this connection has had a lab
    private sees = false
    private tries = 0
    private saw = 0 // [ms], when the page was drawn, as the lab knows
    private again = 0 // [ms], when it may be tried again
    private asked: { what: SheetName; resolve: (answer: Answer) => void }[] = [] // not answered yet
    private readonly news = new Set<(news: News) => void>()
    private readonly listeners = new Set<(change: Change) => void>()

    /** How the page is drawn: dark, in software, in an upright window. `shows`: a class's wall asks for nothing, and its remote control shows no lab. */
    constructor(private readonly drawn: () => { dark: boolean; plain: boolean; upright: boolean }, private readonly shows: "lab" | "wall" | "remote" = "lab") {
        this.drives = shows === "lab" ? driversKey() : ""
    }

    /** Have the lab tell its form and the values of its fields. */
    askForm(): void {
        if (!this.asksForm) this.send({ is: "fields" })
        this.asksForm = true
    }

    /** How each robot is seen, see StateMessage; until there is a picture, a window of any shape shows all of them. */
    get cameras(): readonly (readonly (readonly number[])[])[] {
        const { cameras, drawn } = this.lab!
        const share = drawn ? 1 : Math.min(this.shape / FIRST_SHAPE, 1)
        return share === 1 ? cameras : cameras.map(([across, down, depth]) => [across!.map(each => share * each), down!.map(each => share * each), depth!])
    }

    /** Whether the websocket is open. */
    get isOpen(): boolean { return this.socket?.readyState === WebSocket.OPEN }

    /** Whether there is something to show. */
    get ready(): boolean { return this.words !== null && (this.shows === "remote" ? this.remote !== null : this.lab !== null && this.samples.length > 0) }

    /** Connect, unless it is connected, or was a moment ago; called repeatedly. */
    open(): void {
        if (this.socket || performance.now() < this.again) return
        if (!this.sees) this.see()
        const socket = new WebSocket(location.href.replace(/^http/, "ws").replace(/[?#].*$/, ""), PROTOCOL)
        this.socket = socket
        socket.addEventListener("open", () => {
            this.heard++
            socket.send(JSON.stringify(this.greeting))
        })
        socket.addEventListener("message", ({ data }) => socket === this.socket && this.hear(JSON.parse(data as string) as LabMessage))
        socket.addEventListener("close", ({ code }) => socket === this.socket && this.closed(code))
    }

    private get greeting(): Hello {
        const { page } = this, [labs, teacher, speaks, sounds, first_minute] = this.shows === "wall" ? [] : KEPT.map(kept)
        return { is: "hello", page, site: siteOf(location), ...this.drawn(), labs, teacher, speaks, sounds, first_minute, drives: this.drives }
    }

    /** Tell the lab that the page is drawn: a lab that nobody sees rests. */
    private see(): void {
        this.sees = true
        requestAnimationFrame(now => {
            if (now > this.saw + SEES && this.connected) {
                this.saw = now
                this.send({ is: "seen" })
            }
            this.see()
        })
    }

    close(): void {
        const { socket } = this
        this.socket = null
        socket?.close()
        this.connected = false
    }

    get state(): State {
        const { held, pulled } = this.flags
        const sought = this.sought && performance.now() < this.sought.until ? this.sought : null
        const past = sought ? sought.at : this.past
        return { running: this.running && past === null, rate: this.lab?.rate ?? 1, held, pulled, past, branches: this.lab?.own ?? false, frozen: this.lab?.frozen ?? "" }
    }

    get path(): PathShape { return this.route }

    get texts(): SideText[] {
        const { titles, names, texts, captions } = this.lab!
        return titles.map((title, i) => ({ side: i as 0 | 1, title, name: names[i]!, text: texts[i]!, caption: captions[i]! }))
    }

    get rows(): readonly RowData[] { return this.lab?.rows ?? [] }

    plot(fields: readonly string[]): void {
        if (String(fields) === String(this.plotted)) return
        this.plotted = fields
        this.send({ is: "plots", fields: [...fields] })
    }

    field({ sides }: Sample, side: number, name: string): Vector | null { return (sides[side] as RowSide).field(name) }

    get present(): Sample { return this.samples[this.samples.length - 1]! }

    since(time: number): readonly Sample[] {
        return this.samples.slice(this.samples.findLastIndex(sample => sample.time <= time) + 1, -1)
    }

    on(listener: (change: Change) => void, ended?: AbortSignal): void {
        this.listeners.add(listener)
        ended?.addEventListener("abort", () => this.listeners.delete(listener))
    }

    act(act: Act): void {
        if (!this.lab?.own || this.lab.plant) return
        if (act.do === "seek") this.seek(act.at)
        else {
            this.sought = null
            if (act.do === "hold") this.send({ do: "Hold", on: act.on })
            else if (act.do === "run") this.send({ do: "SetRunning", running: act.on })
            else if (act.do === "rate") this.send({ do: "Set", name: "rate", value: act.rate })
            else this.send({ do: ({ step: "StepOnce", reset: "Reset", goOn: "GoOn" } as const)[act.do] })
        }
    }

    lit(symbol: string, side: number): readonly Vector[] {
        return symbol && this.symbolLines.symbol === symbol ? this.symbolLines.lines[side] ?? [] : []
    }

    /** Ask what a symbol means, and be told as long as the robots move; of joints, only the server knows. */
    light(symbol: string): void {
        this.pointed = symbol
        this.askLines()
    }

    /** Without a picture of the robots, their bars are asked for, too. */
    private askLines(): void {
        if (this.shows === "wall") return
        const asked = AT_JOINTS.find(each => each === this.pointed) ?? (this.lab?.drawn === false ? "bars" : "")
        if (asked === this.symbol) return
        this.symbol = asked
        this.send({ is: "light", symbol: asked })
    }

    /** Send a message; it is lost while there is no connection. */
    send(message: Command | PageMessage): void {
        if (this.isOpen) this.socket!.send(JSON.stringify(message))
    }

    /** What the lab says now for a sheet of the page. */
    ask<Name extends SheetName>(what: Name): Promise<Extract<Answer, { is: Name }>> {
        return new Promise(resolve => {
            this.asked.push({ what, resolve: resolve as (answer: Answer) => void })
            this.send({ is: "ask", what })
        })
    }

    /** Hear what an open sheet is told later. */
    onNews(listener: (news: News) => void, ended: AbortSignal): void {
        this.news.add(listener)
        ended.addEventListener("abort", () => this.news.delete(listener))
    }

    private get flags(): { held: boolean; pulled: boolean } {
        const sides = this.samples.length ? this.present.sides : []
        return { held: sides.some(each => each.held), pulled: sides.some(each => each.pulled) }
    }

    /** Show an instant at once, and let the lab show it soon. */
    private seek(at: number | null): void {
        const sample = at === null ? undefined : sampleAt(this.samples, at)
        this.sought = { at: sample && sample !== this.present ? sample.time : null, until: performance.now() + SETTLES }
        this.sending ||= window.setTimeout(() => {
            this.sending = 0
            if (!this.sought) return
            this.sought.until = performance.now() + SETTLES
            this.send({ do: "LookAt", ago: this.sought.at === null ? 0 : this.present.time - this.sought.at })
            setTimeout(() => this.tell("state"), SETTLES + 1)
        }, HANDED)
        this.tell("state")
    }

    /** Take a message; the page goes on after one that it cannot use. */
    private hear(message: LabMessage): void {
        try {
            this.take(message)
        } catch (error) {
            console.warn(`a message that cannot be used: ${String(error)}`)
        }
    }

    private take(message: LabMessage): void {
        this.heard++
        if (!this.connected) {
            this.connected = true
            this.tries = this.refused = this.saw = 0
            this.hasLab = false
            this.askAgain()
            this.tell("state")
        }
        this.waits = message.is === "wait" ? message.text : message.is === "store" ? this.waits : ""
        if (message.is === "frame") this.frame(message)
        else if (message.is === "path") {
            this.route = new SampledPath(message)
            this.tell("path")
        } else if (message.is === "lit") {
            const { symbol, lines } = message
            this.symbolLines = { symbol, lines: lines.map(line => line.map(point => point.map(each => each / LENGTH))) }
            this.tell("samples")
        } else if (message.is === "state") {
            this.lab = { ...this.lab, ...message } as StateMessage // the first one has everything
            this.askLines()
            this.outbox.settle(this.lab.sent)
            this.tell("state")
        } else if (message.is === "lesson") {
            this.lesson = message
            this.tell("lesson")
        } else if (message.is === "measured") {
            this.measured = message
            this.tell("measured")
        } else if (message.is === "form") {
            this.forms.set(message.place, message)
            this.tell("form")
        } else if (message.is === "values") {
            this.settings.hear(message)
            this.tell("values")
        } else if (message.is === "file" || message.is === "download" || message.is === "part") this.files.hear(message)
        else if (message.is === "compared" || message.is === "told" || message.is === "seat") for (const listener of this.news) listener(message)
        else if (message.is === "words") {
            this.words = message
            this.tell("words")
        } else if (message.is === "lab") {
            keepLab(message.code)
            this.log = null // if there is one, it is told next
            keepDraftsOf(message.code)
            this.outbox.reach(message.code)
            if (this.hasLab) this.askAgain() // another lab, or the same one as another page
            this.hasLab = true
        }
        else if (message.is === "class") {
            this.seat = message
            this.tell("class")
        } else if (message.is === "wall") {
            this.wall = message
            this.tell("class")
        } else if (message.is === "log") {
            this.log = message.file ? logCurves(message.file, message.times, message.fields) : null
            this.tell("log")
        } else if (message.is === "remote") {
            this.remote = message
            this.tell("class")
        } else if (message.is === "store") keep(message.key, message.value)
        else if (message.is === "refused") console.warn(`refused: ${message.why}`)
        else if (message.is !== "alive" && message.is !== "wait") this.answered(message)
    }

    /** Nobody who is asked now knows what the page has asked for. */
    private askAgain(): void {
        if (this.symbol) this.send({ is: "light", symbol: this.symbol })
        if (this.plotted.length) this.send({ is: "plots", fields: [...this.plotted] })
        this.files.restart()
        if (this.asksForm) this.send({ is: "fields" })
        this.settings.connected()
        for (const { what } of this.asked) this.send({ is: "ask", what })
    }

    private answered(answer: Answer): void {
        const [due, left] = [[], []] as [typeof this.asked, typeof this.asked]
        for (const each of this.asked) (each.what === answer.is ? due : left).push(each)
        this.asked = left
        for (const { resolve } of due) resolve(answer)
    }

    private frame({ rows, running, past, anew, fields, straight }: FrameMessage): void {
        const { samples } = this
        const { held, pulled } = this.flags
        if (!rows.length) return
        if (anew) {
            samples.length = 0
            let first = 0
            this.fields = new Map((fields ?? []).map(([name, size, unit]) => [name, { first: (first += size) - size, size, unit }]))
        }
        const late = rows.length - (straight?.length ?? 0) // rows before those with a straight link
        const fresh = rows.map((row, i) => this.sample(row, straight?.[i - late] ?? null))
        let gone = 0
        while (samples.length && samples[samples.length - 1]!.time >= fresh[0]!.time) {
            samples.pop()
            gone++
        }
        samples.push(...fresh)
        const old = samples.findIndex(sample => sample.time >= this.present.time - SECONDS)
        if (old > 64) samples.splice(0, old)
        const before = this.state
        this.running = running
        this.past = past
        this.tell(anew || gone > 1 ? "history" : "samples")
        const now = this.state
        const changed = held !== now.held || pulled !== now.pulled
        if (changed || before.running !== now.running || before.past !== now.past) this.tell("state")
    }

    private sample(row: readonly (number | null)[], straight: readonly number[] | null): Sample {
        const { fields } = this
        const more = [...fields.values()].reduce((sum, { size }) => sum + size, 0)
        const size = (row.length - HEAD) / 2 - more
        const p = (size - 3) / 2
        const sides = [0, 1].map(side => {
            const rigid = straight && straight.slice(side * p, (side + 1) * p).map(each => each / LENGTH)
            return new RowSide(this, row, HEAD + side * size, p, side, fields, HEAD + 2 * size + side * more, rigid)
        })
        return { time: row[0]! / TIME, sides }
    }

    private closed(code: number): void {
        this.socket = null
        this.connected = false
        if (code === REFUSED) this.refused++
        if (code === OTHER_VERSION) this.outdated = true
        this.again = performance.now() + PATIENCE[Math.min(this.tries++, PATIENCE.length - 1)]!
        this.tell("state")
    }

    private tell(change: Change): void {
        if (!this.ready) return
        for (const listener of this.listeners) listener(change)
    }
}
