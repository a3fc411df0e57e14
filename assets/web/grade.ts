// The progress and score that a learning platform receives for a lesson. Pure functions.

import type { StepData } from "./lesson_data"
import { given, type Notes } from "./notes"
import { accepted } from "./own"

/** Shares, from 0 to 1; optional steps and tasks to be found by trying do not count. */
export interface Grade {
    /** The share of parts that are done: steps opened, runs seen to their end, predictions
     * committed, questions answered, tasks passed. */
    progress: number
    /** The share of quizzes, numbers and tasks that are right; null before one of them was answered or passed. The first
     * answer counts, since the page then shows the right one; a task may be tried until it is passed. */
    score: number | null
}

export function gradeOf(steps: StepData[], notes: Notes): Grade {
    const parts: boolean[] = []
    const right: boolean[] = []
    let begun = false
    steps.forEach((step, i) => {
        if (step.optional) return
        parts.push(i < notes.seen)
        if (step.script) parts.push(notes.played[String(i)] === true)
        step.blocks.forEach((block, j) => {
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
            else if (block.kind === "task" && block.checks && !block.exploratory) judged(block.id in notes.tasks, block.id in notes.tasks)
        })
    })
    return { progress: share(parts) ?? 1, score: begun ? share(right) : null }
}

function share(of: boolean[]): number | null {
    return of.length ? of.filter(Boolean).length / of.length : null
}
