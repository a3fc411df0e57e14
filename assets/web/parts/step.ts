// A step of a lesson in a column beside the robots, wherever it is played: what it asks is made answerable, and what
// happened stands beside what was predicted.

import { made } from "../core/dom"
import type { BlockData, PageData } from "../core/lesson_data"
import { phrase } from "../core/words"
import { given, givenTo, predicted, SECOND_TRY, type Notes } from "../lessons/notes"
import type { Student } from "../lessons/student"
import { ask, askAgain } from "./asked"
import { derive } from "./derivation"
import { Comparison, elementOf, predict, predictionAt, type Prediction, type PredictionForm } from "./predictions"

const SMALLEST = 0.75 // smallest scale of a formula that is too wide

/** The robots, as far as a step acts on them. */
export interface Robots {
    /** Whether there are any on which the step's script can be played. */
    readonly ready: boolean
    /** Whether there will be none. */
    readonly refused: boolean
    readonly playing: boolean
    play(): void
    /** Say something to those who do not see the page. */
    tell(text: string): void
    /** Perform the actions of a link: its number among those of a text. */
    act(block: number, link: number): void
}

/** Where the parts of a step stand. */
export interface Places {
    /** The column. */
    section: HTMLElement
    /** The place of a chart below the robots. */
    beneath: HTMLElement
    /** Whether there is room below the robots to draw on. */
    isWide(): boolean
}

export class StepView {
    /** The form of a prediction that is asked here. */
    form: PredictionForm | null = null
    private readonly asked = new Map<string, () => void>() // by block, or by item of a second try: shows the answer to a question
    private compared: Comparison | null = null
    private shown = "" // what it compares
    private played = false // whether the run was on when it was last looked at
    private readonly button: HTMLButtonElement | null // plays the run
    private readonly skip = made("button", "without") // the way past it
    private reads = false // whether the text is read without it

    constructor(
        private readonly page: PageData,
        readonly index: number,
        private readonly student: Student,
        private readonly robots: Robots,
        private readonly places: Places,
    ) {
        const { section } = places
        section.dataset["kind"] = page.steps[index]!.kind
        page.steps[index]!.blocks.forEach((_, i) => this.prepare(i))
        section.querySelectorAll<HTMLElement>("[data-second]").forEach(each => this.prepareSecond(each))
        this.button = section.querySelector(".play button")
        this.button?.addEventListener("click", () => robots.play())
        Object.assign(this.skip, { type: "button", textContent: phrase(page, "lesson.skip_run") })
        this.skip.addEventListener("click", () => {
            this.reads = true
            this.run()
            student.changed()
            section.querySelector<HTMLElement>(".words")!.focus({ preventScroll: true })
        })
    }

    /** Make a part answerable. */
    prepare(place: number): void {
        const { page, index, student, prediction } = this
        const block = page.steps[index]!.blocks[place]!
        const element = this.block(place)
        if (!element) return // for other answers
        if (block.kind === "text") this.links(element, place, block.links)
        else if (block.kind === "quiz" || block.kind === "number" || block.kind === "open")
            this.asked.set(String(place), ask(page, element, block, `${index}.${place}`, student))
        else if (block.kind === "derivation") this.asked.set(String(place), derive(page, element, block, `${index}.${place}`, student))
        else if (prediction?.step === index && prediction.block === place) {
            const before = this.form
            before?.board?.remove()
            this.form = predict(page, prediction, student)
            if (before) this.place()
        }
    }

    /** Make the second try at a question answerable: of a quiz in the step, or of the prediction that it shows. */
    prepareSecond(element: HTMLElement): void {
        const { page, student, prediction } = this
        const place = element.dataset["second"]!, [at, i] = place.split(".").map(Number)
        const data = page.steps[at!]?.blocks[i!]
        if (!data || !("second" in data) || !data.second) return
        const isPredicted = data.kind === "choice", key = `${place}${SECOND_TRY}`
        const question = isPredicted && prediction ? elementOf(prediction) : this.block(i!)!
        const isMissed = () => {
            if (isPredicted && (this.waits || !this.happened || this.robots.playing)) return false
            const own = isPredicted ? [predicted(this.notes, at!)] : givenTo(this.notes, place).map(each => each.answer)
            const options = own.map(each => each?.option).filter(each => typeof each === "number")
            return options.length > 0 && !options.includes(data.right ?? NaN)
        }
        this.asked.set(key, askAgain(page, element, { element: question, data, isMissed }, key, student))
    }

