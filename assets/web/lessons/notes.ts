// A student's notes on the lessons: what was predicted, seen, answered and passed.

import type { Answer, Curves, PageData } from "../core/lesson_data"
import type { Progress } from "./progress"

/** Keys are numbers of steps, from 0; for questions, step and block, such as "3.1". */
export interface Notes {
    step: number
    seen: number
    answers: Record<string, Answer>
    /** What happened after each prediction; this is not kept, since it can be computed again. */
    truths: Record<string, Curves>
    played: Record<string, boolean>
    tasks: Record<string, number>
    /** The way in which each task was passed last, if it is not the usual one, 0. */
    ways: Record<string, number>
    /** Number of hints that were read, by task. */
    hints: Record<string, number>
    quiz: Record<string, number>
    /** First answers to quizzes and questions for numbers, after which the page shows the right ones. */
    first: Record<string, number>
    numbers: Record<string, number>
    written: Record<string, string>
}

const FORMAT = "onpath-progress-1"

export function noNotes(): Notes {
    return { step: 0, seen: 0, answers: {}, truths: {}, played: {}, tasks: {}, ways: {}, hints: {}, quiz: {}, first: {}, numbers: {}, written: {} }
}

export function notesOf(progress: Progress, lesson: string): Notes {
    const kept = parsed(progress.get(key(lesson)) ?? "{}")
    return isNotes(kept) ? { ...noNotes(), ...kept, truths: {} } : noNotes()
}

export function keep(progress: Progress, lesson: string, notes: Notes): void {
    progress.set(key(lesson), JSON.stringify({ ...notes, truths: {} }))
}

/** Whether a prediction was committed; a skipped one is an empty answer. */
export function given(answer: Answer | undefined): boolean {
    return answer?.option !== undefined || answer?.times !== undefined
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
    return fields({
        step: place, seen: place, answers: every(answer), truths: every(curves), played: every(flag),
        tasks: every(number), ways: every(place), hints: every(place), quiz: every(place), first: every(number), numbers: every(number), written: every(text),
    })(read)
}
