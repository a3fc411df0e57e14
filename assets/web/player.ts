// The player of a lesson: one step at a time, in a column beside the robots.

import { made, refused } from "./controls"
import { ask, ordered } from "./asked"
import type { PageData } from "./lesson_data"
import { Legend } from "./legend"
import { given, thinned } from "./notes"
import { said } from "./words"
import { showOwn } from "./own"
import { Comparison, elementOf, predict, predictionAt, type Form, type Prediction } from "./predictions"
import type { Progress } from "./progress"
import { Stage } from "./stage"
import { LocalStudent } from "./student"
import { Task } from "./tasks"

const JUDGED = 500 // [ms] between two looks at the tasks
const SMALLEST = 0.75 // of the size of a formula
const WIDE = matchMedia("(min-width: 60rem)") // as in site.css

export class Player {
    index = 0
    stage: Stage | null = null
    readonly student: LocalStudent
    private readonly sections = [...document.querySelectorAll<HTMLElement>("section.step")]
    private readonly head = document.querySelector<HTMLElement>("#head")!
    private readonly pager = document.querySelector<HTMLElement>("#pager")!
    private readonly next = document.querySelector<HTMLButtonElement>("#next")!
    private readonly back = document.querySelector<HTMLButtonElement>("#back")!
    private readonly bar = [...document.querySelectorAll<HTMLElement>("#progress li")]
    private readonly forms = new Map<number, Form>()
    private readonly legend: Legend
    private tasks: Task[] = []
    private playing = false
    private turn = 0 // so that a figure that arrives late is not shown

    constructor(readonly page: PageData, progress: Progress) {
        this.student = new LocalStudent(page, progress)
        this.legend = new Legend(page, symbol => this.stage?.light(symbol))
        page.steps.forEach((_, i) => this.prepare(i))
        this.student.changed = () => this.show()
        this.next.addEventListener("click", () => this.go(1))
        this.back.addEventListener("click", () => this.go(-1))
        addEventListener("hashchange", () => this.open(this.asked()))
        addEventListener("keydown", event => this.key(event))
        WIDE.addEventListener("change", () => this.place())
        this.turnable()
        addEventListener("resize", () => this.formulas())
        addEventListener("beforeprint", () => this.sections[0]!.before(this.head)) // above all steps
        addEventListener("afterprint", () => this.section.prepend(this.head))
        document.querySelector("main")!.addEventListener("keydown", event => {
            // keys of the focused control are not the figure's
            if ((event.target as HTMLElement).closest("textarea, select, input, summary, a")) event.stopPropagation()
        })
        setInterval(() => this.tasks.forEach(task => task.follow()), JUDGED)
        const asked = this.asked()
        void this.open(asked >= 0 ? asked : Math.min(this.notes.step, page.steps.length), asked >= 0)
    }

