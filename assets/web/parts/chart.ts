// A chart over time. It shades when something acts on the robots, names each line beside it, and labels the peak
// after each event. strip.ts feeds it from an engine, drawing.ts lets a student draw on it.

import { made } from "../core/dom"
import { covers, disc, letters, niceStep, Sheet, stroke, tones, type Box, type Pixel, type Tone } from "../core/ink"
import { said, significant, written, type Texts } from "../core/words"

export interface Curve {
    times: readonly number[]
    values: readonly number[]
}

export interface Line extends Curve {
    name: string
    tone: Tone
    dashed: boolean // colour is not the only sign
}

/** When something acts on a robot. */
export interface Span {
    from: number
    until: number
    kind: "held" | "pulled"
}

export interface Axes {
    label: string
    unit: string
    bottom: number
    top: number
    /** A value with a name, such as the distance from the centre of a circle to it. */
    mark?: { value: number; label: string } | undefined
}

const MARGIN = { left: 42, right: 14, top: 22, bottom: 24 }
const FONT = "12px system-ui, sans-serif"
const BOLD = "600 13px system-ui, sans-serif"
const HALF = 8 // [px], of the height of a label
const TRIED = 25 // times at which a line may be named
const ASIDES = [[-14, 14], [-32, 32], [-50, 50]] // [px], from the line to the middle of its name
const LEAST_PEAK = 0.004 // of the height, below which a peak is not labelled

export class Chart {
    readonly plot: HTMLElement
    readonly sheet: Sheet
    readonly element: HTMLElement
    lines: readonly Line[] = []
    spans: readonly Span[] = []
    /** What a student has drawn. */
    ghost: Curve | null = null
    from = 0
    until = 10
    /** The instant that is shown. */
    at: number | null = null
    /** What to do here, in the middle of an empty chart. */
    hint = ""
    private boxes: Box[] = []
    private places: (number | undefined)[] = [] // times at which lines are named

    constructor(readonly texts: Texts, public axes: Axes, changed: () => void) {
        this.sheet = new Sheet(changed)
        const { canvas } = this.sheet
        canvas.setAttribute("role", "img")
        this.plot = made("div", "plot", canvas)
        this.element = made("div", "strip", this.plot, this.table())
    }

    readonly x = (time: number): number =>
        MARGIN.left + ((time - this.from) / (this.until - this.from)) * (this.sheet.width - MARGIN.left - MARGIN.right)
    readonly y = (value: number): number => {
        const { top, bottom } = this.axes
        return MARGIN.top + ((top - value) / (top - bottom)) * (this.sheet.height - MARGIN.top - MARGIN.bottom)
    }

    /** The time and the value at a place in the plot, within the axes. */
    inverse(x: number, y: number): [number, number] {
        const { top, bottom } = this.axes
        const { width, height } = this.sheet
        const share = (x - MARGIN.left) / (width - MARGIN.left - MARGIN.right)
        const down = (y - MARGIN.top) / (height - MARGIN.top - MARGIN.bottom)
        const within = (each: number) => Math.min(Math.max(each, 0), 1)
        return [this.from + within(share) * (this.until - this.from), top - within(down) * (top - bottom)]
    }

    draw(): void {
        const ink = this.sheet.cleared()
        if (!ink) return
        this.boxes = []
        this.unit(ink)
        this.shade(ink)
        this.grid(ink)
        ink.save()
        ink.beginPath()
        ink.rect(MARGIN.left, 0, this.sheet.width - MARGIN.left - MARGIN.right + 2, this.sheet.height)
        ink.clip()
        if (this.ghost) this.shadow(ink, this.ghost)
        for (const line of this.lines) {
            ink.setLineDash(line.dashed ? [7, 4] : [])
            stroke(ink, this.points(line), tones()[line.tone], 2.5)
        }
        ink.setLineDash([])
        this.instant(ink)
        ink.restore()
        ink.font = BOLD
        ink.textBaseline = "middle"
        this.peaks(ink)
        this.names(ink)
        ink.textAlign = "center"
        if (this.hint) letters(ink, this.hint, (this.x(this.from) + this.x(this.until)) / 2, this.sheet.height / 2, tones().yours, tones().paper)
    }

