// The plots under the stage: rows with one axis of time, which follow an engine and look back together.

import { made } from "../core/dom"
import { shown, type Engine, type Vector } from "../core/engine"
import type { StepData } from "../core/lesson_data"
import { recalled, remember } from "../core/memory"
import { phrase, written, type Texts } from "../core/words"
import type { Chart, Limit } from "./chart"
import { firstAfter, type Span } from "./curves"
import { PhasePlane } from "./phase"
import { PlotMenu, type LogActs } from "./plot_menu"
import { Row } from "./row"
import { tableOf } from "./table"

const SECONDS = 10 // [s] of the axis of time
const [MINUTE, SPARE] = [60, 5] // [s], that are kept, and what is dropped at once
const ROUND = 5e-4 // relative variation of the radius up to which a path is a circle
const SPOKEN = 500 // [ms] between two values that a screen reader speaks
const STEPS: Record<string, number> = { ArrowLeft: -0.1, ArrowDown: -0.1, ArrowRight: 0.1, ArrowUp: 0.1, PageDown: -1, PageUp: 1 }
const DISTANCE = "distance" // the first row, which is always there
const PHASE = "phase" // the plane, which stands beside the rows
const PLANE = ["across", "across_rate"] // rows that are its axes
/** Windows in which several rows take the room of the large numbers, which say the distance elsewhere; see lab.css. */
const CROWDED = matchMedia("(max-width: 36em), (max-aspect-ratio: 4/5) and (max-height: 56em), (max-height: 34em)")

export class Strip {
    readonly element: HTMLElement
    readonly menu: PlotMenu
    readonly handle = made("div", "handle", made("span", ""))
    rows: Row[] = []
    private limits: Record<string, Limit[]> = {} // of a step's tasks, by the name of a row
    private readonly stack = made("div", "stack", this.handle)
    private phase: PhasePlane | null = null
    private chosen: readonly string[]
    private inStep: readonly string[] | null = null // rows of a lesson's step
    private offered = "" // of the rows that there can be
    private stale = true
    private spoken = -Infinity
    private first = 0 // of the axis, while one looks back
    private readonly times: number[] = []
    private readonly kinds: (Span["kind"] | null)[] = []
    private forgets = false // whether the curves start over
    private dragged: { pointer: number; x: number } | null = null

    /** `kept`: the name under which the browser keeps the rows that a user has chosen; `log`: what the menu does with the log of an arm. */
    constructor(private readonly texts: Texts, private readonly engine: Engine, ended?: AbortSignal, private readonly kept = "", log?: LogActs) {
        const chosen = kept ? recalled(kept) : null
        this.chosen = Array.isArray(chosen) ? chosen.filter(each => typeof each === "string") : []
        const columns = () => this.rows.flatMap(({ chart, data }) => chart.lines.map(line => ({ ...line, name: this.heading(line.name, data.label), unit: data.unit })))
        const table = tableOf(texts, () => phrase(texts, "chart.title"), columns, () => spansOf(this.times, this.kinds))
        this.element = made("div", "strip", this.stack, table)
        this.menu = new PlotMenu(texts, (name, on) => this.choose(name, on), () => {
            table.open = true
            table.querySelector("summary")!.focus()
        }, log)
        this.menu.remove.hidden = !engine.log
        engine.on(change => {
            this.stale = true
            if (change === "history") this.forgets = true
            if (change === "path" || change === "history") this.mark()
            if (change === "state" || change === "history") this.build()
            if (change === "log") this.menu.remove.hidden = !engine.log
        }, ended)
        this.build()
        this.hand()
        this.grip(-Infinity)
    }

    /** The chart of the distance. */
    get chart(): Chart { return this.rows[0]!.chart }

    /** Show the plots of a lesson's step besides the distance, with what its tasks want; or the user's own. */
    follows(step: StepData | undefined): void {
        const wanted = step?.blocks.flatMap(block => (block.kind === "task" ? block.limits : [])) ?? []
        this.limits = {}
        for (const { plot, below, above, side, label } of wanted) {
            const limits = (this.limits[plot] ??= [])
            if (!limits.some(each => each.label === label)) limits.push({ below, above, label, tone: `side${side}` })
        }
        this.inStep = step ? [...new Set([...step.plots, ...Object.keys(this.limits)])] : null
        this.build()
    }