    get notes() { return this.student.notes }
    private get section(): HTMLElement { return this.sections[this.index]! }
    /** On a narrow page, lead from the text to the robots and back. */
    private turnable(): void {
        const button = document.querySelector<HTMLButtonElement>("#turn")!
        let seen = false
        const observer = new IntersectionObserver(entries => {
            for (const { target, isIntersecting } of entries) if (this.section.contains(target)) seen = isIntersecting
            button.textContent = said(this.page, seen ? "site.to_text" : "site.to_robots")
        }, { threshold: 0.5 })
        for (const robots of document.querySelectorAll(".step .stage")) observer.observe(robots)
        button.addEventListener("click", () => this.section.querySelector(seen ? ".words" : ".stage")!.scrollIntoView())
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
            this.forms.get(found.step)!.skip()
            if (this.page.steps[this.index]!.kind === "run") return
        }
        void this.open(this.index + by, true)
    }

    private readonly prediction = (index: number): Prediction | null =>
        index < this.page.steps.length ? predictionAt(this.page.steps, index) : null
    private readonly waits = (found: Prediction): boolean => this.notes.answers[String(found.step)] === undefined
    /** Show a step; after the last one comes the end. */
    async open(wanted: number, move = true): Promise<void> {
        const { page, student } = this
        this.index = Math.min(Math.max(wanted, 0), page.steps.length)
        const turn = ++this.turn
        this.stage?.close()
        this.stage = student.recorded = null
        this.tasks = []
        this.playing = false
        student.goes(this.index)
        const { section } = this
        this.sections.forEach((each, i) => {
            each.classList.toggle("open", each === section)
            each.classList.toggle("visited", i < this.notes.seen)
        })
        section.prepend(this.head)
        section.append(this.pager)
        this.place()
        history.replaceState(null, "", `#${this.index + 1}`)
        if (move) {
            const words = section.querySelector<HTMLElement>(".words")!
            words.focus({ preventScroll: true })
            words.scrollTo(0, 0)
            scrollTo(0, 0)
        }
        this.show()
        if (this.index === page.steps.length) return this.end()
        const step = page.steps[this.index]!
        const figure = page.figures[step.figure]
        if (!figure) return this.run() // only the lab shows it
        const into = section.querySelector<HTMLElement>(".stage")!
        let stage: Stage
        try {
            stage = await Stage.open(figure, step.values, into)
        } catch (error) {
            if (turn !== this.turn) return
            into.replaceChildren(refused(figure, error))
            return this.run()
        }
        if (turn !== this.turn) return stage.close()
        this.stage = stage
        student.recorded = stage.simulation
        if (step.kind === "predict" || !step.running) stage.run(false)
        this.tasks = step.blocks.flatMap((block, i) =>
            block.kind === "task" ? [new Task(page, this.block(i), block, student, () => this.tell("lesson.passed"))] : [],
        )
        this.run()
    }

    private readonly block = (place: number, index = this.index): HTMLElement =>
        this.sections[index]!.querySelector<HTMLElement>(`[data-block="${place}"]`)!
    /** Make a step's parts answerable. */
    private prepare(index: number): void {
        const { page, student } = this
        const step = page.steps[index]!
        const section = this.sections[index]!
        section.dataset["kind"] = step.kind
        step.blocks.forEach((block, i) => {
            const element = this.block(i, index)
            const options = element.querySelector(".options")
            if (options) ordered(options, student.name, `${page.lesson} ${index} ${i}`)
            if (block.kind === "text") this.links(element, block.links)
            else if (block.kind === "quiz" || block.kind === "number" || block.kind === "open")
                ask(page, element, block, `${index}.${i}`, student)
        })
        const found = this.prediction(index)
        if (found?.step === index) this.forms.set(index, predict(page, found, student))
        section.querySelector(".play button")?.addEventListener("click", () => this.play())
        this.legend.add(section)
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

    /** Shrink formulas that are wider than the column while they can be read; others are scrolled, also by keys. */
    private formulas(): void {
        for (const formula of this.section.querySelectorAll<MathMLElement>("math[display=block]")) {
            formula.style.fontSize = ""
            const share = formula.clientWidth / formula.scrollWidth
            if (share < 1) formula.style.fontSize = `${Math.max(0.98 * share, SMALLEST)}em`
            formula.tabIndex = formula.scrollWidth > formula.clientWidth ? 0 : -1
        }
    }

    /** Put the board into the strip below the robots or, on a narrow page, below its question. */
    private place(): void {
        const board = this.forms.get(this.index)?.board
        if (!board) return
        if (WIDE.matches) this.section.querySelector(".beneath")!.append(board)
        else elementOf(this.prediction(this.index)!).querySelector(".committing")!.before(board)
    }

    private play(): void {
        const { index, page, stage } = this
        const step = page.steps[index]!
        if (!stage || !step.script) return
        const found = this.prediction(index)
        const quantity = found?.data.kind === "sketch" ? found.data.quantity : "distance"
        const told = this.section.querySelector<HTMLElement>(".play")!
        const line = made("span", "", said(page, "lesson.playing"))
        told.querySelectorAll("span").forEach(each => each.remove())
        if (!this.section.querySelector(".op-watch")) told.append(line)
        this.playing = true
        const comparison = this.comparison(found)
        const draw = () => {
            if (!this.playing || this.stage !== stage) return
            if (found?.data.kind === "sketch") comparison?.draw(stage.simulation.curve(quantity))
            requestAnimationFrame(draw)
        }
        stage.play(step.script, whole => {
            this.playing = false
            line.remove()
            if (!whole) return
            this.student.sees(index, found?.step ?? index, thinned(stage.simulation.curve(quantity)))
            this.run()
        })
        draw()
    }

    /** The chart of a run in the strip, or the verdict in the column. */
    private comparison(found: Prediction | null): Comparison | null {
        const { section } = this
        section.querySelectorAll(".compared").forEach(each => each.remove())
        if (!found || this.waits(found)) return null
        const comparison = new Comparison(this.page, found, this.notes)
        const box = made("div", "compared", ...comparison.elements)
        if (found.data.kind === "sketch") section.querySelector(".beneath")!.append(box)
        else if (!this.happened(this.index)) return null
        else {
            box.classList.add("op-box")
            const play = section.querySelector(".play")
            if (play) play.after(box)
            else section.querySelector(".beside")!.append(box)
        }
        return comparison
    }

    /** Whether a run has been seen; a run that only the lab can play is seen in its picture. */
    private readonly happened = (index: number): boolean =>
        Boolean(this.notes.played[String(index)]) || !this.page.steps[index]!.script
    /** Show of a run what may be seen: nothing before the prediction, the words after it. */
    private run(): void {
        const { page, index, section } = this
        const step = page.steps[index]
        if (!step || step.kind !== "run") return
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
            const reading = made("button", "read", said(page, "lesson.read"))
            reading.type = "button"
            reading.addEventListener("click", () => {
                section.dataset["read"] = "yes"
                this.run()
            })
            told?.append(" ", reading)
        }
        if (this.happened(index) && !waits) this.comparison(found)?.draw(this.notes.truths[String(found!.step)])
    }

    private tell(key: string): void {
        document.querySelector("#live")!.textContent = said(this.page, key)
    }

    /** Show the student's own answers, where the student is, and what comes next. */
    private show(): void {
        const { page, index, next, back, notes, pager } = this
        const { length } = page.steps
        showOwn(page, notes)
        const where = document.querySelector("#where")!
        where.textContent = index < length ? said(page, "lesson.step", { step: String(index + 1), steps: String(length) }) : ""
        this.bar.forEach((each, i) => {
            each.classList.toggle("done", i < notes.seen)
            each.classList.toggle("now", i === index)
        })
        const found = this.prediction(index)
        const waits = found !== null && this.waits(found)
        back.disabled = index === 0
        next.disabled = index === length
        next.textContent = said(page, waits ? "site.skip_short" : index === length - 1 ? "lesson.finish" : "lesson.next")
        next.ariaLabel = waits ? said(page, "lesson.skip") : null
        const seen = index === length || page.steps[index]!.kind !== "run" || this.happened(index)
        next.classList.toggle("main", !waits && seen)
        pager.querySelectorAll(".commit").forEach(each => each.remove())
        const form = this.forms.get(index)
        if (form && !given(notes.answers[String(index)])) pager.append(form.commit)
        if (!this.playing) this.run()
        this.formulas()
    }

    /** Show what was predicted, and what happened. */
    private end(): void {
        const { page, notes } = this
        const words = this.section.querySelector(".words")!
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
