// A path, and its control points while readers drag them: an edit goes as far as possible, and shows
// where the path would be refused, as in app/lab/path_editor.py.

import type { PathShape, Vector } from "../core/engine"
import type { FigureData, PathData, Point } from "../core/figure_data"
import { lengthOf, products } from "./fit"
import type { Kernels } from "./kernels"

const [LINE, OUTLINE] = [600, 240] // pieces of a line through points of a series, and of its outline
const ORDERS = 4 // the curve and its derivatives
const MOST_VALUES = 12 // of a curve in space
const NEAR = 1.5 // pieces by which the closest point of a drawing may be away from where it was expected
const BLOCK = 16 // segments of a drawing that have a box in common
const WORK = 64 // numbers of work that functions share

/** Why a curve cannot be followed: keys of messages, and places in the picture; and its length if
 * it is too short, [mm]. Without places, there is no such curve. */
export interface Fault {
    reasons: string[]
    marks: Point[]
    length?: number
}

/** Points of a stroke of a drawing, or of a link between two, along which the pen is up. */
interface Part<Of> {
    points: Of[]
    raised: boolean
}

export class Path {
    private readonly edit = this.figure.edit
    private readonly flat = this.data.points.flat()
    private readonly pieces = this.kernels.put([this.data.pieces])
    private readonly intervals = this.data.pieces ? this.data.samples : OUTLINE
    /** The curve that is followed. */
    readonly table = this.kernels.put(this.data.table)
    outline: number[] = []
    edited = false
    /** Why the last edit went no further. */
    fault: Fault | null = null
    /** What is ambiguous about the path that is kept: keys of messages. */
    doubts = this.data.doubts
    private progress = 1
    private known: { parts?: Part<Point>[]; steepest?: number; turning?: number } = {}
    /** Control points and curve before an edit, as shown, and as tried. */
    private readonly kept = [this.kernels.put(this.flat), this.kernels.put(this.data.table)] as const
    private readonly shown = [this.kernels.put(this.flat), this.kernels.put(this.data.table)] as const
    private readonly tried = [this.kernels.put(this.flat), this.kernels.put(this.data.table)] as const
    private readonly before = this.kernels.put(this.data.table)
    private readonly work = this.kernels.room(WORK)
    private readonly values = this.kernels.room(MOST_VALUES)
    private readonly state = this.kernels.room(ORDERS + this.figure.sizes.p)
    /** Points from which the search for the closest one begins, and their distance in θ. */
    private readonly grid = this.kernels.room(this.data.grid * this.figure.sizes.p)
    private readonly span = this.kernels.put([2 * Math.PI / (this.data.closed ? this.data.grid : this.data.grid - 1)])
    readonly begin = this.kernels.put([this.data.begin])
    private readonly rows = this.kernels.room(
        Math.max(
            this.edit.row * (this.data.samples + 1),
            ORDERS * this.data.dimension * (Math.max(this.intervals, LINE) + 1),
        ),
    )

    constructor(readonly data: PathData, private readonly figure: FigureData, private readonly kernels: Kernels) {
        this.refresh()
    }

    /** Places of the control points in the picture. */
    readonly spots = (): Point[] => this.data.points.map((_, i) => this.spot(this.shown[0] + 2 * i))
    /** Lines of the followed curve, in the space of the end-points. */
    shape(): Pick<PathShape, "lines" | "strokes" | "links"> {
        const { kernels, work, data, figure: { sizes } } = this, count = Math.max(this.intervals, LINE)
        const seen = (place: number): Vector => {
            this.call("at", place, work)
            return [...kernels.numbers.subarray(work, work + sizes.p)]
        }
        const lines = [this.along(-Math.PI, Math.PI, count, seen)]
        if (!data.raised.length) return { lines }
        const parts = [...this.split(count, seen)]
        const of = (raised: boolean) => parts.filter(each => each.raised === raised).map(each => each.points)
        return { lines, strokes: of(false), links: of(true) }
    }

    /** The strokes of the followed curve and the links between them, in the picture. */
    get parts(): Part<Point>[] {
        return (this.known.parts ??= [...this.split(this.intervals, place => this.seen(place))])
    }

    /** The point in the picture at a distance to the left of the followed curve, [m]. */
    beside(theta: number, across: number): Point {
        const { work, kernels } = this, values = this.valuesAt(theta)
        kernels.numbers[work] = across
        this.call("beside", values, work, work + 1)
        return kernels.pair(work + 1)
    }

    /** The place of the curve and its derivatives at θ. */
    valuesAt(theta: number): number {
        this.kernels.numbers.set([0, theta, 0, theta], this.state)
        this.scan("curve", this.state, this.table, this.values, 1)
        return this.values
    }

