// The progress and score that a learning platform receives for a lesson. Pure functions.

import type { Grade } from "./progress"
import type { StepData } from "../core/lesson_data"
import { statesOf } from "./derivation"
import { given, type Notes } from "./notes"
import { accepted } from "./own"

export function gradeOf(steps: StepData[], notes: Notes): Grade {
    const parts: boolean[] = []
    const right: boolean[] = []
    let begun = false
    steps.forEach((step, i) => {
        if (step.optional) return
        parts.push(i < notes.seen)
        if (step.script) parts.push(notes.played[String(i)] === true)
        step.blocks.forEach((block, j) => {
            if ("uncounted" in block && block.uncounted) return
            const key = `${i}.${j}`
            const first = notes.first[key] ?? notes.quiz[key] ?? notes.numbers[key]
            const judged = (done: boolean, good: boolean) => {
                parts.push(done)
                right.push(good)
                begun ||= done
            }
            if (block.kind === "choice" || block.kind === "sketch") parts.push(given(notes.answers[String(i)]))
            else if (block.kind === "open") parts.push(key in notes.written)
            else if (block.kind === "quiz") judged(first !== undefined, first === block.right)
            else if (block.kind === "number") judged(first !== undefined, first !== undefined && accepted(first, block))
            else if (block.kind === "derivation") for (const line of statesOf(block, notes.written[key] ?? "")) judged(line.closed, line.tries[0] !== undefined && line.tries[0].verdict !== "wrong")
            else if (block.kind === "task" && block.checks && !block.exploratory) judged(block.id in notes.tasks, block.id in notes.tasks)
        })
    })
    return { progress: share(parts) ?? 1, score: begun ? share(right) : null }
}

function share(of: boolean[]): number | null {
    return of.length ? of.filter(Boolean).length / of.length : null
}
