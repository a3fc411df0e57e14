// A magnifier on a robot's end-point: path, closest point, reference point, error, trace and force, to scale.

import { made, tell } from "../core/dom"
import { shown, type Engine, type PathShape, type SideSample, type Vector } from "../core/engine"
import type { Point } from "../core/figure_data"
import { arrow, covers, dashed, disc, letters, Sheet, stroke, tones, type Box, type Pixel } from "../core/ink"
import { niceStep } from "../core/numbers"
import { drawShapes, shapesOf } from "../core/symbols"
import { phrase, significant, written, type Texts } from "../core/words"

const FACTORS = [1.5, 3, 6, 12, 20]
const FITS = 0.62 // share of the radius that what is to be seen fills after a change of scale
const CLOSER = 0.45 // share of the radius below which the lens may go closer
const HIGHER = 0.92 // of the radius, from the top to the middle of what is to be seen, which is above the bar
const RIM = 5 // [px] between letters and the edge
const HALF = 8 // [px], half the height of letters
const CLOSEST = FACTORS[FACTORS.length - 1]!
const [SMALL, TINY] = [55, 40] // [px], of a radius with no room for words, and none for a bar
const PATIENCE = 900 // [ms] for which it could have gone closer before it does
const GLIDE = 120 // [ms], time constant of a change of scale
const TRACE = 2 // [s] of the past that the trace shows
const FORCE = 2.2 // [px/N], length of the arrow of a force
const LONGEST = 46 // [px], longest arrow of a force
const WEAK = 0.05 // [N] below which a force is not drawn
const CALM = 2e-4 // [m] of error out of the path's plane up to which the picture is not turned

/** Two directions at right angles, in which the lens looks. */
type Plane = readonly [Vector, Vector]

export class Lens {
    readonly element: HTMLElement
    private symbol = ""
    /** Pixels of the picture around the lens for a metre, of which factors are multiples. */
    scale = 1000
    readonly sheet: Sheet
    private readonly distance = made("b", "distance")
    private readonly more = made("span", "")
    private stale = true
    private factor = CLOSEST
    private drawn = 0 // pixels for a metre, at present
    private could = 0 // [ms], since when it could go closer
    private last = 0
    private boxes: Box[] = [] // that letters do not cover

    constructor(private readonly texts: Texts, private readonly engine: Engine, private readonly side: number, ended?: AbortSignal) {
        this.sheet = new Sheet(() => (this.stale = true), true)
        this.sheet.canvas.setAttribute("role", "img")
        const tone = engine.texts[side]!.side
        this.element = made("div", `lens side${tone}`, this.sheet.canvas, made("p", "reading", this.distance, " ", this.more))
        engine.on(() => (this.stale = true), ended)
        this.read(shown(engine).sides[side]!)
    }

    /** The symbol that is shown; may be empty. */
    get lit(): string { return this.symbol }
    set lit(symbol: string) {
        this.symbol = symbol
        this.stale = true
    }

    draw(now = performance.now()): void {
        const { sheet, engine, side } = this
        if (!this.stale) return
        this.stale = false
        const sample = shown(engine).sides[side]!
        const ink = sheet.cleared()
        const radius = Math.min(sheet.width, sheet.height) / 2
        const plane = planeOf(sample, engine.path)
        const flat = (point: Vector): Pixel => [dot(point, plane[0]), -dot(point, plane[1])]
        const seen = [sample.tip, sample.closest, ...(sample.reference ? [sample.reference] : []), ...(sample.straight ? [sample.straight] : [])]
        const [middle, reach] = extent(seen.map(flat))
        this.zoom(reach, radius || 80, now)
        this.read(sample)
        if (!ink || radius < 10) return
        const pixel = (point: Vector): Pixel => {
            const [x, y] = flat(point)
            return [radius + (x - middle[0]) * this.drawn, HIGHER * radius + (y - middle[1]) * this.drawn]
        }
        ink.save()
        ink.beginPath()
        ink.arc(radius, radius, radius - 2, 0, 2 * Math.PI)
        ink.fillStyle = tones().paper
        ink.fill()
        ink.clip()
        this.grid(ink, middle, radius)
        this.things(ink, sample, pixel, radius)
        if (this.lit) this.light(ink, sample, plane, ([x, y]) => [
            radius + (x - middle[0]) * this.drawn, HIGHER * radius - (y + middle[1]) * this.drawn,
        ])
        if (radius >= TINY) this.bar(ink, radius)
        else this.times(ink, radius)
        ink.restore()
        ink.lineWidth = 3
        ink.strokeStyle = tones()[`side${engine.texts[side]!.side}`]
        ink.beginPath()
        ink.arc(radius, radius, radius - 2, 0, 2 * Math.PI)
        ink.stroke()
    }

