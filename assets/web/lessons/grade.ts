// The progress and score that a learning platform receives for a lesson. Pure functions.

import type { Given } from "../core/shared_data"
import type { BlockData, StepData } from "../core/lesson_data"
import { statesOf } from "./derivation"
import { given, givenTo, predicted, lastSaid, SECOND_TRY, type Notes } from "./notes"
import { accepted } from "./own"
import type { Grade } from "./progress"

const SECOND = 0.5 // what a right second answer counts

/** What a prediction, by its step, or a question, by step and block, asks. */
export function blockOf(steps: StepData[], item: string): BlockData | undefined {
    const [step, place, second] = item.split("."), blocks = steps[Number(step)]?.blocks ?? []
    const asked = blocks[Number(place)]
    if (second !== undefined) return asked && "second" in asked ? asked.second : undefined
    return place === undefined ? blocks.find(({ kind }) => kind === "choice" || kind === "sketch") : asked
}

/** As `is_right` in lessons/right.py. */
export function isRight(block: BlockData, { answer, number, text }: Given): boolean | null {
    if (block.kind === "number") return typeof number === "number" && accepted(number, block)
    if (block.kind === "derivation") return statesOf(block, text ?? "").every(line => points(line.tries.map(each => each.verdict !== "wrong")) === 1)
    if ((block.kind !== "choice" && block.kind !== "quiz") || typeof answer?.option !== "number") return null
    return answer.option === block.right
}

export function gradeOf(steps: StepData[], notes: Notes): Grade {
    const parts: boolean[] = []
    const scores: number[] = []
    let begun = false
    const judged = (done: boolean, score: number) => {
        parts.push(done)
        scores.push(score)
        begun ||= done
    }
    steps.forEach((step, i) => {
        if (step.optional) return
        parts.push(i < notes.seen)
        if (step.script) parts.push(notes.played[String(i)] === true)
        step.blocks.forEach((block, j) => {
            if ("uncounted" in block && block.uncounted) return
            const item = block.kind === "task" ? block.id : `${i}.${j}`, events = givenTo(notes, item)
            if (block.kind === "choice" || block.kind === "sketch") parts.push(given(predicted(notes, i)))
            else if (block.kind === "open") parts.push(events.length > 0)
            else if (block.kind === "quiz" || block.kind === "number") {
                const tried = givenTo(notes, `${item}${SECOND_TRY}`)[0], second = "second" in block ? block.second : undefined
                const right = events.map(each => each.right ?? isRight(block, each) ?? false)
                if (tried && second) right[1] = tried.right ?? isRight(second, tried) ?? false
                judged(events.length > 0, points(right))
            }
            else if (block.kind === "derivation") for (const line of statesOf(block, String(lastSaid(notes, item) ?? ""))) judged(line.closed, points(line.tries.map(each => each.verdict !== "wrong")))
            else if (block.kind === "task" && block.checks && !block.exploratory) judged(events.length > 0, Number(events.length > 0 && !isShown(block.hints, events[0]!)))
        })
    })
    return { progress: share(parts) ?? 1, score: begun ? share(scores) : null }
}

/** The first try counts in full, a right second one half; after it, what is right has been told. */
function points(right: boolean[]): number {
    return right[0] ? 1 : right[1] ? SECOND : 0
}

/** Whether a task was passed after its last hint, the recipe: it is done, but counts nothing. */
function isShown(all: number | undefined, { hints }: Given): boolean {
    return Boolean(all) && (hints ?? 0) >= all!
}

function share(of: (boolean | number)[]): number | null {
    return of.length ? of.reduce<number>((sum, each) => sum + Number(each), 0) / of.length : null
}
