// What a symbol of a lesson's text means, drawn to scale over a robot; see lessons/symbols.py.

import type { Point } from "./figure_data"
import { stroke } from "./ink"

/** What is known of a robot in a picture, [m]; x is to the right, y is up. */
export interface Seen {
    tip: Point
    /** The point of the path that is closest to the end-point. */
    closest: Point
    /** The clock's point; null if the law has no clock. */
    reference: Point | null
    /** The end of the arrow of the force on the end-point. */
    pushed: Point
    /** The path, from θ = −π to π if it is closed. */
    outline: Point[]
    closed: boolean
    /** What symbols of joints mean, if the robot has such a thing: a line, or one point for a joint. */
    joints: Readonly<Record<string, Point[]>>
}

/** The symbols of joints. */
export const AT_JOINTS = ["q_1", "q_2", "delta", "rho"] as const

export interface Shape {
    kind: "line" | "arrow" | "spring" | "damper" | "ring"
    points: Point[]
}

const LONG = 0.03 // [m], length of a unit vector
const PIECE = 0.02 // [m], length of a spring along the path
const ARC = 0.05 // [m], radius of the arc of an angle
const COILS = 7

/** The shapes of a symbol; none if this robot has no such thing. */
export function shapesOf(symbol: string, seen: Seen): Shape[] {
    const { tip, closest, reference, outline, joints } = seen
    const line = (...points: Point[]): Shape[] => [{ kind: "line", points }]
    const arrow = (from: Point, to: Point): Shape[] => [{ kind: "arrow", points: [from, to] }]
    const tied = reference ?? closest // the spring K1 pulls the end-point there
    switch (symbol) {
        case "lambda": case "xi_1": case "d": return line(closest, tip)
        case "theta": return line(...along(seen, closest))
        case "theta_r": return reference ? line(...along(seen, reference)) : []
        case "e": return reference ? arrow(reference, tip) : []
        case "y": return [{ kind: "ring", points: [tip] }]
        case "sigma": return line(...outline)
        case "T": return arrow(closest, moved(closest, tangent(seen), LONG))
        case "N": return arrow(closest, moved(closest, turned(tangent(seen)), LONG))
        case "F": return away(tip, seen.pushed) > 0 ? arrow(tip, seen.pushed) : []
        case "K_1": return [{ kind: "spring", points: [tied, tip] }]
        case "K_2": return [{ kind: "damper", points: [tied, tip] }]
        case "K_4": return reference ? [] : [{ kind: "spring", points: [moved(tip, tangent(seen), PIECE), tip] }]
        case "K_5": return reference ? [] : [{ kind: "damper", points: [moved(tip, tangent(seen), PIECE), tip] }]
    }
    const points = joints[symbol] ?? []
    return points.length ? [{ kind: points.length > 1 ? "line" : "ring", points }] : []
}

/** What the symbols of joints mean on a five-bar. */
export function jointsOfFiveBar(base: Point, elbow: Point, short: Point, tip: Point): Seen["joints"] {
    return {
        q_1: [elbow, base, ...angle(base, 0, direction(base, elbow))],
        q_2: [short, base, ...angle(base, 0, direction(base, short))],
        delta: angle(elbow, direction(elbow, base), direction(elbow, tip)),
        rho: [base, tip],
    }
}

/** Draw shapes in one colour; `pixel` converts from metres. */
export function drawShapes(ink: CanvasRenderingContext2D, shapes: Shape[], pixel: (point: Point) => Point, colour: string): void {
    ink.lineCap = ink.lineJoin = "round"
    for (const { kind, points } of shapes) {
        const at = points.map(pixel)
        if (kind === "ring") trace(ink, circle(at[0]!, 12), colour)
        else if (kind === "line") trace(ink, at.length && size(at) < 3 ? circle(at[0]!, 4) : at, colour)
        else if (kind === "arrow") for (const part of arrowhead(at[0]!, at[1]!)) trace(ink, part, colour)
        else trace(ink, kind === "spring" ? coil(at[0]!, at[1]!) : piston(at[0]!, at[1]!), colour)
    }
}

