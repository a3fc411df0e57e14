// The picture of one robot, in two dimensions.

import type { Side } from "./side"
import type { FigureData, Point } from "./figure_data"
import type { Path } from "./path"

const FAINT = "66" // how opaque the trace is, of "ff"
const [REACH, NEAR] = [44, 22] // [px], from the tip and from a control point, within which they are grabbed
const TIE = 8 // [px] by which a point must be nearer than the tip, unless it is selected

/** An empty canvas, in pixels of the page. */
export function inkOf(canvas: HTMLCanvasElement): CanvasRenderingContext2D | null {
    const ratio = window.devicePixelRatio || 1
    canvas.width = Math.round(canvas.clientWidth * ratio)
    canvas.height = Math.round(canvas.clientHeight * ratio)
    const ink = canvas.getContext("2d")
    ink?.scale(ratio, ratio)
    return ink
}

export class View {
    readonly canvas = document.createElement("canvas")
    private scale = 1
    private left = 0
    private top = 0

    constructor(private readonly side: Side, private readonly data: FigureData) {}

    /** Converts pixels to metres in the picture. */
    readonly metres = (dx: number, dy: number): Point => [dx / this.scale, -dy / this.scale]
    /** What a press in the window grabs: the nearest control point, "tip", or null. */
    grabbed(x: number, y: number, path: Path, selected: number | null): number | "tip" | null {
        const { controls } = this.data
        const { left, top } = this.canvas.getBoundingClientRect()
        const distance = ([atX, atY]: Point) => Math.hypot(x - left - atX, y - top - atY)
        const away = (place: Point) => distance(this.pixel(place))
        const far = controls.includes("drag") ? path.spots().map(away) : []
        const nearest = Math.min(...far)
        const tip = controls.includes("pull") ? away(this.side.tip()) : Infinity
        if (nearest < NEAR && (far.indexOf(nearest) === selected || nearest + TIE < tip)) return far.indexOf(nearest)
        return tip < REACH ? "tip" : null
    }

    draw(path: Path, selected: number | null, trace: Point[]): void {
        const ink = inkOf(this.canvas)
        if (!ink) return
        this.fill()
        const { colours, controls } = this.data
        this.line(ink, points(path.outline), colours.path, 2)
        const spots = controls.includes("drag") ? path.spots() : []
        if (selected !== null) this.disc(ink, spots[selected]!, 9, colours.selected)
        for (const spot of spots) this.disc(ink, spot, 6, colours.point)
        this.line(ink, trace, this.side.data.colour + FAINT, 3)
        for (const mark of path.fault?.marks ?? []) this.disc(ink, mark, 4, colours.warning)
        this.robot(ink)
        this.marker(ink)
        this.force(ink)
    }

    /** Let the figure's box fill the canvas. */
    private fill(): void {
        const { clientWidth: width, clientHeight: height } = this.canvas
        const [left, right, bottom, top] = this.data.box
        this.scale = Math.min(width / (right - left), height / (top - bottom))
        this.left = (left + right) / 2 - width / 2 / this.scale
        this.top = (bottom + top) / 2 + height / 2 / this.scale
    }

    private readonly pixel = ([x, y]: Point): Point => [(x - this.left) * this.scale, (this.top - y) * this.scale]
    private robot(ink: CanvasRenderingContext2D): void {
        const { sizes, strip, colours } = this.data
        const { dark, colour } = this.side.data
        const picture = this.side.picture()
        const links = sizes.bars - strip
        for (let i = 0; i < sizes.bars; i++) {
            const ends = points(picture.subarray(4 * i, 4 * i + 4))
            this.line(ink, ends, i < links && i % 2 === 0 ? dark : colour, i < links ? 9 : 5)
        }
        for (const joint of points(picture.subarray(4 * sizes.bars))) this.disc(ink, joint, 5, colours.steel)
        this.disc(ink, this.side.tip(), 5, colours.ink)
    }

    /** Draw a ring at a reference point that a law aims at, or a dot with a white rim at a closest point. */
    private marker(ink: CanvasRenderingContext2D): void {
        const { dark } = this.side.data
        const { aim } = this.side.does()
        const [rim, radius, ...colours] = aim === "theta_ref" ? [9, 6, dark, "#fff"] as const : [7, 5, "#fff", dark] as const
        this.disc(ink, this.side.aim(), rim, colours[0])
        this.disc(ink, this.side.aim(), radius, colours[1])
    }

    private force(ink: CanvasRenderingContext2D): void {
        const [begin, end] = [this.pixel(this.side.tip()), this.pixel(this.side.arrow())]
        const [dx, dy] = [end[0] - begin[0], end[1] - begin[1]]
        const length = Math.hypot(dx, dy)
        if (length < 6) return
        const [x, y] = [(8 * dx) / length, (8 * dy) / length]
        const barbs: Point[] = [[end[0] - x - y / 2, end[1] - y + x / 2], end, [end[0] - x + y / 2, end[1] - y - x / 2]]
        for (const way of [[begin, end], barbs]) stroke(ink, way, this.data.colours.force, 3)
    }

    private line(ink: CanvasRenderingContext2D, way: Point[], colour: string, width: number): void {
        ink.lineCap = ink.lineJoin = "round"
        stroke(ink, way.map(point => this.pixel(point)), colour, width)
    }

    private disc(ink: CanvasRenderingContext2D, place: Point, radius: number, colour: string): void {
        ink.fillStyle = colour
        ink.beginPath()
        ink.arc(...this.pixel(place), radius, 0, 2 * Math.PI)
        ink.fill()
    }
}

export function stroke(ink: CanvasRenderingContext2D, way: Point[], colour: string, width: number): void {
    ink.strokeStyle = colour
    ink.lineWidth = width
    ink.beginPath()
    for (const point of way) ink.lineTo(...point)
    ink.stroke()
}

function points(flat: ArrayLike<number>): Point[] {
    return Array.from({ length: flat.length / 2 }, (_, i) => [flat[2 * i]!, flat[2 * i + 1]!])
}
