import { TEXTS } from "../page"
import assert from "node:assert/strict"
import { test } from "node:test"
import type { ServerEngine } from "../../../../assets/web/channel/channel"
import type { LessonMessage } from "../../../../assets/web/channel/messages"
import { noNotes } from "../../../../assets/web/lessons/notes"
import { Column } from "../../../../assets/web/parts/column"
import { chance } from "../random"

/** The pager as the server makes it (assets/templates/lesson/pager.html). */
const pagerTo = (forward: string) => `<div class="ways">
    <button type="button" aria-label="Back" title="Back" data-send='[{"do":"GoToStep","by":-1}]'>←</button>
    <span class="gap"></span>
    ${forward}
</div>`
const PAGER = pagerTo(`<button type="button" class="main" data-send='[{"do":"GoToStep","by":1}]'>Next</button>`)
const SKIPPER = pagerTo(`<button type="button" aria-label="Skip" title="Skip" data-send='[{"do":"GoToStep","by":1}]'>Skip</button>`)
const PREDICTION = `<p>What will happen?</p><ul class="options"><li><input type="radio" name="o" value="0"></li></ul>
    <div class="committing"><button type="button" class="lead main">Commit</button></div><p class="verdict"></p>`
const part = (number: number, inside: string) => `<div data-block="${number}">${inside}</div>`
const FIELD = part(2, "<p>What do you see?</p><textarea></textarea><button type=button>Keep</button>")

function opened(): { column: Column; sent: unknown[]; hear: (changes?: Partial<LessonMessage>) => void } {
    const sent: unknown[] = [], ended = new AbortController().signal
    const engine = { connected: true, path: { lines: [] }, outbox: { has: () => false }, send: (message: unknown) => sent.push(message) } as unknown as ServerEngine
    const column = new Column(TEXTS, engine, () => true, () => {}, ended)
    document.body.replaceChildren(column.element)
    let version = 0
    const hear = (changes: Partial<LessonMessage> = {}) => column.hear({
        is: "lesson", lesson: "a", version: ++version, index: 0, ended: false, test: false, playing: false, symbols: {}, head: "<p>1. A</p>", pager: PAGER,
        sections: { "0": `<h2 id="title-1">One</h2>${FIELD}${part(3, "<p>Two</p>")}` },
        steps: [{ kind: "play", optional: false, running: true, script: null, figure: -1, values: { lengths: [], paths: [] }, blocks: Array.from({ length: 5 }, () => ({ kind: "text", links: [] })) }],
        notes: noNotes(), charts: [], ...changes,
    } as LessonMessage)
    return { column, sent, hear }
}

const words = () => document.querySelector(".step.open .words")!

test("a column without a lesson is not there", () => {
    const { column, hear } = opened()
    hear({ lesson: "" })
    assert.ok(column.element.hidden && !column.open)
    hear()
    assert.ok(!column.element.hidden && column.open)
    hear({ lesson: "" })
    assert.ok(column.element.hidden)
})

test("what has not changed stays as it is, with what is typed in it and the focus", () => {
    const { hear } = opened()
    hear()
    const field = words().querySelector("textarea")!
    field.value = "half a sent"
    field.focus()
    const draw = chance(3)
    for (let k = 0; k < 40; k++) {
        const some = (numbers: number[]) => numbers.filter(() => draw() < 0.7).map(number => part(number, `<p>${Math.floor(3 * draw())}</p>`))
        const [before, others] = [some([0, 1]), some([3, 4])] as const
        hear({ sections: { "0": `<h2 id="title-1">One</h2>${before.join("")}${FIELD}${others.join("")}` }, pager: PAGER + (k % 2 ? "<p>more</p>" : "") })
        assert.ok(words().querySelector("textarea") === field)
        assert.equal(field.value, "half a sent")
        assert.ok(document.activeElement === field, `${k}`)
        const shown = [...words().querySelectorAll("[data-block]")].map(each => each.outerHTML.replace(/<\/textarea>.*/, ""))
        assert.equal(shown.length, before.length + 1 + others.length)
    }
})

