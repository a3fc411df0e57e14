// Questions that are answered at once: quizzes, numbers, and open questions.

import { made } from "../core/dom"
import { draftOf, keepDraft } from "../core/drafts"
import type { BlockData, ChoiceData, PageData } from "../core/lesson_data"
import { localized, phrase } from "../core/words"
import { givenTo, lastSaid } from "../lessons/notes"
import { accepted, known } from "../lessons/own"
import type { Student } from "../lessons/student"

/** The order of the options for a student, which is always the same. */
export function ordered(list: Element, student: string, question: string): void {
    const drawn = [...list.children].map((each, i) => [hash(`${student} ${question} ${i}`), each] as const)
    list.append(...drawn.sort((a, b) => a[0] - b[0]).map(([, each]) => each))
}

/** Show what was chosen, whether it is right, and why, with texts from the page. */
export function judged(page: PageData, element: Element, right: number | undefined, own: number | undefined): HTMLElement {
    if (right === undefined) return made("div", "judged") // not told yet
    const answers = (option: number) => [...element.querySelector(`[data-answer="${option}"]`)!.cloneNode(true).childNodes]
    const lines: HTMLElement[] = []
    if (own !== undefined) {
        const verdict = made("p", own === right ? "right" : "wrong", phrase(page, own === right ? "lesson.right" : "lesson.not_quite"))
        lines.push(verdict, made("div", "", ...answers(own)))
    }
    if (own !== right) lines.push(...rightOne(page, element, right))
    return made("div", "judged", ...lines)
}

/** What is said to a first answer that is wrong, before the right one is shown. */
export function repliedTo(page: PageData, reply: Element | null, followed = false): HTMLElement[] {
    const own = [...reply?.cloneNode(true).childNodes ?? []]
    const lines = [made("p", "wrong", phrase(page, "lesson.not_quite"))]
    if (own.length) lines.push(made("div", "", ...own))
    return followed ? lines : [...lines, made("p", "", phrase(page, "lesson.once_more"))]
}

/** Which option of a question is right, and why. */
function rightOne(page: PageData, element: Element, right: number, title = "report.right"): HTMLElement[] {
    const answer = element.querySelector(`[data-answer="${right}"]`)!.cloneNode(true)
    return [made("p", "", made("b", "", phrase(page, title))), made("div", "", ...answer.childNodes)]
}

/** Make the second try at a question answerable, which is asked once the question was missed. Its answer is followed by
 * what was right there. Returns what shows it. */
export function askAgain(page: PageData, element: HTMLElement, question: { element: HTMLElement; data: ChoiceData; isMissed: () => boolean }, key: string,
    student: Student): () => void {
    const { data } = question
    const show = ask(page, element, data.second!, key, student, () => (data.right === undefined ? [] : rightOne(page, question.element, data.right, "answer.before")))
    const reveal = () => {
        element.hidden = !question.isMissed()
        show()
    }
    reveal()
    return reveal
}

/** Make a question answerable. Returns what shows the answer, or what has become of it.
 * @param more of a second try: what stands below the answer to it. */
