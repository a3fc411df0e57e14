import { TEXTS } from "../page"
import assert from "node:assert/strict"
import { test } from "node:test"
import type { BlockData, ChoiceData, NumberData, PageData } from "../../../../assets/web/core/lesson_data"
import { noNotes, noted } from "../../../../assets/web/lessons/notes"
import type { Student } from "../../../../assets/web/lessons/student"
import { StepView, type Robots } from "../../../../assets/web/parts/step"
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

/** A quiz with a second try on the site, or in a lab, which sends of both what is told by then. */
function followed(second: ChoiceData | NumberData, inside: string) {
    const quiz: BlockData = { kind: "quiz", right: 0, followed: true, second }
    document.body.innerHTML = `<section id="step-1"><div class="words"><div class="quiz" data-block="0">${QUIZ}</div><div data-second="0.0" hidden>${inside}</div></div></section>` // oxlint-disable-line no-restricted-properties
    const page = { words: TEXTS.words, lesson: "a", steps: [{ kind: "quiz", blocks: [quiz] }] } as unknown as PageData
    const notes = noNotes()
    const give = (item: string, event: object) => {
        noted(notes, { item, ...event })
        view.run()
    }
    const student = {
        notes, name: "", way: () => "",
        chooses: (item: string, option: number) => give(item, { answer: { option } }),
        gives: (item: string, number: number) => give(item, { number }),
    } as unknown as Student
    const section = document.querySelector<HTMLElement>("section")!
    const view = new StepView(page, 0, student, {} as Robots, { section, beneath: document.body, isWide: () => false })
    view.run()
    const [first, other] = [...section.querySelectorAll<HTMLElement>(".words > div")]
    const press = (element: HTMLElement, given: number) => {
        const inputs = [...element.querySelectorAll("input")]
        if (inputs.length > 1) inputs.forEach(each => (each.checked = each.value === String(given)))
        else inputs[0]!.value = String(given)
        element.querySelector("button")!.click()
    }
    const told = (element: HTMLElement) => element.querySelector(".verdict")!.textContent
    return { first: first!, other: other!, press, told, notes, page, student }
}

test("after a wrong choice something else is asked, and what was right is told below its answer", () => {
    const { first, other, press, told, notes } = followed({ kind: "quiz", right: 2 }, QUIZ.replaceAll("no clock", "wrong reason").replaceAll("too soft", "right reason"))
    assert.ok(other.hidden)
    press(first, 1)
    says(told(first), "too slow", "lesson.not_quite")
    assert.ok(!other.hidden && first.querySelector("button")!.hidden && [...first.querySelectorAll("input")].every(each => each.disabled))
    assert.equal(told(other), "")
    press(other, 0)
    says(told(first), "too slow", "lesson.not_quite")
    says(told(other), "no clock", "lesson.not_quite") // of the first question, which is told now
    assert.match(told(other), /wrong reason.*right reason.*answer.before.*no clock/s)
    assert.ok(other.querySelector("button")!.hidden)
    assert.deepEqual(notes.given.map(each => [each.item, each.attempt]), [["0.0", 1], ["0.0.second", 2]])
})

test("another number is judged at once, and followed by what was right", () => {
    for (const [given, verdict] of [[6, "lesson.right"], [7, "lesson.not_quite"]] as const) {
        const { first, other, press, told } = followed({ kind: "number", number: 6, tolerance: 0.1 }, NUMBER)
        press(first, 2)
        press(other, given)
        assert.match(told(other), new RegExp(verdict))
        assert.equal(other.textContent.split("no clock").length - 1, 1)
        assert.ok(!other.querySelector<HTMLElement>(".after")!.hidden)
    }
})

test("a right choice is followed by nothing", () => {
    const { first, other, press, told } = followed({ kind: "quiz", right: 2 }, QUIZ)
    press(first, 0)
    says(told(first), "no clock", "lesson.right")
    assert.ok(other.hidden)
})
