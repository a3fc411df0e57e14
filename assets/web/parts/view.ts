// The picture of one robot, in two dimensions.

import type { FigureData, Point } from "../core/figure_data"
import { arrow, dashed, disc, Sheet, stroke, tones } from "../core/ink"
import { drawShapes, jointsOfFiveBar, shapesOf, type Seen } from "../core/symbols"
import { Drawings } from "./drawings"
import type { Path } from "../simulation/path"
import type { Side } from "../simulation/side"

const NARROW = 240, MARGIN = 0.025 // [px], width of a narrow picture, and [m] that it leaves out at each side
const FAINT = 0.4 // opacity of the trace
const [REACH, NEAR] = [44, 22] // [px], from the tip and from a control point, within which they are grabbed
const TIE = 8 // [px] by which a point must be nearer than the tip, unless it is selected

export class View {
    /** The symbol that is shown; may be empty. */
    lit = ""
    readonly canvas: HTMLCanvasElement
    private readonly sheet: Sheet
    scale = 1000 // pixels for a metre; this one until there is a picture
    private left = 0
    private top = 0

    /** How many times as large the deflection of a flexible link is drawn. */
    larger = 1
    readonly drawings: Drawings

    /** `clock`: the robot whose point runs by the clock. */
    constructor(private readonly side: Side, private readonly clock: Side, private readonly data: FigureData, changed: () => void) {
        this.sheet = new Sheet(changed)
        this.canvas = this.sheet.canvas
        this.drawings = new Drawings(data.drawings, changed)
    }

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

    draw(path: Path, number: number, selected: number | null, trace: Point[]): void {
        const ink = this.sheet.cleared()
        if (!ink) return
        this.fill()
        const { side, clock, pixel, scale, drawings } = this, scene = { side, clock, path, number, pixel, scale }
        drawings.beneath(ink, scene)
        const { controls } = this.data, colours = tones()
        for (const part of path.parts) (part.raised ? dashed : stroke)(ink, part.points.map(pixel), colours.path, 2.5)
        const spots = controls.includes("drag") ? path.spots() : []
        if (selected !== null) this.disc(ink, spots[selected]!, 9, colours.selected)
        for (const spot of spots) {
            this.disc(ink, spot, 4.5, colours.point)
            this.disc(ink, spot, 2.5, colours.paper)
        }
        ink.globalAlpha = FAINT
        this.line(ink, trace, this.colour, 3)
        ink.globalAlpha = 1
        for (const mark of path.fault?.marks ?? []) this.disc(ink, mark, 4, colours.warning)
        this.robot(ink)
        this.marker(ink)
        this.force(ink)
        drawings.over(ink, scene)
        if (this.lit) drawShapes(ink, shapesOf(this.lit, this.seen(path)), this.pixel, colours.selected)
    }

    private seen(path: Path): Seen {
        const { side, data: { sizes } } = this
        const [base, elbow, short] = points(side.picture().slice(4 * sizes.bars))
        const isFiveBar = sizes.bars === 4 && sizes.joints === 4
        return {
            tip: side.tip(), closest: side.closest(), reference: side.does().aim === "theta_ref" ? side.reference() : null,
            pushed: side.arrow(), outline: points(path.outline), closed: path.data.closed,
            joints: isFiveBar ? jointsOfFiveBar(base!, elbow!, short!, side.tip()) : {},
        }
    }

    /** Let the figure's box fill the canvas. */
    private fill(): void {
        const { width, height } = this.sheet
        const [left, right, bottom, top] = this.data.box
        const margin = width < NARROW ? MARGIN : 0
        this.scale = Math.min(width / (right - left - 2 * margin), height / (top - bottom))
        this.left = (left + right) / 2 - width / 2 / this.scale
        this.top = (bottom + top) / 2 + height / 2 / this.scale
    }

    private get colour(): string { return tones()[`side${this.side.data.side}`] }
    private get dark(): string { return tones()[`dark${this.side.data.side}`] }
    private readonly pixel = ([x, y]: Point): Point => [(x - this.left) * this.scale, (this.top - y) * this.scale]
    private robot(ink: CanvasRenderingContext2D): void {
        const { sizes, strip } = this.data
        const { dark, colour } = this, mixed = `color-mix(in srgb, ${dark}, ${colour})`
        const picture = this.side.picture(this.larger)
        const links = sizes.bars - strip
        for (let i = 0; i < sizes.bars; i++) {
            const ends = points(picture.subarray(4 * i, 4 * i + 4))
            if (i < links) this.line(ink, ends, dark, 12)
            this.line(ink, ends, i < links && i % 2 === 0 ? mixed : colour, i < links ? 8 : 5)
        }
        for (const joint of points(picture.subarray(4 * sizes.bars))) this.joint(ink, joint)
        const tip: Point = this.larger === 1 ? this.side.tip() : [picture[4 * sizes.bars - 2]!, picture[4 * sizes.bars - 1]!]
        this.disc(ink, tip, 5, tones().ink)
    }

    private joint(ink: CanvasRenderingContext2D, place: Point): void {
        this.disc(ink, place, 7, tones().steel)
        this.disc(ink, place, 2.5, tones().paper)
    }

    /** Draw a ring at a reference point that a law aims at, or a dot with a white rim at a closest point. */
    private marker(ink: CanvasRenderingContext2D): void {
        const { dark } = this
        const { aim } = this.side.does()
        const [rim, radius, ...colours] = aim === "theta_ref" ? [10, 7, dark, tones().paper] as const : [6.5, 4.75, tones().paper, dark] as const
        this.disc(ink, this.side.aim(), rim, colours[0])
        this.disc(ink, this.side.aim(), radius, colours[1])
    }

    private force(ink: CanvasRenderingContext2D): void {
        const [begin, end] = [this.pixel(this.side.tip()), this.pixel(this.side.arrow())]
        if (Math.hypot(end[0] - begin[0], end[1] - begin[1]) >= 6) arrow(ink, begin, end, tones().force, 3)
    }

    private line(ink: CanvasRenderingContext2D, line: Point[], colour: string, width: number): void {
        stroke(ink, line.map(point => this.pixel(point)), colour, width)
    }

    private disc(ink: CanvasRenderingContext2D, place: Point, radius: number, colour: string): void {
        disc(ink, this.pixel(place), radius, colour)
    }
}

function points(flat: ArrayLike<number>): Point[] {
    return Array.from({ length: flat.length / 2 }, (_, i) => [flat[2 * i]!, flat[2 * i + 1]!])
}