    /** The element of a part. */
    block(place: number): HTMLElement | null {
        return this.places.section.querySelector<HTMLElement>(`[data-block="${place}"]`)
    }

    private get notes(): Notes { return this.student.notes }
    /** What is predicted here; what is right is known only after the run. */
    get prediction(): Prediction | null { return predictionAt(this.page.steps, this.index) }
    /** Whether a prediction is pending. */
    get waits(): boolean { return this.prediction !== null && predicted(this.notes, this.prediction.step) === undefined }
    /** Whether its own prediction was committed. */
    get committed(): boolean { return given(predicted(this.notes, this.index)) }
    /** Whether the text is read without the run: by choice, or because there are no robots. */
    private get without(): boolean { return this.reads || this.robots.refused }
    /** Whether its run is the next thing to see: it has not been seen, and is not read without. */
    private get isDue(): boolean { return this.page.steps[this.index]!.kind === "run" && !this.happened && !this.without }
    /** Whether the main thing to press now is the step's own: to commit its prediction, or to let it happen. */
    get leads(): boolean { return (this.form !== null && !this.committed) || this.isDue }
    /** Put the main button of the step, if it has one now, where one turns the page, and take away another step's; until its
     * run is seen or skipped, Next is not there. */
    static lead(view: StepView | null, ways: HTMLElement): void {
        const commit = view?.committed ? undefined : view?.form?.commit
        const plays = view !== null && view.isDue && !view.waits && !commit
        const wanted = plays ? [view.skip, view.button] : commit ? [commit] : []
        for (const each of ways.querySelectorAll<HTMLButtonElement>(".lead, .without")) if (!wanted.includes(each)) each.remove()
        for (const each of wanted) if (each && each.parentElement !== ways) ways.append(each)
        for (const name of ["lead", "main"]) view?.button?.classList.toggle(name, plays)
        const play = view?.places.section.querySelector(".play")
        if (view?.button && !plays && view.button.parentElement !== play) play!.prepend(view.button) // moved, it would lose the focus
        const next = ways.querySelector<HTMLButtonElement>("span ~ button:not(.lead, .without)")
        if (!next) return
        if (plays && next === document.activeElement) view.button?.focus()
        next.hidden = plays
        next.classList.toggle("main", !wanted.length && !view?.waits)
    }

    /** Whether the step's run has been seen; a run that only the lab can play is seen in its picture. */
    get happened(): boolean {
        return Boolean(this.notes.played[String(this.index)]) || !this.page.steps[this.index]!.script
    }

    /** Put the settings that the step needs below the text of its first task, or else before its first question. */
    offer(form: HTMLElement): void {
        const { blocks } = this.page.steps[this.index]!
        const place = (wanted: (block: BlockData) => boolean) => this.block(blocks.findIndex(wanted))
        const text = place(({ kind }) => kind === "task")?.firstElementChild
        const question = place(({ kind }) => kind !== "text")
        if (text) text.after(form)
        else if (question) question.before(form)
        else this.places.section.querySelector(".words")!.append(form)
    }

    /** Put the board into the strip below the robots or, on a narrow page, below its question. */
    place(): void {
        const { board } = this.form ?? {}
        if (!board) return
        const { beneath } = this.places
        const asked = elementOf(this.prediction!).querySelector(".committing")!
        const isWide = this.places.isWide()
        if (isWide ? board.parentElement === beneath : board.nextElementSibling === asked) return
        if (isWide) beneath.append(board)
        else asked.before(board)
        dispatchEvent(new Event("resize"))
    }

