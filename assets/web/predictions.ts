// Predictions: a choice or a curve, to which a student commits before the run.

import { made } from "./controls"
import { judged } from "./asked"
import { said, type BlockData, type PageData, type SketchData, type StepData } from "./lesson_data"
import { given, type Answer, type Notes } from "./notes"
import { Board, Chart } from "./sketch"

export interface Prediction {
    /** Number of the step that asks, and of the block in it. */
    step: number
    block: number
    data: SketchData | Extract<BlockData, { kind: "choice" | "quiz" }>
}

/** What a step asks, or what it shows: the prediction of the step before. */
export function predictionAt(steps: StepData[], index: number): Prediction | null {
    const candidates = steps[index]!.kind === "run" ? [index, index - 1] : [index]
    for (const step of candidates)
        for (const [block, data] of (steps[step]?.blocks ?? []).entries())
            if (data.kind === "choice" || data.kind === "sketch")
                return { step, block, data: data as Prediction["data"] }
    return null
}

export function elementOf(prediction: Prediction): HTMLElement {
    return document.querySelector<HTMLElement>(`#step-${prediction.step + 1} [data-block="${prediction.block}"]`)!
}

/** Make a prediction answerable. Once committed, it cannot be changed; a skipped one can still be made. */
export function predict(page: PageData, prediction: Prediction, notes: Notes, changed: () => void): void {
    const element = elementOf(prediction)
    const key = String(prediction.step)
    const { data } = prediction
    const told = element.querySelector<HTMLElement>(".verdict")!
    const commit = element.querySelector<HTMLButtonElement>(".commit")!
    const asked = element.querySelector<HTMLElement>(".committing")!
    element.querySelector<HTMLElement>(".after")?.setAttribute("hidden", "")
    let answer: Answer = {}
    commit.disabled = true
    if (data.kind === "sketch") {
        const board = new Board(page, data, () => {
            answer = board.answer
            commit.disabled = !answer.times
            told.textContent = said(page, answer.times ? "lesson.drawn" : "lesson.draw_first")
        })
        asked.before(board.element)
        const draw = () => board.draw(given(notes.answers[key]) ? notes.answers[key] : answer, undefined)
        draw()
        addEventListener("resize", draw)
    } else
        element.addEventListener("change", event => {
            const input = event.target as HTMLInputElement
            if (input.type !== "radio") return
            answer = { option: Number(input.value) }
            commit.disabled = false
        })
    const show = () => {
        const kept = notes.answers[key]
        if (!kept) return
        told.textContent = said(page, given(kept) ? "lesson.committed" : "site.skipped")
        if (!given(kept)) return
        asked.hidden = true
        element.querySelectorAll<HTMLInputElement>("input").forEach(input => (input.disabled = true))
        element.querySelectorAll<HTMLElement>(".board").forEach(board => (board.parentElement!.inert = true))
        if (kept.option !== undefined) element.querySelector<HTMLInputElement>(`input[value="${kept.option}"]`)!.checked = true
    }
    const finish = (own: Answer) => {
        notes.answers[key] = own
        show()
        changed()
    }
    commit.addEventListener("click", () => finish({ ...answer, ...beside(element) }))
    element.querySelector(".leave")!.addEventListener("click", () => finish({}))
    element.addEventListener("skip", () => notes.answers[key] ?? finish({}))
    show()
}

/** How a prediction compares with what happened. */
export class Comparison {
    readonly elements: HTMLElement[] = []
    private readonly chart: Chart | null = null
    private readonly again: HTMLElement

    constructor(page: PageData, private readonly prediction: Prediction, private readonly notes: Notes) {
        const { data } = prediction
        this.again = made("p", "", said(page, "site.again"))
        if (data.kind === "sketch") {
            this.chart = new Chart(page, data)
            this.elements.push(this.chart.canvas, this.again)
        } else this.elements.push(judged(page, elementOf(prediction), data.right, this.answer?.option))
    }

    /** If the truth is not kept, the page says how to see it again. */
    draw(truth: Notes["truths"][string] | undefined): void {
        this.again.hidden = truth !== undefined
        this.chart?.draw(this.answer, truth)
    }

    private get answer(): Answer | undefined {
        return this.notes.answers[String(this.prediction.step)]
    }
}

/** How sure the student is, and why, if stated. */
function beside(element: HTMLElement): Answer {
    const value = (name: string) => element.querySelector<HTMLSelectElement | HTMLTextAreaElement>(name)?.value ?? ""
    const found: Answer = {}
    if (value(".sure")) found.sure = value(".sure")
    if (value(".reason")) found.reason = Number(value(".reason"))
    if (value(".why").trim()) found.why = value(".why").trim().slice(0, 1000)
    return found
}
