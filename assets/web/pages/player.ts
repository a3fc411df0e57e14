// The player of a lesson: one step at a time, in a column beside the robots.

import { made } from "../core/dom"
import type { Action, PageData, Setting, StepData } from "../core/lesson_data"
import { refused } from "../core/refusal"
import { phrase } from "../core/words"
import { given, passedTasks, predicted } from "../lessons/notes"
import { showOwn } from "../lessons/own"
import type { Progress } from "../lessons/progress"
import { Recorded } from "../lessons/recorded"
import { LocalStudent } from "../lessons/student"
import { ordered } from "../parts/asked"
import { Legend } from "../parts/legend"
import { Comparison, elementOf } from "../parts/predictions"
import { StepView, type Robots } from "../parts/step"
import { Task } from "../parts/tasks"
import { kernelsOf, Stage } from "./stage"

const PHONE = 480 // [px], least width of a step that is not on a telephone
const TALL = 760 // [px], height of a step that leaves room for its text beside robots and plots
const JUDGED = 500 // [ms] between evaluations of the tasks

export class Player implements Robots {
    index = 0
    stage: Stage | null = null
    readonly student: LocalStudent
    private readonly sections = [...document.querySelectorAll<HTMLElement>("section.step")]
    private readonly head = document.querySelector<HTMLElement>("#head")!
    private readonly pager = document.querySelector<HTMLElement>("#pager")!
    private readonly next = document.querySelector<HTMLButtonElement>("#next")!
    private readonly back = document.querySelector<HTMLButtonElement>("#back")!
    private readonly bar = [...document.querySelectorAll<HTMLElement>("#progress li")]
    private readonly views: StepView[]
    private readonly legend: Legend
    private tasks: Task[] = []
    refused = false
    playing = false
    private turn = 0 // so that a figure that arrives late is not shown

    constructor(readonly page: PageData, progress: Progress) {
        this.student = new LocalStudent(page, progress)
        this.legend = new Legend(page, symbol => this.stage?.light(symbol))
        this.views = page.steps.map((_, i) => this.prepared(i))
        this.student.changed = () => this.show()
        this.next.addEventListener("click", () => this.go(1))
        this.back.addEventListener("click", () => this.go(-1))
        addEventListener("hashchange", () => void this.open(this.asked()))
        addEventListener("keydown", event => this.key(event))
        addEventListener("resize", () => {
            this.view?.place()
            this.placePlots()
            this.view?.formulas()
        })
        addEventListener("toggle", () => this.view?.formulas(), { capture: true })
        addEventListener("beforeprint", () => this.sections[0]!.before(this.head)) // above all steps
        addEventListener("afterprint", () => this.section.prepend(this.head))
        document.querySelector("main")!.addEventListener("keydown", event => {
            // keys of the focused control are not the figure's
            if ((event.target as HTMLElement).closest("textarea, select, input, summary, a")) event.stopPropagation()
        })
        setInterval(() => this.judge(), JUDGED)
        const asked = this.asked()
        void this.open(asked >= 0 ? asked : Math.min(this.notes.step, page.steps.length), asked >= 0)
    }

