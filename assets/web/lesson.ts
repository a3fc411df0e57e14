// The page of a lesson: one step at a time, with its figure.

import { made, refused } from "./controls"
import { ask, ordered } from "./asked"
import type { PageData } from "./lesson_data"
import { said } from "./words"
import { gradeOf } from "./grade"
import { given, keep, notesOf, thinned, type Notes } from "./notes"
import { showOwn } from "./own"
import { Comparison, elementOf, predict, predictionAt, type Prediction } from "./predictions"
import type { Progress } from "./progress"
import { Stage } from "./stage"
import { Task } from "./tasks"

const JUDGED = 500 // [ms] between two looks at the tasks

export class LessonPage {
    index = 0
    stage: Stage | null = null
    readonly notes: Notes
    private readonly sections = [...document.querySelectorAll<HTMLElement>("section.step")]
    private readonly next = document.querySelector<HTMLButtonElement>("#next")!
    private readonly back = document.querySelector<HTMLButtonElement>("#back")!
    private tasks: Task[] = []
    private turn = 0 // so that a figure that arrives late is not shown

    constructor(readonly page: PageData, private readonly progress: Progress) {
        this.notes = notesOf(progress, page.lesson)
        this.page.steps.forEach((_, i) => this.prepare(i))
        this.next.addEventListener("click", () => this.go(1))
        this.back.addEventListener("click", () => this.go(-1))
        addEventListener("hashchange", () => this.open(this.asked()))
        addEventListener("keydown", event => this.key(event))
        document.querySelector("main")!.addEventListener("keydown", event => {
            // keys of the focused control are not the figure's
            if ((event.target as HTMLElement).closest("textarea, select, input, summary, a")) event.stopPropagation()
        })
        setInterval(() => this.follow(), JUDGED)
        const asked = this.asked()
        void this.open(asked >= 0 ? asked : Math.min(this.notes.step, page.steps.length), asked >= 0)
    }