    /** Put the point at θ, in the space of the end-points, somewhere. */
    readonly at = (theta: number, into: number) => this.call("at", this.valuesAt(theta), into)
    /** Put the distance of an end-point, and the closest point, somewhere.
     *
     * On a series it is that of all points. On a drawing it is that near the point at which the robot's law aims or, if the
     * robot is far from it, of all points. */
    nearest(y: number, theta: number, aim: number, into: number): void {
        const { kernels: { numbers }, state, work, data, span, figure: { sizes: { p } }, edit: { refinements } } = this
        const size = 1 + p
        numbers[into] = Infinity
        const take = (found: number) => {
            if (numbers[found]! < numbers[into]!) numbers.copyWithin(into, found, found + size)
        }
        const improve = () => {
            this.scan("nearest", state, this.table, this.rows, refinements + 1)
            take(this.rows + refinements * size)
        }
        numbers[state] = data.pieces ? aim : theta
        numbers.copyWithin(state + 1, y, y + p)
        improve()
        if (data.pieces && Math.abs(numbers[state] - aim) < NEAR * 2 * Math.PI / data.pieces) return
        numbers.set([0, Infinity], state + size)
        this.loop("lowest", state, span, this.grid, data.grid)
        improve()
        if (data.closed) return
        for (const end of [-1, 1]) {
            const values = this.valuesAt(end * Math.PI)
            numbers[work] = end
            this.call("beyond", values, work, y, work + 1)
            take(work + 1)
        }
    }

    /** Whether the pen is down at θ. */
    draws(theta: number): boolean {
        const { closed, raised } = this.data
        const inner = closed ? theta - 2 * Math.PI * Math.floor(theta / (2 * Math.PI) + 0.5) : theta
        return !raised.some(([begin, end]) => begin < inner && inner < end)
    }

    /** The largest turn of the tangent for a radian of θ, along a drawing that has been edited. */
    get turning(): number {
        return (this.known.turning ??= this.mostTurning())
    }

    /** The largest |σ'| where the pen is down, [m/rad]. */
    get steepest(): number {
        const { kernels, data: { dimension } } = this
        const slope = (values: number) => Math.hypot(...kernels.numbers.subarray(values + dimension, values + 2 * dimension))
        const drawn = () => [...this.split(this.intervals, slope)].filter(each => !each.raised)
        return (this.known.steepest ??= Math.max(...drawn().flatMap(each => each.points)))
    }

    /** Move a point by a vector in the picture, from where it was before the edit. */
    drag(index: number, by: Point): void {
        const { work } = this
        this.kernels.numbers.set([0, 0, ...by], work)
        this.call("planar", this.kept[0] + 2 * index, work, work + 2, work + 4)
        this.move(index, this.kernels.pair(work + 4))
    }

    /** Move a point in the plane of the path, [m], and keep it there; returns whether it has moved. */
    shift(index: number, right: number, up: number): boolean {
        const [x, y] = this.kernels.pair(this.kept[0] + 2 * index)
        this.move(index, [x + right, y + up])
        return this.finish()
    }

    /** Move a point towards a target, [m]; if that is refused, find by bisection how far it may go. */
    move(index: number, target: Point): void {
        this.fault = this.refusal(index, target, 1)
        if (this.fault && !this.fault.marks.length) return
        this.take(this.fault ? this.kept : this.tried)
        for (let i = 1, reached = 0; i <= this.edit.halvings && this.fault; i++) {
            const refusal = this.refusal(index, target, reached + 0.5 ** i)
            if (refusal?.marks.length) this.fault = refusal
            if (refusal) continue
            reached += 0.5 ** i
            this.take(this.tried)
        }
        this.kernels.copy(this.table, this.before, this.data.table.length)
        this.progress = 0
        this.edited = true
    }

    /** Keep the result of an edit; returns whether it is new. */
    finish(): boolean {
        const { numbers } = this.kernels, [kept, shown] = [this.kept[0], this.shown[0]]
        const isNew = this.flat.some((_, i) => numbers[kept + i] !== numbers[shown + i])
        this.take(this.shown, this.kept)
        if (this.edited) this.doubts = this.ambiguities()
        return isNew
    }

    /** Move the followed curve towards the shown one; returns whether it moves. */
    advance(seconds: number): boolean {
        if (this.progress >= 1) return false
        const { kernels: { numbers }, table, before, shown, edit } = this
        this.progress += seconds / edit.blend
        const share = this.progress
        if (share >= 1) this.kernels.copy(shown[1], table, this.data.table.length)
        else for (let i = 0; i < this.data.table.length; i++) numbers[table + i] = (1 - share) * numbers[before + i]! + share * numbers[shown[1] + i]!
        this.refresh()
        return true
    }