    /** Choose a factor: further away at once, closer after a while; and glide there. */
    private zoom(reach: number, radius: number, now: number): void {
        const fits = (factor: number, share: number) => reach * factor * this.scale <= share * radius
        if (!fits(this.factor, FITS)) {
            this.factor = [...FACTORS].reverse().find(factor => fits(factor, FITS)) ?? FACTORS[0]!
            this.could = 0
        } else {
            const closer = FACTORS[FACTORS.indexOf(this.factor) + 1]
            if (!closer || !fits(closer, CLOSER)) this.could = 0
            else if (!this.could) this.could = now
            else if (now > this.could + PATIENCE) {
                this.factor = closer
                this.could = 0
            }
            if (this.could) this.stale = true
        }
        const goal = this.factor * this.scale
        const share = this.drawn ? Math.exp(-Math.min(now - this.last, 100) / GLIDE) : 0
        this.last = now
        this.drawn = goal * (Math.max(this.drawn, 1) / goal) ** share
        if (Math.abs(this.drawn / goal - 1) < 0.005) this.drawn = goal
        else this.stale = true
    }

    private read(sample: SideSample): void {
        const { texts, factor, engine, side } = this
        const name = phrase(texts, "lens.name", { law: engine.texts[side]!.title })
        if (this.sheet.canvas.ariaLabel !== name) this.sheet.canvas.ariaLabel = name
        tell(this.distance, `${written(texts, 1e3 * sample.distance, factor === CLOSEST ? 2 : 1)} mm`)
        const acts = sample.held ? "chart.held" : sample.pulled ? "chart.pulled" : ""
        tell(this.more, [acts && phrase(texts, acts), `×${written(texts, factor)}`].filter(Boolean).join(" · "))
    }

    private grid(ink: CanvasRenderingContext2D, middle: Pixel, radius: number): void {
        const step = niceStep(22 / this.drawn)
        const lines = (at: number, share = 1) => Array.from({ length: Math.ceil((2 * radius) / this.drawn / step) + 1 }, (_, i) =>
            share * radius + ((Math.floor((at - (share * radius) / this.drawn) / step) + i) * step - at) * this.drawn)
        for (const x of lines(middle[0])) stroke(ink, [[x, 0], [x, 2 * radius]], tones().grid, 0.6)
        for (const y of lines(middle[1], HIGHER)) stroke(ink, [[0, y], [2 * radius, y]], tones().grid, 0.6)
    }

    private things(ink: CanvasRenderingContext2D, sample: SideSample, pixel: (point: Vector) => Pixel, radius: number): void {
        const { engine, side, texts } = this
        const { path, texts: faces } = engine
        const all = tones(), tone = faces[side]!.side
        const [colour, dark] = [all[`side${tone}`], all[`dark${tone}`]]
        const [tip, closest] = [pixel(sample.tip), pixel(sample.closest)]
        for (const line of path.strokes ?? path.lines) stroke(ink, line.map(pixel), all.path, 3)
        for (const link of path.links ?? []) dashed(ink, link.map(pixel), all.path, 3)
        const time = shown(engine).time
        const trace = engine.since(time - TRACE).filter(each => each.time <= time).map(each => pixel(each.sides[side]!.tip))
        ink.globalAlpha = 0.35
        stroke(ink, [...trace, tip], colour, 4)
        ink.globalAlpha = 1
        this.normal(ink, tip, closest)
        if (sample.straight) this.straight(ink, tip, pixel(sample.straight))
        const from = sample.reference ? pixel(sample.reference) : closest
        if (far(from, tip) > 12) arrow(ink, from, tip, dark, 2)
        disc(ink, closest, 5.5, all.paper)
        disc(ink, closest, 3.5, dark)
        if (sample.reference) {
            ink.lineWidth = 3
            ink.strokeStyle = dark
            ink.beginPath()
            ink.arc(...(from as [number, number]), 8, 0, 2 * Math.PI)
            ink.stroke()
        }
        disc(ink, tip, 7.5, all.paper)
        disc(ink, tip, 5.5, colour)
        this.boxes = [around(tip, 8), around(closest, 6), around(from, sample.reference ? 10 : 6)]
        this.force(ink, tip, pixel, sample, radius)
        const named: [Pixel, string][] = [[closest, phrase(texts, "lens.closest")]]
        if (sample.reference) named.unshift([from, phrase(texts, "lens.reference")])
        for (const [at, name] of named) this.name(ink, name, at, tip, radius, dark)
        if (sample.straight) this.name(ink, phrase(texts, "lens.straight"), pixel(sample.straight), tip, radius, all.soft)
    }

