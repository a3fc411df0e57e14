// Builds a figure in a page, and runs its time.

import { caption, notes, spoken } from "./captions"
import { Controls, isTyped, made, written } from "./controls"
import { said, written as number, type Point } from "./figure_data"
import { LocalEngine } from "./local"
import { Plot } from "./plot"
import type { Simulation } from "./simulation"
import { View } from "./view"

const SILENCE = 3000 // [ms], at least, between two announcements of the same kind
const LATE = 0.15 // [s] lost lately, above which the page says that time runs late
const DARK = matchMedia("(prefers-color-scheme: dark)")
DARK.addEventListener("change", () => dispatchEvent(new Event("resize"))) // everything is drawn anew
const TRACE = 4 // [s], of the tips' traces
const PULL = 0.03 // [m], by which a key pulls
const PULLS: Record<string, Point> = { a: [-PULL, 0], d: [PULL, 0], w: [0, PULL], s: [0, -PULL] }

export class Figure {
    readonly engine = new LocalEngine(this.simulation)
    private readonly data = this.simulation.data
    private readonly views = this.simulation.sides.map(side => new View(side, this.data))
    private readonly titles = this.views.map(() => made("span", ""))
    private readonly captions = this.views.map(() => made("span", "caption"))
    private readonly plot = new Plot(this.simulation)
    private readonly live = made("p", "live")
    private readonly note = made("p", "note")
    private readonly poles = made("p", "poles")
    private readonly axis = made("p", "axis")
    readonly controls = new Controls(this.simulation, this, this.ended)
    private pending: (() => void) | null = null // a drag to be handled before the next picture
    private stale = true
    private shown = 0 // simulated time in the picture, in ticks
    private kind = ""
    private said = 0

    /** `ended` stops the figure when a page puts another one in its place. */
    constructor(
        readonly simulation: Simulation,
        into: HTMLElement,
        private readonly ended: AbortSignal = new AbortController().signal,
    ) {
        this.live.setAttribute("role", "status")
        into.replaceChildren(...this.parts())
        for (const view of this.views) this.grabs(view)
        if (this.data.controls.includes("pull")) this.keys()
        addEventListener("resize", () => (this.stale = true), { signal: ended })
        this.changed()
        requestAnimationFrame(() => this.frame())
    }

    private readonly drag = () => [this.pending?.(), (this.pending = null)]
    get running(): boolean { return this.engine.running }

    /** Something else is to be drawn and said. */
    changed(): void {
        const { simulation, data } = this
        this.poles.replaceChildren(...simulation.lines().map(line => made("span", "", line)))
        this.titles.forEach((element, i) => {
            const law = (element.textContent = simulation.title(i))
            element.title = simulation.sides[i]!.does().text
            const hint = data.controls.includes("drag") ? `. ${said(data, "standalone.drag_hint")}` : ""
            this.views[i]!.canvas.setAttribute("aria-label", said(data, "standalone.scene", { law }) + hint)
        })
        this.stale = true
    }

    /** Advance by a number of ticks, independently of the clock. */
    readonly advance = (ticks: number) => this.simulation.advance(ticks)

    private parts(): HTMLElement[] {
        const { data } = this
        const robots = this.views.map((view, i) => {
            const heading = made("h2", `title side${i}`, this.titles[i]!, " ", this.captions[i]!)
            view.canvas.setAttribute("role", "img")
            return made("section", "robot", heading, view.canvas)
        })
        const { canvas } = this.plot
        const plotted = said(data, "standalone.plot")
        canvas.setAttribute("role", "img")
        canvas.setAttribute("aria-label", plotted)
        return [
            made("div", "robots", ...robots),
            this.note,
            this.controls.element,
            ...(data.controls.includes("poles") ? [this.poles] : []),
            ...(data.controls.includes("plot") ? [this.axis, made("div", "plot", canvas)] : []),
            this.live,
        ]
    }

