// The range of an axis that follows what it shows.

import { niceStep } from "../core/numbers"

export interface Range {
    bottom: number
    top: number
}

const PARTS = 5 // largest number of round steps in the range
const ROOM = 0.06 // share of the range that is left free beyond the values
const LOOSE = 0.5 // share of the present range below which the axis shrinks

/** The range for values from `low` to `high`, between round numbers, with at least `least`. It grows at once, and shrinks
 * only when half of it would do, so that it does not flicker. */
export function axisFor(before: Range, low: number, high: number, least: readonly [number, number]): Range {
    const room = ROOM * (Math.max(high, least[1]) - Math.min(low, least[0]))
    const from = Math.min(low < 0 || least[0] > 0 ? low - room : low, least[0])
    const to = Math.max(high > 0 || least[1] < 0 ? high + room : high, least[1])
    const step = niceStep((to - from) / PARTS)
    const wanted = { bottom: step * Math.floor(from / step + 1e-9), top: step * Math.ceil(to / step - 1e-9) }
    const [size, needed] = [before.top - before.bottom, wanted.top - wanted.bottom]
    const fits = low >= before.bottom && high <= before.top && least[0] >= before.bottom && least[1] <= before.top
    return fits && needed > LOOSE * size ? before : wanted
}
