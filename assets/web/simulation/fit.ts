// The curve through control points, as `closed_through` and `open_through` of models/paths/curve_fit.py: a cubic spline through
// them is resampled at equal arc length; a matrix of Python's makes a series of the samples' products with its basis.

import type { FitNumbers, Point } from "../core/figure_data"

/** A piece of a spline: the knot where it begins, and the coefficients of the powers of what is beyond it. */
interface Piece {
    knot: number
    powers: readonly [Point, Point, Point, Point]
}

/** Sums over the samples of 1, C_1 … C_K, S_1 … S_K, each times a sample; or why there is no curve. */
export function products(points: readonly Point[], closed: boolean, numbers: FitNumbers): number[] | "standalone.coincide" | "error.path_too_short" {
    const { samples, harmonics, closest, shortest } = numbers
    const ends = distance(points[0]!, points[points.length - 1]!)
    if (Math.min(ends, ...gaps(points)) <= closest) return "standalone.coincide"
    if (lengthOf(points) < shortest) return "error.path_too_short"
    const sums = Array.from({ length: 2 * (2 * harmonics + 1) }, () => 0)
    const [pieces, total] = splineThrough(closed ? [...points, points[0]!] : points, closed)
    evenly(pieces, total, closed, numbers).forEach((point, n) => basis((2 * n / (closed ? samples : samples - 1) - 1) * Math.PI, closed, harmonics)
        .forEach((each, k) => point.forEach((z, i) => (sums[2 * k + i]! += each * z))))
    return sums
}

/** The sum of the distances of neighbours, [m]. */
export const lengthOf = (points: readonly Point[]): number => gaps(points).reduce((sum, each) => sum + each, 0)
/** A spline with centripetal knots, periodic or straight at its ends: its pieces, and its last knot. */
function splineThrough(points: readonly Point[], closed: boolean): [Piece[], number] {
    const widths = gaps(points).map(Math.sqrt)
    const slopes = widths.map((width, i) => both(k => (points[i + 1]![k] - points[i]![k]) / width))
    const bends = bendsOf(widths, slopes, closed)
    let knot = 0
    const pieces = widths.map((width, i): Piece => {
        const [m, next] = [bends[i]!, bends[i + 1]!]
        const piece: Piece = {
            knot,
            powers: [
                points[i]!, both(k => slopes[i]![k] - width * (2 * m[k] + next[k]) / 6), both(k => m[k] / 2),
                both(k => (next[k] - m[k]) / (6 * width)),
            ],
        }
        knot += width
        return piece
    })
    return [pieces, knot]
}

/** Second derivatives M_i at the knots: w_(i-1) M_(i-1) + 2 (w_(i-1) + w_i) M_i + w_i M_(i+1) = 6 (d_i - d_(i-1)). */
function bendsOf(widths: readonly number[], slopes: readonly Point[], closed: boolean): Point[] {
    const n = widths.length, size = closed ? n : n + 1
    const rows = Array.from({ length: size }, (_, i) => {
        const row = Array.from({ length: size + 2 }, () => 0)
        if (!closed && (i === 0 || i === n)) row[i] = 1
        else {
            const before = (i + n - 1) % n
            row[(i + size - 1) % size]! += widths[before]!
            row[i]! += 2 * (widths[before]! + widths[i]!)
            row[(i + 1) % size]! += widths[i]!
            for (const k of [0, 1] as const) row[size + k] = 6 * (slopes[i]![k] - slopes[before]![k])
        }
        return row
    })
    const found = solved(rows)
    return closed ? [...found, found[0]!] : found
}

/** The solution of a system whose diagonal is dominant, with two right sides, by elimination. */
function solved(rows: number[][]): Point[] {
    const n = rows.length
    rows.forEach((pivot, i) => rows.forEach((row, j) => {
        const factor = row[i]! / pivot[i]!
        if (i !== j && factor) for (let k = i; k < row.length; k++) row[k]! -= factor * pivot[k]!
    }))
    return rows.map((row, i) => [row[n]! / row[i]!, row[n + 1]! / row[i]!])
}

/** Points of a spline at equal arc length, that of many straight lines. */
function evenly(pieces: readonly Piece[], total: number, closed: boolean, { samples, fine }: FitNumbers): Point[] {
    const step = total / fine
    const knots = Array.from({ length: fine + 1 }, (_, i) => (i < fine ? i * step : total))
    const steps = gaps(knots.map(pointsOf(pieces))), whole = steps.reduce((sum, each) => sum + each, 0)
    const at = pointsOf(pieces), found: Point[] = []
    let length = 0
    steps.forEach((each, i) => {
        const after = i + 1 < fine ? length + each : Infinity
        for (let wanted; found.length < samples && (wanted = found.length * whole / (closed ? samples : samples - 1)) < after; )
            found.push(at(knots[i]! + Math.min((wanted - length) / each, 1) * step))
        length += each
    })
    return found
}

/** A function of knots that increase. */
function pointsOf(pieces: readonly Piece[]): (knot: number) => Point {
    let i = 0
    return knot => {
        while (i + 1 < pieces.length && knot >= pieces[i + 1]!.knot) i++
        const { knot: begin, powers } = pieces[i]!, u = knot - begin
        return both(k => powers[0][k] + u * (powers[1][k] + u * (powers[2][k] + u * powers[3][k])))
    }
}

function basis(theta: number, closed: boolean, harmonics: number): number[] {
    const angle = closed ? theta : Math.acos(Math.min(Math.max(theta / Math.PI, -1), 1))
    const orders = Array.from({ length: harmonics }, (_, k) => (k + 1) * angle)
    return [1, ...orders.map(Math.cos), ...orders.map(closed ? Math.sin : () => 0)]
}

const both = (of: (k: 0 | 1) => number): Point => [of(0), of(1)]
const distance = (a: Point, b: Point): number => Math.hypot(a[0] - b[0], a[1] - b[1])
const gaps = (points: readonly Point[]): number[] => points.slice(1).map((point, i) => distance(points[i]!, point))
