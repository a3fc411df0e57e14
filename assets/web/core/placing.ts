// Where something is over the robots' picture.

import type { Vector } from "./engine"
import type { Point } from "./figure_data"

/** A robot's part of the picture, [px]. */
export interface Share {
    readonly left: number
    readonly width: number
    /** Of the robot, from the left of its part. */
    readonly middle: number
}

/** Share the picture among robots: each gets what is nearer to it than to its neighbours.
 * @param middles of the robots, [px]; the camera may show them in any order, or not at all
 * @param width of the picture, [px] */
export function shares(middles: readonly number[], width: number): Share[] {
    const order = middles.map((_, i) => i).sort((a, b) => middles[a]! - middles[b]!)
    const borders = [0, ...order.slice(1).map((each, i) => within((middles[order[i]!]! + middles[each]!) / 2, 0, width)), width]
    return middles.map((middle, i) => {
        const at = order.indexOf(i), left = borders[at]!, right = borders[at + 1]!
        return { left, width: right - left, middle: within(middle, left, right) - left }
    })
}

/** Where a camera shows a point: to the right and down from the middle, as shares of the picture's height. */
export function projected(camera: readonly (readonly number[])[], point: Vector): Point {
    const [across, down, depth] = camera.map(row => point.reduce((sum, each, k) => sum + row[k]! * each, row[point.length]!))
    return [across! / depth!, down! / depth!]
}

function within(value: number, low: number, high: number): number {
    return Math.min(Math.max(value, low), high)
}
