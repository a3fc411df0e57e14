import { inkOf, resize, TEXTS } from "../page"
import assert from "node:assert/strict"
import { test } from "node:test"
import { keepDraftsOf, keepScroll } from "../../../../assets/web/core/drafts"
import type { BlockData, PageData } from "../../../../assets/web/core/lesson_data"
import { noNotes } from "../../../../assets/web/lessons/notes"
import type { Student } from "../../../../assets/web/lessons/student"
import { ask } from "../../../../assets/web/parts/asked"
import { predict, predictionAt } from "../../../../assets/web/parts/predictions"

// A page that is loaded anew has the same storage, and nothing else of the one before.

const COMMITTING = `<div class="committing"><select class="sure"><option value=""></option><option value="fairly"></option></select>
    <textarea class="why"></textarea><button type="button" class="lead main">commit</button></div><p class="verdict"></p>`
const SKETCH = { kind: "sketch", quantity: "distance", label: "distance", unit: "mm", robots: ["a", "b"], seconds: 8, top: 60, bottom: 0 } as const
const OPTIONS = `<ul class="options"><li><input type="radio" name="o" value="0"></li><li><input type="radio" name="o" value="1"></li></ul>`

/** The student, whose notes the server keeps; `left`: what has been committed. */
function student(left: unknown[] = []): Student {
    const commit = (...given: unknown[]) => void left.push(given)
    return { notes: noNotes(), name: "", predicts: commit, chooses: commit, gives: commit, writes: commit, way: () => "" } as unknown as Student
}

/** A page with one question, as if it had just been loaded. */
function loaded(block: object, inside: string): { page: PageData; element: HTMLElement } {
    keepDraftsOf("lab")
    document.body.innerHTML = `<section id="step-1"><div class="words"><div data-block="0">${inside}</div></div></section>` // oxlint-disable-line no-restricted-properties
    const page = {
        words: TEXTS.words, lesson: "a", symbols: {}, figures: [], lessons: {},
        steps: [{ kind: "predict", blocks: [block] }, { kind: "run", blocks: [], figure: -1, script: null }],
    } as unknown as PageData
    return { page, element: document.querySelector<HTMLElement>("[data-block]")! }
}

const input = (element: HTMLElement, value: string) => {
    Object.assign(element, { value })
    element.dispatchEvent(new Event("input", { bubbles: true }))
}

test("a curve that was drawn, and what was said of it, are there after a reload until they are committed", () => {
    const open = (left: unknown[] = []) => {
        const { page, element } = loaded(SKETCH, COMMITTING), who = student(left)
        return { element, form: predict(page, predictionAt(page.steps, 0)!, who) }
    }
    const first = open()
    assert.ok(first.form.commit.disabled)
    const points = [...first.form.board!.querySelectorAll<HTMLElement>("[role=slider]")]
    for (const key of ["ArrowUp", "ArrowUp", "PageUp"]) points[8]!.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true }))
    const drawn = points.map(each => each.getAttribute("aria-valuenow"))
    input(first.element.querySelector(".why")!, "because <b>")
    input(first.element.querySelector(".sure")!, "fairly")
    const left: unknown[] = [], { element, form } = open(left)
    assert.deepEqual([...form.board!.querySelectorAll("[role=slider]")].map(each => each.getAttribute("aria-valuenow")), drawn)
    assert.ok(new Set(drawn).size > 1 && !form.commit.disabled)
    assert.equal(element.querySelector<HTMLTextAreaElement>(".why")!.value, "because <b>")
    assert.equal(element.querySelector<HTMLSelectElement>(".sure")!.value, "fairly")
    form.commit.click()
    assert.equal(left.length, 1)
    assert.ok(open().form.commit.disabled)
})

test("half an answer is there after a reload until it is given", () => {
    const kinds = { open: "<textarea></textarea>", number: "<input>", quiz: OPTIONS }
    for (const [kind, inside] of Object.entries(kinds)) {
        const open = (left: unknown[] = []) => {
            const { page, element } = loaded({ kind }, `${inside}<p class="verdict"></p>`)
            ask(page, element, { kind } as unknown as BlockData, `0.${kind}`, student(left))
            return element
        }
        const value = (element: HTMLElement) => element.querySelector<HTMLInputElement>(kind === "quiz" ? "input:checked" : "input, textarea")?.value ?? ""
        const first = open()
        if (kind === "quiz") first.querySelectorAll("input")[1]!.checked = true
        input(kind === "quiz" ? first.querySelectorAll("input")[1]! : first.querySelector("input, textarea")!, "1")
        const left: unknown[] = [], second = open(left)
        assert.equal(value(second), "1", kind)
        second.querySelector("button")!.click()
        assert.equal(left.length, 1, kind)
        assert.equal(value(open()), "", kind)
    }
})

test("a text begins where one has read it to, and another one at its top", () => {
    keepDraftsOf("lab")
    const read = (of: string) => {
        const element = document.createElement("div")
        keepScroll(element, "read", of)
        return element
    }
    const first = read("step 1")
    first.scrollTop = 120
    first.dispatchEvent(new Event("scroll"))
    assert.equal(read("step 1").scrollTop, 120)
    assert.equal(read("step 2").scrollTop, 0)
    assert.equal(read("step 1").scrollTop, 0) // one has left it
    keepDraftsOf("another lab")
    assert.equal(read("step 1").scrollTop, 0)
})

test("what was drawn before a discussion stays in sight, and is none of the new answer", () => {
    const before = { times: [0, 4, 8], values: [0, 30, 10] }
    const { page } = loaded({ ...SKETCH, before }, COMMITTING), left: unknown[] = []
    const { board, commit } = predict(page, predictionAt(page.steps, 0)!, student(left))
    const canvas = board!.querySelector("canvas")!
    resize(canvas, 600, 200)
    const named = () => inkOf(canvas).texts.map(each => each.text)
    assert.ok(commit.disabled)
    const points = [...board!.querySelectorAll<HTMLElement>("[role=slider]")]
    assert.ok(points.every(each => each.getAttribute("aria-valuenow") === "0"))
    points[8]!.dispatchEvent(new KeyboardEvent("keydown", { key: "PageUp", bubbles: true, cancelable: true }))
    assert.deepEqual(["chart.first", "chart.yours"].filter(each => named().includes(each)), ["chart.first", "chart.yours"])
    commit.click()
    assert.equal(left.length, 1)
    assert.notDeepEqual((left as [[number, typeof before]])[0][1].values, before.values)
})