    get notes() { return this.student.notes }
    get ready(): boolean { return this.stage !== null }
    private get section(): HTMLElement { return this.sections[this.index]! }
    /** The open step; undefined at the end. */
    private get view(): StepView | undefined { return this.views[this.index] }
    private readonly asked = (): number => Number(/^#(\d+)$/.exec(location.hash)?.[1] ?? 0) - 1
    private key(event: KeyboardEvent): void {
        const by = { PageDown: 1, PageUp: -1 }[event.key]
        if (!by) return
        event.preventDefault()
        this.go(by)
    }

    /** Go to another step; a prediction that was not made is skipped. */
    private go(by: number): void {
        const { view } = this
        if (by > 0 && view?.waits) {
            this.views[view.prediction!.step]!.form!.skip()
            if (this.page.steps[this.index]!.kind === "run") return
        }
        void this.open(this.index + by, true)
    }

    /** Show a step; after the last one comes the end. */
    async open(wanted: number, move = true): Promise<void> {
        const { page, student } = this
        this.judge()
        this.index = Math.min(Math.max(wanted, 0), page.steps.length)
        const turn = ++this.turn
        this.stage?.close()
        this.stage = student.recorded = null
        this.tasks = []
        this.playing = this.refused = false
        student.goes(this.index)
        const { section } = this
        this.sections.forEach((each, i) => {
            each.classList.toggle("open", each === section)
            each.classList.toggle("visited", i < this.notes.seen)
        })
        section.prepend(this.head)
        section.append(this.pager)
        this.view?.place()
        history.replaceState(null, "", `#${this.index + 1}`)
        if (move) {
            const words = section.querySelector<HTMLElement>(".words")!
            words.focus({ preventScroll: true })
            for (const scrolls of [words, section]) scrolls.scrollTo(0, 0)
        }
        this.show()
        if (this.index === page.steps.length) {
            this.end()
            if ((await this.recall(page.steps.keys())) && turn === this.turn) this.end()
            return
        }
        const step = page.steps[this.index]!
        const figure = page.figures[step.figure]
        if (!figure) return this.run() // only the lab shows it
        const into = section.querySelector<HTMLElement>(".stage")!
        let stage: Stage
        try {
            stage = await Stage.open(figure, step, into)
        } catch (error) {
            if (turn !== this.turn) return
            into.replaceChildren(refused(figure, error))
            this.refused = true
            return this.show()
        }
        if (turn !== this.turn) return stage.close()
        this.put(stage, step)
        student.recorded = stage.simulation
        if (step.kind === "predict" || !step.running) stage.run(false)
        this.tasks = step.blocks.flatMap((block, i) =>
            block.kind === "task" ? [new Task(page, this.block(i), block, student, () => this.tell(phrase(page, "lesson.passed")))] : [],
        )
        this.run()
        if ((await this.recall([this.index])) && turn === this.turn) this.run()
    }

    /** Evaluate the tasks now; also before the record of a run is lost. */
    private judge(): void {
        for (const task of this.tasks) task.follow()
    }

    private put(stage: Stage, step: StepData): void {
        const { page } = this
        this.stage = stage
        this.subdue()
        stage.figure.strip.follows(step)
        if (page.figures[step.figure]!.form.groups.length) this.view?.offer(stage.figure.form.element)
        this.placePlots()
        stage.simulation.ending = () => this.judge()
        stage.simulation.remake = (name, value) => void this.remake(name, value)
    }

    private placePlots(): void {
        const { section } = this
        this.stage?.figure.place(isWide(section) || section.clientWidth >= PHONE, section.clientHeight >= TALL)
    }

    /** Show another robot, with all else as it is; its run begins. */
    private async remake(name: string, value: Setting): Promise<void> {
        const { page, stage, turn, student } = this
        const step = page.steps[this.index]!
        const data = page.figures[step.remade[name]?.[String(value)] ?? -1]
        if (!stage || !data) return
        await kernelsOf(data.module)
        if (turn !== this.turn) return
        const { simulation, figure: { running } } = stage
        stage.close()
        const next = await Stage.open(data, step, this.section.querySelector<HTMLElement>(".stage")!)
        next.simulation.goOnFrom(simulation, name, value)
        this.put(next, step)
        student.goesOn(next.simulation)
        next.figure.changed()
        next.run(running)
    }

    /** Find out what happened in runs that were seen, as far as this visit does not know: curves are not kept, since the page
     * has them or can compute them again. Returns whether anything is new. */
    private async recall(runs: Iterable<number>): Promise<boolean> {
        const { page, notes } = this
        let isNew = false
        for (const index of runs) {
            const { script, truth, values, figure } = page.steps[index]!
            const data = page.figures[figure]
            const { prediction, waits } = this.views[index]!
            if (prediction?.data.kind !== "sketch" || waits || notes.truths[String(prediction.step)]) continue
            let found = index < notes.seen ? truth : undefined
            if (!found && notes.played[String(index)] && script && data)
                found = new Recorded(data, await kernelsOf(data.module), values).played(script, prediction.data.quantity)
            if (!found) continue
            notes.truths[String(prediction.step)] = found
            isNew = true
        }
        return isNew
    }

    private readonly block = (place: number, index = this.index): HTMLElement =>
        this.sections[index]!.querySelector<HTMLElement>(`[data-block="${place}"]`)!

    /** Make a step's parts answerable, with options in the student's order; in a lecture, which is also on paper, in the author's. */
    private prepared(index: number): StepView {
        const { page, student } = this, isLecture = document.body.classList.contains("lecture")
        const section = this.sections[index]!
        page.steps[index]!.blocks.forEach((_, i) => {
            const options = this.block(i, index).querySelector(".options")
            if (options && !isLecture) ordered(options, student.name, `${page.lesson} ${index} ${i}`)
        })
        this.legend.add(section)
        const beneath = section.querySelector<HTMLElement>(".beneath")!
        return new StepView(page, index, student, this, { section, beneath, isWide: () => isWide(section) })
    }

    act(block: number, link: number): void {
        const data = this.page.steps[this.index]!.blocks[block]!
        if (data.kind === "text") this.stage?.act(data.links[link] as Action[])
    }

    play(): void {
        const { index, page, stage, view } = this
        const step = page.steps[index]!
        if (!stage || !step.script || !view) return
        const found = view.prediction
        const quantity = found?.data.kind === "sketch" ? found.data.quantity : "distance"
        this.playing = true
        view.run()
        const draw = () => {
            if (!this.playing || this.stage !== stage) return
            view.draw(stage.simulation.curve(quantity))
            requestAnimationFrame(draw)
        }
        stage.play(step.script, whole => {
            this.playing = false
            if (whole) this.student.sees(index, found?.step ?? index, stage.simulation.curve(quantity))
            this.run()
        })
        draw()
    }

    private run(): void {
        const { page, index, view } = this
        if (page.steps[index]?.truth) void this.recall([index])
        view?.run()
    }

    tell(text: string): void {
        document.querySelector("#live")!.textContent = text
    }

    /** Show the student's own answers, where the student is, and what comes next. */
    private show(): void {
        const { page, index, next, back, notes, pager } = this
        const { length } = page.steps
        showOwn(page, notes)
        const where = document.querySelector("#where")!
        where.textContent = index < length ? phrase(page, "lesson.step", { step: String(index + 1), steps: String(length) }) : ""
        this.bar.forEach((each, i) => {
            each.classList.toggle("done", i < notes.seen)
            each.classList.toggle("now", i === index)
        })
        const { view } = this
        const waits = view?.waits ?? false
        back.disabled = index === 0
        next.disabled = index === length
        next.textContent = phrase(page, waits ? "site.skip_short" : index === length - 1 ? "lesson.finish" : "lesson.next")
        next.ariaLabel = waits ? phrase(page, "lesson.skip") : null
        StepView.lead(view ?? null, pager)
        if (!this.playing) this.run()
        view?.formulas()
        this.subdue()
    }

    /** One main button a moment: the step's own, or the brake. */
    private subdue(): void {
        if (this.stage) this.stage.figure.transport.subdued = this.view?.leads ?? false
    }

    /** Show what was predicted, and what happened. */
    private end(): void {
        const { page, notes } = this
        const words = this.section.querySelector(".words")!
        words.querySelectorAll(".compared").forEach(each => each.remove())
        const tasks = String(Object.keys(passedTasks(notes)).length)
        const counts = { done: String(notes.seen), all: String(page.steps.length), tasks }
        document.querySelector("#counts")!.textContent = phrase(page, "site.done", counts)
        page.steps.forEach((_, i) => {
            const found = this.views[i]!.prediction
            if (found?.step !== i) return
            const question = elementOf(found).querySelector(".question")!.textContent
            const answer = predicted(notes, i)
            const truth = notes.truths[String(i)]
            const comparison = new Comparison(page, found, notes)
            const run = page.steps[i]!.kind === "run" ? i : i + 1
            const happened = truth !== undefined || notes.played[String(run)]
            const skipped = given(answer) ? [] : [made("p", "", phrase(page, "lesson.skipped"))]
            const shown = happened ? comparison.elements : [made("p", "", phrase(page, "report.not_happened"))]
            words.append(made("div", "compared op-box", made("p", "", made("b", "", question)), ...skipped, ...shown))
            if (happened) comparison.draw(truth)
        })
    }
}

/** Whether a step's text is beside the robots. */
function isWide(section: HTMLElement): boolean {
    return getComputedStyle(section).display === "grid"
}
