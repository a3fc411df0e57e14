// A student's notes on the lessons: what was predicted, seen, answered and passed.

import type { Answer, Curves, PageData } from "../core/lesson_data"
import type { Given } from "../core/shared_data"
import { notesOfToday } from "./former"
import type { Progress } from "./progress"

/** Keys are numbers of steps, from 0. */
export interface Notes {
    step: number
    seen: number
    /** What happened after each prediction; this is not kept, since it can be computed again. */
    truths: Record<string, Curves>
    played: Record<string, boolean>
    /** Number of hints that were read, by task. */
    hints: Record<string, number>
    /** All answers, in the order in which they were given. */
    given: Given[]
}

const FORMAT = "onpath-progress-1"

export function noNotes(): Notes {
    return { step: 0, seen: 0, truths: {}, played: {}, hints: {}, given: [] }
}

/** The answers to an item: a prediction, by step, a question, by step and block, or a task. */
export function givenTo(notes: Notes, item: string): Given[] {
    return notes.given.filter(each => each.item === item)
}

/** Ends the item of a second try, before which stand the step and the block of its question; see lessons/second_try.py. */
export const SECOND_TRY = ".second"

/** The answer to a prediction that counts: the first one that was not skipped; a skipped one is empty. */
export function predicted(notes: Notes, step: number | string): Answer | undefined {
    const all = givenTo(notes, String(step)).filter(each => each.way === undefined)
    return (all.find(each => given(each.answer)) ?? all[0])?.answer ?? undefined
}

/** What was chosen or typed last, in answer to a question. */
export function lastSaid(notes: Notes, question: string): number | string | undefined {
    const last = givenTo(notes, question).at(-1)
    return last?.answer?.option ?? last?.number ?? (last?.text || undefined)
}

/** The tasks that were passed: the least value, or 0 for tasks without one, and the way in which each was passed last. */
export function passedTasks(notes: Notes): Record<string, { best: number; way: number }> {
    const found: Record<string, { best: number; way: number }> = {}
    for (const { item, number, way } of notes.given)
        if (way !== undefined) found[item] = { best: Math.min(found[item]?.best ?? Infinity, number ?? 0), way: way ?? 0 }
    return found
}

/** Keep one more answer, unless it says the same again; as `_keep` in app/lab/lesson_state.py. Returns it, or null. */
export function noted(notes: Notes, answer: Omit<Given, "attempt">): Given | null {
    const before = givenTo(notes, answer.item), last = before.at(-1)
    if (last && says(last) === says(answer)) return null
    const all = [...before, { ...answer, attempt: last ? (last.attempt ?? 1) + 1 : answer.item.endsWith(SECOND_TRY) ? 2 : 1 }]
    const made = all.findIndex(each => !each.answer || given(each.answer)), judged = typeof all[0]!.right === "boolean"
    const kept = all.filter((_, i) => i === 0 || i === made || (judged && i === 1) || i === all.length - 1)
    notes.given = [...notes.given.filter(each => each.item !== answer.item), ...kept]
    return all.at(-1)!
}

function says({ answer, number, text, way }: Omit<Given, "attempt">): string {
    return JSON.stringify([answer, number, text, way])
}

export function notesOf(progress: Progress, lesson: string): Notes {
    const kept = notesOfToday(parsed(progress.get(key(lesson)) ?? "{}"))
    return isNotes(kept) ? { ...noNotes(), ...kept, truths: {} } : noNotes()
}

export function keep(progress: Progress, lesson: string, notes: Notes): void {
    progress.set(key(lesson), JSON.stringify({ ...notes, truths: {} }))
}

/** Whether a prediction was committed; a skipped one is an empty answer. */
export function given(answer: Answer | null | undefined): boolean {
    return typeof answer?.option === "number" || answer?.times !== undefined
}

/** All notes of a course as a file. */
export function exported(progress: Progress, page: PageData): string {
    const kept = Object.keys(page.lessons).map(name => [name, notesOf(progress, name)] as const)
    return JSON.stringify({ format: FORMAT, lessons: Object.fromEntries(kept) })
}

/** Read the notes from a file; false if it is not one of ours. */
export function imported(progress: Progress, page: PageData, text: string): boolean {
    const read = parsed(text) as { format?: unknown; lessons?: unknown } | null
    if (read?.format !== FORMAT || typeof read.lessons !== "object" || !read.lessons) return false
    const lessons = Object.entries(read.lessons).filter(([name]) => name in page.lessons)
        .map(([name, notes]) => [name, notesOfToday(notes)] as const)
    if (!lessons.every(([, notes]) => isNotes(notes))) return false
    for (const [name, notes] of lessons) progress.set(key(name), JSON.stringify(notes))
    return true
}

export function forget(progress: Progress, page: PageData): void {
    for (const name of Object.keys(page.lessons)) progress.set(key(name), "{}")
}

function key(lesson: string): string {
    return `notes.${lesson}`
}

export function parsed(text: string): unknown {
    try {
        return JSON.parse(text) as unknown
    } catch {
        return null
    }
}

/** Whether data have the form of notes: numbers and texts where they belong. */
function isNotes(read: unknown): read is Partial<Notes> {
    if (typeof read !== "object" || !read || Array.isArray(read)) return false
    const number = (each: unknown) => typeof each === "number" && Number.isFinite(each)
    const text = (each: unknown) => typeof each === "string" && each.length <= 1000
    const flag = (each: unknown) => typeof each === "boolean"
    const numbers = (each: unknown) => Array.isArray(each) && each.length <= 1000 && each.every(number)
    const every = (of: (each: unknown) => boolean) => (each: unknown) =>
        typeof each === "object" && each !== null && !Array.isArray(each) && Object.values(each).every(of)
    const fields = (forms: Record<string, (each: unknown) => boolean>) => (each: unknown) =>
        typeof each === "object" && each !== null &&
        Object.entries(each).every(([name, value]) => Object.hasOwn(forms, name) && forms[name]!(value))
    const place = (each: unknown) => number(each) && Number.isInteger(each) && (each as number) >= 0
    const answer = fields({ option: place, reason: place, times: numbers, values: numbers, sure: text, why: text })
    const curves = fields({ times: numbers, tracker: numbers, follower: numbers })
    const event = fields({
        item: text, attempt: place, time: number, round: place, answer, number, text, right: flag, hints: place, way: place,
        lost: flag, mark: text, why_mark: text, key: text, lesson: text, product: text,
    })
    const all = (each: unknown) => Array.isArray(each) && each.length <= 10000 && each.every(one => event(one) && "item" in (one as object))
    return fields({ step: place, seen: place, truths: every(curves), played: every(flag), hints: every(place), given: all })(read)
}
