import { TEXTS } from "../page"
import assert from "node:assert/strict"
import { test } from "node:test"
import type { PageData, SketchFeature } from "../../../../assets/web/core/lesson_data"
import { noNotes } from "../../../../assets/web/lessons/notes"
import type { Student } from "../../../../assets/web/lessons/student"
import { StepView } from "../../../../assets/web/parts/step"

// What can be seen in a drawn curve is told beside what can be seen in the true one, and not before the run is over.

const NONE: SketchFeature = { name: "", peaks: null, highest: null, lowest: null, at: [], level: [] }
const FEATURES: SketchFeature[] = [{ ...NONE, name: "high", highest: [20, 60] }, { ...NONE, name: "one peak", peaks: [1, 1] }]
const SKETCH = {
    kind: "sketch", quantity: "distance", label: "distance", unit: "mm", robots: ["a", "b"], robot: "follower", seconds: 2, top: 60, bottom: 0, features: FEATURES,
} as const
const DRAWN = { times: [0, 1, 2], values: [0, 10, 0] }
const TRUTH = { times: [0, 1, 2], tracker: [0, 0, 0], follower: [0, 30, 0] }

test("features are told after the run, of the robot that was predicted", () => {
    document.body.innerHTML = `<section id="step-1"><div data-block="0"></div></section><section id="step-2"><p class="play"><button></button></p><div class="words"></div></section><div id="beneath"></div>` // oxlint-disable-line no-restricted-properties
    const script = { until: 2, do: [] }
    const steps = [{ kind: "predict", script: null, blocks: [SKETCH] }, { kind: "run", script, blocks: [] }]
    const page = { words: TEXTS.words, lesson: "a", figures: [], steps } as unknown as PageData
    const notes = noNotes()
    const robots = { ready: true, refused: false, playing: false, play: () => {}, tell: () => {}, act: () => {} }
    const section = document.querySelector<HTMLElement>("#step-2")!
    const student = { notes, name: "", way: () => "" } as unknown as Student
    const view = new StepView(page, 1, student, robots, { section, beneath: document.querySelector("#beneath")!, isWide: () => true })
    const rows = () => {
        view.run()
        return [...section.querySelectorAll(".judged-by tbody tr")].map(row => [...row.children].map(cell => cell.textContent))
    }
    assert.deepEqual(rows(), []) // nothing is predicted
    notes.given = [{ item: "0", answer: DRAWN }]
    assert.deepEqual(rows(), [])
    notes.truths["0"] = TRUTH
    robots.playing = true
    view.draw(TRUTH)
    assert.deepEqual(rows(), []) // as much of the run as there is so far
    robots.playing = false
    notes.played["1"] = true
    assert.deepEqual(rows(), [["high", "sketch.unseen", "sketch.seen"], ["one peak", "sketch.seen", "sketch.seen"]])
    assert.equal(rows().length, 2) // once
    notes.given = [{ item: "0", answer: {} }]
    assert.deepEqual(rows(), []) // it was skipped
})
