// Evaluates the checks of a task, as lessons/checks.py does. Pure functions.

import type { Better, Bound, Check, Compare, Once, Only, Robot, Phrases, Setting, SettingCheck, TimeWindow } from "../core/lesson_data"
import { fixed, general, sum } from "../core/numbers"
import type { Verdict } from "../core/shared_data"
import { filled, localized } from "../core/words"

export interface Happening {
    run: number
    time: number
    name: string
    detail: string
    robots: Robot[]
}

/** The record since a step began or since the last reset; each instant lasts until the next one. */
export interface RunRecord {
    times: number[]
    end: number
    values: Record<Robot, Record<string, number[]>>
    happenings: Happening[]
    run: number
    settings: Record<string, Setting>
    /** Names of the settings that have changed since the step began. */
    changed: string[]
    /** What was measured earlier: see earlier.ts. */
    before: ReadonlyMap<Check, number>
}

type Words = Record<string, string>
const TINY = 1e-9 // smallest divisor of a ratio
const INSTANT = 1e-6 // [s], tolerance of comparisons of times
const BAND = 0.05 // share of the largest value within which a quantity counts as settled

export function judge(checks: Check[], record: RunRecord, words: Words): Verdict[] {
    const begun = record.happenings.some(each => each.run === record.run)
    return checks.map(check => ({ share: null, broken: null, ...verdict(check, record, words), begun })).filter(each => each.words)
}

/** The number of the way in which a task is passed, from 1; 0 if it has none that holds. */
export function wayOf(ways: Check[], record: RunRecord, words: Words): number {
    return ways.findIndex(check => verdict(check, record, words).passed) + 1
}

type Found = Pick<Verdict, "passed" | "words"> & Partial<Verdict>

function verdict(check: Check, record: RunRecord, words: Words): Found {
    if (check.kind === "bound") return bound(check, record, words)
    if (check.kind === "compare") return compare(check, record, words)
    if (check.kind === "better") return better(check, record, words)
    if (check.kind === "once") return once(check, record, words)
    if (check.kind === "setting") return setting(check, record, words)
    if (check.kind === "only") return only(check, record, words)
    if (check.kind === "event") {
        const undone = record.happenings.map(each => check.since.some(wanted => happens(each, wanted))).lastIndexOf(true)
        const have = record.happenings.filter((each, i) => i >= undone && happens(each, check)).length
        const counts = { have: String(Math.min(have, check.times)), need: String(check.times) }
        return { passed: have >= check.times, words: filled(words["check.event"]!, { ...check.phrases, ...counts }) }
    }
    let found = 0
    for (const each of record.happenings) if (found < check.events.length && happens(each, check.events[found]!)) found++
    const marked = check.events.map((event, i) => (i < found ? "✓ " : "") + event.phrase)
    return {
        passed: found === check.events.length,
        words: filled(words["check.order"]!, { events: marked.join(" → ") }),
    }
}

/** Whether an event counts as the wanted one. */
export function happens(each: { name: string; detail: string }, wanted: { event: string; name: string }): boolean {
    return each.name === wanted.event && (wanted.name === "" || wanted.name === each.detail)
}

function bound(check: Bound, record: RunRecord, words: Words): Found {
    const { phrases, below, above } = check
    if (stopped(record, check.robot)) return halted(phrases["robot"]!, words)
    const mask = chosen(record, check.robot, check)
    const [enough, seconds, share] = duration(check, record, mask, phrases, words)
    const value = statistic(record, check.robot, check.quantity, check.stat, mask)
    if (value === null)
        return { passed: false, words: filled(words["check.nothing"]!, { ...phrases, seconds }), share }
    const shown = filled(words["check.bound"]!, { ...phrases, value: digits(value, below, above, words) }) + seconds
    const broken = missed(check, record, mask)
    const when = broken === null ? "" : filled(words["check.broken"]!, { time: localized(fixed(broken, 1), { words }) })
    return { passed: enough && within(value, below, above), words: shown + when, share, broken }
}

/** When a value was beyond a bound on the largest or smallest one, which no later one mends. */
function missed(check: Bound, { times, values }: RunRecord, mask: boolean[]): number | null {
    const limit = check.stat === "max" ? check.below : check.stat === "min" ? check.above : null
    if (limit === null || check.last > 0) return null
    const all = values[check.robot][check.quantity]!
    const first = all.findIndex((value, i) => mask[i] && (check.stat === "max" ? value > limit : value < limit))
    return times[first] ?? null
}

