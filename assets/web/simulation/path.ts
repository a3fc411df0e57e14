// A path, and its control points while readers drag them: an edit goes as far as possible, and shows
// where the path would be refused, as in app/lab/path_editor.py.

import type { Vector } from "../core/engine"
import type { FigureData, PathData, Point } from "../core/figure_data"
import type { Kernels } from "./kernels"

const LINE = 600 // pieces of a line through points of the path
const ARC = 3 // numbers of a row of arc length

/** Why a curve cannot be followed: keys of messages, and places in the picture; and its length if
 * it is too short, [mm]. Without places, there is no such curve. */
export interface Fault {
    reasons: string[]
    marks: Point[]
    length?: number
}

export class Path {
    private readonly edit = this.figure.edit
    private readonly flat = this.data.points.flat()
    /** The curve that is followed, points on it, and its outline. */
    readonly table = this.kernels.put(this.data.table)
    readonly grid = this.kernels.put(this.data.grid)
    outline = this.data.outline
    edited = false
    /** Why the last edit went no further. */
    fault: Fault | null = null
    /** What is ambiguous about the path that is kept: keys of messages. */
    doubts = this.data.doubts
    private progress = 1
    /** Control points and curve before an edit, as shown, and as tried. */
    private readonly kept = [this.kernels.put(this.flat), this.kernels.put(this.data.table)] as const
    private readonly shown = [this.kernels.put(this.flat), this.kernels.put(this.data.table)] as const
    private readonly tried = [this.kernels.put(this.flat), this.kernels.put(this.data.table)] as const
    private readonly before = this.kernels.put(this.data.table)
    private readonly work = this.kernels.room(this.edit.piece * (this.flat.length + 4) + this.edit.sums)
    private readonly rows = this.kernels.room(this.flat.length && ARC * this.edit.fine)

    constructor(readonly data: PathData, private readonly figure: FigureData, private readonly kernels: Kernels) {}

    /** Places of the control points in the picture. */
    readonly spots = (): Point[] => this.data.points.map((_, i) => this.spot(this.shown[0] + 2 * i))
    /** Points of the followed curve, in the space of the end-points. */
    line(): Vector[] {
        const { work, kernels, figure } = this
        const end = work + 1
        return Array.from({ length: LINE + 1 }, (_, i) => {
            kernels.numbers[work] = (2 * i / LINE - 1) * Math.PI
            this.call("at", this.table, work, end)
            return [...kernels.numbers.subarray(end, end + figure.sizes.p)]
        })
    }

    /** The point in the picture at a distance to the left of the followed curve, [m]. */
    beside(theta: number, across: number): Point {
        const { work, kernels } = this
        kernels.numbers.set([theta, across], work)
        this.call("beside", this.table, work, work + 1, work + 2)
        return kernels.pair(work + 2)
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
        const { work, kernels, table, edit, rows } = this
        this.progress += seconds / edit.blend
        kernels.numbers[work] = this.progress
        if (this.progress < 1) this.call("mix", this.before, this.shown[1], work, table)
        else kernels.copy(this.shown[1], table, this.data.table.length)
        kernels.numbers[work] = 0
        this.scan("grid", work, table, this.grid, edit.grid)
        kernels.numbers[work] = 0
        this.scan("outline", work, table, rows, edit.outline)
        this.outline = [...kernels.numbers.subarray(rows, rows + this.outline.length)]
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
        numbers.set(this.data.grid, this.grid)
        Object.assign(this, { outline: this.data.outline, doubts: this.data.doubts, edited: false, fault: null, progress: 1 })
    }

    /** The length of the kept curve, [m]. */
    length(): number {
        const { work, rows, edit, kernels } = this
        kernels.numbers.fill(0, work, work + 4)
        this.scan("check", work, this.kept[1], rows, edit.samples + 1)
        return kernels.numbers[rows + edit.row * edit.samples + 2]!
    }

    /** Follow the shown curve at once. */
    settle(): void {
        this.finish()
        this.fault = null
        this.advance(this.edit.blend)
    }

    /** Try a share of the move to a target. */
    private refusal(index: number, target: Point, share: number): Fault | null {
        const { kept, tried, work } = this
        this.take(kept, tried)
        this.kernels.numbers.set([...target, share], work)
        this.call("toward", kept[0] + 2 * index, work, work + 2, tried[0] + 2 * index)
        return this.fit() ?? this.check()
    }

    /** Fit a curve to the tried points. */
    private fit(): Fault | null {
        const { kernels, work, edit, data } = this
        const { numbers } = kernels
        const arc = work + edit.piece * (data.points.length + (data.closed ? 1 : 0))
        const sums = arc + 5
        kernels.call(`spline.${data.fit}`, this.tried[0], work, arc, sums)
        const reason = [null, "standalone.coincide", "error.path_too_short"][numbers[sums]!]
        if (reason) return { reasons: [reason], marks: [], length: numbers[sums + 1]! }
        this.along("arc", arc, arc)
        numbers.fill(0, sums, sums + edit.sums)
        numbers.set([0, numbers[arc + 1]!, numbers[arc + 4]!], sums)
        this.along(`resample.${data.kind}`, sums, arc)
        this.call("table", sums, this.tried[1])
        return null
    }

    /** A scan along the pieces of a spline, whose last one only ends the others. */
    private along(name: string, state: number, end: number): void {
        const { work, edit, kernels } = this
        for (let place = work, row = this.rows; place < end - edit.piece; place += edit.piece) {
            const count = kernels.numbers[place + 1]!
            if (count) kernels.loop(name, [state, place, row, row], count)
            row += ARC * count
        }
    }

    /** Whether a robot could follow the tried curve. */
    private check(): Fault | null {
        const { work, rows, edit } = this
        const { numbers } = this.kernels
        const { row, samples } = edit
        const fault: Fault = { reasons: [], marks: [] }
        numbers.fill(0, work, work + 4)
        this.scan("check", work, this.tried[1], rows, samples + 1)
        edit.checks.forEach((name, k) => {
            const bad = Array.from({ length: samples }, (_, i) => rows + row * i).filter(each => numbers[each + 3 + k])
            if (!bad.length) return
            fault.marks.push(...bad.map(place => this.spot(place)))
            fault.reasons.push(`fault.${name}`)
        })
        return fault.reasons.length ? fault : null
    }

    /** Whether strands of the kept curve cross or are too close to each other. */
    private ambiguities(): string[] {
        const { work, rows, edit } = this
        const { numbers } = this.kernels
        const { row, samples } = edit
        let [near, crosses] = [false, false]
        const length = this.length()
        for (let i = 0, next = rows + row; i < samples - 1; i++, next += row) {
            numbers.set([0, 0, 0, 0, length], work)
            this.scan("strands", work, next - row, next, samples - 1 - i)
            if (numbers[work]) near = true
            if (numbers[work + 1]) crosses = true
        }
        return crosses ? ["fault.crosses"] : near ? ["fault.narrow"] : []
    }

    private take(from: readonly [number, number], to = this.shown): void {
        this.kernels.copy(from[0], to[0], this.flat.length)
        this.kernels.copy(from[1], to[1], this.data.table.length)
    }

    private spot(place: number): Point {
        this.call("spot", place, this.work + 8)
        return this.kernels.pair(this.work + 8)
    }

    private readonly call = (name: string, ...places: number[]) =>
        this.kernels.call(`${name}.${this.data.kind}`, ...places)
    private readonly scan = (name: string, state: number, constants: number, rows: number, count: number) =>
        this.kernels.loop(`${name}.${this.data.kind}`, [state, constants, rows, rows], count)
}
