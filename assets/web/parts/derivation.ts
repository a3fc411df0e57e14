// A derivation: one line after the other is typed, and answered at once.

import { made } from "../core/dom"
import { draftOf, keepDraft } from "../core/drafts"
import type { DerivationData, LineState, PageData } from "../core/lesson_data"
import { phrase } from "../core/words"
import { statesOf } from "../lessons/derivation"
import { lastSaid } from "../lessons/notes"
import type { Student } from "../lessons/student"
import { readFormula, Refused } from "../lessons/typed"

/** Make a derivation answerable. Returns what shows what has become of it. */
export function derive(page: PageData, element: HTMLElement, data: DerivationData, key: string, student: Student): () => void {
    const [step, place] = key.split(".").map(Number)
    const states = (): LineState[] => { // a lab tells them again after each answer
        const block = page.steps[step!]!.blocks[place!]!
        return statesOf(block.kind === "derivation" ? block : data, String(lastSaid(student.notes, key) ?? ""))
    }
    const lines = [...element.querySelectorAll<HTMLElement>("[data-line]")]
    const after = element.querySelector<HTMLDetailsElement>(":scope > .after")
    const told = element.querySelector<HTMLElement>(":scope > .verdict")!
    const name = `${page.lesson} ${key}`
    const open = () => states().findIndex(state => !state.closed)
    const inputs = lines.map((line, i) => {
        const input = line.querySelector("input")!
        const button = made("button", "script-only", phrase(page, "answer.check"))
        button.type = "button"
        input.closest("label")!.after(" ", button)
        const give = () => {
            const row = input.value.trim()
            const fault = row ? refused(page, row, data) : null
            line.querySelector(".told")!.replaceChildren(...fault ? [marked(row, fault.place), made("p", "", fault.text)] : [])
            if (!row || fault || open() !== i) return
            keepDraft(name, null)
            student.derives(key, row)
            show()
        }
        button.addEventListener("click", give)
        input.addEventListener("keydown", event => {
            if (event.key === "Enter") give()
        })
        input.addEventListener("input", () => keepDraft(name, { line: i, typed: input.value }))
        return input
    })
    const draft = draftOf<{ line: number; typed: string }>(name)
    const drafted = inputs[draft?.line ?? -1]
    if (drafted && typeof draft?.typed === "string") drafted.value = draft.typed
    let shown = ""
    const show = () => {
        const isSending = student.way(key) === "sending"
        told.textContent = isSending ? phrase(page, "answer.sending") : ""
        const found = states(), now = JSON.stringify(found)
        if (now === shown) return
        shown = now
        const first = open()
        lines.forEach((line, i) => {
            const state = found[i]!
            line.hidden = first >= 0 && i > first
            const typing = line.querySelector<HTMLElement>("p.script-only")!
            const reads = typing.contains(document.activeElement)
            typing.hidden = state.closed
            const answer = line.querySelector<HTMLDetailsElement>(".after")
            if (answer) [answer.hidden, answer.open] = [!state.closed, true]
            if (reads && state.closed) inputs[first]?.focus()
            if (state.tries.length) line.querySelector(".told")!.replaceChildren(...replied(page, line, state))
        })
        if (after) {
            after.hidden = first >= 0
            after.open = true
        }
    }
    show()
    return show
}

/** Where a row is not understood, and why. */
function refused(page: PageData, row: string, { known }: DerivationData): { place: number; text: string } | null {
    try {
        readFormula(row, known, page.words["point"] ?? ".")
        return null
    } catch (error) {
        if (!(error instanceof Refused)) throw error
        return { place: error.place, text: phrase(page, "formula.refused", { place: String(error.place + 1), reason: phrase(page, error.reason, error.values) }) }
    }
}

/** A row with a mark at a place. */
function marked(row: string, place: number): HTMLElement {
    const letters = Array.from(row)
    return made("p", "typed", letters.slice(0, place).join(""), made("mark", "", "▸"), letters.slice(place).join(""))
}

/** What is said to the answers to a line. */
function replied(page: PageData, line: HTMLElement, { tries, closed }: LineState): HTMLElement[] {
    const { typed, verdict, known } = tries.at(-1)!
    const parts = [made("p", "typed", typed)]
    if (verdict === "wrong") parts.push(made("p", "wrong", phrase(page, "lesson.not_quite")))
    else parts.push(made("p", "right", phrase(page, verdict === "carried" ? "answer.carried" : "lesson.right")))
    const own = known === null ? null : line.querySelector(`[data-answer="${known}"]`)
    if (own) parts.push(made("div", "", ...[...own.cloneNode(true).childNodes]))
    if (!closed) parts.push(made("p", "", phrase(page, "lesson.once_more")))
    return parts
}
