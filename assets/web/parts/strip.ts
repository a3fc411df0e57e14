// The chart of both distances: it follows an engine, and looks back.

import { made } from "../core/dom"
import { shown, type Engine, type Vector } from "../core/engine"
import { niceStep } from "../core/ink"
import { said, written, type Texts } from "../core/words"
import { Chart, firstAfter, type Line, type Span } from "./chart"

const SECONDS = 10 // on the axis
const TOPS = [10, 20, 30, 40, 60, 80, 100, 150, 200, 300, 400, 600, 800, 1000] // [mm]
const FILLED = 0.94 // of the height, from which the scale grows
const [MINUTE, SPARE] = [60, 5] // [s], that are kept, and what is dropped at once
const ROUND = 5e-4 // by how much the radius of a circle may vary
const SPOKEN = 500 // [ms] between two values for a screen reader
const STEPS: Record<string, number> = { ArrowLeft: -0.1, ArrowDown: -0.1, ArrowRight: 0.1, ArrowUp: 0.1, PageDown: -1, PageUp: 1 }

export class Strip {
    readonly chart: Chart
    readonly handle = made("div", "handle", made("span", ""))
    private stale = true
    private spoken = -Infinity
    private first = 0 // of the axis, while one looks back
    private readonly times: number[] = []
    private readonly values: number[][] = [] // [mm], of each robot
    private readonly kinds: (Span["kind"] | null)[] = []
    private most = 0 // [mm]
    private forgets = false // whether the curves begin anew
    private dragged: { pointer: number; x: number } | null = null

    constructor(private readonly texts: Texts, private readonly engine: Engine, ended?: AbortSignal) {
        const axes = { label: said(texts, "chart.title"), unit: "mm", bottom: 0, top: TOPS[0]! }
        this.chart = new Chart(texts, axes, () => (this.stale = true))
        this.chart.sheet.canvas.setAttribute("aria-label", said(texts, "chart.title"))
        this.chart.plot.append(this.handle)
        this.scale()
        engine.on(change => {
            this.stale = true
            if (change === "history") [this.forgets, this.most] = [true, 0]
            if (change === "history" || change === "path") this.scale(change === "history" ? 0 : this.chart.axes.top)
        }, ended)
        this.hand()
        this.grip(-Infinity)
    }

    /** Draw what has changed. */
    draw(now = performance.now()): void {
        const { dragged, chart } = this
        if (dragged && this.chart.from > 0 && dragged.x < chart.x(chart.from)) this.drag(dragged.x) // goes further back
        if (!this.stale) return
        this.stale = false
        this.follow()
        chart.draw()
        this.grip(now)
    }

    /** The radius of a circle and a little more, but not less than before in a run. */
    private scale(least = 0): void {
        const { chart, engine, texts } = this
        const radius = radiusOf(engine.path.lines[0] ?? [])
        const wanted = Math.max(radius ? 1.15e3 * radius : 0, least)
        const top = TOPS.find(each => each >= wanted) ?? wanted
        const mark = radius ? { value: 1e3 * radius, label: said(texts, "chart.centre") } : undefined
        chart.axes = { ...chart.axes, top, mark }
    }

    private follow(): void {
        const { chart, engine, times, kinds } = this
        const { past } = engine.state
        const end = engine.present.time
        if (past === null) this.first = Math.max(0, end - SECONDS)
        else if (past < this.first || past > this.first + SECONDS) this.first = Math.max(0, past - SECONDS / 2)
        this.record()
        chart.from = this.first
        chart.until = this.first + SECONDS
        chart.at = shown(engine).time
        chart.spans = spansOf(times, kinds)
        chart.lines = engine.texts.map(({ name, side }, i): Line => {
            return { name, tone: `side${side}`, dashed: side === 1, times, values: this.values[i]! }
        })
        const { axes } = chart
        if (this.most > FILLED * axes.top) axes.top = TOPS.find(each => FILLED * each >= this.most) ?? niceStep(this.most / FILLED)
    }

    /** Add what is new to the curves, and the present at their ends. */
    private record(): void {
        const { engine, times, kinds } = this
        if (this.forgets) this.shorten(times.length)
        else if (times.length) this.shorten(1, true)
        this.forgets = false
        for (const { time, sides } of [...engine.since(times[times.length - 1] ?? -Infinity), engine.present]) {
            times.push(time)
            kinds.push(sides.some(side => side.held) ? "held" : sides.some(side => side.pulled) ? "pulled" : null)
            sides.forEach(({ distance }, i) => (this.values[i] ??= []).push(1e3 * distance))
            this.most = Math.max(this.most, ...sides.map(({ distance }) => 1e3 * distance))
        }
        const oldest = times[times.length - 1]! - MINUTE
        if (times[0]! < oldest - SPARE) this.shorten(firstAfter(times, oldest))
    }