    private frame(): void {
        if (this.ended.aborted) return
        this.drag()
        if (this.engine.pass(performance.now())) this.stale = true
        this.controls.show()
        if (this.stale || this.shown !== this.simulation.ticks) this.draw()
        requestAnimationFrame(() => this.frame())
    }

    private draw(): void {
        const { simulation, data } = this
        this.stale = false
        this.shown = simulation.ticks
        const moments = [...simulation.recent, simulation.moment()]
        const traced = moments.filter(moment => moment.time > simulation.time - TRACE)
        data.colours = data.tones[DARK.matches ? "dark" : "light"]
        this.views.forEach((view, i) => {
            view.draw(simulation.followed, simulation.selected, traced.map(moment => moment.tips[i]!))
        })
        this.plot.draw(moments)
        const captions = simulation.sides.map(side => caption(side, data))
        this.captions.forEach((element, i) => written(element, captions[i]!))
        const now = simulation.sides.map((side, i) => `${simulation.title(i)} ${number(data, 1e3 * side.distance, 1)}`)
        written(this.axis, `${said(data, "standalone.plot")}: ${now.join(", ")}`)
        const late = this.engine.lost > LATE ? said(data, "standalone.late") : ""
        const note = [notes(simulation), late].filter(Boolean).join(" ")
        written(this.note, note)
        this.say(captions, note)
    }

    /** Announce what robots do when it changes, and from time to time their millimetres. */
    private say(captions: string[], note: string): void {
        const line = `${spoken(this.simulation, captions)} ${note}`.trim()
        const kind = line.replace(/[0-9]+/g, "")
        const now = performance.now()
        if (line === this.live.textContent || (kind === this.kind && now < this.said + SILENCE)) return
        this.kind = kind
        this.said = now
        this.live.textContent = line
    }

    /** Pull all tips, or move a point of the path, while the mouse or a finger drags one of them. */
    private grabs(view: View): void {
        const { simulation } = this
        const { canvas } = view
        const at = (place: { clientX: number; clientY: number }) =>
            view.grabbed(place.clientX, place.clientY, simulation.followed, simulation.selected)
        let grabbed: { what: number | "tip"; from: PointerEvent } | null = null
        const act = (by: Point | null) => {
            if (grabbed?.what === "tip") simulation.pull(by)
            else if (grabbed && by) simulation.followed.drag(grabbed.what, by)
            else simulation.followed.finish()
            this.stale = true
        }
        const begin = (event: TouchEvent) => at(event.touches[0]!) !== null && event.preventDefault() // no scrolling
        canvas.addEventListener("touchstart", begin, { passive: false })
        canvas.addEventListener("pointerdown", event => {
            const what = at(event)
            if (what === null || grabbed) return
            grabbed = { what, from: event }
            canvas.setPointerCapture(event.pointerId)
            if (what === "tip") act([0, 0])
            else simulation.select(what)
        })
        canvas.addEventListener("pointermove", event => {
            canvas.classList.toggle("near", grabbed !== null || at(event) !== null)
            if (event.pointerId !== grabbed?.from.pointerId) return
            const by = view.metres(event.clientX - grabbed.from.clientX, event.clientY - grabbed.from.clientY)
            this.pending = () => act(by)
        })
        canvas.addEventListener("pointerleave", () => canvas.classList.remove("near"))
        for (const end of ["pointerup", "pointercancel"] as const)
            canvas.addEventListener(end, event => {
                if (event.pointerId !== grabbed?.from.pointerId) return
                this.drag()
                act(null)
                grabbed = null
            })
    }

    private keys(): void {
        const { ended: signal } = this
        let pulling = "" // the key that pulls
        addEventListener("keydown", event => {
            const key = event.key.toLowerCase()
            if (!PULLS[key] || event.repeat || isTyped(event)) return
            pulling = key
            this.simulation.pull(PULLS[key])
        }, { signal })
        addEventListener("keyup", event => event.key.toLowerCase() === pulling && this.simulation.pull(null), { signal })
        addEventListener("blur", () => this.simulation.pull(null), { signal })
    }
}
