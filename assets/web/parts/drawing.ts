// Draws a prediction on a chart: with the mouse, a finger, or a row of sliders for keys.

import { made } from "../core/dom"
import { niceStep } from "../core/numbers"
import { phrase, significant } from "../core/words"
import type { Chart } from "./chart"
import { firstAfter, valueAt, type Curve } from "./curves"

const POINTS = 33 // number of points that keys move; in eight seconds, four a second
const MOST = 160 // points that are kept
const STEPS: Record<string, number> = { ArrowUp: 1, ArrowDown: -1, PageUp: 5, PageDown: -5, Home: -1000, End: 1000 }

export class Drawing {
    private readonly points: HTMLElement[]
    private pointer: number | null = null // that draws
    private last = 0 // time at which it draws

    /** `changed` is called at each change; the chart's ghost is then the curve, or null. */
    constructor(private readonly chart: Chart, private readonly changed: () => void) {
        const { texts, plot } = chart
        this.points = Array.from({ length: POINTS }, (_, i) => {
            const point = made("div", "point")
            const name = phrase(texts, "chart.point", { time: significant(texts, this.time(i), 3) })
            Object.assign(point, { tabIndex: i ? -1 : 0, role: "slider", ariaLabel: name, ariaOrientation: "vertical" })
            point.addEventListener("keydown", event => this.key(event, i))
            point.addEventListener("focus", () => this.points.forEach(each => (each.tabIndex = each === point ? 0 : -1))) // one stop of Tab
            return point
        })
        plot.classList.add("drawn")
        plot.append(...this.points)
        chart.sheet.canvas.classList.add("board")
        this.hand()
        this.show()
    }

    /** Whether a curve can be drawn. */
    set open(open: boolean) {
        this.chart.plot.classList.toggle("drawn", open)
        for (const point of this.points) point.hidden = !open
    }

    /** Put the sliders where the curve is. */
    show(): void {
        const { chart, points } = this
        const { texts, axes, sheet: { zoom } } = chart
        points.forEach((point, i) => {
            const value = this.value(i)
            point.style.transform = `translate(${(zoom * chart.x(this.time(i))).toFixed(1)}px, ${(zoom * chart.y(value)).toFixed(1)}px)`
            const told = { min: String(axes.bottom), max: String(axes.top), now: String(value), text: `${significant(texts, value, 3)} ${axes.unit}` }
            for (const [name, each] of Object.entries(told)) point.setAttribute(`aria-value${name}`, each)
        })
    }

    private readonly time = (i: number): number => this.chart.from + (i / (POINTS - 1)) * (this.chart.until - this.chart.from)
    /** The value of the curve at a slider; beyond the curve's ends, that at the end. */
    private value(i: number): number {
        const { ghost, axes } = this.chart
        if (!ghost?.values.length) return Math.min(Math.max(0, axes.bottom), axes.top)
        const found = valueAt(ghost, this.time(i))
        return found ?? ghost.values[firstAfter(ghost.times, this.time(i)) === 0 ? 0 : ghost.values.length - 1]!
    }

    private key(event: KeyboardEvent, i: number): void {
        const aside = { ArrowLeft: -1, ArrowRight: 1 }[event.key]
        const by = STEPS[event.key]
        if (aside === undefined && by === undefined) return
        event.preventDefault()
        event.stopPropagation()
        if (aside) return this.points[i + aside]?.focus()
        const { top, bottom } = this.chart.axes
        const step = niceStep((top - bottom) / 60)
        const values = this.points.map((_, k) => this.value(k))
        values[i] = rounded(Math.min(Math.max(values[i]! + by! * step, bottom), top))
        this.keep({ times: values.map((_, k) => rounded(this.time(k))), values })
    }

    private hand(): void {
        const { plot } = this.chart
        plot.addEventListener("pointerdown", event => {
            if (this.pointer !== null || !plot.classList.contains("drawn") || event.button !== 0) return
            this.pointer = event.pointerId
            plot.setPointerCapture(event.pointerId)
            const [time, value] = this.place(event)
            this.last = time
            this.keep({ times: [time], values: [value] })
        })
        plot.addEventListener("pointermove", event => {
            if (event.pointerId !== this.pointer) return
            for (const each of event.getCoalescedEvents?.() ?? [event]) this.extend(...this.place(each))
        })
        for (const end of ["pointerup", "pointercancel"] as const)
            plot.addEventListener(end, event => {
                if (event.pointerId !== this.pointer) return
                this.pointer = null
                if ((this.chart.ghost?.times.length ?? 0) < 2) this.keep(null)
            })
    }

    private place({ clientX, clientY }: PointerEvent): [number, number] {
        const { plot, sheet } = this.chart
        const box = plot.getBoundingClientRect()
        const at = this.chart.inverse((clientX - box.left) / sheet.zoom, (clientY - box.top) / sheet.zoom)
        return at.map(rounded) as [number, number]
    }

    /** Go on drawing; going back draws that part again. */
    private extend(time: number, value: number): void {
        const { ghost, from, until } = this.chart
        const least = (until - from) / MOST
        if (Math.abs(time - this.last) < least) return
        const [low, high] = time > this.last ? [this.last + least / 2, time + least / 2] : [time - least / 2, this.last - least / 2]
        const kept = ghost!.times.map((each, i) => [each, ghost!.values[i]!] as const).filter(([each]) => each < low || each > high)
        const all = [...kept, [time, value] as const].sort((a, b) => a[0] - b[0])
        this.last = time
        this.keep({ times: all.map(each => each[0]), values: all.map(each => each[1]) })
    }

    private keep(curve: Curve | null): void {
        this.chart.ghost = curve
        this.show()
        this.changed()
    }
}

function rounded(value: number): number {
    return Math.round(1e3 * value) / 1e3
}