    /** Show what a symbol means, in the plane in which the lens looks. */
    private light(ink: CanvasRenderingContext2D, sample: SideSample, [right, up]: Plane, pixel: (point: Point) => Point): void {
        const { path } = this.engine
        const flat = (point: Vector): Point => [dot(point, right), dot(point, up)]
        const pushed = sample.tip.map((each, k) => each + FORCE * sample.force[k]! / this.drawn)
        const seen = {
            tip: flat(sample.tip), closest: flat(sample.closest), reference: sample.reference && flat(sample.reference),
            pushed: flat(pushed), outline: (path.lines[0] ?? []).map(flat), closed: path.closed,
            joints: { [this.lit]: this.engine.lit(this.lit, this.side).map(flat) },
        }
        drawShapes(ink, shapesOf(this.lit, seen), pixel, tones().selected)
    }

    /** A name beside a point that is away from the end-point, on the side that the end-point is not on. */
    private name(ink: CanvasRenderingContext2D, text: string, at: Pixel, tip: Pixel, radius: number, colour: string): void {
        if (far(at, tip) <= 34 || radius < SMALL) return
        ink.font = "11px system-ui, sans-serif"
        const aside = ink.measureText(text).width / 2 + 13
        const [x, y] = at
        const [right, down] = [x < tip[0] ? -aside : aside, y > tip[1] ? 18 : -18]
        this.write(ink, text, [[x + right, y], [x - right, y], [x, y + down], [x, y - down]], radius, colour)
    }

    /** Write letters at the first free of some places, moved into the lens and above its bar; `always`: even if none is free. */
    private write(ink: CanvasRenderingContext2D, text: string, tried: Pixel[], radius: number, colour: string, always = false): void {
        const half = ink.measureText(text).width / 2 + 2
        const chord = (away: number) => Math.sqrt(Math.max((radius - RIM) ** 2 - away ** 2, 0))
        const boxes = tried.map(([x, y]): Box => {
            const row = between(y, radius - chord(half) + HALF, barOf(radius) - 5 - HALF)
            const aside = Math.max(chord(Math.abs(row - radius) + HALF) - half, 0)
            const middle = between(x, radius - aside, radius + aside)
            return { left: middle - half, right: middle + half, top: row - HALF, bottom: row + HALF }
        })
        const box = boxes.find(each => !this.boxes.some(other => covers(each, other))) ?? (always ? boxes[0] : undefined)
        if (!box) return
        this.boxes.push(box)
        ink.textAlign = "center"
        ink.textBaseline = "middle"
        letters(ink, text, box.left + half, box.top + HALF, colour, tones().paper)
    }

    /** A broken line along the normal, from the path to the end-point. */
    private normal(ink: CanvasRenderingContext2D, tip: Pixel, closest: Pixel): void {
        const length = far(tip, closest)
        if (length < 3) return
        const [x, y] = [(tip[0] - closest[0]) / length, (tip[1] - closest[1]) / length]
        ink.setLineDash([3, 4])
        stroke(ink, [[closest[0] - 14 * x, closest[1] - 14 * y], tip], tones().soft, 1.5)
        ink.setLineDash([])
    }

    /** Where the tip would be if the link were straight. */
    private straight(ink: CanvasRenderingContext2D, tip: Pixel, at: Pixel): void {
        const { soft, paper } = tones()
        ink.setLineDash([1, 5])
        stroke(ink, [at, tip], soft, 2)
        ink.setLineDash([])
        const [x, y] = at
        ink.fillStyle = paper
        ink.strokeStyle = soft
        ink.lineWidth = 2
        ink.beginPath()
        for (const [dx, dy] of [[0, -6], [6, 0], [0, 6], [-6, 0]] as const) ink.lineTo(x + dx, y + dy)
        ink.closePath()
        ink.fill()
        ink.stroke()
    }

