// A curve that a student draws, and the truth on the same axes.

import { made } from "./controls"
import { said, type PageData, type SketchData } from "./lesson_data"
import type { Answer, Curves } from "./notes"
import { local } from "./numbers"
import { inkOf } from "./view"

const MARGIN = { left: 46, right: 12, top: 26, bottom: 26 }
const POINTS = 9 // of a typed curve
const MOST = 160 // points that are kept

export class Chart {
    readonly canvas = made("canvas", "chart")

    constructor(protected readonly page: PageData, protected readonly axes: SketchData) {
        this.canvas.setAttribute("role", "img")
        this.canvas.setAttribute("aria-label", `${axes.label} [${axes.unit}]`)
    }

    draw(answer: Answer | undefined, truth: Curves | undefined): void {
        const ink = inkOf(this.canvas)
        if (!ink) return
        this.frame(ink)
        const { robots } = this.axes
        const shown: [string, string, number[], number[] | undefined, number[] | undefined][] = [
            [said(this.page, "lesson.yours"), this.colour("yours"), [], answer?.times, answer?.values],
            [robots[0]!, this.colour("tracker"), [], truth?.times, truth?.tracker],
            [robots[1]!, this.colour("follower"), [7, 4], truth?.times, truth?.follower],
        ]
        let legend = MARGIN.left
        shown.forEach(([name, colour, dashes, times, values], i) => {
            if (!times?.length || !values) return
            ink.strokeStyle = ink.fillStyle = colour
            ink.lineWidth = i === 0 ? 4 : 2
            ink.setLineDash(dashes)
            this.line(ink, times, values)
            ink.setLineDash([])
            ink.textAlign = "left"
            ink.fillText(name, legend, 12)
            legend += ink.measureText(name).width + 16
        })
    }

    protected x(time: number): number {
        return MARGIN.left + (time / this.axes.seconds) * (this.canvas.clientWidth - MARGIN.left - MARGIN.right)
    }

    protected y(value: number): number {
        const { top, bottom } = this.axes
        const height = this.canvas.clientHeight - MARGIN.top - MARGIN.bottom
        return MARGIN.top + ((top - value) / (top - bottom)) * height
    }

    /** A colour of the page's style, light or dark. */
    private colour(name: string): string {
        return getComputedStyle(this.canvas).getPropertyValue(`--chart-${name}`)
    }

    private frame(ink: CanvasRenderingContext2D): void {
        const { seconds, top, bottom } = this.axes
        const point = this.page.words["point"]!
        ink.font = "12px system-ui, sans-serif"
        ink.strokeStyle = this.colour("grid")
        ink.fillStyle = this.colour("ink")
        ink.textBaseline = "middle"
        ink.textAlign = "right"
        for (let i = 0; i <= 4; i++) {
            const value = bottom + (i / 4) * (top - bottom)
            this.line(ink, [0, seconds], [value, value])
            ink.fillText(local(value, 3, point), MARGIN.left - 6, this.y(value))
        }
        ink.textAlign = "center"
        for (let i = 0; i <= 4; i++) ink.fillText(local((i / 4) * seconds, 3, point), this.x((i / 4) * seconds), this.y(bottom) + 14)
        ink.fillText("t [s]", this.x(0.875 * seconds), this.y(bottom) + 14)
    }

    private line(ink: CanvasRenderingContext2D, times: number[], values: number[]): void {
        const span = this.axes.top - this.axes.bottom
        ink.save()
        ink.beginPath()
        ink.rect(MARGIN.left, MARGIN.top - 2, this.canvas.clientWidth - MARGIN.left - MARGIN.right, this.y(this.axes.bottom) - MARGIN.top + 4)
        ink.clip()
        ink.beginPath()
        times.forEach((time, i) => {
            const value = Math.min(Math.max(values[i]!, this.axes.bottom - span), this.axes.top + span)
            ink.lineTo(this.x(time), this.y(value))
        })
        ink.stroke()
        ink.restore()
    }
}

/** The board on which a curve is drawn, by hand or with numbers. */
export class Board extends Chart {
    readonly element: HTMLElement
    answer: Answer = {}
    private drawing: number | null = null // the pointer that draws
    private readonly inputs: HTMLInputElement[]

    constructor(page: PageData, axes: SketchData, private readonly changed: () => void) {
        super(page, axes)
        this.canvas.classList.add("board")
        const seconds = local(axes.seconds, 4, page.words["point"]!)
        this.canvas.setAttribute("aria-label", said(page, "site.sketch", { quantity: axes.label, unit: axes.unit, seconds }))
        this.inputs = Array.from({ length: POINTS }, () => made("input", ""))
        const labels = this.inputs.map((input, i) => {
            const time = local(this.time(i), 3, page.words["point"]!)
            input.inputMode = "decimal"
            input.addEventListener("change", () => this.typed())
            return made("label", "", said(page, "lesson.at", { time, unit: axes.unit }), " ", input)
        })
        const summary = made("summary", "", said(page, "lesson.numbers"))
        this.element = made("div", "", this.canvas, made("details", "", summary, made("div", "points", ...labels)))
        this.hand()
    }

    private readonly time = (i: number): number => (i / (POINTS - 1)) * this.axes.seconds
    private hand(): void {
        const { canvas } = this
        canvas.addEventListener("pointerdown", event => {
            if (this.drawing !== null) return
            this.drawing = event.pointerId
            canvas.setPointerCapture(event.pointerId)
            this.answer = { times: [], values: [] }
            this.extend(event)
        })
        canvas.addEventListener("pointermove", event => {
            if (event.pointerId !== this.drawing) return
            for (const each of event.getCoalescedEvents?.() ?? [event]) this.extend(each)
        })
        for (const end of ["pointerup", "pointercancel"] as const)
            canvas.addEventListener(end, event => {
                if (event.pointerId !== this.drawing) return
                if (this.answer.times!.length < 2) this.answer = {}
                this.drawing = null
                this.show()
            })
    }

    private extend(event: PointerEvent): void {
        const box = this.canvas.getBoundingClientRect()
        const { seconds, top, bottom } = this.axes
        const share = (event.clientX - box.left - this.x(0)) / (this.x(seconds) - this.x(0))
        const time = round(Math.min(Math.max(share, 0), 1) * seconds)
        const height = (event.clientY - box.top - this.y(top)) / (this.y(bottom) - this.y(top))
        const value = round(Math.min(Math.max(top - height * (top - bottom), bottom), top))
        const { times, values } = this.answer as Required<Answer>
        if (times.length && time < times[times.length - 1]! + seconds / MOST) return
        times.push(time)
        values.push(value)
        this.show()
    }

    /** The numbers that were typed, without empty boxes. */
    private typed(): void {
        const point = this.page.words["point"]!
        const typed = this.inputs.map(input => Number(input.value.trim().replace(point, ".").replace("−", "-") || NaN))
        const given = typed.map((value, i) => [this.time(i), value] as const).filter(([, value]) => Number.isFinite(value))
        const { top, bottom } = this.axes
        this.answer = given.length < 2 ? {} : {
            times: given.map(([time]) => round(time)),
            values: given.map(([, value]) => round(Math.min(Math.max(value, bottom), top))),
        }
        this.show()
    }

    private show(): void {
        this.draw(this.answer, undefined)
        this.changed()
    }
}

function round(value: number): number {
    return Math.round(1e3 * value) / 1e3
}