/** A line with a white rim, so that it is seen on the robot, too. */
function trace(ink: CanvasRenderingContext2D, points: Point[], colour: string): void {
    stroke(ink, points, "#ffffffd0", 8)
    stroke(ink, points, colour, 4)
}

/** The path from θ = 0, or from its beginning if it is open, to a point on it. */
function along({ outline, closed }: Seen, to: Point): Point[] {
    if (!outline.length) return []
    const from = closed ? (outline.length - 1) / 2 : 0
    const [before, after] = [outline[Math.floor(from)]!, outline[Math.ceil(from)]!]
    const until = nearest(outline, to)
    const part = outline.filter((_, i) => (i - from) * (i - until) < 0)
    return [beside(before, after, 0.5, 0), ...(until < from ? part.reverse() : part), to]
}

/** The direction of the path at the closest point, in which θ grows. */
function tangent({ outline, closest }: Seen): Point {
    const at = nearest(outline, closest)
    const [before, after] = [outline[Math.max(at - 1, 0)]!, outline[Math.min(at + 1, outline.length - 1)]!]
    const length = away(before, after) || 1
    return [(after[0] - before[0]) / length, (after[1] - before[1]) / length]
}

function nearest(outline: Point[], to: Point): number {
    return outline.reduce((best, point, i) => (away(point, to) < away(outline[best]!, to) ? i : best), 0)
}

function angle(at: Point, from: number, until: number): Point[] {
    const whole = ((until - from) % (2 * Math.PI) + 2 * Math.PI) % (2 * Math.PI)
    const turn = from !== 0 && whole > Math.PI ? whole - 2 * Math.PI : whole // the smaller one of a triangle
    return Array.from({ length: 33 }, (_, i) => {
        const now = from + (turn * i) / 32
        return [at[0] + ARC * Math.cos(now), at[1] + ARC * Math.sin(now)]
    })
}

function arrowhead(from: Point, to: Point): Point[][] {
    const [x, y] = [to[0] - from[0], to[1] - from[1]]
    const length = Math.hypot(x, y)
    if (length < 3) return [circle(to, 4)]
    const head = Math.min(12, length / 2) / length
    const barb = (side: number): Point => [to[0] - head * (x + side * y / 2), to[1] - head * (y - side * x / 2)]
    return [[from, to], [barb(1), to, barb(-1)]]
}

function coil(from: Point, to: Point): Point[] {
    return Array.from({ length: 2 * COILS + 3 }, (_, i): Point => {
        const inside = i > 0 && i < 2 * COILS + 2
        return beside(from, to, i / (2 * COILS + 2), inside ? (i % 2 ? 6 : -6) : 0)
    })
}

function piston(from: Point, to: Point): Point[] {
    const at = (share: number, by: number) => beside(from, to, share, by)
    return [at(0, 0), at(0.6, 0), at(0.6, 5), at(0.6, -5), at(0.6, 0), at(0.35, 0), at(0.35, 8), at(0.75, 8), at(0.75, -8),
        at(0.35, -8), at(0.75, -8), at(0.75, 0), at(1, 0)]
}

/** A point between two others, a number of pixels beside their line. */
function beside(from: Point, to: Point, share: number, by: number): Point {
    const [x, y] = [to[0] - from[0], to[1] - from[1]]
    const length = Math.hypot(x, y) || 1
    return [from[0] + share * x - (by * y) / length, from[1] + share * y + (by * x) / length]
}

function circle([x, y]: Point, radius: number): Point[] {
    return Array.from({ length: 25 }, (_, i) => [x + radius * Math.cos((i * Math.PI) / 12), y + radius * Math.sin((i * Math.PI) / 12)])
}

const away = (a: Point, b: Point): number => Math.hypot(a[0] - b[0], a[1] - b[1])
const size = (points: Point[]): number => Math.max(...points.map(point => away(point, points[0]!)))
const direction = (from: Point, to: Point): number => Math.atan2(to[1] - from[1], to[0] - from[0])
const moved = (from: Point, step: Point, by: number): Point => [from[0] + by * step[0], from[1] + by * step[1]]
const turned = ([x, y]: Point): Point => [-y, x]
