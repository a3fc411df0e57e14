// The column of a lesson in the lab: the open step as its server tells it, beside the robots and above the strip.

import type { Action, Command, LessonMessage, MeasuredMessage, PageMessage } from "../channel/messages"
import { elementsOf, isTyped, made } from "../core/dom"
import { keepScroll } from "../core/drafts"
import type { Answer, BlockData, PageData, TaskData } from "../core/lesson_data"
import { phrase, type Texts } from "../core/words"
import type { Verdict } from "../core/shared_data"
import { noNotes, SECOND_TRY } from "../lessons/notes"
import type { Result, Student } from "../lessons/student"
import type { ServerEngine } from "../channel/channel"
import type { AnswerCommand } from "../channel/outbox"
import { Legend } from "./legend"
import { compared } from "./predictions"
import { StepView, type Robots } from "./step"
import { radiusOf } from "./strip"
import { Task } from "./tasks"

type Sent = Command | PageMessage

const END = "end" // the section that stands for the end of a lesson

/** Notes in the lab, where Python judges. */
class RemoteStudent implements Student {
    notes = noNotes()
    readonly name = "" // the server puts options into their order
    changed: () => void = () => {}
    verdicts: Record<string, Verdict[]> = {}

    constructor(private readonly engine: ServerEngine, private readonly page: PageData) {}

    goes(): void {}
    sees(): void {}
    predicts(step: number, { option, times, values, sure, reason, why }: Answer): void {
        const given = { option, times, values, sure, reason, why }
        this.post({ do: "Predict", ...Object.fromEntries(Object.entries(given).filter(([, each]) => each !== undefined)) }, String(step))
    }
    chooses(question: string, option: number): void { this.post({ do: "AnswerQuiz", ...placeOf(question), option }, question) }
    gives(question: string, given: number): void { this.post({ do: "AnswerNumber", ...placeOf(question), given }, question) }
    reads(): void {} // the server shows the hints, and so knows
    writes(question: string, typed: string): void { this.post({ do: "AnswerInWords", block: placeOf(question).block, typed }, question) }
    derives(question: string, row: string): void { this.writes(question, row) } // the server adds it
    way(item: string): "" | "sending" | "sent" {
        if (this.engine.outbox.has(this.page.lesson, item)) return "sending"
        return this.engine.seat?.membership === "member" ? "sent" : ""
    }
    private post(answer: AnswerCommand, item: string): void {
        this.engine.outbox.post(answer, this.page.lesson, Number.parseInt(item))
    }
    result({ id }: TaskData): Result | null {
        const verdicts = this.verdicts[id]
        return verdicts ? { verdicts, run: 0 } : null
    }
}

/** A question's number among the parts of its step, and whether its second try is meant. */
function placeOf(question: string): { block: number; second: boolean } {
    return { block: Number(question.split(".")[1]), second: question.endsWith(SECOND_TRY) }
}

export class Column implements Robots {
    readonly element = made("main", "lesson")
    /** Below the robots: where one draws, and sees what happened. */
    readonly beneath = made("div", "beneath")
    readonly refused = false
    playing = false
    private readonly head = made("div", "head")
    private readonly pager = made("nav", "pager")
    private readonly live = made("p", "op-unseen")
    private readonly student: RemoteStudent
    private readonly page: PageData
    private readonly legend: Legend
    private sections: Record<string, HTMLElement> = {}
    private sources: Record<string, string[]> = {} // HTML of the parts of the sections, as the server sent it
    private place = "" // symbols that mean something on this robot, lesson and step
    private view: StepView | null = null
    private tasks: Task[] = []
    private lent: HTMLElement | null = null
    private turned = false // whether a key has turned the page

    constructor(texts: Texts, private readonly engine: ServerEngine, private readonly isWide: () => boolean,
        light: (symbol: string) => void, ended: AbortSignal) {
        this.page = { words: texts.words, lesson: "", symbols: {}, figures: [], steps: [], lessons: {} }
        this.student = new RemoteStudent(engine, this.page)
        this.element.id = "op-column"
        this.element.hidden = true
        this.pager.ariaLabel = phrase(texts, "lesson.lessons")
        this.live.setAttribute("role", "status")
        this.element.append(this.live)
        this.legend = new Legend(this.page, light, ended)
        this.element.addEventListener("click", event => this.press(event))
        addEventListener("keydown", event => this.key(event), { signal: ended })
        addEventListener("resize", () => this.view?.formulas(), { signal: ended })
        addEventListener("toggle", () => this.view?.formulas(), { signal: ended, capture: true })
        this.student.changed = () => this.show()
    }

