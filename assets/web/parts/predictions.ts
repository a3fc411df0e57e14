// Predictions: a choice or a curve, to which a student commits before the run.

import { made, tell } from "../core/dom"
import { draftOf, keepDraft } from "../core/drafts"
import type { BlockData, PageData, Script, SketchData, StepData, Answer, Curves } from "../core/lesson_data"
import { phrase, significant, type Texts } from "../core/words"
import { given, predicted, type Notes } from "../lessons/notes"
import { has } from "../lessons/features"
import type { Student } from "../lessons/student"
import { judged, repliedTo } from "./asked"
import { Chart, type Axes } from "./chart"
import type { Span } from "./curves"
import { Drawing } from "./drawing"
import { radiusOf } from "./strip"

const CALM = matchMedia("(prefers-reduced-motion: reduce)")

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
                return { step, block, data }
    return null
}

export function elementOf(prediction: Prediction): HTMLElement {
    return document.querySelector<HTMLElement>(`#step-${prediction.step + 1} [data-block="${prediction.block}"]`)!
}

/** The parts of a prediction that stand elsewhere on the page than its question. */
export interface PredictionForm {
    commit: HTMLButtonElement
    /** Where a curve is drawn; null if there is nothing to draw. */
    board: HTMLElement | null
    /** Show what has been committed, if anything: it cannot be changed. */
    show(): void
    /** Leave it out, unless it has been made. */
    skip(): void
}

/** Make a prediction answerable. Once committed, it cannot be changed; a skipped one can still be made. */
export function predict(page: PageData, prediction: Prediction, student: Student): PredictionForm {
    const element = elementOf(prediction)
    const answerKept = () => predicted(student.notes, prediction.step)
    const { data } = prediction
    const told = element.querySelector<HTMLElement>(".verdict")!
    const commit = element.querySelector<HTMLButtonElement>(".lead")!
    const asked = element.querySelector<HTMLElement>(".committing")!
    element.querySelector<HTMLElement>(".after")?.setAttribute("hidden", "")
    let answer: Answer = {}
    const answers = () => {
        commit.disabled = answer.times === undefined && answer.option === undefined
        const { top } = element.getBoundingClientRect(), stuck = getComputedStyle(element).position === "sticky"
        element.classList.toggle("answered", !commit.disabled) // how sure, and why, is asked then
        if (!stuck || commit.disabled) return
        element.closest(".words")!.scrollTop += element.getBoundingClientRect().top - top // it stays under the mouse, then glides
        asked.scrollIntoView({ block: "nearest", behavior: CALM.matches ? "instant" : "smooth" })
    }
    let board: HTMLElement | null = null
    let committed = (_: Answer) => {}
    const name = `${page.lesson} ${prediction.step}`
    const draft = answerKept() ? null : draftOf<Answer>(name)
    const keep = () => !given(answerKept() ?? {}) && keepDraft(name, { ...answer, ...beside(element) })
    for (const event of ["input", "change"]) element.addEventListener(event, keep)
    commit.disabled = true
    if (data.kind === "sketch") {
        const chart = chartOf(page, prediction, data, () => {
            drawing.show()
            chart.draw()
        })
        const seconds = significant(page, data.seconds, 4)
        chart.sheet.canvas.setAttribute("aria-label", phrase(page, "site.sketch", { quantity: data.label, unit: data.unit, seconds }))
        chart.ghost = curveOf(answerKept())
        const before = curveOf(data.before)
        if (before) {
            chart.lines = [{ ...before, name: phrase(page, "chart.first"), tone: "yours", dashed: true, thin: true }]
            chart.hasPeaks = false
        }
        const ask = () => told.replaceChildren(phrase(page, "site.draw_first"), made("span", "by-keys", ` ${phrase(page, "site.draw_keys")}`))
        const hint = () => (chart.hint = chart.ghost ? "" : phrase(page, "chart.draw"))
        hint()
        const drawing = new Drawing(chart, () => {
            const { times, values } = chart.ghost ?? {}
            answer = times && values ? { times: [...times], values: [...values] } : {}
            answers()
            if (times) told.textContent = phrase(page, "lesson.drawn")
            else ask()
            hint()
            chart.draw()
            keep()
        })
        if (draft && isCurve(draft)) {
            chart.ghost = curveOf(draft)
            hint()
            drawing.show()
            answer = { times: draft.times!, values: draft.values! }
        }
        board = chart.element
        ask()
        committed = kept => {
            drawing.open = false
            chart.ghost = curveOf(kept)
            hint()
            chart.draw()
        }
    } else
        element.addEventListener("change", event => {
            const input = event.target as HTMLInputElement
            if (input.type !== "radio") return
            answer = { option: Number(input.value) }
            answers()
        })
    if (draft) {
        const chosen = element.querySelector<HTMLInputElement>(`input[type=radio][value="${Number(draft.option)}"]`)
        if (chosen) {
            chosen.checked = true
            answer = { option: Number(draft.option) }
        }
        for (const [field, value] of [[".sure", draft.sure], [".reason", draft.reason], [".why", draft.why]] as const) {
            const found = element.querySelector<HTMLSelectElement | HTMLTextAreaElement>(field)
            if (found && value !== undefined) found.value = String(value)
        }
        if (answer.times) told.textContent = phrase(page, "lesson.drawn")
        answers()
    }
    let wasSending = false
    const show = () => {
        const kept = answerKept(), way = student.way(String(prediction.step))
        if (way === "sending") tell(told, phrase(page, "answer.sending"))
        else if (wasSending && !kept) tell(told, "")
        wasSending = way === "sending"
        commit.disabled = wasSending || (answer.times === undefined && answer.option === undefined)
        if (!kept) return
        const says = !given(kept) ? "site.skipped" : way === "sent" ? "answer.sent" : "lesson.committed"
        if (way !== "sending" && (given(kept) || commit.disabled)) tell(told, phrase(page, says))
        if (!given(kept) || asked.hidden) return
        asked.hidden = true
        element.querySelectorAll<HTMLInputElement>("input").forEach(input => (input.disabled = true))
        committed(kept)
        if (kept.option !== undefined) element.querySelector<HTMLInputElement>(`input[value="${kept.option}"]`)!.checked = true
    }
    const finish = (own: Answer) => {
        student.predicts(prediction.step, own)
        keepDraft(name, null)
        show()
    }
    commit.addEventListener("click", () => finish({ ...answer, ...beside(element) }))
    show()
    return { commit, board, show, skip: () => void (answerKept() ?? finish({})) }
}

