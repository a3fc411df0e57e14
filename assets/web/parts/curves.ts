// Curves over time.

export interface Curve {
    times: readonly number[]
    /** A number that is not known is NaN. */
    values: readonly number[]
}

/** When something acts on a robot. */
export interface Span {
    from: number
    until: number
    kind: "held" | "pulled"
}

/** The number of the first time that is not before another. */
export function firstAfter(times: readonly number[], time: number): number {
    let [low, high] = [0, times.length]
    while (low < high) {
        const middle = (low + high) >> 1
        if (times[middle]! < time - 1e-9) low = middle + 1
        else high = middle
    }
    return low
}

/** The value of a curve at a time, between its points; null outside, and where it is not known. */
export function valueAt({ times, values }: Curve, time: number): number | null {
    const next = firstAfter(times, time)
    if (next === times.length) return null
    const gap = times[next]! - time
    if (gap >= 1e-6 && next === 0) return null
    const share = gap < 1e-6 ? 0 : gap / (times[next]! - times[next - 1]!)
    const found = share ? share * values[next - 1]! + (1 - share) * values[next]! : values[next]!
    return Number.isNaN(found) ? null : found
}