    /** As before all edits. */
    restore(): void {
        const { numbers } = this.kernels
        for (const [points, table] of [this.kept, this.shown, this.tried]) {
            numbers.set(this.flat, points)
            numbers.set(this.data.table, table)
        }
        numbers.set(this.data.table, this.table)
        Object.assign(this, { doubts: this.data.doubts, edited: false, fault: null, progress: 1 })
        this.refresh()
    }

    /** The length of the kept curve, [m]. */
    length(): number {
        return this.kernels.numbers[this.checked(this.kept[1]) + this.edit.row * this.data.samples + 2]!
    }

    /** Follow the shown curve at once. */
    settle(): void {
        this.finish()
        this.fault = null
        this.advance(this.edit.blend)
    }

    /** Compute what depends on the followed curve. */
    private refresh(): void {
        const { kernels, work, data, grid, figure: { sizes: { p } } } = this
        this.known = {}
        this.outline = this.along(-Math.PI, Math.PI, this.intervals, place => this.seen(place)).flat()
        let into = grid
        this.along(-Math.PI, Math.PI * (data.closed ? 1 - 2 / data.grid : 1), data.grid - 1, place => {
            this.call("at", place, work)
            kernels.copy(work, into, p)
            into += p
        })
    }

    /** What a function gives for the curve and its derivatives at even steps, both ends included. */
    private along<Of>(begin: number, end: number, intervals: number, of: (place: number) => Of): Of[] {
        const { kernels, state, rows, data } = this
        kernels.numbers.set([0, begin, (end - begin) / intervals, end], state)
        this.scan("curve", state, this.table, rows, intervals + 1)
        return Array.from({ length: intervals + 1 }, (_, i) => of(rows + i * ORDERS * data.dimension))
    }

    /** The parts of the curve, with as many intervals for all of it. */
    private *split<Of>(intervals: number, of: (place: number) => Of): Iterable<Part<Of>> {
        const edges = [-Math.PI, ...this.data.raised.flat(), Math.PI]
        for (let i = 0; i + 1 < edges.length; i++) {
            const [from, to] = [edges[i]!, edges[i + 1]!]
            const count = Math.max(Math.ceil(((to - from) / (2 * Math.PI)) * intervals), 1)
            if (to > from) yield { points: this.along(from, to, count, of), raised: i % 2 === 1 }
        }
    }

    private mostTurning(): number {
        const { state, kernels, data, edit } = this
        kernels.numbers.set([0, 0], state)
        this.scan("turning", state, this.table, this.work, edit.turns * data.pieces)
        return kernels.numbers[state + 1]!
    }

    /** Try a share of the move to a target. */
    private refusal(index: number, target: Point, share: number): Fault | null {
        const { kept, tried, work } = this
        this.take(kept, tried)
        this.kernels.numbers.set([...target, share], work)
        this.call("toward", kept[0] + 2 * index, work, work + 2, tried[0] + 2 * index)
        return (this.data.pieces ? this.bend(index) : this.fit()) ?? this.check()
    }

    /** Bend the tried drawing at a control point, as in models/paths/drawing_design.py. */
    private bend(index: number): null {
        const { kernels: { numbers }, kept, tried, state, values, edit: { grain }, data: { handles } } = this
        const by = [0, 1].map(k => numbers[tried[0] + 2 * index + k]! - numbers[kept[0] + 2 * index + k]!)
        handles[index]!.weights.forEach((weight, j) => by.forEach((each, k) => {
            const at = 2 * j + k
            numbers[tried[1] + at] = grain * Math.round((numbers[kept[1] + at]! + weight * each) / grain) + 0 // no -0
        }))
        handles.forEach(({ theta }, i) => {
            numbers.set([0, theta, 0, theta], state)
            this.scan("curve", state, tried[1], values, 1)
            this.kernels.copy(values, tried[0] + 2 * i, 2)
        })
        return null
    }

    /** Fit a series to the tried points. */
    private fit(): Fault | null {
        const { kernels, work, figure, tried, data } = this
        const points = data.points.map((_, i) => kernels.pair(tried[0] + 2 * i))
        const found = products(points, data.closed, figure.fit)
        if (typeof found === "string") return { reasons: [found], marks: [], length: 1e3 * lengthOf(points) }
        kernels.numbers.set(found, work)
        this.call("table", work, tried[1])
        return null
    }