    /** Draw what has changed. */
    draw(now = performance.now()): void {
        const { dragged, chart } = this
        if (dragged && chart.from > 0 && dragged.x < chart.x(chart.from)) this.drag(dragged.x) // goes further back
        if (!this.stale) return
        this.stale = false
        this.follow(now)
        for (const row of this.rows) row.chart.draw()
        this.phase?.draw()
        this.grip(now)
    }

    private get wanted(): readonly string[] { return this.inStep ?? this.chosen }
    private heading(line: string, label: string): string { return this.rows.length > 1 ? `${label}: ${line}` : line }

    private choose(name: string, on: boolean): void {
        const names = this.wanted.filter(each => each !== name)
        if (on) names.push(name)
        if (this.inStep) this.inStep = names
        else {
            this.chosen = names
            if (this.kept) remember(this.kept, names)
        }
        this.build()
    }

    /** Make the rows that are wanted, of those that these robots can have. */
    private build(): void {
        const { engine, texts, stack, handle, wanted } = this
        const { rows } = engine
        const possible = rows.some(row => row.name === PLANE[0]) ? [...rows.map(row => row.name), PHASE] : rows.map(row => row.name)
        const names = [DISTANCE, ...wanted.filter(name => name !== DISTANCE && possible.includes(name))]
        const offered = JSON.stringify([rows, engine.texts.length, names])
        if (offered === this.offered) return
        this.offered = offered
        const changed = () => void (this.stale = true)
        this.rows = names.flatMap(name => rows.filter(row => row.name === name)).map(data => {
            const kept = this.rows.find(row => row.data === data || JSON.stringify(row.data) === JSON.stringify(data))
            return kept ?? new Row(texts, engine, data, changed)
        })
        const plane = PLANE.map(name => rows.find(row => row.name === name)!) as [Row["data"], Row["data"]]
        this.phase?.element.remove()
        this.phase = names.includes(PHASE) ? new PhasePlane(texts, engine, plane, changed) : null
        this.rows.forEach(({ chart, data }, i) => {
            const isLast = i === this.rows.length - 1
            Object.assign(chart, { hasTimes: isLast, namesSpans: i === 0, hasPeaks: !data.floats, namesAll: false })
        })
        stack.replaceChildren(...this.rows.map(({ chart }) => chart.plot), handle)
        if (this.phase) stack.after(this.phase.element)
        const root = document.documentElement // whose style makes room for the rows
        root.style.setProperty("--op-rows", String(this.rows.length))
        root.classList.toggle("op-rows", this.rows.length > 1 || this.phase !== null)
        const menu = (name: string) => rows.find(row => row.name === name)?.menu ?? phrase(texts, "plot.phase")
        this.menu.show(possible.filter(name => name !== DISTANCE).map(name => ({ name, menu: menu(name), on: names.includes(name) })))
        engine.plot([...new Set([...this.rows.flatMap(row => row.fields), ...(this.phase ? plane.flatMap(row => row.lines[0]!.field) : [])])])
        this.mark()
        this.forgets = this.stale = true
    }

    /** Mark the centre of a circle in the chart of the distance. */
    private mark(): void {
        const { chart, engine, texts } = this
        const radius = radiusOf(engine.path.lines[0] ?? [])
        chart.axes = { ...chart.axes, mark: radius ? { value: 1e3 * radius, label: phrase(texts, "chart.centre") } : undefined }
    }

    private follow(now: number): void {
        const { engine, times, kinds, limits } = this
        const { past } = engine.state
        const end = engine.present.time
        if (past === null) this.first = Math.max(0, end - SECONDS)
        else if (past < this.first || past > this.first + SECONDS) this.first = Math.max(0, past - SECONDS / 2)
        this.record()
        const spans = spansOf(times, kinds), sample = shown(engine)
        const isSaid = (name: string) => name === DISTANCE && !(this.rows.length > 1 && CROWDED.matches)
        for (const row of this.rows) {
            const { chart, data } = row
            Object.assign(chart, { from: this.first, until: this.first + SECONDS, at: sample.time, spans, limits: limits[data.name] ?? [] })
            row.follow(times)
            row.tell(sample, now, isSaid(data.name))
        }
    }