/** How a prediction compares with what happened. */
export class Comparison {
    readonly elements: HTMLElement[] = []
    private readonly chart: Chart | null = null
    private readonly again: HTMLElement

    constructor(private readonly page: PageData, private readonly prediction: Prediction, private readonly notes: Notes) {
        const { data } = prediction
        this.again = made("p", "", phrase(page, "site.again"))
        this.again.hidden = true
        if (data.kind === "sketch") {
            const chart = (this.chart = chartOf(page, prediction, data, () => chart.draw()))
            if (!given(this.answer ?? {})) chart.hint = phrase(page, "chart.pending")
            drawn(chart, data, this.answer, undefined)
            this.elements.push(chart.element, this.again)
        } else {
            const own = this.answer?.option ?? undefined, element = elementOf(prediction)
            const missed = data.second !== undefined && own !== undefined && own !== data.right
            const lines = missed ? repliedTo(page, element.querySelector(`[data-answer="${own}"]`), true) : []
            this.elements.push(missed ? made("div", "judged", ...lines) : judged(page, element, data.right, own))
        }
    }

    /** The verdict on a choice, in words. */
    get words(): string[] {
        return this.chart ? [] : this.elements.flatMap(each => [...each.children]).map(each => each.textContent)
    }

    /** What can be seen in the drawn curve and in the true one, once the run is over; null if nothing is looked for. */
    seen(truth: Curves | undefined): HTMLElement | null {
        const { page, answer, prediction: { data } } = this, own = curveOf(answer)
        if (data.kind !== "sketch" || !data.features?.length || !truth || !own) return null
        const happened = { times: truth.times, values: truth[data.robot ?? "tracker"] }
        const told = (is: boolean) => phrase(page, is ? "sketch.seen" : "sketch.unseen")
        const rows = data.features.map(each => made("tr", "", made("th", "", each.name), ...[own, happened].map(curve => made("td", "", told(has(data, each, curve))))))
        rows.forEach(row => row.querySelector("th")!.setAttribute("scope", "row"))
        const head = ["sketch.looked_for", "sketch.own", "sketch.run"].map(key => made("th", "", phrase(page, key)))
        return made("table", "features", made("thead", "", made("tr", "", ...head)), made("tbody", "", ...rows))
    }