export function ask(page: PageData, element: HTMLElement, block: BlockData, key: string, student: Student, more?: () => HTMLElement[]): () => void {
    const told = element.querySelector<HTMLElement>(".verdict")!
    const after = element.querySelector<HTMLDetailsElement>(".after") // a lab sends it with its verdict
    if (after) after.hidden = true
    const below = made("div", "judged") // what was right before, after another number
    if (more) element.append(below)
    const input = element.querySelector<HTMLInputElement | HTMLTextAreaElement>("input, textarea")!
    const button = made("button", "script-only", phrase(page, block.kind === "open" || page.test ? "answer.keep" : "answer.check"))
    button.type = "button"
    told.before(button)
    const followed = "followed" in block && block.followed === true
    if (block.kind !== "open" && !page.test && !("uncounted" in block && block.uncounted))
        button.after(" ", made("span", "price", phrase(page, more ? "answer.price_second" : followed ? "answer.price_followed" : "answer.price")))
    let shown: unknown, wasSending = false // the answer that is judged
    const kept = () => lastSaid(student.notes, key)
    const show = () => {
        const own = kept(), way = student.way(key), isSending = way === "sending"
        button.disabled = isSending
        if (isSending) {
            told.textContent = phrase(page, "answer.sending")
            shown = undefined
        } else if (wasSending) told.textContent = ""
        wasSending = isSending
        if (isSending || own === undefined || own === shown) return
        shown = own
        if (page.test || ("voted" in block && block.voted)) { // nobody is told yet what is right
            if (way) told.textContent = phrase(page, "answer.sent")
            return
        }
        const first = (givenTo(student.notes, key).at(-1)?.attempt ?? 1) === 1
        if (more || (followed && block.right !== own)) close()
        if (block.kind === "quiz") {
            const isOpen = block.right === undefined || ((first || followed) && own !== block.right)
            if (isOpen) return told.replaceChildren(...repliedTo(page, element.querySelector(`[data-answer="${own}"]`), followed))
            return told.replaceChildren(...judged(page, element, block.right, own as number).childNodes, ...more?.() ?? [])
        }
        if (block.kind === "number") {
            const right = block.number !== undefined && accepted(own as number, block)
            told.className = "verdict"
            if (block.number === undefined || (first && !right)) {
                if (after) after.hidden = true
                const wrong = block.number === undefined ? "" : `="${known(own as number, block)}"` // a lab has sent the only one
                return told.replaceChildren(...repliedTo(page, element.querySelector(`[data-answer${wrong}]`)))
            }
            told.replaceChildren(made("p", right ? "right" : "wrong", phrase(page, right ? "lesson.right" : "lesson.not_quite")))
        }
        if (!after) return
        after.hidden = false
        after.open = true
        below.replaceChildren(...more?.() ?? [])
    }
    const close = () => { // it cannot be answered otherwise
        button.hidden = true
        element.querySelectorAll("input").forEach(each => (each.disabled = true))
    }
    const own = kept()
    if (own !== undefined) {
        if (block.kind === "quiz") element.querySelector<HTMLInputElement>(`input[value="${own}"]`)!.checked = true
        else input.value = block.kind === "number" ? localized(String(own), page) : String(own)
        show()
    }
    const name = `${page.lesson} ${key}`
    const typed = () => (block.kind === "quiz" ? element.querySelector<HTMLInputElement>("input:checked")?.value ?? "" : input.value)
    const draft = own === undefined ? draftOf<{ typed: string }>(name) : null
    if (typeof draft?.typed === "string") {
        if (block.kind !== "quiz") input.value = draft.typed
        else element.querySelectorAll("input").forEach(each => (each.checked = each.value === draft.typed))
    }
    element.addEventListener("input", () => keepDraft(name, { typed: typed() }))
    input.addEventListener("keydown", event => {
        if (block.kind === "number" && (event as KeyboardEvent).key === "Enter") button.click()
    })
    button.addEventListener("click", () => {
        if (block.kind === "quiz") {
            const chosen = element.querySelector<HTMLInputElement>("input:checked")
            if (!chosen) return
            student.chooses(key, Number(chosen.value))
        } else if (block.kind === "number") {
            const given = Number(input.value.trim().replace(page.words["point"]!, ".").replace("−", "-") || NaN)
            if (!Number.isFinite(given)) {
                told.textContent = phrase(page, "lesson.no_number")
                return
            }
            student.gives(key, given)
        } else if (input.value.trim()) student.writes(key, input.value.trim().slice(0, 1000))
        else return
        keepDraft(name, null)
        shown = undefined
        show()
    })
    return show
}

function hash(text: string): number {
    let value = 2166136261
    for (const letter of text) value = Math.imul(value ^ letter.codePointAt(0)!, 16777619)
    return Math.imul(value ^ (value >>> 15), 2246822519) >>> 0
}