    /** The visible part of a curve. */
    private points({ times, values }: Curve): Pixel[] {
        const [first, last] = [Math.max(firstAfter(times, this.from) - 1, 0), firstAfter(times, this.until) + 1]
        return times.slice(first, last).map((time, i) => [this.x(time), this.y(values[first + i]!)])
    }

    /** The unit, above the numbers of its axis. */
    private unit(ink: CanvasRenderingContext2D): void {
        const { unit } = this.axes
        ink.font = FONT
        ink.textBaseline = "middle"
        ink.textAlign = "right"
        const { width } = ink.measureText(unit)
        const right = Math.max(MARGIN.left - 6, width + 2)
        this.boxes.push({ left: right - width, right: right + 4, top: 9 - HALF, bottom: 9 + HALF })
        ink.fillStyle = tones().soft
        ink.fillText(unit, right, 9)
    }

    private shade(ink: CanvasRenderingContext2D): void {
        const { from, until, axes } = this
        ink.textAlign = "center"
        for (const span of this.spans) {
            const [left, right] = [Math.max(span.from, from), Math.min(span.until, until)].map(this.x) as [number, number]
            if (right <= left) continue
            ink.fillStyle = tones()[span.kind]
            ink.fillRect(left, MARGIN.top, right - left, this.y(axes.bottom) - MARGIN.top)
            const text = said(this.texts, `chart.${span.kind}`)
            const half = ink.measureText(text).width / 2
            const x = Math.min(Math.max((left + right) / 2, this.x(from) + half), this.x(until) - half)
            if (this.taken({ left: x - half, right: x + half, top: 4, bottom: 18 })) continue
            ink.fillStyle = tones().ink
            ink.fillText(text, x, 12)
        }
    }

    private grid(ink: CanvasRenderingContext2D): void {
        const { axes, from, until, texts, sheet } = this
        const { top, bottom, mark } = axes
        const { ink: dark, soft, grid, paper } = tones()
        const [left, right] = [this.x(from), this.x(until)]
        const rows = Math.max(2, Math.floor((sheet.height - MARGIN.top - MARGIN.bottom) / 34))
        const step = niceStep((top - bottom) / rows)
        ink.textAlign = "right"
        ink.fillStyle = dark
        for (let value = Math.ceil(bottom / step - 1e-9) * step; value <= top + 1e-9 * step; value += step) {
            const y = Math.round(this.y(value)) + 0.5
            stroke(ink, [[left, y], [right, y]], grid, 1)
            ink.fillText(significant(texts, value, 4), left - 6, y)
        }
        const apart = niceStep((64 * (until - from)) / (right - left))
        ink.textAlign = "center"
        ink.fillStyle = dark
        for (let time = Math.ceil(from / apart - 1e-9) * apart; time <= until + 1e-9; time += apart) {
            const text = significant(texts, time, 4)
            ink.fillText(time < from + apart ? `${text} s` : text, this.x(time), sheet.height - 7)
        }
        if (!mark || mark.value > top || mark.value < bottom) return
        const y = Math.round(this.y(mark.value)) + 0.5
        ink.setLineDash([2, 4])
        stroke(ink, [[left, y], [right, y]], soft, 1)
        ink.setLineDash([])
        ink.textAlign = "right"
        const { width } = ink.measureText(mark.label)
        const row = [y - HALF, y + HALF].find(each => !this.taken({ left: right - width - 4, right, top: each - HALF, bottom: each + HALF }))
        if (row) letters(ink, mark.label, right - 4, row, soft, paper)
    }

    private shadow(ink: CanvasRenderingContext2D, ghost: Curve): void {
        const points = this.points(ghost)
        if (!points.length) return
        const base = this.y(Math.max(this.axes.bottom, Math.min(0, this.axes.top)))
        const { yours } = tones()
        ink.globalAlpha = 0.14
        ink.fillStyle = yours
        ink.beginPath()
        for (const [x, y] of [[points[0]![0], base] as const, ...points, [points[points.length - 1]![0], base] as const]) ink.lineTo(x, y)
        ink.fill()
        ink.globalAlpha = 1
        ink.setLineDash([1, 6])
        stroke(ink, points, yours, 3.5)
        ink.setLineDash([])
    }