test("a button that is replaced by its successor keeps the focus", () => {
    const { hear } = opened()
    hear({ sections: { "0": `<h2>One</h2>${part(0, "<button type=button>Hint 1</button>")}` } })
    words().querySelector("button")!.focus()
    hear({ sections: { "0": `<h2>One</h2>${part(0, "<p>The hint.</p><button type=button>Hint 2</button>")}` } })
    assert.equal(document.activeElement?.textContent, "Hint 2")
})

test("settings in a part that is replaced are in its successor before one reads on", () => {
    const { column, hear } = opened(), form = document.createElement("div")
    form.className = "form"
    const task = (hint: string) => part(0, `<p>Hold both.</p>${hint}<ul class="verdicts"></ul>`)
    const steps = [{ kind: "task", optional: false, running: true, script: null, figure: -1, values: { lengths: [], paths: [] }, blocks: [{ kind: "task", limits: [], checks: [], ways: [] }] }]
    const told = (hint: string) => hear({ sections: { "0": `<h2>One</h2>${task(hint)}` }, steps } as unknown as Partial<LessonMessage>)
    told("")
    column.offer(form)
    told("<p>The hint.</p>")
    assert.equal(words().querySelector("[data-block] > p + .form + p")?.textContent, "The hint.")
})

test("settings without a task stand before the first question, or at the end", () => {
    for (const kinds of [["text", "text"], ["text", "open"], ["text", "text", "open", "text"]]) {
        const { column, hear } = opened(), form = document.createElement("div")
        form.className = "form"
        const blocks = kinds.map(kind => ({ kind, links: [], hints: [] }))
        const steps = [{ kind: "play", optional: false, running: true, script: null, figure: -1, values: { lengths: [], paths: [] }, blocks }]
        const html = kinds.map((_, i) => part(i, `<textarea></textarea><p class="verdict"></p>`)).join("")
        hear({ sections: { "0": `<h2>One</h2>${html}` }, steps } as unknown as Partial<LessonMessage>)
        column.offer(form)
        const place = [...words().querySelectorAll("[data-block], .form")].indexOf(form)
        assert.equal(place, kinds.includes("open") ? kinds.indexOf("open") : kinds.length)
    }
})

test("a button sends what stands in it, and keys turn pages unless they are typed", () => {
    const { sent, hear } = opened()
    hear()
    for (const button of document.querySelectorAll<HTMLElement>(".pager [data-send]")) button.click()
    assert.deepEqual(sent, [{ do: "GoToStep", by: -1 }, { do: "GoToStep", by: 1 }])
    sent.length = 0
    for (const target of [words().querySelector("textarea")!, document.body])
        target.dispatchEvent(new KeyboardEvent("keydown", { key: "PageDown", bubbles: true, cancelable: true }))
    assert.deepEqual(sent[0], { do: "GoToStep", by: 1 })
    assert.equal(sent.length, 1)
})

test("a step leads while its prediction or its run is to come, and then no longer", () => {
    const { column, hear } = opened()
    const step = { kind: "run", optional: false, running: true, script: { do: [], seconds: 1 }, figure: -1, values: { lengths: [], paths: [] }, blocks: [] }
    const steps = (kind: string, script: unknown = step.script) => [{ ...step, kind, script }] as unknown as LessonMessage["steps"]
    const sections = { "0": `<h2 id="title-1">One</h2>` }
    hear({ sections, steps: steps("run") })
    assert.ok(column.leads)
    hear({ sections, steps: steps("run"), notes: { ...noNotes(), played: { 0: true } } as unknown as LessonMessage["notes"] & object })
    assert.ok(!column.leads)
    for (const [kind, script] of [["run", null], ["play", null], ["task", null]] as const) {
        hear({ lesson: kind, sections, steps: steps(kind, script) })
        assert.ok(!column.leads, kind)
    }
    hear({ lesson: "" })
    assert.ok(!column.leads)
})

