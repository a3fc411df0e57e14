// Builds a figure in a page, and runs its time.

import { made, tell } from "../core/dom"
import type { Point } from "../core/figure_data"
import { phrase, withoutNumbers } from "../core/words"
import { notes, spoken } from "../simulation/captions"
import { LocalEngine } from "../simulation/local"
import type { Simulation } from "../simulation/simulation"
import { Form } from "../parts/form"
import { Lens } from "../parts/lens"
import { Strip } from "../parts/strip"
import { Transport } from "../parts/transport"
import { View } from "../parts/view"
import { hearKeys } from "./figure_keys"
import { OwnHold } from "./own_hold"
import { LocalSettings } from "./settings"

const SILENCE = 3000 // [ms], least time between two announcements of the same kind
const LATE = 0.15 // [s] lost recently above which the page says that time runs late
const TRACE = 4 // [s] of the past that the tips' traces show

export class Figure {
    readonly engine = new LocalEngine(this.simulation, !this.inLesson)
    readonly settings = new LocalSettings(this.simulation, () => this.changed())
    private readonly data = this.simulation.data
    private readonly views = this.simulation.sides.map(side => new View(side, this.simulation.sides[0]!, this.data, () => (this.stale = true)))
    private readonly lenses = this.views.map((_, i) => new Lens(this.data, this.engine, i, this.ended))
    private readonly titles = this.views.map(() => made("span", ""))
    private readonly captions = this.views.map(() => made("span", "caption"))
    readonly strip = new Strip(this.data, this.engine, this.ended)
    private readonly live = made("p", "live")
    private readonly note = made("p", "note")
    private readonly late = made("p", "late") // which moves nothing when it comes and goes
    readonly transport = new Transport(this.data, this.engine, this.data.controls, this.ended)
    private readonly brakes = made("div", "transport brakes", this.transport.brake)
    private readonly bar = made("div", "bar", this.transport.element, this.late)
    /** The settings that one may change; a page may put it elsewhere. */
    readonly form = new Form(this.data.form, this.settings, this.ended)
    /** What it does by itself, unless it is in a lesson. */
    readonly own: OwnHold | null
    private pending: (() => void) | null = null // a drag to be handled before the next picture
    private stale = true
    private kind = ""
    private announced = 0

    /** `ended` stops the figure when a page puts another one in its place; in a lesson, one cannot go on from the past,
     * and keys pull as in the lab. */
    constructor(
        readonly simulation: Simulation,
        into: HTMLElement,
        private readonly ended: AbortSignal = new AbortController().signal,
        private readonly inLesson = false,
    ) {
        this.live.setAttribute("role", "status")
        into.replaceChildren(...this.parts())
        for (const view of this.views) this.grabs(view)
        hearKeys(this, inLesson, ended)
        this.engine.on(() => (this.stale = true), ended)
        this.changed()
        this.own = !inLesson && this.data.controls.includes("hold") ? new OwnHold(this.engine, ended) : null
        requestAnimationFrame(() => this.frame())
    }

    private readonly drag = () => [this.pending?.(), (this.pending = null)]
    get running(): boolean { return this.engine.running }

    /** Update everything that depends on the settings. */
    changed(): void {
        const { simulation, data } = this
        const shown = new Set(data.drawings.switches.map(each => each.name).filter(name => simulation.values[name]))
        for (const view of this.views) {
            view.larger = Number(simulation.values["larger"] ?? 1)
            view.drawings.shown = shown
        }
        this.form.update()
        this.titles.forEach((element, i) => {
            const law = (element.textContent = simulation.title(i))
            element.title = simulation.sides[i]!.does().text
            const hint = data.controls.includes("drag") ? `. ${phrase(data, "standalone.drag_hint")}` : ""
            this.views[i]!.canvas.setAttribute("aria-label", phrase(data, "standalone.scene", { law }) + hint)
        })
        simulation.changed("state")
    }

    /** Show on the robots what a symbol means; nothing if it is empty. */
    light(symbol: string): void {
        for (const picture of [...this.views, ...this.lenses]) picture.lit = symbol
        this.engine.simulation.changed("state")
    }

    /** Advance by a number of ticks, independently of the clock. */
    readonly advance = (ticks: number) => this.simulation.advance(ticks)

    /** Put several plots where they are seen with what one sets: on a telephone in the place of the lenses, or below the form
     * where there is no room for both. */
    place(isWide: boolean, isTall: boolean): void {
        const { strip, bar, brakes, data, form } = this
        if (!data.controls.includes("plot")) return
        if (isWide || strip.rows.length < 2) bar.after(strip.element)
        else if (isTall) brakes.before(strip.element)
        else (form.element.parentElement ? form.element : bar).after(strip.element)
    }

    private parts(): HTMLElement[] {
        const { data, transport } = this
        const robots = this.views.map((view, i) => {
            const heading = made("h2", `title side${this.engine.texts[i]!.side}`, this.titles[i]!, " ", this.captions[i]!)
            view.canvas.setAttribute("role", "img")
            return made("section", "robot", heading, made("div", "seen", view.canvas, this.lenses[i]!.element))
        })
        const strip = data.controls.includes("plot") ? [this.strip.element] : []
        if (strip.length) transport.add(this.strip.menu.element)
        return [
            made("div", "scene", made("div", "robots", ...robots), this.brakes),
            this.note,
            this.bar,
            ...strip,
            ...(this.inLesson ? [] : [this.form.element]), // a step has it in its card
            this.live,
        ]
    }

    private frame(): void {
        if (this.ended.aborted) return
        this.drag()
        const now = performance.now()
        if (this.engine.pass(now)) {
            this.stale = true
            this.own?.follow()
        }
        if (this.stale) this.draw()
        this.strip.draw(now)
        for (const [i, lens] of this.lenses.entries()) {
            lens.scale = this.views[i]!.scale
            lens.draw(now)
        }
        requestAnimationFrame(() => this.frame())
    }

    private draw(): void {
        const { simulation, data, engine } = this
        this.stale = false
        const { past } = engine.state
        const moments = [...engine.since((past ?? simulation.time) - TRACE), ...(past === null ? [engine.present] : [])]
        const traced = moments.filter(moment => past === null || moment.time <= past)
        this.views.forEach((view, i) => {
            view.draw(simulation.followed, simulation.path, simulation.selected, traced.map(moment => moment.tips[i]!))
        })
        const captions = engine.texts.map(text => (past === null ? text.caption : ""))
        this.captions.forEach((element, i) => tell(element, captions[i]!))
        const late = engine.lost > LATE ? phrase(data, "standalone.late") : ""
        const note = notes(simulation)
        tell(this.note, note)
        tell(this.late, late)
        if (!this.own?.plays) this.say(captions, `${note} ${late}`.trim())
    }

    /** Announce what robots do when it changes, and from time to time their millimetres. */
    private say(captions: string[], note: string): void {
        const line = `${spoken(this.simulation, captions)} ${note}`.trim()
        const kind = withoutNumbers(line)
        const now = performance.now()
        if (line === this.live.textContent || (kind === this.kind && now < this.announced + SILENCE)) return
        this.kind = kind
        this.announced = now
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
            else simulation.drop()
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
}
