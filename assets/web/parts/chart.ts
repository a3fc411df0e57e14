// A chart over time. It names its quantity, shades when something acts on the robots, names each line beside it, and
// labels the peak after each event. strip.ts feeds it from an engine, drawing.ts lets a student draw on it.

import { made } from "../core/dom"
import { covers, disc, letters, Sheet, stroke, tones, type Box, type Pixel, type Tone } from "../core/ink"
import { niceStep } from "../core/numbers"
import { phrase, significant, written, type Texts } from "../core/words"
import { firstAfter, valueAt, type Curve, type Span } from "./curves"
import { tableOf, type TableColumn } from "./table"

export interface Line extends Curve {
    name: string
    tone: Tone
    dashed: boolean // colour is not the only sign
    thin?: boolean // as of a robot's second quantity in the chart
    logged?: boolean // of a real arm, on which nothing acts here
}

/** What a task wants of a line. */
export interface Limit {
    below: number | null
    above: number | null
    label: string
    tone: Tone
}

type Named = Curve & { name: string; tone: Tone }

export interface Axes {
    label: string
    unit: string
    bottom: number
    top: number
    /** A value with a name, such as the distance from the centre of a circle to it. */
    mark?: { value: number; label: string } | undefined
}

const MARGIN = { left: 42, right: 14, top: 24 }
const BOTTOM = { times: 24, none: 14 } // [px] below the plot, with the numbers of the axis of time or without
const TITLE = 9 // [px] from the top to the middle of the title
const FONT = "12px system-ui, sans-serif"
const BOLD = "600 13px system-ui, sans-serif"
const HALF = 8 // [px], half the height of a label
const SAMPLE = 18 // [px] of a line before its name above the plot
const SAME = 2 // [px], of lines that lie on each other
const TRIED = 25 // number of places along a line that are tried for its name
const ASIDES = [[-14, 14], [-32, 32], [-50, 50]] // [px], tried distances of the middle of its name from a line
const LEAST_PEAK = 0.004 // share of the height below which a peak is not labelled

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
    limits: readonly Limit[] = []
    /** The present values, beside the title: each after its name or, where there is no room for all names, alone. */
    readings: readonly { name: string; value: string; tone: Tone }[] = []
    /** Whether the axis of time has its numbers here. */
    hasTimes = true
    /** Whether what acts is named, and the peak after it has its number. */
    namesSpans = true
    hasPeaks = true
    /** Whether a line is named even where its name covers a line. */
    namesAll = true
    private boxes: Box[] = []
    private places: (number | undefined)[] = [] // times at which lines are named
    private told: readonly string[] = [] // names of lines that stand above the plot

    constructor(readonly texts: Texts, public axes: Axes, changed: () => void) {
        this.sheet = new Sheet(changed, true)
        const { canvas } = this.sheet
        canvas.setAttribute("role", "img")
        this.plot = made("div", "plot", canvas)
        this.element = made("div", "strip", this.plot, tableOf(texts, () => axes.label, () => this.columns, () => this.spans))
    }

    /** What stands in the table. */
    get columns(): TableColumn[] {
        const { lines, ghost, texts, axes: { unit } } = this
        const found: TableColumn[] = lines.map(({ name, times, values }) => ({ name, times, values, unit }))
        return ghost ? [...found, { ...ghost, name: phrase(texts, "chart.yours"), unit }] : found
    }

    private get bottom(): number { return this.hasTimes ? BOTTOM.times : BOTTOM.none }

    readonly x = (time: number): number =>
        MARGIN.left + ((time - this.from) / (this.until - this.from)) * (this.sheet.width - MARGIN.left - MARGIN.right)
    readonly y = (value: number): number => {
        const { top, bottom } = this.axes
        return MARGIN.top + ((top - value) / (top - bottom)) * (this.sheet.height - MARGIN.top - this.bottom)
    }

    /** The time and the value at a place in the plot, within the axes. */
    inverse(x: number, y: number): [number, number] {
        const { top, bottom } = this.axes
        const { width, height } = this.sheet
        const share = (x - MARGIN.left) / (width - MARGIN.left - MARGIN.right)
        const down = (y - MARGIN.top) / (height - MARGIN.top - this.bottom)
        const within = (each: number) => Math.min(Math.max(each, 0), 1)
        return [this.from + within(share) * (this.until - this.from), top - within(down) * (top - bottom)]
    }

    draw(): void {
        const ink = this.sheet.cleared()
        if (!ink) return
        this.boxes = []
        this.title(ink)
        this.shade(ink)
        this.grid(ink)
        for (const limit of this.limits) this.limit(ink, limit)
        ink.save()
        ink.beginPath()
        ink.rect(MARGIN.left, 0, this.sheet.width - MARGIN.left - MARGIN.right + 2, this.sheet.height)
        ink.clip()
        if (this.ghost) this.shadow(ink, this.ghost)
        for (const line of this.lines) {
            ink.setLineDash(line.dashed ? [7, 4] : [])
            stroke(ink, this.points(line), tones()[line.tone], line.thin ? 1.2 : 2.5)
        }
        ink.setLineDash([])
        this.instant(ink)
        ink.restore()
        ink.font = BOLD
        ink.textBaseline = "middle"
        if (this.hasPeaks) this.peaks(ink)
        if (this.namesSpans) this.spanNames(ink)
        ink.font = BOLD
        this.names(ink)
        ink.textAlign = "center"
        if (this.hint) letters(ink, this.hint, (this.x(this.from) + this.x(this.until)) / 2, this.sheet.height / 2, tones().yours, tones().paper)
    }

    /** The visible part of a curve. */
    private points({ times, values }: Curve): Pixel[] {
        const [first, last] = [Math.max(firstAfter(times, this.from) - 1, 0), firstAfter(times, this.until) + 1]
        return times.slice(first, last).map((time, i) => [this.x(time), this.y(values[first + i]!)])
    }

    /** The quantity and its unit, above the axis, and what it is now. */
    private title(ink: CanvasRenderingContext2D): void {
        const { label, unit } = this.axes
        ink.textBaseline = "middle"
        ink.textAlign = "left"
        let x = 4
        const write = (text: string, tone: Tone) => {
            ink.fillStyle = tones()[tone]
            ink.fillText(text, x, TITLE)
            x += ink.measureText(text).width + 14
        }
        ink.font = FONT
        write(unit ? `${label} [${unit}]` : label, "ink")
        ink.font = BOLD
        const { readings } = this
        const fit = (texts: string[], before: number) => x + texts.reduce((sum, text) => sum + before + ink.measureText(text).width + 14, -14) <= this.sheet.width
        const named = readings.map(({ name, value }) => `${name} ${value}`), values = readings.map(({ value }) => value)
        this.told = fit(named, SAMPLE) ? readings.map(({ name }) => name) : []
        const shown = this.told.length ? named : fit(values, 0) ? values : []
        shown.forEach((text, i) => {
            const { tone } = readings[i]!, line = this.lines.find(each => each.name === this.told[i])
            if (line) {
                ink.setLineDash(line.dashed ? [7, 4] : [])
                stroke(ink, [[x, TITLE], [x + SAMPLE - 5, TITLE]], tones()[tone], 2.5)
                ink.setLineDash([])
                x += SAMPLE
            }
            write(text, tone)
        })
        this.boxes.push({ left: 0, right: x - 8, top: TITLE - HALF, bottom: TITLE + HALF })
        ink.font = FONT
    }

    /** A band in which a line is wanted, with its words at its border. */
    private limit(ink: CanvasRenderingContext2D, { below, above, label, tone }: Limit): void {
        const { axes, from, until } = this
        const [left, right] = [this.x(from), this.x(until)]
        const [top, bottom] = [Math.min(below ?? axes.top, axes.top), Math.max(above ?? axes.bottom, axes.bottom)]
        if (top <= bottom) return
        ink.fillStyle = tones()[tone]
        ink.globalAlpha = 0.1
        ink.fillRect(left, this.y(top), right - left, this.y(bottom) - this.y(top))
        ink.globalAlpha = 1
        ink.setLineDash([8, 3])
        for (const value of [below, above]) {
            if (value === null || value > axes.top || value < axes.bottom) continue
            const y = Math.round(this.y(value)) + 0.5
            stroke(ink, [[left, y], [right, y]], tones()[tone], 1.2)
        }
        ink.setLineDash([])
        ink.textAlign = "right"
        ink.font = FONT
        const { width } = ink.measureText(label), edge = this.y(below === null ? bottom : top)
        const row = [edge - HALF - 1, edge + HALF + 1].find(y =>
            y > MARGIN.top && y < this.y(axes.bottom) && !this.taken({ left: right - width - 6, right, top: y - HALF, bottom: y + HALF }))
        if (row !== undefined) letters(ink, label, right - 4, row, tones()[tone], tones().paper)
    }

    private shade(ink: CanvasRenderingContext2D): void {
        for (const span of this.spans) {
            const [left, right] = this.ends(span)
            if (right <= left) continue
            ink.fillStyle = tones()[span.kind]
            ink.fillRect(left, MARGIN.top, right - left, this.y(this.axes.bottom) - MARGIN.top)
        }
    }

    /** The visible part of a span [px]. */
    private ends(span: Span): [number, number] {
        return [this.x(Math.max(span.from, this.from)), this.x(Math.min(span.until, this.until))]
    }

    /** Name what acts: within it, beside the lines, or else above it. */
    private spanNames(ink: CanvasRenderingContext2D): void {
        ink.font = FONT
        ink.textAlign = "center"
        for (const span of this.spans) {
            const [left, right] = this.ends(span)
            if (right <= left) continue
            const text = phrase(this.texts, `chart.${span.kind}`)
            const half = ink.measureText(text).width / 2
            const x = Math.min(Math.max((left + right) / 2, this.x(this.from) + half), this.x(this.until) - half)
            const box = (y: number): Box => ({ left: x - half, right: x + half, top: y - HALF, bottom: y + HALF })
            const within = [MARGIN.top + TITLE, MARGIN.top + TITLE + 2 * HALF, this.y(this.axes.bottom) - HALF - 2]
            const fits = right - left > 2 * half
            const rows = [...within.filter(y => fits && !this.crossed(box(y))), TITLE + 3, ...within]
            const row = rows.find(y => !this.taken(box(y)))
            if (row !== undefined) letters(ink, text, x, row, tones().ink, tones()[span.kind])
        }
    }

    private grid(ink: CanvasRenderingContext2D): void {
        const { axes, from, until, texts, sheet } = this
        const { top, bottom } = axes
        const { ink: dark, grid } = tones()
        const [left, right] = [this.x(from), this.x(until)]
        const rows = Math.max(2, Math.floor((sheet.height - MARGIN.top - this.bottom) / 34))
        const step = niceStep((top - bottom) / rows)
        ink.textAlign = "right"
        ink.fillStyle = dark
        for (let value = Math.ceil(bottom / step - 1e-9) * step; value <= top + 1e-9 * step; value += step) {
            const y = Math.round(this.y(value)) + 0.5
            stroke(ink, [[left, y], [right, y]], grid, 1)
            ink.fillText(significant(texts, value, 4), left - 6, y)
        }
        if (!this.hasTimes) return this.mark(ink)
        const apart = niceStep((64 * (until - from)) / (right - left))
        ink.textAlign = "center"
        ink.fillStyle = dark
        for (let time = Math.ceil(from / apart - 1e-9) * apart; time <= until + 1e-9; time += apart) {
            const text = significant(texts, time, 4)
            ink.fillText(time < from + apart ? `${text} s` : text, this.x(time), sheet.height - 7)
        }
        this.mark(ink)
    }

    private mark(ink: CanvasRenderingContext2D): void {
        const { top, bottom, mark } = this.axes
        if (!mark || mark.value > top || mark.value < bottom) return
        const { soft, paper } = tones()
        const [left, right] = [this.x(this.from), this.x(this.until)]
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
            for (const line of lines.filter(each => !each.logged)) {
                const first = firstAfter(line.times, span.from), last = firstAfter(line.times, end)
                let peak = -1
                for (let k = first; k < last; k++) if (peak < 0 || Math.abs(line.values[k]!) > Math.abs(line.values[peak]!)) peak = k
                const value = line.values[peak]
                if (value === undefined || line.times[peak]! < from || line.times[peak]! > until || Math.abs(value) < LEAST_PEAK * (axes.top - axes.bottom)) continue
                const text = written(texts, value, Math.abs(value) < 100 ? 1 : 0)
                const half = ink.measureText(text).width / 2 + 2
                const x = this.x(line.times[peak]!), y = Math.max(this.y(value) - 12, MARGIN.top + 2)
                const found = [0, 14, -14, 30, -30].find(aside => this.room(x + aside, y, half))
                if (found !== undefined) letters(ink, text, x + found, y, tones()[line.tone], tones().paper)
            }
        })
    }

    /** Name each line beside it, where it does not cover anything and is far from the others; lines that lie on each other
     * together, and none that is named above the plot. */
    private names(ink: CanvasRenderingContext2D): void {
        const { lines, ghost, texts, from, until } = this
        ink.textAlign = "center"
        const all: Named[] = lines.filter(line => !this.told.includes(line.name))
        if (ghost) all.push({ ...ghost, name: phrase(texts, "chart.yours"), tone: "yours" })
        const groups: Named[][] = []
        for (const line of all.filter(each => each.times.length)) {
            const group = groups.find(([other]) => this.coincide(line, other!))
            if (group) group.push(line)
            else groups.push([line])
        }
        const shown = groups.map(([line]) => line!)
        shown.forEach((line, i) => {
            const parts = groups[i]!.map(({ name, tone }, k) => ({ text: k < groups[i]!.length - 1 ? `${name}, ` : name, tone }))
            const half = parts.reduce((sum, { text }) => sum + ink.measureText(text).width, 0) / 2 + 3
            const [first, last] = [Math.max(line.times[0]!, from), Math.min(line.times[line.times.length - 1]!, until)]
            const apart = (time: number) => Math.min(90, ...shown.map(other => {
                const [own, its] = [valueAt(line, time), valueAt(other, time)]
                return other === line || own === null || its === null ? 90 : Math.abs(this.y(own) - this.y(its))
            }))
            const kept = this.places[i]
            const times = Array.from({ length: TRIED }, (_, k) => last - (k / (TRIED - 1)) * (last - first)).filter(time => valueAt(line, time) !== null)
            const scored = times.map(time => [apart(time), time] as const)
            if (kept !== undefined && kept >= first && kept <= last) scored.push([1.5 * apart(kept) + 1, kept]) // so that it stays
            scored.sort((a, b) => b[0] - a[0])
            const write = (x: number, y: number, clear: boolean): boolean => {
                if (y < MARGIN.top || y > this.y(this.axes.bottom) - 6) return false
                const box = { left: x - half, right: x + half, top: y - HALF, bottom: y + HALF }
                if ((clear && this.crossed(box)) || this.taken(box)) return false
                let left = x - half + 3
                for (const { text, tone } of parts) {
                    const { width } = ink.measureText(text)
                    letters(ink, text, left + width / 2, y, tones()[tone], tones().paper)
                    left += width
                }
                return true
            }
            const height = (time: number, aside: number) => this.y(valueAt(line, time) ?? 0) + aside
            for (const clear of this.namesAll ? [true, false] : [true]) {
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

    /** Whether two lines lie on each other wherever both are shown. */
    private coincide(line: Curve, other: Curve): boolean {
        const { from, until } = this
        const times = line.times.filter(time => time >= from && time <= until && valueAt(other, time) !== null)
        return times.length > 0 && times.every(time => Math.abs(this.y(valueAt(line, time)!) - this.y(valueAt(other, time)!)) <= SAME)
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
}
