import { TEXTS } from "../page"
import assert from "node:assert/strict"
import { test } from "node:test"
import type { BlockData, PageData } from "../../../../assets/web/core/lesson_data"
import { noNotes, noted } from "../../../../assets/web/lessons/notes"
import type { Student } from "../../../../assets/web/lessons/student"
import { ask } from "../../../../assets/web/parts/asked"

// A wrong first answer is told what speaks against it; what is right, only after the second one.

const OPTIONS = ["no clock", "too slow", "too soft"]
const QUIZ = `<ul class="options">${OPTIONS.map((_, i) => `<li><input type="radio" name="o" value="${i}"></li>`).join("")}</ul><p class="verdict"></p>
    <details class="after"><ul>${OPTIONS.map((each, i) => `<li data-answer="${i}">${each}</li>`).join("")}</ul></details>`
const NUMBER = `<input><p class="verdict"></p>
    <details class="after"><div>so it is six</div><div data-answer="0" hidden>a factor two</div></details>`

/** A question on the site or, with only the answers that a lab sends, in a lab; `answer` gives an answer. */
function asked(block: BlockData, inside: string, isTest = false, way = (): string => "") {
    document.body.innerHTML = `<section id="step-1"><div data-block="0">${inside}</div></section>` // oxlint-disable-line no-restricted-properties
    const page = { words: TEXTS.words, lesson: "a", test: isTest, steps: [{ kind: "quiz", blocks: [block] }] } as unknown as PageData
    const element = document.querySelector<HTMLElement>("[data-block]")!
    const notes = noNotes()
    const student = {
        notes, name: "", way,
        chooses: (item: string, option: number) => noted(notes, { item, answer: { option } }),
        gives: (item: string, number: number) => noted(notes, { item, number }),
    } as unknown as Student
    const shows = ask(page, element, block, "0.0", student)
    const show = () => {
        shows()
        return element.querySelector(".verdict")!.textContent
    }
    const answer = (given: number) => {
        if (block.kind === "quiz") element.querySelectorAll("input").forEach(each => (each.checked = each.value === String(given)))
        else element.querySelector("input")!.value = String(given)
        element.querySelector("button")!.click()
        return element.querySelector(".verdict")!.textContent
    }
    return { answer, show, after: element.querySelector<HTMLElement>(".after") }
}

const says = (text: string, ...parts: string[]) => OPTIONS.concat("six", "a factor two", "lesson.not_quite", "lesson.right", "lesson.once_more")
    .forEach(part => assert.equal(text.includes(part), parts.includes(part), `${part}: ${text}`))

test("an option is answered by its own answer, then by the right one", () => {
    const quiz: BlockData = { kind: "quiz", right: 0 }
    says(asked(quiz, QUIZ).answer(0), "no clock", "lesson.right")
    const { answer } = asked(quiz, QUIZ)
    says(answer(1), "too slow", "lesson.not_quite", "lesson.once_more")
    says(answer(1), "too slow", "lesson.not_quite", "lesson.once_more") // the same answer is no second one
    says(answer(2), "too soft", "lesson.not_quite", "no clock")
    const other = asked(quiz, QUIZ)
    other.answer(2)
    says(other.answer(0), "no clock", "lesson.right")
})

test("in a lab, which keeps what is right to itself, it is the same", () => {
    const only = QUIZ.replaceAll(/<li data-answer="[02]">[a-z ]*<\/li>/g, "")
    says(asked({ kind: "quiz" }, only).answer(1), "too slow", "lesson.not_quite", "lesson.once_more")
    says(asked({ kind: "number" }, NUMBER.replace("so it is six", "")).answer(12), "a factor two", "lesson.not_quite", "lesson.once_more")
    says(asked({ kind: "number" }, `<input><p class="verdict"></p>`).answer(12), "lesson.not_quite", "lesson.once_more")
})

test("a test tells nothing", () => {
    says(asked({ kind: "quiz" }, QUIZ, true).answer(1))
})

test("while a class votes, an answer is being sent or sent, and nothing else is said", () => {
    let way = "sending"
    const only = QUIZ.replaceAll(/<li data-answer="[02]">[a-z ]*<\/li>/g, "")
    const { answer, show } = asked({ kind: "quiz", voted: true }, only, false, () => way)
    assert.equal(answer(1), "answer.sending")
    way = "sent"
    assert.equal(show(), "answer.sent")
})

test("a number is answered by its known mistake, then by the right one", () => {
    const six: BlockData = { kind: "number", number: 6, tolerance: 0.1, wrong: [12] }
    const { answer, after } = asked(six, NUMBER)
    says(answer(12.05), "a factor two", "lesson.not_quite", "lesson.once_more")
    assert.ok(after!.hidden)
    says(answer(7), "lesson.not_quite")
    assert.ok(!after!.hidden)
    says(asked(six, NUMBER).answer(7), "lesson.not_quite", "lesson.once_more")
    says(asked(six, NUMBER).answer(5.95), "lesson.right")
})