    private readonly asked = (): number => Number(/^#(\d+)$/.exec(location.hash)?.[1] ?? 0) - 1
    private key(event: KeyboardEvent): void {
        const by = { PageDown: 1, PageUp: -1 }[event.key]
        if (!by) return
        event.preventDefault()
        this.go(by)
    }

    /** Go to another step; a prediction that was not made is skipped. */
    private go(by: number): void {
        const found = this.prediction(this.index)
        if (by > 0 && found && this.waits(found)) {
            elementOf(found).dispatchEvent(new Event("skip"))
            if (this.page.steps[this.index]!.kind === "run") return
        }
        void this.open(this.index + by, true)
    }

    private readonly prediction = (index: number): Prediction | null =>
        index < this.page.steps.length ? predictionAt(this.page.steps, index) : null
    private readonly waits = (found: Prediction): boolean => this.notes.answers[String(found.step)] === undefined
    /** Show a step; after the last one comes the end. */
    async open(wanted: number, move = true): Promise<void> {
        const { page, notes } = this
        this.index = Math.min(Math.max(wanted, 0), page.steps.length)
        const turn = ++this.turn
        this.stage?.close()
        this.stage = null
        this.tasks = []
        notes.step = this.index
        notes.seen = Math.max(notes.seen, Math.min(this.index + 1, page.steps.length))
        const section = this.sections[this.index]!
        this.sections.forEach((each, i) => {
            each.classList.toggle("open", each === section)
            each.classList.toggle("seen", i < notes.seen)
        })
        history.replaceState(null, "", `#${this.index + 1}`)
        if (move) {
            section.focus({ preventScroll: true })
            scrollTo(0, 0)
        }
        this.save()
        this.marks()
        if (this.index === page.steps.length) return this.end()
        const step = page.steps[this.index]!
        const figure = page.figures[step.figure]
        if (!figure) return this.shown() // only the lab shows it
        const into = section.querySelector<HTMLElement>(".stage")!
        let stage: Stage
        try {
            stage = await Stage.open(figure, step.values, into)
        } catch (error) {
            if (turn !== this.turn) return
            into.replaceChildren(refused(figure, error))
            return this.shown()
        }
        if (turn !== this.turn) return stage.close()
        this.stage = stage
        if (step.kind === "predict" || !step.running) stage.run(false)
        this.tasks = step.blocks.flatMap((block, i) =>
            block.kind === "task" ? [new Task(page, this.block(i), block, notes, line => this.told(line))] : [],
        )
        this.shown()
    }

    private readonly block = (place: number, index = this.index): HTMLElement =>
        this.sections[index]!.querySelector<HTMLElement>(`[data-block="${place}"]`)!
    /** Make a step's parts answerable. */
    private prepare(index: number): void {
        const { page, notes } = this
        const step = page.steps[index]!
        const section = this.sections[index]!
        section.dataset["kind"] = step.kind
        const student = this.student()
        step.blocks.forEach((block, i) => {
            const element = this.block(i, index)
            const options = element.querySelector(".options")
            if (options) ordered(options, student, `${page.lesson} ${index} ${i}`)
            if (block.kind === "text") this.links(element, block.links)
            else if (block.kind === "quiz" || block.kind === "number" || block.kind === "open")
                ask(page, element, block, `${index}.${i}`, notes, () => this.save())
        })
        const found = this.prediction(index)
        if (found?.step === index)
            predict(page, found, notes, () => {
                this.save()
                this.marks()
                this.shown()
            })
        section.querySelector(".play button")?.addEventListener("click", () => this.play())
    }

    private links(element: HTMLElement, links: (unknown[] | null)[]): void {
        element.querySelectorAll<HTMLButtonElement>("button[data-link]").forEach((button, i) => {
            const acts = links[i]
            if (!acts) {
                button.disabled = true
                button.append(` (${said(this.page, "site.link_only_lab")})`)
            }
            button.addEventListener("click", () => this.stage?.act(acts as never))
        })
    }

    private student(): string {
        const kept = this.progress.get("student") ?? crypto.getRandomValues(new Uint32Array(2)).join("-")
        this.progress.set("student", kept)
        return kept
    }

    private play(): void {
        const { index, page, stage, notes } = this
        const step = page.steps[index]!
        if (!stage || !step.script) return
        const found = this.prediction(index)
        const quantity = found?.data.kind === "sketch" ? found.data.quantity : "distance"
        const told = this.sections[index]!.querySelector<HTMLElement>(".play")!
        const line = made("span", "", said(page, "lesson.playing"))
        told.querySelectorAll("span").forEach(each => each.remove())
        told.append(line)
        let playing = true
        const comparison = this.comparison(found)
        const draw = () => {
            if (!playing || this.stage !== stage) return
            if (found?.data.kind === "sketch") comparison?.draw(stage.simulation.curve(quantity))
            requestAnimationFrame(draw)
        }
        stage.play(step.script, whole => {
            playing = false
            line.remove()
            if (!whole) return
            notes.truths[String(found?.step ?? index)] = thinned(stage.simulation.curve(quantity))
            notes.played[String(index)] = true
            this.save()
            this.shown()
        })
        draw()
    }

    /** The chart or the verdict of a run, beside its figure. */
    private comparison(found: Prediction | null): Comparison | null {
        const beside = this.sections[this.index]!.querySelector<HTMLElement>(".beside")!
        beside.querySelector(".compared")?.remove()
        if (!found || this.waits(found)) return null
        const comparison = new Comparison(this.page, found, this.notes)
        if (found.data.kind !== "sketch" && !this.happened(this.index)) return null
        const place = found.data.kind === "sketch" ? beside : this.sections[this.index]!.querySelector<HTMLElement>(".play") ?? beside
        place.parentElement!.querySelectorAll(".compared").forEach(each => each.remove())
        const box = made("div", "compared op-box", ...comparison.elements)
        if (place === beside) beside.append(box)
        else place.after(box)
        return comparison
    }

    /** Whether a run has been seen; a run that only the lab can play is seen in its picture. */
    private readonly happened = (index: number): boolean =>
        Boolean(this.notes.played[String(index)]) || !this.page.steps[index]!.script
    /** Show of a run what may be seen: nothing before the prediction, the words after it. */
    private shown(): void {
        const { page, index } = this
        const step = page.steps[index]
        if (!step || step.kind !== "run") return
        const section = this.sections[index]!
        const found = this.prediction(index)
        const waits = found !== null && this.waits(found)
        if (step.truth && !waits) this.notes.truths[String(found?.step ?? index)] = step.truth
        const told = section.querySelector<HTMLElement>(".play")
        const button = told?.querySelector<HTMLButtonElement>("button.main")
        if (button) {
            button.disabled = waits || !this.stage
            button.textContent = said(page, this.notes.played[String(index)] ? "lesson.replay" : "lesson.play")
        }
        section.querySelector(".before")?.remove()
        if (waits) (told ?? section.querySelector("h2"))!.after(made("p", "before op-text", said(page, "lesson.predict_before")))
        const read = section.dataset["read"] === "yes"
        const open = !waits && (this.happened(index) || read)
        section.classList.toggle("veiled", !open)
        if (step.script) section.querySelector(".still")?.classList.toggle("always", open && !this.stage)
        section.querySelector(".read")?.remove()
        if (!open && !waits) {
            const button = made("button", "read", said(page, "lesson.read"))
            button.type = "button"
            button.addEventListener("click", () => {
                section.dataset["read"] = "yes"
                this.shown()
            })
            told?.append(" ", button)
        }
        if (this.happened(index) && !waits) this.comparison(found)?.draw(this.notes.truths[String(found!.step)])
    }

    private readonly follow = () => this.tasks.forEach(task => this.stage && task.follow(this.stage.simulation))
    private told(line: string): void {
        this.save()
        if (line) document.querySelector("#live")!.textContent = line
    }

    private save(): void {
        const { page, notes, progress } = this
        keep(progress, page.lesson, notes)
        showOwn(page, notes)
        progress.grade(gradeOf(page.steps, notes))
    }

    /** Show where the student is. */
    private marks(): void {
        const { page, index, next, back } = this
        const { length } = page.steps
        const where = document.querySelector("#where")!
        where.textContent = index < length ? said(page, "lesson.step", { step: String(index + 1), steps: String(length) }) : ""
        const found = this.prediction(index)
        back.disabled = index === 0
        next.disabled = index === length
        const skips = found !== null && this.waits(found)
        next.textContent = said(page, skips ? "lesson.skip" : index === length - 1 ? "lesson.finish" : "lesson.next")
    }

    /** Show what was predicted, and what happened. */
    private end(): void {
        const { page, notes } = this
        const words = this.sections[this.index]!.querySelector(".words")!
        words.querySelectorAll(".compared").forEach(each => each.remove())
        const tasks = String(Object.keys(notes.tasks).length)
        const counts = { done: String(notes.seen), all: String(page.steps.length), tasks }
        document.querySelector("#counts")!.textContent = said(page, "site.done", counts)
        page.steps.forEach((_, i) => {
            const found = this.prediction(i)
            if (found?.step !== i) return
            const question = elementOf(found).querySelector(".question")!.textContent!
            const answer = notes.answers[String(i)]
            const truth = notes.truths[String(i)]
            const comparison = new Comparison(page, found, notes)
            const run = page.steps[i]!.kind === "run" ? i : i + 1
            const happened = truth !== undefined || notes.played[String(run)]
            const skipped = given(answer) ? [] : [made("p", "", said(page, "lesson.skipped"))]
            const shown = happened ? comparison.elements : [made("p", "", said(page, "report.not_happened"))]
            words.append(made("div", "compared op-box", made("p", "", made("b", "", question)), ...skipped, ...shown))
            if (happened) comparison.draw(truth)
        })
    }
}