    private force(ink: CanvasRenderingContext2D, tip: Pixel, pixel: (point: Vector) => Pixel, { tip: at, force }: SideSample, radius: number): void {
        const size = Math.hypot(...force)
        if (size < WEAK) return
        const end = pixel(at.map((each, k) => each + force[k]! / size))
        const away = far(end, tip) || 1
        const length = Math.min(Math.max(FORCE * size, 12), LONGEST)
        const [x, y] = [(end[0] - tip[0]) / away, (end[1] - tip[1]) / away]
        const to: Pixel = [tip[0] + x * length, tip[1] + y * length]
        arrow(ink, tip, to, tones().force, 3)
        if (radius < SMALL) return
        ink.font = "600 12px system-ui, sans-serif"
        const text = `${significant(this.texts, Math.max(size, 0.1), size < 1 ? 1 : 2)} N`
        const beside = (from: Pixel, dx: number, dy: number): Pixel => [from[0] + 30 * dx, from[1] + 16 * dy]
        this.boxes.push(around(to, 2))
        this.write(ink, text, [[to[0] + 24 * x, to[1] + 12 * y], beside(to, -y, x), beside(to, y, -x), beside(tip, -x, -y)],
            radius, tones().force, true)
    }

    /** How many times larger than on the stage all is, where there is no room for a bar. */
    private times(ink: CanvasRenderingContext2D, radius: number): void {
        ink.font = "11px system-ui, sans-serif"
        ink.textAlign = "center"
        ink.textBaseline = "middle"
        letters(ink, `×${written(this.texts, this.factor)}`, radius, 2 * radius - RIM - HALF, tones().soft, tones().paper)
    }

    /** A bar of a round number of millimetres. */
    private bar(ink: CanvasRenderingContext2D, radius: number): void {
        const length = niceStep((0.28 * radius) / this.drawn)
        const half = (length * this.drawn) / 2, y = barOf(radius)
        stroke(ink, [[radius - half, y - 4], [radius - half, y], [radius + half, y], [radius + half, y - 4]], tones().ink, 1.5)
        ink.font = "11px system-ui, sans-serif"
        ink.textAlign = "center"
        ink.textBaseline = "middle"
        letters(ink, `${significant(this.texts, 1e3 * length, 2)} mm`, radius, y + 9, tones().ink, tones().paper)
    }
}

/** The plane in which the lens looks: the path's, in two dimensions; in three, that of the path's direction at
 * the closest point and of the end-point, turned as little as possible from the one in which the path is seen. */
function planeOf({ tip, closest }: SideSample, { lines, right, up }: PathShape): Plane {
    if (tip.length < 3) return [right, up]
    const tangent = unit(along(closest, lines))
    const out = unit(cross(right, up))
    const inside = unit(cross(out, tangent))
    const error = tip.map((each, k) => each - closest[k]!)
    const turned = inside.map((each, k) => each * CALM + error[k]! * (dot(error, inside) < 0 ? -1 : 1))
    const normal = unit(cross(tangent, turned))
    if (!normal.every(Number.isFinite)) return [right, up]
    const first = unit(right.map((each, k) => each - dot(right, normal) * normal[k]!))
    return first.every(Number.isFinite) ? [first, cross(normal, first)] : [right, up]
}

/** The direction of the lines' piece that is closest to a point. */
function along(point: Vector, lines: PathShape["lines"]): Vector {
    let best = Infinity, found: Vector = point
    for (const line of lines)
        for (let i = 1; i < line.length; i++) {
            const away = Math.hypot(...line[i]!.map((each, k) => each - point[k]!))
            if (away >= best) continue
            best = away
            found = line[i]!.map((each, k) => each - line[i - 1]![k]!)
        }
    return found
}

/** The middle of points, and the largest distance from it. */
function extent(points: readonly Pixel[]): [Pixel, number] {
    const [xs, ys] = [points.map(each => each[0]), points.map(each => each[1])]
    const middle: Pixel = [(Math.min(...xs) + Math.max(...xs)) / 2, (Math.min(...ys) + Math.max(...ys)) / 2]
    return [middle, Math.max(...points.map(each => far(each, middle)))]
}

/** The height at which a lens has its bar. */
const barOf = (radius: number): number => 2 * radius - Math.max(0.2 * radius, 25)
const around = ([x, y]: Pixel, half: number): Box => ({ left: x - half, right: x + half, top: y - half, bottom: y + half })
const between = (value: number, least: number, most: number): number => Math.min(Math.max(value, least), most)
const far = (a: Pixel, b: Pixel): number => Math.hypot(a[0] - b[0], a[1] - b[1])
const dot = (a: Vector, b: Vector): number => a.reduce((sum, each, k) => sum + each * b[k]!, 0)
const unit = (a: Vector): Vector => a.map(each => each / Math.hypot(...a))
const cross = ([a, b, c]: Vector, [d, e, f]: Vector): Vector => [b! * f! - c! * e!, c! * d! - a! * f!, a! * e! - b! * d!]