    /** The instant that is shown: a line, and dots on the lines. */
    private instant(ink: CanvasRenderingContext2D): void {
        const { at, axes, lines } = this
        if (at === null) return
        const x = this.x(at)
        stroke(ink, [[x, MARGIN.top], [x, this.y(axes.bottom)]], tones().soft, 1.5)
        for (const line of lines) {
            const value = valueAt(line, at)
            if (value === null) continue
            disc(ink, [x, this.y(value)], 6, tones().paper)
            disc(ink, [x, this.y(value)], 4.5, tones()[line.tone])
        }
    }

    /** The largest value of each line from when something begins to act until something acts again. */
    private peaks(ink: CanvasRenderingContext2D): void {
        const { spans, lines, axes, from, until, texts } = this
        ink.textAlign = "center"
        spans.forEach((span, i) => {
            const end = spans[i + 1]?.from ?? Infinity
            if (span.from > until || end < from) return
            for (const line of lines) {
                const first = firstAfter(line.times, span.from), last = firstAfter(line.times, end)
                let peak = -1
                for (let k = first; k < last; k++) if (peak < 0 || Math.abs(line.values[k]!) > Math.abs(line.values[peak]!)) peak = k
                const value = line.values[peak]
                if (value === undefined || line.times[peak]! < from || line.times[peak]! > until || Math.abs(value) < LEAST_PEAK * (axes.top - axes.bottom)) continue
                const text = written(texts, value, Math.abs(value) < 100 ? 1 : 0)
                const half = ink.measureText(text).width / 2 + 2
                const x = this.x(line.times[peak]!), y = Math.max(this.y(value) - 12, MARGIN.top - 6)
                const found = [0, 14, -14, 30, -30].find(aside => this.room(x + aside, y, half))
                if (found !== undefined) letters(ink, text, x + found, y, tones()[line.tone], tones().paper)
            }
        })
    }

    /** Name each line beside it, where it does not cover anything and is far from the others. */
    private names(ink: CanvasRenderingContext2D): void {
        const { lines, ghost, texts, from, until } = this
        ink.textAlign = "center"
        const shown: (Curve & { name: string; tone: Tone })[] = [...lines]
        if (ghost) shown.push({ ...ghost, name: said(texts, "chart.yours"), tone: "yours" })
        shown.forEach((line, i) => {
            if (!line.times.length) return
            const half = ink.measureText(line.name).width / 2 + 3
            const [first, last] = [Math.max(line.times[0]!, from), Math.min(line.times[line.times.length - 1]!, until)]
            const apart = (time: number) => Math.min(90, ...shown.map(other => {
                const [own, its] = [valueAt(line, time), valueAt(other, time)]
                return other === line || own === null || its === null ? 90 : Math.abs(this.y(own) - this.y(its))
            }))
            const kept = this.places[i]
            const times = Array.from({ length: TRIED }, (_, k) => last - (k / (TRIED - 1)) * (last - first))
            const scored = times.map(time => [apart(time), time] as const)
            if (kept !== undefined && kept >= first && kept <= last) scored.push([1.5 * apart(kept) + 1, kept]) // so that it stays
            scored.sort((a, b) => b[0] - a[0])
            const write = (x: number, y: number, clear: boolean): boolean => {
                if (y < MARGIN.top || y > this.y(this.axes.bottom) - 6) return false
                const box = { left: x - half, right: x + half, top: y - HALF, bottom: y + HALF }
                if ((clear && this.crossed(box)) || this.taken(box)) return false
                letters(ink, line.name, x, y, tones()[line.tone], tones().paper)
                return true
            }
            const height = (time: number, aside: number) => this.y(valueAt(line, time) ?? 0) + aside
            for (const clear of [true, false]) {
                for (const asides of clear ? ASIDES : ASIDES.slice(0, 1))
                    for (const [, time] of scored) {
                        const x = Math.min(Math.max(this.x(time), this.x(from) + half), this.x(until) - half)
                        if (!asides.some(aside => write(x, height(time, aside), clear))) continue
                        this.places[i] = time
                        return
                    }
                const beyond = this.x(last) + half + 12
                if (beyond + half < this.x(until) && [-8, -24, -40].some(aside => write(beyond, height(last, aside), clear))) return
            }
        })
    }