function compare(check: Compare, record: RunRecord, words: Words): Found {
    const { phrases } = check
    if (stopped(record, check.smaller)) return halted(phrases["smaller"]!, words)
    const mask = chosen(record, check.larger, check)
    const [enough, seconds, share] = duration(check, record, mask, phrases, words)
    const [large, small] = [check.larger, check.smaller].map(robot =>
        statistic(record, robot, check.quantity, check.stat, chosen(record, robot, check)),
    ) as [number | null, number | null]
    if (large === null || small === null) {
        const values = { ...phrases, robot: phrases["larger"]!, wanted: `${phrases["wanted"]}×`, seconds }
        return { passed: false, words: filled(words["check.nothing"]!, values), share }
    }
    const ratio = large / Math.max(small, TINY)
    const shown = ratio < 1000 ? digits(ratio, null, check.ratio, words) : ">1000"
    return {
        passed: enough && ratio >= check.ratio,
        words: filled(words["check.compare"]!, { ...phrases, ratio: shown }) + seconds,
        share,
    }
}

function better(check: Better, record: RunRecord, words: Words): Found {
    const { phrases } = check
    if (stopped(record, check.robot)) return halted(phrases["robot"]!, words)
    const mask = chosen(record, check.robot, check)
    const [enough, seconds, share] = duration(check, record, mask, phrases, words)
    const value = statistic(record, check.robot, check.quantity, check.stat, mask)
    const before = record.before.get(check) ?? null
    const limit = before === null ? null : check.share * before
    const written = (each: number | null, below: number | null) =>
        each === null ? "–" : `${digits(each, below, null, words)} ${phrases["unit"]!}`
    const shown = { ...phrases, value: written(value, limit), before: written(before, null) }
    return {
        passed: enough && value !== null && limit !== null && value < limit,
        words: filled(words["check.better"]!, shown) + seconds,
        share,
    }
}

/** The statistic of a check in a run; null if it was too short for that. */
export function measured(check: Better | Once, record: RunRecord): number | null {
    const mask = chosen(record, check.robot, check)
    if (stopped(record, check.robot) || secondsOf(record, mask) < check.least - INSTANT) return null
    return statistic(record, check.robot, check.quantity, check.stat, mask)
}

function once(check: Once, record: RunRecord, words: Words): Found {
    const kept = record.before.get(check) ?? null
    const now = kept === null && setting(check.setting, record, words).passed
    const mask = chosen(record, check.robot, check)
    const shown = now ? statistic(record, check.robot, check.quantity, check.stat, mask) : kept
    const value = shown === null ? "–" : digits(shown, check.below, check.above, words)
    return { passed: kept !== null, words: filled(words["check.once"]!, { ...check.phrases, value }) }
}

/** The value that meets the bound while the setting is as required; null if there is none. */
export function keeps(check: Once, record: RunRecord, words: Words): number | null {
    if (!setting(check.setting, record, words).passed) return null
    const value = measured(check, record)
    return value !== null && within(value, check.below, check.above) ? value : null
}

function setting(check: SettingCheck, record: RunRecord, words: Words): Found {
    const value = record.settings[check.name] ?? "None"
    const { equals, phrases } = check
    const passed =
        equals !== null
            ? same(value, equals, check.whole)
            : typeof value === "number" && within(value, check.below, check.above)
    const shown =
        typeof value !== "number" ? (check.labels[String(value)] ?? String(value)) : check.whole ? String(value) : localized(general(value, 4), { words })
    return { passed, words: filled(words["check.setting"]!, { ...phrases, value: shown }) }
}

/** A check that holds has no message. */
function only({ names, labels }: Only, record: RunRecord, words: Words): Found {
    const others = record.changed.filter(name => !names.includes(name))
    if (!others.length) return { passed: true, words: "" }
    const told = others.map(name => labels[name] ?? name).join(", ")
    return { passed: false, words: filled(words["check.only"]!, { others: told }) }
}

function same(value: Setting, wanted: Setting, whole: boolean): boolean {
    if (typeof value !== "number" || typeof wanted !== "number" || whole) return String(value) === String(wanted)
    return Math.abs(value - wanted) <= 1e-6 + 1e-3 * Math.abs(wanted)
}

function halted(robot: string, words: Words): Found {
    return { passed: false, words: filled(words["check.stopped"]!, { robot }) }
}

function stopped({ happenings, run }: RunRecord, robot: Robot): boolean {
    return happenings.some(each => each.name === "diverged" && each.run === run && each.robots.includes(robot))
}

/** Duration of every instant, [s]. */
function steps({ times, end }: RunRecord): number[] {
    return times.map((time, i) => Math.max(0, (times[i + 1] ?? end) - time))
}