    /** Whether the open step has the main thing to press now. */
    get leads(): boolean { return this.open && (this.view?.leads ?? false) }
    /** Whether a lesson is in it. */
    get open(): boolean { return !this.element.hidden && !this.lent }
    get ready(): boolean { return this.engine.connected }

    play(): void {
        this.engine.send({ do: "PlayStep" })
    }

    act(block: number, link: number): void {
        const data = this.page.steps[this.view!.index]!.blocks[block]!
        if (data.kind === "text") this.engine.send({ do: "Act", actions: data.links[link] as Action[] })
    }

    /** Show something else in its place, such as a teacher's class; null: nothing else. */
    lend(element: HTMLElement | null): void {
        if (element === this.lent) return
        this.lent?.remove()
        this.lent = element
        if (element) {
            this.leave("")
            this.element.append(element)
        }
        this.reveal(element !== null)
    }

    private reveal(on: boolean): void {
        this.element.hidden = !on
        document.documentElement.classList.toggle("op-lesson", on)
    }

    /** Show the open step, or what has changed in it. */
    hear(message: LessonMessage): void {
        const { page, student, element } = this
        if (this.lent) return
        this.reveal(message.lesson !== "")
        element.dataset["version"] = String(message.version)
        document.documentElement.classList.remove("op-waits", "op-plays")
        if (!this.open) return this.leave("")
        const place = `${Object.keys(message.symbols).join()} ${message.lesson}.${message.ended ? END : message.index}`
        const isNew = place !== this.place
        const reads = this.turned || element.contains(document.activeElement)
        if (isNew) this.leave(place)
        for (const step of message.steps) for (const block of step.blocks) this.bend(block)
        Object.assign(page, { lesson: message.lesson, symbols: message.symbols, steps: message.steps, test: message.test })
        student.notes = message.notes ?? noNotes()
        this.playing = message.playing
        put(this.head, message.head)
        put(this.pager, message.pager)
        this.fill(message)
        if (isNew) this.begin(reads)
        this.show()
    }

    /** Show verdicts, and draw what is happening. */
    measure({ verdicts, truth }: MeasuredMessage): void {
        this.student.verdicts = verdicts
        for (const task of this.tasks) task.follow()
        if (truth && this.playing) this.view?.draw(truth)
    }

    /** Put the board where the window has room for it. */
    arrange(): void {
        this.view?.place()
        this.view?.formulas()
    }

    private get section(): HTMLElement { return this.sections[this.place.slice(this.place.lastIndexOf(".") + 1)]! }

    private leave(place: string): void {
        this.place = place
        this.legend.clear()
        this.view = null
        this.tasks = []
        for (const section of Object.values(this.sections)) section.remove()
        this.sections = {}
        this.sources = {}
        this.beneath.replaceChildren()
    }

    /** A sketch is drawn on the path that the robots follow. */
    private bend(block: BlockData): void {
        if (block.kind === "sketch") block.radius = radiusOf(this.engine.path.lines[0] ?? [])
    }

    /** Put the sections into the page; in those that are there, parts that have changed are replaced. */
    private fill({ sections, charts, index, ended }: LessonMessage): void {
        const { view } = this
        for (const [name, html] of Object.entries(sections)) {
            const source = elementsOf(html)
            for (const sign of source.querySelectorAll("[data-symbol]")) // without a meaning on this robot
                if (!this.page.symbols[sign.getAttribute("data-symbol")!]) sign.removeAttribute("data-symbol")
            const parts = [...source.children] as HTMLElement[]
            const before = this.sources[name]
            this.sources[name] = parts.map(part => part.outerHTML)
            const isOpen = name === (ended ? END : String(index))
            if (before) this.renew(name, before, parts, isOpen ? view : null)
            else {
                const number = name === END ? 0 : Number(name) + 1
                const words = made("div", "words", ...parts)
                Object.assign(words, { tabIndex: 0, role: "group" })
                words.setAttribute("aria-labelledby", `title-${number}`)
                const section = (this.sections[name] = made("section", `step${isOpen ? " open" : ""}`, words))
                section.id = `step-${number}`
                section.hidden = !isOpen
                this.live.before(section)
            }
        }
        if (!ended && !view) {
            const { section, beneath, isWide } = this
            this.view = new StepView(this.page, index, this.student, this, { section, beneath, isWide })
        }
        this.section.querySelectorAll("[data-chart]").forEach((each, i) => {
            const { data, script, answer, truth } = charts[i]!
            if (!each.childElementCount) each.append(compared(this.page, data, script, answer, truth ?? undefined))
        })
    }

    /** Put the settings into the open step, if there is one. */
    offer(form: HTMLElement): void {
        this.view?.offer(form)
    }

