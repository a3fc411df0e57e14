// Notes as earlier versions kept them: the last answers, and the first ones beside them.

import type { Answer } from "../core/lesson_data"
import type { Given } from "../core/shared_data"

interface Former {
    answers: Record<string, Answer>
    quiz: Record<string, number>
    first: Record<string, number>
    numbers: Record<string, number>
    written: Record<string, string>
    tasks: Record<string, number>
    ways: Record<string, number>
}

const NAMES: (keyof Former)[] = ["answers", "quiz", "first", "numbers", "written", "tasks", "ways"]

/** Notes of any version, as they would be kept today; they are not checked. */
export function notesOfToday(notes: unknown): unknown {
    if (typeof notes !== "object" || !notes || !NAMES.some(name => name in notes)) return notes
    const kept = notes as Record<string, unknown>
    const of = <Name extends keyof Former>(name: Name) => Object.entries(kept[name] ?? {}) as [string, Former[Name][string]][]
    const first = Object.fromEntries(of("first")), ways = Object.fromEntries(of("ways"))
    const all: Given[] = of("answers").map(([item, answer]) => ({ item, answer }))
    const both = (item: string, last: number, event: (value: number) => Given) => {
        if (first[item] === undefined || first[item] === last) all.push(event(last))
        else all.push(event(first[item]), { ...event(last), attempt: 2 })
    }
    for (const [item, option] of of("quiz")) both(item, option, each => ({ item, answer: { option: each } }))
    for (const [item, number] of of("numbers")) both(item, number, each => ({ item, number: each }))
    for (const [item, text] of of("written")) all.push({ item, text })
    for (const [item, number] of of("tasks")) all.push({ item, number, right: true, way: ways[item] ?? 0 })
    const others = Object.entries(kept).filter(([name]) => !(NAMES as string[]).includes(name))
    return { ...Object.fromEntries(others), given: all }
}
