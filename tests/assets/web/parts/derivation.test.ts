import { TEXTS } from "../page"
import assert from "node:assert/strict"
import { test } from "node:test"
import type { DerivationData, PageData } from "../../../../assets/web/core/lesson_data"
import { noNotes, noted, lastSaid } from "../../../../assets/web/lessons/notes"
import type { Student } from "../../../../assets/web/lessons/student"
import { derive } from "../../../../assets/web/parts/derivation"

// One line after the other is asked, and answered by name; what cannot be read is marked, and is no try.

const DATA: DerivationData = {
    kind: "derivation", known: { K1: "K1", sqrt: "sqrt" }, values: { K1: Array.from({ length: 20 }, (_, i) => 1 + i) },
    lines: [{ name: "root", formula: "sqrt(K1)", tolerance: 0, wrong: ["K1"] }, { name: "", formula: "2*root", tolerance: 0, wrong: [] }],
}
const LINE = (i: number) => `<li data-line="${i}"><p class="script-only"><label>formula <input></label></p><div class="told"></div>
    <details class="after">line ${i}</details><div data-answer="0" hidden>not the root</div></li>`

function page(data = DATA) {
    document.body.innerHTML = `<div id="box"><ol>${LINE(0)}${LINE(1)}</ol><p class="verdict"></p><details class="after">so</details></div>` // oxlint-disable-line no-restricted-properties
    const element = document.getElementById("box")!
    const notes = noNotes()
    const derives = (key: string, row: string) => noted(notes, { item: key, text: [lastSaid(notes, key), row].filter(Boolean).join("\n") })
    const student = { notes, name: "", derives, way: () => "" } as unknown as Student
    const told = { words: TEXTS.words, lesson: "a", steps: [{ blocks: [data] }] } as unknown as PageData
    const show = derive(told, element, data, "0.0", student)
    const hears = (block: DerivationData) => {
        told.steps[0]!.blocks[0] = block
        show()
    }
    const lines = [...element.querySelectorAll<HTMLElement>("li")]
    const type = (i: number, row: string) => {
        lines[i]!.querySelector("input")!.value = row
        lines[i]!.querySelector("button")!.click()
        return lines[i]!.querySelector(".told")!.textContent
    }
    const shown = () => [...lines, ...element.querySelectorAll<HTMLElement>("details")].map(each => !each.hidden)
    return { notes, type, shown, hears, said: () => lines[0]!.querySelector(".told")!.textContent }
}

test("a wrong line is answered by name, a second one closes it, and an own value is carried on", () => {
    const { type, shown, notes } = page()
    assert.deepEqual(shown(), [true, false, false, false, false])
    const said = type(0, "K1")
    for (const part of ["not the root", "lesson.not_quite", "lesson.once_more"]) assert.ok(said.includes(part), said)
    assert.deepEqual(shown(), [true, false, false, false, false])
    assert.ok(!type(0, "3K1").includes("lesson.once_more"))
    assert.deepEqual(shown(), [true, true, true, false, false])
    assert.ok(type(1, "6K1").includes("answer.carried"))
    assert.deepEqual(shown(), [true, true, true, true, true])
    assert.equal(lastSaid(notes, "0.0"), "K1\n3K1\n6K1")
    assert.equal(type(1, "2sqrt(K1)").includes("lesson.right"), false) // it is closed
})

test("what cannot be read is marked at its place, and kept nowhere", () => {
    const { type, notes } = page()
    assert.ok(type(0, "sqrt(K1").includes("sqrt(K1▸"))
    assert.ok(type(0, "x").includes("▸x"))
    assert.deepEqual(notes.given, [])
    assert.ok(type(0, "sqrt(K1)").includes("lesson.right"))
})

test("a lab says itself what has become of each line", () => {
    const states = [{ tries: [{ typed: "K1", verdict: "wrong" as const, known: 0 }], closed: false }, { tries: [], closed: false }]
    const { shown, hears, said } = page({ kind: "derivation", known: DATA.known, states })
    assert.deepEqual(shown(), [true, false, false, false, false])
    hears({ kind: "derivation", known: DATA.known, states: [{ tries: [{ typed: "K1", verdict: "right", known: null }], closed: true }, states[1]!] })
    assert.deepEqual(shown(), [true, true, true, false, false])
    assert.ok(said().includes("lesson.right"))
})