    /** Replace the parts of a section that have changed; the focus stays where it is. */
    private renew(name: string, before: string[], parts: HTMLElement[], view: StepView | null): void {
        const words = this.sections[name]!.querySelector(".words")!
        const known = new Map<string, HTMLElement[]>() // the elements made of each part
        ;[...words.children].filter(each => !isOurs(each)).forEach((each, i) => {
            known.set(before[i]!, [...(known.get(before[i]!) ?? []), each as HTMLElement])
        })
        const focused = document.activeElement, { scrollTop } = words, form = words.querySelector<HTMLElement>(".form")
        const kept = parts.map(part => known.get(part.outerHTML)?.shift() ?? part)
        const gone = [...known.values()].flat()
        const at = gone.find(each => each.contains(focused))
        const place = at ? controlsOf(at).indexOf(focused as HTMLElement) : -1
        for (const each of gone) each.remove()
        let next = words.firstElementChild
        for (const each of kept) { // what stays is not moved, or it would lose the focus
            while (next && next !== each && each.parentElement === words && isOurs(next)) next = next.nextElementSibling
            if (next === each) next = next.nextElementSibling
            else words.insertBefore(each, next)
        }
        if (form && !words.contains(form)) view?.offer(form)
        const fresh = kept.filter(each => parts.includes(each))
        for (const each of fresh) if (each.dataset["block"]) view?.prepare(Number(each.dataset["block"]))
        for (const each of fresh) if (each.dataset["second"]) view?.prepareSecond(each)
        const nameOf = ({ dataset }: HTMLElement) => dataset["block"] ?? dataset["second"]
        const successor = at && kept.find(each => nameOf(each) === nameOf(at))
        if (successor) (controlsOf(successor)[place] ?? successor.querySelector<HTMLElement>("summary, button"))?.focus({ preventScroll: true })
        if (view) this.follow()
        words.scrollTop = scrollTop // the browser has lost what it would keep in its place
    }

    /** A step has been opened, perhaps by a key or by someone whose focus was in the column. */
    private begin(reads: boolean): void {
        const { section, view } = this
        const words = section.querySelector<HTMLElement>(".words")!
        section.prepend(this.head)
        section.append(this.pager)
        if (view) this.legend.add(section)
        this.follow()
        view?.place()
        keepScroll(words, "read", this.place)
        if (reads) words.focus({ preventScroll: true }) // whoever turns the page reads on
        this.turned = false
    }

    /** Follow the tasks of the open step. */
    private follow(): void {
        const { page, view, student } = this
        this.tasks = page.steps[view?.index ?? -1]?.blocks.flatMap((block, i) =>
            block.kind === "task" ? [new Task(page, view!.block(i)!, block, student, () => this.tell(phrase(page, "lesson.passed")))] : [],
        ) ?? []
        for (const task of this.tasks) task.follow()
    }

    private show(): void {
        const { view, pager } = this
        StepView.lead(view, pager.querySelector(".ways")!)
        document.documentElement.classList.toggle("op-waits", view?.waits ?? false)
        document.documentElement.classList.toggle("op-plays", this.playing)
        view?.run()
        view?.formulas()
    }

    tell(text: string): void {
        this.live.textContent = text
    }

    private press(event: MouseEvent): void {
        const sent = (event.target as HTMLElement).closest<HTMLElement>("[data-send]")?.dataset["send"]
        if (!sent) return
        const messages = JSON.parse(sent) as Sent | Sent[]
        for (const message of [messages].flat()) this.engine.send(message)
    }

    /** The keys that turn pages do so in a lesson, unless they are typed into a field. */
    private key(event: KeyboardEvent): void {
        const by = { PageDown: 1, PageUp: -1 }[event.key]
        if (!by || !this.open || isTyped(event) || document.querySelector("[role=dialog]")) return
        event.preventDefault()
        this.turned = true
        this.engine.send({ do: "GoToStep", by })
    }
}

/** Put HTML into an element unless it is there; a focused button is replaced by its successor. */
function put(element: HTMLElement, html: string): void {
    if (element.dataset["html"] === html) return
    element.dataset["html"] = html
    const at = controlsOf(element).indexOf(document.activeElement as HTMLElement)
    element.replaceChildren(elementsOf(html))
    const buttons = controlsOf(element)
    if (at >= 0) buttons[Math.min(at, buttons.length - 1)]?.focus({ preventScroll: true })
}

/** Whether the script has made an element, not the server. */
function isOurs(element: Element): boolean {
    return element.matches(".compared, .judged-by, .symbols, .before, .form")
}

function controlsOf(element: Element): HTMLElement[] {
    return [...element.querySelectorAll<HTMLElement>("button, input, select, textarea, summary")]
}
