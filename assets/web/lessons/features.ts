// What can be seen in a curve: whether it has what the author of a prediction names.

import type { SketchData, SketchFeature } from "../core/lesson_data"

const HEIGHT = 0.1 // least height of a peak over the valleys on both sides, as a share of the axis

export interface Curve { times: number[]; values: number[] }

/** Whether a curve has all that a feature names; as `has` in lessons/measures/shapes.py. */
export function has({ top, bottom }: Pick<SketchData, "top" | "bottom">, feature: SketchFeature, { times, values }: Curve): boolean {
    const { peaks, highest, lowest, at, level } = feature
    const count = peaksOf(values, HEIGHT * (top - bottom))
    const then = (time: number) => valueAt(times, values, time)
    const within = (value: number, [low, high]: [number, number]) => low <= value && value <= high
    return (!peaks || within(count, peaks))
        && (!highest || within(Math.max(...values), highest))
        && (!lowest || within(Math.min(...values), lowest))
        && at.every(([time, low, high]) => within(then(time), [low, high]))
        && level.every(([start, end, low, high]) => [start, ...times.filter(time => start < time && time < end), end]
            .every(time => within(then(time), [low, high])))
}

/** Number of peaks that rise from a valley and fall to one by at least `height`. */
function peaksOf(values: number[], height: number): number {
    let count = 0, climbs = false, turn = values[0] ?? 0
    for (const value of values) { // turn: the highest since the climb, or else the lowest since the peak
        turn = climbs ? Math.max(turn, value) : Math.min(turn, value)
        if (Math.abs(value - turn) < height) continue
        count += Number(climbs)
        climbs = !climbs
        turn = value
    }
    return count
}

/** The value at a time, linear between the points and constant beyond them. */
function valueAt(times: number[], values: number[], time: number): number {
    const after = times.findIndex(each => each >= time)
    if (after < 0) return values.at(-1)!
    if (after === 0 || times[after] === time) return values[after]!
    const [t0, t1] = [times[after - 1]!, times[after]!], [v0, v1] = [values[after - 1]!, values[after]!]
    return v0 + ((v1 - v0) * (time - t0)) / (t1 - t0)
}