    private room(x: number, y: number, half: number): boolean {
        const box = { left: x - half, right: x + half, top: y - HALF, bottom: y + HALF }
        return !this.taken(box) && x + half < this.x(this.until) + MARGIN.right && x - half > MARGIN.left
    }

    /** Whether a box covers another one; if not, it is taken now. */
    private taken(box: Box): boolean {
        if (this.boxes.some(other => covers(box, other))) return true
        this.boxes.push(box)
        return false
    }

    /** Whether a line runs through a box. */
    private crossed({ left, right, top, bottom }: Box): boolean {
        const [from, until] = [left, right].map(x => this.inverse(x, 0)[0]) as [number, number]
        return [...this.lines, ...(this.ghost ? [this.ghost] : [])].some(({ times, values }) => {
            for (let i = Math.max(firstAfter(times, from) - 1, 0); i < times.length && times[i]! <= until; i++) {
                const y = this.y(values[i]!)
                if (y > top - 2 && y < bottom + 2) return true
            }
            return false
        })
    }

    /** The same as a table, made when it is opened. */
    private table(): HTMLElement {
        const { texts } = this
        const body = made("div", "wide")
        body.tabIndex = 0 // so that keys scroll it
        const details = made("details", "table", made("summary", "", said(texts, "chart.table")), body)
        details.addEventListener("toggle", () => body.replaceChildren(...(details.open ? [this.rows()] : [])))
        return details
    }

    private rows(): HTMLElement {
        const { texts, axes, spans, lines, ghost } = this
        const curves: (Curve & { name: string })[] = [...lines]
        if (ghost) curves.push({ ...ghost, name: said(texts, "chart.yours") })
        const heads = [said(texts, "chart.time"), ...curves.map(({ name }) => `${name} [${axes.unit}]`), said(texts, "chart.acts")]
        const row = (tag: "th" | "td", cells: string[]) => made("tr", "", ...cells.map(cell => made(tag, "", cell)))
        const all = curves.flatMap(({ times }) => [times[0] ?? Infinity, times[times.length - 1] ?? -Infinity])
        const [first, last] = [Math.min(...all), Math.max(...all)]
        const step = niceStep(Math.max((last - first) / 60, 0.5))
        const seconds = Array.from({ length: Math.max(0, Math.floor((last - first) / step + 1e-9)) + 1 }, (_, i) => first + i * step)
        const body = seconds.filter(Number.isFinite).map(time => {
            const values = curves.map(curve => valueAt(curve, time)).map(value => (value === null ? "" : written(texts, value, 1)))
            const acts = spans.filter(span => span.from <= time && time < span.until).map(span => said(texts, `chart.${span.kind}`))
            return row("td", [written(texts, time, 1), ...values, acts.join(", ")])
        })
        const table = made("table", "", made("thead", "", row("th", heads)), made("tbody", "", ...body))
        table.setAttribute("aria-label", axes.label)
        return table
    }
}

/** The number of the first time that is not before another. */
export function firstAfter(times: readonly number[], time: number): number {
    let [low, high] = [0, times.length]
    while (low < high) {
        const middle = (low + high) >> 1
        if (times[middle]! < time - 1e-9) low = middle + 1
        else high = middle
    }
    return low
}

/** The value of a curve at a time, between its points; null outside. */
export function valueAt({ times, values }: Curve, time: number): number | null {
    const next = firstAfter(times, time)
    if (next === times.length) return null
    const gap = times[next]! - time
    if (gap < 1e-6) return values[next]!
    if (next === 0) return null
    const share = gap / (times[next]! - times[next - 1]!)
    return share * values[next - 1]! + (1 - share) * values[next]!
}
