// The chart of both distances: it follows an engine, and looks back.

import { Chart, firstAfter, type Line, type Span } from "./chart"
import { made } from "./controls"
import { shown, type Engine, type Sample, type Vector } from "./engine"
import { niceStep } from "./ink"
import { said, written, type Texts } from "./words"

const SECONDS = 10 // on the axis
const TOPS = [10, 20, 30, 40, 60, 80, 100, 150, 200, 300, 400, 600, 800, 1000] // [mm]
const FILLED = 0.94 // of the height, from which the scale grows
const ROUND = 5e-4 // by how much the radius of a circle may vary
const SPOKEN = 500 // [ms] between two values for a screen reader
const STEPS: Record<string, number> = { ArrowLeft: -0.1, ArrowDown: -0.1, ArrowRight: 0.1, ArrowUp: 0.1, PageDown: -1, PageUp: 1 }

export class Strip {
    readonly chart: Chart
    readonly handle = made("div", "handle")
    private stale = true
    private spoken = -Infinity
    private first = 0 // of the axis, while one looks back
    private dragged: { pointer: number; x: number } | null = null

    constructor(private readonly texts: Texts, private readonly engine: Engine, ended?: AbortSignal) {
        const axes = { label: said(texts, "chart.title"), unit: "mm", bottom: 0, top: TOPS[0]! }
        this.chart = new Chart(texts, axes, () => (this.stale = true), ended)
        this.chart.sheet.canvas.setAttribute("aria-label", said(texts, "chart.title"))
        this.chart.plot.append(this.handle)
        this.scale()
        engine.on(change => {
            this.stale = true
            if (change === "history" || change === "path") this.scale()
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

    /** Begin with the radius of a circle and a little more. */
    private scale(): void {
        const { chart, engine, texts } = this
        const radius = radiusOf(engine.path.lines[0] ?? [])
        const least = radius ? 1.15e3 * radius : TOPS[0]!
        const top = TOPS.find(each => each >= least) ?? least
        const mark = radius ? { value: 1e3 * radius, label: said(texts, "chart.centre") } : undefined
        chart.axes = { ...chart.axes, top, ...(mark ? { mark } : { mark: undefined }) } as Chart["axes"]
    }

    private follow(): void {
        const { chart, engine } = this
        const { past } = engine.state
        const end = engine.present.time
        if (past === null) this.first = Math.max(0, end - SECONDS)
        else if (past < this.first || past > this.first + SECONDS) this.first = Math.max(0, past - SECONDS / 2)
        const samples = engine.since(-Infinity)
        const all = end > (samples[samples.length - 1]?.time ?? -1) ? [...samples, engine.present] : samples
        const times = all.map(sample => sample.time)
        chart.from = this.first
        chart.until = this.first + SECONDS
        chart.at = shown(engine).time
        chart.spans = spansOf(all)
        const begin = Math.max(firstAfter(times, chart.from) - 1, 0), seen = times.slice(begin)
        chart.lines = engine.texts.map(({ name, side }, i): Line => {
            const values = all.slice(begin).map(({ sides }) => 1e3 * sides[i]!.distance)
            return { name, tone: `side${side}`, dashed: side === 1, times: seen, values }
        })
        const most = chart.lines.reduce((found, { values }) => values.reduce((a, b) => (b > a ? b : a), found), 0)
        const { axes } = chart
        if (most > FILLED * axes.top) axes.top = TOPS.find(each => FILLED * each >= most) ?? niceStep(most / FILLED)
    }

    /** Put the handle where it belongs, and say what is there. */
    private grip(now: number): void {
        const { handle, chart, engine, texts } = this
        const sample = shown(engine)
        handle.style.transform = `translateX(${chart.x(sample.time).toFixed(1)}px)`
        if (now < this.spoken + SPOKEN && engine.state.past === null) return
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
        const { plot } = chart
        plot.addEventListener("pointerdown", event => {
            if (this.dragged || event.button !== 0) return
            this.dragged = { pointer: event.pointerId, x: 0 }
            plot.setPointerCapture(event.pointerId)
            this.drag(event.clientX - plot.getBoundingClientRect().left)
        })
        plot.addEventListener("pointermove", event => {
            if (event.pointerId === this.dragged?.pointer) this.drag(event.clientX - plot.getBoundingClientRect().left)
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
export function spansOf(samples: readonly Sample[]): Span[] {
    const found: Span[] = []
    for (const { time, sides } of samples) {
        const kind = sides.some(side => side.held) ? "held" : sides.some(side => side.pulled) ? "pulled" : null
        const last = found[found.length - 1]
        const goes = last?.until === Infinity
        if (goes && last.kind !== kind) last.until = time
        if (kind && !(goes && last.kind === kind)) found.push({ from: time, until: Infinity, kind })
    }
    const last = found[found.length - 1]
    if (last?.until === Infinity) last.until = samples[samples.length - 1]!.time
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