    /** Add what is new to the curves, and the present at their ends. */
    private record(): void {
        const { engine, times, kinds } = this
        if (this.forgets) this.shorten(times.length)
        else if (times.length) this.shorten(1, true)
        this.forgets = false
        for (const sample of [...engine.since(times[times.length - 1] ?? -Infinity), engine.present]) {
            const { time, sides } = sample
            times.push(time)
            kinds.push(sides.some(side => side.held) ? "held" : sides.some(side => side.pulled) ? "pulled" : null)
            for (const row of this.rows) row.add(sample)
        }
        const oldest = times[times.length - 1]! - MINUTE
        if (times[0]! < oldest - SPARE) this.shorten(firstAfter(times, oldest))
    }

    private shorten(by: number, last = false): void {
        for (const each of [this.times, this.kinds]) each.splice(last ? each.length - by : 0, by)
        for (const row of this.rows) row.shorten(by, last)
    }

    /** Put the handle where it belongs, and say what is there. */
    private grip(now: number): void {
        const { handle, chart, engine, texts, rows } = this
        const sample = shown(engine)
        handle.style.transform = `translateX(${(chart.sheet.zoom * chart.x(sample.time)).toFixed(1)}px)`
        if (now && now < this.spoken + SPOKEN && engine.state.past === null) return
        this.spoken = now
        const values = rows.map(row => (row.data.name === DISTANCE ? "" : `${row.data.label}: `) + row.spoken(sample)).join("; ")
        const told = {
            "aria-valuemin": (engine.since(-Infinity)[0]?.time ?? 0).toFixed(1),
            "aria-valuemax": engine.present.time.toFixed(1),
            "aria-valuenow": sample.time.toFixed(1),
            "aria-valuetext": phrase(texts, "chart.at", { time: written(texts, sample.time, 1), values }),
        }
        for (const [name, value] of Object.entries(told)) handle.setAttribute(name, value)
    }

    private hand(): void {
        const { handle, stack, engine, texts } = this
        Object.assign(handle, { tabIndex: 0, role: "slider", ariaLabel: phrase(texts, "chart.look"), title: phrase(texts, "chart.look_hint") })
        handle.addEventListener("keydown", event => {
            const { time } = shown(engine)
            const to = event.key === "Home" ? 0 : event.key === "End" || event.key === "Escape" ? null : time + (STEPS[event.key] ?? NaN)
            if (Number.isNaN(to)) return
            event.preventDefault()
            event.stopPropagation()
            this.seek(to)
        })
        const place = (event: PointerEvent): number => (event.clientX - stack.getBoundingClientRect().left) / this.chart.sheet.zoom
        stack.addEventListener("pointerdown", event => {
            if (this.dragged || event.button !== 0) return
            this.dragged = { pointer: event.pointerId, x: 0 }
            stack.setPointerCapture(event.pointerId)
            this.drag(place(event))
        })
        stack.addEventListener("pointermove", event => {
            if (event.pointerId === this.dragged?.pointer) this.drag(place(event))
        })
        for (const end of ["pointerup", "pointercancel"] as const)
            stack.addEventListener(end, event => event.pointerId === this.dragged?.pointer && (this.dragged = null))
    }

    private drag(x: number): void {
        const { chart, dragged } = this
        dragged!.x = x
        if (x < chart.x(chart.from)) chart.from = this.first = Math.max(0, this.first - 0.1)
        this.seek(chart.inverse(x, 0)[0])
    }

    /** Show an instant; not before the first one, and at the last one only what is present. */
    private seek(time: number | null): void {
        const { engine } = this
        const first = engine.since(-Infinity)[0]?.time ?? 0
        engine.act({ do: "seek", at: time === null || time >= engine.present.time ? null : Math.max(time, first) })
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
