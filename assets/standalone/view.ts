// The picture of one robot, in two dimensions.

import type { Bench } from "./bench"
import type { FigureData } from "./data"

const TRACE = 240 // frames
const REACH = 44 // [px], from the tip, within which it can be grabbed
type Point = [number, number]

export class View {
    readonly canvas = document.createElement("canvas")
    private trace: Point[] = []
    private scale = 1
    private left = 0
    private top = 0

    constructor(
        private readonly bench: Bench,
        private readonly data: FigureData,
    ) {}

    clear(): void {
        this.trace = []
    }

    /** Note where the tip is now. */
    follow(): void {
        this.trace.push(this.bench.tip())
        if (this.trace.length > TRACE) this.trace.shift()
    }

    /** Metres of the picture that a way of so many pixels is. */
    metres(dx: number, dy: number): Point {
        return [dx / this.scale, -dy / this.scale]
    }

    /** Whether a place in the window is near enough to the tip. */
    holds(x: number, y: number): boolean {
        const box = this.canvas.getBoundingClientRect()
        const [tipX, tipY] = this.pixel(this.bench.tip())
        return Math.hypot(x - box.left - tipX, y - box.top - tipY) < REACH
    }

    draw(outline: number[]): void {
        const ink = this.prepared()
        if (!ink) return
        const { colours } = this.data
        this.line(ink, points(outline), colours.path, 2)
        this.line(ink, this.trace, this.bench.data.pale, 3)
        this.robot(ink)
        this.marker(ink)
        this.force(ink)
    }

    private prepared(): CanvasRenderingContext2D | null {
        const { canvas } = this
        const { clientWidth: width, clientHeight: height } = canvas
        const ratio = window.devicePixelRatio || 1
        if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
            canvas.width = Math.round(width * ratio)
            canvas.height = Math.round(height * ratio)
        }
        const [left, right, bottom, top] = this.data.box
        this.scale = Math.min(width / (right - left), height / (top - bottom))
        this.left = (left + right) / 2 - width / 2 / this.scale
        this.top = (bottom + top) / 2 + height / 2 / this.scale
        const ink = canvas.getContext("2d")
        ink?.setTransform(ratio, 0, 0, ratio, 0, 0)
        ink?.clearRect(0, 0, width, height)
        return ink
    }

    private pixel([x, y]: Point): Point {
        return [(x - this.left) * this.scale, (this.top - y) * this.scale]
    }

    private robot(ink: CanvasRenderingContext2D): void {
        const { sizes, strip, colours } = this.data
        const picture = this.bench.picture()
        const links = sizes.bars - strip
        for (let i = 0; i < sizes.bars; i++) {
            const ends = points(picture.subarray(4 * i, 4 * i + 4))
            const behind = i < links && i % 2 === 0
            this.line(ink, ends, behind ? this.bench.data.dark : this.bench.data.colour, i < links ? 9 : 5)
        }
        for (const joint of points(picture.subarray(4 * sizes.bars)))
            this.disc(ink, joint, 5, colours.steel)
        this.disc(ink, this.bench.tip(), 5, colours.ink)
    }

    /** A ring at a reference point that a law aims at, a dot with a white rim at a closest point. */
    private marker(ink: CanvasRenderingContext2D): void {
        const { aim, dark } = this.bench.data
        const place = this.bench.aim()
        this.disc(ink, place, aim === "theta_ref" ? 9 : 7, aim === "theta_ref" ? dark : "#fff")
        this.disc(ink, place, aim === "theta_ref" ? 6 : 5, aim === "theta_ref" ? "#fff" : dark)
    }

    private force(ink: CanvasRenderingContext2D): void {
        const begin = this.pixel(this.bench.tip())
        const end = this.pixel(this.bench.arrow())
        const [dx, dy] = [end[0] - begin[0], end[1] - begin[1]]
        const length = Math.hypot(dx, dy)
        if (length < 6) return
        const [x, y] = [(8 * dx) / length, (8 * dy) / length]
        ink.strokeStyle = this.data.colours.force
        ink.lineWidth = 3
        ink.beginPath()
        ink.moveTo(...begin)
        ink.lineTo(...end)
        ink.moveTo(end[0] - x - y / 2, end[1] - y + x / 2)
        ink.lineTo(...end)
        ink.lineTo(end[0] - x + y / 2, end[1] - y - x / 2)
        ink.stroke()
    }

    private line(ink: CanvasRenderingContext2D, way: Point[], colour: string, width: number): void {
        ink.strokeStyle = colour
        ink.lineWidth = width
        ink.lineCap = ink.lineJoin = "round"
        ink.beginPath()
        for (const point of way) ink.lineTo(...this.pixel(point))
        ink.stroke()
    }

    private disc(ink: CanvasRenderingContext2D, place: Point, radius: number, colour: string): void {
        ink.fillStyle = colour
        ink.beginPath()
        ink.arc(...this.pixel(place), radius, 0, 2 * Math.PI)
        ink.fill()
    }
}

function points(flat: ArrayLike<number>): Point[] {
    return Array.from({ length: flat.length / 2 }, (_, i) => [flat[2 * i]!, flat[2 * i + 1]!])
}