    /** Shrink formulas that are wider than the column while they can be read; others, and those in a text, are scrolled, also
     * by keys. */
    formulas(): void {
        const formulas = [...this.places.section.querySelectorAll<MathMLElement>("math[display=block]")]
        for (const { style } of formulas) style.fontSize = ""
        const shares = formulas.map(each => each.clientWidth / each.scrollWidth) // one layout for all
        formulas.forEach(({ style }, i) => { if (shares[i]! < 1) style.fontSize = `${Math.max(0.98 * shares[i]!, SMALLEST)}em` })
        const scrolled = formulas.map(each => each.scrollWidth > each.clientWidth)
        formulas.forEach((each, i) => (each.tabIndex = scrolled[i] ? 0 : -1))
        const within = [...this.places.section.querySelectorAll<HTMLElement>(".math.inline:not(td *)")]
        for (const formula of within) formula.classList.remove("long")
        const isLong = within.map(formula => formula.offsetWidth > formula.closest("p, li, div")!.clientWidth)
        within.forEach((formula, i) => {
            formula.classList.toggle("long", isLong[i])
            if (isLong[i]) formula.tabIndex = 0
            else formula.removeAttribute("tabindex")
        })
    }

    /** Show what was committed, and as much of a run as may be seen: nothing before the prediction is made, the text
     * after it. */
    run(): void {
        const { page, index, notes, robots, prediction } = this
        const { section } = this.places
        const step = page.steps[index]!
        this.form?.show()
        for (const show of this.asked.values()) show()
        if (step.kind !== "run") return
        const told = section.querySelector<HTMLElement>(".play")
        const { waits, happened, button } = this
        if (button) {
            button.disabled = waits || !robots.ready
            button.hidden = robots.playing || robots.refused
            button.textContent = phrase(page, notes.played[String(index)] ? "lesson.replay" : "lesson.play")
        }
        section.querySelector(".before")?.remove()
        if (waits) (told ?? section.querySelector("h2"))!.after(made("p", "before op-text", phrase(page, "lesson.predict_before")))
        told?.querySelectorAll("span").forEach(each => each.remove())
        if (robots.playing && !section.querySelector(".op-watch")) told?.append(made("span", "", phrase(page, "lesson.playing")))
        const open = !waits && (happened || this.without)
        section.classList.toggle("veiled", !open)
        if (step.script) section.querySelector(".still")?.classList.toggle("always", open && !robots.ready)
        this.compare()
        if (this.played && happened && !robots.playing)
            robots.tell([phrase(page, "lesson.happened"), ...this.compared?.words ?? []].join(" "))
        this.played = robots.playing
        section.querySelector(".judged-by")?.remove()
        if (!happened || waits || robots.playing) return
        const truth = notes.truths[String(prediction?.step)]
        this.draw(truth)
        const seen = this.compared?.seen(truth)
        if (seen) this.beside(made("div", "judged-by op-box", seen))
    }

    /** Draw what is happening, or has happened, beside what was predicted. */
    draw(truth: Notes["truths"][string] | undefined): void {
        this.compared?.draw(truth)
    }

    /** The chart of a run in the strip, or the verdict in the column. */
    private compare(): void {
        const { page, prediction, notes, robots } = this
        const { section, beneath } = this.places
        const sketched = prediction?.data.kind === "sketch"
        const due = prediction !== null && !this.waits && (sketched || (this.happened && !robots.playing))
        const shown = due ? JSON.stringify([predicted(notes, prediction.step), page.steps[prediction.step]!.blocks]) : ""
        if (shown === this.shown) return // an open table stays open
        this.shown = shown
        for (const place of [section, beneath]) place.querySelectorAll(".compared").forEach(each => each.remove())
        this.compared = null
        if (!due) return
        this.compared = new Comparison(page, prediction, notes)
        const box = made("div", "compared", ...this.compared.elements)
        if (sketched) return beneath.append(box)
        box.classList.add("op-box")
        this.beside(box)
    }

    /** Put what has become of a prediction below the button that plays its run. */
    private beside(box: HTMLElement): void {
        const { section } = this.places, play = section.querySelector(".play")
        if (play) play.after(box)
        else (section.querySelector(".beside") ?? section.querySelector(".words")!).append(box)
    }

    private links(element: HTMLElement, place: number, links: (unknown[] | null)[]): void {
        element.querySelectorAll<HTMLButtonElement>("button[data-link]").forEach((button, i) => {
            if (!links[i]) {
                button.disabled = true
                button.append(` (${phrase(this.page, "site.link_only_lab")})`)
            }
            button.addEventListener("click", () => this.robots.act(place, i))
        })
    }
}