    /** Whether a robot could follow the tried curve. */
    private check(): Fault | null {
        const { edit: { row }, data: { samples, checks }, kernels: { numbers } } = this
        const fault: Fault = { reasons: [], marks: [] }
        const rows = this.checked(this.tried[1])
        checks.forEach((name, k) => {
            const bad = Array.from({ length: samples }, (_, i) => rows + row * i)
                .filter((each, i) => numbers[each + 3 + k] && (name !== "bends_sharply" || this.draws(this.sampled(i))))
            if (!bad.length) return
            fault.marks.push(...bad.map(place => this.spot(place)))
            fault.reasons.push(`fault.${name}`)
        })
        return fault.reasons.length ? fault : null
    }

    /** Rows of checks of a curve; the last one is that of its end. */
    private checked(table: number): number {
        const { work, rows, data } = this
        this.kernels.numbers.fill(0, work, work + 4)
        this.scan("check", work, table, rows, data.samples + 1)
        return rows
    }

    private readonly sampled = (i: number): number => (2 * i / (this.data.samples - (this.data.closed ? 0 : 1)) - 1) * Math.PI
    /** Whether strands of the kept curve cross or are too close to each other. */
    private ambiguities(): string[] {
        const { work, rows, edit: { row }, data: { samples, pieces }, kernels: { numbers } } = this
        const length = this.length()
        if (pieces) return this.meets() ? ["fault.crosses"] : []
        let [near, crosses] = [false, false]
        for (let i = 0, next = rows + row; i < samples - 1; i++, next += row) {
            numbers.set([0, 0, 0, 0, length], work)
            this.loop("strands", work, next - row, next, samples - 1 - i)
            if (numbers[work]) near = true
            if (numbers[work + 1]) crosses = true
        }
        return crosses ? ["fault.crosses"] : near ? ["fault.narrow"] : []
    }

    /** Whether a drawing crosses itself, from the rows of its checks: each segment is compared with those blocks whose boxes it meets. */
    private meets(): boolean {
        const { work, rows, edit: { row }, data: { samples, closed }, kernels: { numbers } } = this
        for (let i = 0; i < samples; i++) numbers[rows + row * i + row - 1] = this.draws(this.sampled(i)) ? 1 : 0
        const segments = samples - (closed ? 0 : 1)
        const box = (from: number, to: number) => [0, 1].map(k => {
            const along = Array.from({ length: to - from + 1 }, (_, i) => numbers[rows + row * (from + i) + k]!)
            return [Math.min(...along), Math.max(...along)] as const
        })
        const blocks = Array.from({ length: Math.ceil(segments / BLOCK) }, (_, k) => box(k * BLOCK, Math.min((k + 1) * BLOCK, segments)))
        for (let i = 0; i < segments; i++) {
            const own = box(i, i + 1), end = closed && !i ? segments - 1 : segments // neighbours share a point
            for (let k = Math.floor((i + 2) / BLOCK); k < blocks.length; k++) {
                if (own.some(([low, high], axis) => low > blocks[k]![axis]![1] || high < blocks[k]![axis]![0])) continue
                const first = Math.max(k * BLOCK, i + 2), count = Math.min((k + 1) * BLOCK, end) - first
                numbers.set([0, 0], work)
                if (count > 0) this.loop("strands", work, rows + row * i, rows + row * first, count)
                if (numbers[work + 1]) return true
            }
        }
        return false
    }

    private take(from: readonly [number, number], to = this.shown): void {
        this.kernels.copy(from[0], to[0], this.flat.length)
        this.kernels.copy(from[1], to[1], this.data.table.length)
    }

    private spot(place: number): Point {
        this.call("spot", place, this.work + 8)
        return this.kernels.pair(this.work + 8)
    }

    /** The point in the picture of the curve whose values are somewhere. */
    private seen(values: number): Point {
        const { work, figure: { sizes: { p } } } = this
        this.call("at", values, work)
        this.call("place", work, work + p)
        return this.kernels.pair(work + p)
    }

    private readonly call = (name: string, ...addresses: number[]) =>
        this.kernels.call(`${name}.${this.data.kind}`, ...addresses)
    /** A scan along a curve, of which it takes what a step needs. */
    private readonly scan = (name: string, state: number, table: number, results: number, count: number) =>
        this.kernels.loop(`${name}.${this.data.kind}`, [state, this.pieces, table, results], count)
    /** A scan along rows, in which its results are. */
    private readonly loop = (name: string, state: number, constants: number, rows: number, count: number) =>
        this.kernels.loop(`${name}.${this.data.kind}`, [state, constants, rows, rows], count)
}
