// Packs notes into a text that fits a learning platform: 4,096 characters in SCORM 1.2. Pure functions.

import type { Given } from "./shared_data"

/** What packing may leave out: points of a drawn curve, which keeps its ends and extremes; and the ends of long texts, which
 * the page must say. */
interface Size {
    points: number
    letters: number
}

export interface Packed {
    text: string
    /** Whether the student's texts are cut. */
    cut: boolean
}

/** Answers, as item, time after the first one, and the rest: `v` is the place of its versions among all, if not the first. */
type Row = [item: string, time: number, rest: { v?: number } & Partial<Given>]
interface Rows { since: number; versions: unknown[][]; rows: Row[] }
type Curve = [begin: number, end: number, low: number, high: number, letters: string]
const LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_"
const FINE = LETTERS.length ** 2 - 1 // parts of the length and of the height of a curve, of two letters
const SIZES: Size[] = [
    ...[Infinity, 80, 40, 20, 16, 13, 10].map(points => ({ points, letters: Infinity })),
    ...Array.from({ length: 47 }, (_, i) => ({ points: 10, letters: 980 - 20 * i })),
]

/** The most complete text with at most `room` characters; null if none fits. */
export function packed(kept: unknown, room: number): Packed | null {
    for (const size of SIZES) {
        const text = JSON.stringify(kept, (_, own: unknown) => reduced(own, size))
        if (text.length <= room) return { text, cut: size.letters < Infinity }
    }
    return null
}

/** The packed notes; undefined if the text is not one of ours. */
export function unpacked(text: string): unknown {
    try {
        return JSON.parse(text, (_, own: { curve?: unknown } | null): unknown => {
            const { curve, ...rest } = { ...own }
            if (isCurve(curve)) return { ...rest, ...drawn(curve) }
            return isRows(rest) ? givenOf(rest) : own
        })
    } catch {
        return undefined
    }
}

function reduced(own: unknown, size: Size): unknown {
    if (typeof own === "string") return shortened(own, size.letters)
    if (Array.isArray(own) && own.every(isGiven)) return own.length ? rowsOf(own) : own
    const { times, values, ...rest } = { ...(own as { times?: unknown; values?: unknown } | null) }
    if (!isLine(times) || !isLine(values) || times.length !== values.length || times.length < 2) return own
    return { ...rest, curve: curveOf(times, values, size.points) }
}

function rowsOf(given: Given[]): Rows {
    const since = given[0]!.time ?? 0
    const versions = [...new Set(given.map(({ lesson, product }) => JSON.stringify([lesson ?? null, product ?? null])))]
    const rows = given.map(({ item, attempt = 1, time = 0, lesson, product, ...rest }): Row => {
        const v = versions.indexOf(JSON.stringify([lesson ?? null, product ?? null]))
        return [item, thousandths(time - since), { ...(attempt > 1 ? { attempt } : {}), ...(v ? { v } : {}), ...rest }]
    })
    return { since, versions: versions.map(each => JSON.parse(each) as unknown[]), rows }
}

function givenOf({ since, versions, rows }: Rows): object[] {
    return rows.map(([item, time, { v = 0, ...rest }]) => {
        const [lesson, product] = versions[v] ?? []
        return { item, attempt: 1, time: thousandths(since + time), ...rest, ...(lesson === null ? {} : { lesson }), ...(product === null ? {} : { product }) }
    })
}

function shortened(text: string, letters: number): string {
    const all = Array.from(text) // so that an emoji is not cut in two
    return all.length <= letters ? text : `${all.slice(0, letters - 1).join("")}…`
}

function curveOf(times: number[], values: number[], points: number): Curve {
    const box = [times[0]!, times[times.length - 1]!, Math.min(...values), Math.max(...values)] as const
    const [begin, end, low, high] = box
    const letters = fewest(times, values, points).map(i => pair(times[i]!, begin, end) + pair(values[i]!, low, high))
    return [...box, letters.join("")]
}

function drawn([begin, end, low, high, letters]: Curve): { times: number[]; values: number[] } {
    const places = Array.from({ length: letters.length / 2 }, (_, i) => {
        const [one, other] = [letters[2 * i]!, letters[2 * i + 1]!].map(letter => LETTERS.indexOf(letter)) as [number, number]
        return (LETTERS.length * one + other) / FINE
    })
    const between = (from: number, to: number, share: number) => from * (1 - share) + to * share
    return {
        times: places.filter((_, i) => i % 2 === 0).map(share => between(begin, end, share)),
        values: places.filter((_, i) => i % 2 === 1).map(share => between(low, high, share)),
    }
}

function pair(value: number, from: number, to: number): string {
    const part = to > from ? Math.round((FINE * (value - from)) / (to - from)) : 0
    return LETTERS[Math.floor(part / LETTERS.length)]! + LETTERS[part % LETTERS.length]!
}

/** Indices of a limited number of points: the ends, the extremes, and then repeatedly the point farthest from the
 * line through those that are kept. */
function fewest(times: number[], values: number[], most: number): number[] {
    if (times.length <= most) return [...times.keys()]
    const extremes = [Math.min(...values), Math.max(...values)].map(value => values.indexOf(value))
    let places = [...new Set([0, ...extremes, times.length - 1])].sort((a, b) => a - b)
    while (places.length < most) {
        const away = times.map((time, i) => Math.abs(values[i]! - height(time, i)))
        const farthest = Math.max(...away)
        if (!(farthest > 0)) break // all are on the line
        places = [...places, away.indexOf(farthest)].sort((a, b) => a - b)
    }
    return places

    /** Of the line through the kept points on both sides of point i. */
    function height(time: number, i: number): number {
        const next = places.find(place => place >= i)!
        const last = places.findLast(place => place <= i)!
        if (next === last) return values[i]!
        const share = (time - times[last]!) / (times[next]! - times[last]!)
        return values[last]! * (1 - share) + values[next]! * share
    }
}

function isLine(own: unknown): own is number[] {
    return Array.isArray(own) && own.every(Number.isFinite)
}

function isGiven(own: unknown): own is Given {
    return typeof own === "object" && own !== null && "item" in own && typeof own.item === "string"
}

function thousandths(time: number): number {
    return Math.round(1000 * time) / 1000
}

function isRows(own: Partial<Rows>): own is Rows {
    const { since, versions, rows } = own
    return typeof since === "number" && Array.isArray(versions) && Array.isArray(rows) &&
        rows.every(row => Array.isArray(row) && row.length === 3 && typeof row[0] === "string" && typeof row[2] === "object")
}

function isCurve(own: unknown): own is Curve {
    const letters = Array.isArray(own) && own.length === 5 && isLine(own.slice(0, 4)) ? (own[4] as unknown) : null
    return typeof letters === "string" && /^([\w-]{4})+$/.test(letters)
}