test("one button at a time is the main one: to let it happen until the run is seen or skipped, and then to go on", () => {
    const draw = chance(7)
    const step = { kind: "run", optional: false, running: true, script: { do: [], seconds: 1 }, figure: -1, values: { lengths: [], paths: [] }, blocks: [] }
    for (let k = 0; k < 30; k++) {
        const { hear } = opened()
        const kind = draw() < 0.7 ? "run" : "explain"
        const script = kind === "run" ? `<p class="play"><button>Play</button></p>` : ""
        const steps = [{ ...step, kind, script: script ? step.script : null }] as unknown as LessonMessage["steps"]
        let [played, skipped] = [false, false]
        for (let change = 0; change < 8; change++) {
            const playing = Boolean(script) && draw() < 0.3
            played ||= Boolean(script) && draw() < 0.15
            hear({ sections: { "0": `<h2 id="title-1">One</h2>${script}` }, steps, playing, notes: { ...noNotes(), played: { 0: played } } as unknown as LessonMessage["notes"] & object })
            const seen = [...document.querySelectorAll<HTMLElement>(".step.open button")].filter(each => !each.hidden)
            const due = Boolean(script) && !played && !skipped
            const main = seen.filter(each => each.classList.contains("main"))
            assert.equal(main.length, due && playing ? 0 : 1)
            if (main[0]) assert.ok(main[0].parentElement?.matches(".ways") && main[0] === [...main[0].parentElement.children].at(-1))
            assert.equal(seen.some(each => each.textContent === "Next"), !due)
            const skip = seen.find(each => each.matches(".without"))
            assert.equal(Boolean(skip), due)
            assert.equal(document.querySelector(".step.open")!.classList.contains("veiled"), due)
            if (!skip || draw() > 0.2) continue
            skip.click()
            skipped = true
            assert.ok(document.activeElement === words() && !skip.isConnected)
        }
    }
})

test("of a prediction that is open, skipped or made, one button at a time is the main one", () => {
    const shared = { optional: false, running: true, figure: -1, values: { lengths: [], paths: [] } }
    const script = { do: [], seconds: 1 }, blocks = [{ kind: "choice", options: 1 }], text = `<h2 id="title-1">One</h2>`
    const play = `<p class="play"><button>Play</button></p>`
    const asks = { ...shared, kind: "predict", script: null, blocks }, runs = { ...shared, kind: "run", script, blocks: [] }
    const cases = { // the steps, which is open, and its HTML
        asked: { steps: [asks, runs], index: 0, html: text + part(0, PREDICTION) },
        "before the run": { steps: [asks, runs], index: 1, html: text + play },
        "within the run": { steps: [{ ...runs, blocks }], index: 0, html: text + part(0, PREDICTION) + play },
    }
    for (const [name, { steps, index, html }] of Object.entries(cases))
        for (const order of [["open", "skipped", "made"], ["open", "made"], ["skipped", "made"]]) {
            const { hear } = opened()
            for (const state of order) {
                const given = state === "open" ? [] : [{ item: "0", answer: state === "made" ? { option: 0 } : {} }]
                hear({ steps, index, sections: { [index]: html }, pager: state === "open" ? SKIPPER : PAGER, notes: { ...noNotes(), given } } as unknown as Partial<LessonMessage>)
                const main = [...document.querySelectorAll<HTMLElement>(".step.open button.main")].filter(each => !each.closest("[hidden]"))
                const asksHere = name !== "before the run" && state !== "made"
                const due = asksHere ? ["Commit"] : state === "open" ? [] : name === "asked" ? ["Next"] : ["lesson.play"]
                assert.deepEqual(main.map(each => each.textContent), due, `${name}, ${state}`)
                assert.ok(main.every(each => each.parentElement!.matches(".ways")))
            }
        }
})