/** The instants that a window selects. */
export function chosen(record: RunRecord, robot: Robot, window: TimeWindow): boolean[] {
    const held = () => during(record, robot, "hold", "let_go")
    const pulled = () => during(record, robot, "pull", "release")
    let mask = record.times.map(() => true)
    if (window.during === "held") mask = held()
    if (window.during === "pulled") mask = pulled()
    if (window.during === "free" || window.during === "released") {
        const [one, other] = [held(), pulled()]
        let counts = window.during === "free"
        mask = mask.map((_, i) => {
            const free = !one[i] && !other[i]
            counts ||= !free
            return free && counts
        })
    }
    if (window.last > 0) {
        const lasting = steps(record).map((step, i) => (mask[i] ? step : 0))
        let later = 0
        for (let i = mask.length - 1; i >= 0; i--) {
            const before = later + lasting[i]!
            mask[i] = mask[i]! && before - lasting[i]! < window.last - 1e-9
            later = before
        }
    }
    return mask
}

function during(record: RunRecord, robot: Robot, begin: string, end: string): boolean[] {
    const mask = record.times.map(() => false)
    const mark = (from: number, until: number) =>
        record.times.forEach((time, i) => (mask[i] ||= time >= from && time < until))
    let since: number | null = null
    for (const event of record.happenings) {
        if (event.run !== record.run || !event.robots.includes(robot)) continue
        if (event.name === begin && since === null) since = event.time
        else if (event.name === end && since !== null) {
            mark(since, event.time)
            since = null
        }
    }
    if (since !== null) mark(since, Infinity)
    return mask
}

/** A statistic of a quantity over the chosen instants; null if it is undefined. */
export function statistic(
    record: RunRecord, robot: Robot, quantity: string, stat: string, mask: boolean[],
): number | null {
    const all = record.values[robot][quantity]
    if (!all || !mask.includes(true)) return null
    if (stat === "settling" || stat === "overshoot") {
        const last = mask.lastIndexOf(true)
        const first = mask.lastIndexOf(false, last) + 1
        const values = all.slice(first, last + 1)
        return stat === "settling" ? settling(record.times.slice(first, last + 1), values) : overshoot(values)
    }
    const values = all.filter((_, i) => mask[i])
    if (stat === "max") return values.reduce((a, b) => Math.max(a, b))
    if (stat === "min") return values.reduce((a, b) => Math.min(a, b))
    if (stat === "mean") return sum(values) / values.length
    if (stat === "rms") return Math.sqrt(sum(values.map(value => value * value)) / values.length)
    return values[values.length - 1]!
}

function settling(times: number[], values: number[]): number | null {
    const largest = Math.max(...values.map(Math.abs))
    const after = values.findLastIndex(value => Math.abs(value) > BAND * largest) + 1
    if (after === 0) return 0
    return after === values.length ? null : times[after]! - times[0]!
}

function overshoot(values: number[]): number {
    const sizes = values.map(Math.abs)
    const peak = sizes.indexOf(Math.max(...sizes))
    if (values[peak] === 0) return 0
    return 100 * values.slice(peak).reduce((most, value) => Math.max(most, -value / values[peak]!), 0)
}

function within(value: number, below: number | null, above: number | null): boolean {
    return (below === null || value <= below) && (above === null || value >= above)
}

/** A value with the fewest digits that keep it on its side of the bounds; see `_rounded` in lessons/checks.py. */
function digits(value: number, below: number | null, above: number | null, words: Words): string {
    const bounds = [below, above].filter(each => each !== null && each !== 0).map(each => Math.abs(each!))
    const least = bounds.length ? Math.min(...bounds) : 1
    const decimals = Math.max(2, 2 - Math.floor(Math.log10(least)))
    const holds = within(value, below, above)
    const tried = [Math.abs(value) < 1 ? fixed(value, decimals) : general(value, 3)]
    for (let count = 3; count < 17; count++) tried.push(general(value, count))
    const shown = tried.find(text => within(Number(text), below, above) === holds) ?? String(value)
    return localized(shown, { words })
}

function secondsOf(record: RunRecord, mask: boolean[]): number {
    return sum(steps(record).filter((_, i) => mask[i]))
}

/** Whether the instants last long enough, the words for it, and the share that they last, rounded down. */
function duration(check: TimeWindow, record: RunRecord, mask: boolean[], phrases: Phrases, words: Words): [boolean, string, number] {
    const have = secondsOf(record, mask)
    const need = phrases["need"]!, point = words["point"]!
    const enough = have >= check.least - INSTANT
    const tenths = Math.floor(10 * have)
    const shown = enough ? (need.includes(point) ? need : `${need}${point}0`) : `${Math.floor(tenths / 10)}${point}${tenths % 10}`
    const share = enough ? 1 : Math.floor((100 * have) / check.least) / 100
    return [enough, filled(words["check.seconds"]!, { have: shown, need }), share]
}