    private shorten(by: number, last = false): void {
        for (const each of [this.times, this.kinds, ...this.values]) each.splice(last ? each.length - by : 0, by)
    }

    /** Put the handle where it belongs, and say what is there. */
    private grip(now: number): void {
        const { handle, chart, engine, texts } = this
        const sample = shown(engine)
        handle.style.transform = `translateX(${(chart.sheet.zoom * chart.x(sample.time)).toFixed(1)}px)`
        if (now && now < this.spoken + SPOKEN && engine.state.past === null) return
        this.spoken = now
        const values = engine.texts.map(({ name }, i) => `${name} ${written(texts, 1e3 * sample.sides[i]!.distance, 1)} mm`).join(", ")
        const told = {
            "aria-valuemin": (engine.since(-Infinity)[0]?.time ?? 0).toFixed(1),
            "aria-valuemax": engine.present.time.toFixed(1),
            "aria-valuenow": sample.time.toFixed(1),
            "aria-valuetext": said(texts, "chart.at", { time: written(texts, sample.time, 1), values }),
        }
        for (const [name, value] of Object.entries(told)) handle.setAttribute(name, value)
    }

    private hand(): void {
        const { handle, chart, engine, texts } = this
        Object.assign(handle, { tabIndex: 0, role: "slider", ariaLabel: said(texts, "chart.look"), title: said(texts, "chart.look_hint") })
        handle.addEventListener("keydown", event => {
            const { time } = shown(engine)
            const to = event.key === "Home" ? 0 : event.key === "End" || event.key === "Escape" ? null : time + (STEPS[event.key] ?? NaN)
            if (Number.isNaN(to)) return
            event.preventDefault()
            event.stopPropagation()
            this.look(to)
        })
        const { plot, sheet } = chart
        const place = (event: PointerEvent): number => (event.clientX - plot.getBoundingClientRect().left) / sheet.zoom
        plot.addEventListener("pointerdown", event => {
            if (this.dragged || event.button !== 0) return
            this.dragged = { pointer: event.pointerId, x: 0 }
            plot.setPointerCapture(event.pointerId)
            this.drag(place(event))
        })
        plot.addEventListener("pointermove", event => {
            if (event.pointerId === this.dragged?.pointer) this.drag(place(event))
        })
        for (const end of ["pointerup", "pointercancel"] as const)
            plot.addEventListener(end, event => event.pointerId === this.dragged?.pointer && (this.dragged = null))
    }

    private drag(x: number): void {
        const { chart, dragged } = this
        dragged!.x = x
        if (x < chart.x(chart.from)) chart.from = this.first = Math.max(0, this.first - 0.1)
        this.look(chart.inverse(x, 0)[0])
    }

    /** Look at an instant; not before the first one, and at the last one only what is present. */
    private look(time: number | null): void {
        const { engine } = this
        const first = engine.since(-Infinity)[0]?.time ?? 0
        engine.act({ do: "look", at: time === null || time >= engine.present.time ? null : Math.max(time, first) })
    }
}

/** When something acted. */
function spansOf(times: readonly number[], kinds: readonly (Span["kind"] | null)[]): Span[] {
    const found: Span[] = []
    let last: Span["kind"] | null = null
    kinds.forEach((kind, i) => {
        if (last && kind !== last) found[found.length - 1]!.until = times[i]!
        if (kind && kind !== last) found.push({ from: times[i]!, until: times[times.length - 1]!, kind })
        last = kind
    })
    return found
}

/** The radius of a circle through points; null if they are not on one. */
export function radiusOf(points: readonly Vector[]): number | null {
    if (points.length < 8) return null
    const middle = points[0]!.map((_, k) => points.slice(1).reduce((sum, point) => sum + point[k]!, 0) / (points.length - 1))
    const radii = points.map(point => Math.hypot(...point.map((each, k) => each - middle[k]!)))
    const [least, most] = [Math.min(...radii), Math.max(...radii)]
    return most - least < ROUND * most && most > 0 ? (least + most) / 2 : null
}