    /** Draw what happened, too; if that is not kept, the page says how to see it again. */
    draw(truth: Curves | undefined): void {
        this.again.hidden = truth !== undefined
        const { chart, prediction } = this
        if (!chart || prediction.data.kind !== "sketch") return
        chart.hint = ""
        drawn(chart, prediction.data, this.answer, truth)
    }

    private get answer(): Answer | undefined {
        return predicted(this.notes, this.prediction.step)
    }
}

/** A chart of a prediction, and of what happened, that stands by itself. */
export function compared(page: Texts, data: SketchData, script: Script | null, answer: Answer | undefined, truth: Curves | undefined): HTMLElement {
    const chart = chartWith(page, data, script, () => chart.draw())
    drawn(chart, data, answer, truth)
    return chart.element
}

/** Draw a prediction, and what happened. */
function drawn(chart: Chart, { robots }: SketchData, answer: Answer | undefined, truth: Curves | undefined): void {
    chart.ghost = curveOf(answer)
    chart.lines = truth ? [
        { name: robots[0]!, tone: "side0", dashed: false, times: truth.times, values: truth.tracker },
        { name: robots[1]!, tone: "side1", dashed: true, times: truth.times, values: truth.follower },
    ] : []
    chart.draw()
}

/** The chart of a prediction, with what its run does. */
function chartOf(page: PageData, { step }: Prediction, data: SketchData, changed: () => void): Chart {
    const run = page.steps[page.steps[step]!.kind === "run" ? step : step + 1]
    const outline = page.figures[run?.figure ?? -1]?.paths[0]?.outline ?? []
    const points = Array.from({ length: outline.length / 2 }, (_, i) => outline.slice(2 * i, 2 * i + 2))
    return chartWith(page, { ...data, radius: data.radius ?? radiusOf(points) }, run?.script ?? null, changed)
}

/** A chart with the axes of a prediction, and when a script holds and pulls. */
function chartWith(page: Texts, data: SketchData, script: Script | null, changed: () => void): Chart {
    const { label, unit, bottom, top, quantity, seconds, radius } = data
    const axes: Axes = { label, unit, bottom, top }
    if (quantity === "distance" && radius) axes.mark = { value: 1e3 * radius, label: phrase(page, "chart.centre") }
    const chart = new Chart(page, axes, changed)
    chart.sheet.canvas.setAttribute("aria-label", `${label} [${unit}]`)
    chart.until = seconds
    chart.spans = acting(script)
    return chart
}

/** When a script holds or pulls a robot; after a reset, times mean something else. */
function acting(script: Script | null): Span[] {
    const found: Span[] = []
    let span: Span | null = null
    for (const [time, action] of [...script?.do ?? []].sort((a, b) => a[0] - b[0])) {
        if (action.reset || action.path !== undefined) break
        const kind = action.hold ? "held" : action.pull ? "pulled" : null
        if (span && (action.hold === false || action.release)) {
            span.until = time
            span = null
        } else if (kind && !span) found.push((span = { from: time, until: script!.until, kind }))
    }
    return found
}

function curveOf(answer: Answer | undefined): { times: number[]; values: number[] } | null {
    return answer?.times && answer.values ? { times: answer.times, values: answer.values } : null
}

/** Whether a draft has a curve that can be drawn. */
function isCurve({ times, values }: Answer): boolean {
    const areNumbers = (list: unknown) => Array.isArray(list) && list.every(Number.isFinite)
    return areNumbers(times) && areNumbers(values) && times!.length > 1 && times!.length === values!.length
}

/** How sure the student is, and why, if stated. */
function beside(element: HTMLElement): Answer {
    const value = (name: string) => element.querySelector<HTMLSelectElement | HTMLTextAreaElement>(name)?.value ?? ""
    const found: Answer = {}
    if (value(".sure")) found.sure = value(".sure") as Answer["sure"]
    if (value(".reason")) found.reason = Number(value(".reason"))
    if (value(".why").trim()) found.why = value(".why").trim().slice(0, 1000)
    return found
}
