// Questions whose answers are looked up at once: of a quiz, numbers, and in own words.

import { made } from "../standalone/controls"
import { said, type BlockData, type PageData } from "./data"
import type { Notes } from "./notes"

/** The order in which a student sees the options: always the same for one student. */
export function ordered(list: Element, student: string, question: string): void {
    const drawn = [...list.children].map((each, i) => [hash(`${student} ${question} ${i}`), each] as const)
    list.append(...drawn.sort((a, b) => a[0] - b[0]).map(([, each]) => each))
}

/** What was chosen, whether it is right, and why; with the words that stand in the page. */
export function judged(page: PageData, element: Element, right: number, own: number | undefined): HTMLElement {
    const answers = (option: number) => [...element.querySelector(`[data-answer="${option}"]`)!.cloneNode(true).childNodes]
    const lines: HTMLElement[] = []
    if (own !== undefined) {
        const verdict = made("p", own === right ? "right" : "wrong", said(page, own === right ? "lesson.right" : "lesson.not_quite"))
        lines.push(verdict, made("div", "", ...answers(own)))
    }
    if (own !== right) lines.push(made("p", "", made("b", "", said(page, "report.right"))), made("div", "", ...answers(right)))
    return made("div", "judged", ...lines)
}

/** Make a question answerable. */
export function ask(
    page: PageData, element: HTMLElement, block: BlockData, key: string, notes: Notes, changed: () => void,
): void {
    const told = element.querySelector<HTMLElement>(".verdict")!
    const after = element.querySelector<HTMLDetailsElement>(".after")!
    after.hidden = true
    if (block.kind === "quiz") {
        const show = () => {
            const own = notes.quiz[key]
            if (own === undefined) return
            element.querySelector<HTMLInputElement>(`input[value="${own}"]`)!.checked = true
            told.replaceChildren(...judged(page, element, block.right, own).childNodes)
        }
        element.addEventListener("change", event => {
            notes.quiz[key] = Number((event.target as HTMLInputElement).value)
            show()
            changed()
        })
        return show()
    }
    const input = element.querySelector<HTMLInputElement | HTMLTextAreaElement>("input, textarea")!
    const button = made("button", "script-only", said(page, block.kind === "number" ? "answer.check" : "answer.keep"))
    button.type = "button"
    told.before(button)
    const show = () => {
        if (block.kind === "number" && notes.numbers[key] !== undefined) {
            const right = Math.abs(notes.numbers[key] - block.number) <= block.tolerance * (1 + 1e-9)
            told.className = `verdict ${right ? "right" : "wrong"}`
            told.textContent = said(page, right ? "lesson.right" : "lesson.not_quite")
        }
        after.hidden = false
        after.open = true
    }
    if (block.kind === "number" && notes.numbers[key] !== undefined) {
        input.value = String(notes.numbers[key]).replace(".", page.words["point"]!)
        show()
    } else if (block.kind === "open" && notes.written[key]) {
        input.value = notes.written[key]
        show()
    }
    button.addEventListener("click", () => {
        if (block.kind === "number") {
            const given = Number(input.value.trim().replace(page.words["point"]!, ".").replace("−", "-") || NaN)
            if (!Number.isFinite(given)) return void (told.textContent = said(page, "lesson.no_number"))
            notes.numbers[key] = given
        } else if (input.value.trim()) notes.written[key] = input.value.trim().slice(0, 1000)
        else return
        show()
        changed()
    })
}

function hash(text: string): number {
    let value = 2166136261
    for (const letter of text) value = Math.imul(value ^ letter.codePointAt(0)!, 16777619)
    value ^= value >>> 15
    return Math.imul(value, 2246822519) >>> 0
}
