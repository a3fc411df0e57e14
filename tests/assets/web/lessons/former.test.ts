import assert from "node:assert/strict"
import { test } from "node:test"
import { givenTo, lastSaid, notesOf, passedTasks, predicted } from "../../../../assets/web/lessons/notes"
import type { Progress } from "../../../../assets/web/lessons/progress"

// Notes that an earlier version has kept in a browser or in a learning platform say the same today.

test("what was kept by an earlier version is read", () => {
    const kept = {
        step: 3, seen: 5, truths: {}, played: { 2: true }, hints: { hold: 2 }, answers: { 1: { times: [0, 1], values: [2, 3] }, 3: {} },
        quiz: { "7.0": 1, "8.0": 2 }, first: { "7.0": 0, "8.0": 2 }, numbers: { "7.1": 60 }, written: { "7.2": "so" }, tasks: { hold: 1.5 }, ways: { hold: 1 },
    }
    const progress = { get: () => JSON.stringify(kept), set() {}, grade() {}, tell() {} } as Progress
    const notes = notesOf(progress, "a")
    assert.deepEqual([notes.step, notes.seen, notes.played, notes.hints], [3, 5, { 2: true }, { hold: 2 }])
    assert.deepEqual(predicted(notes, 1), { times: [0, 1], values: [2, 3] })
    assert.deepEqual(predicted(notes, 3), {})
    assert.deepEqual(["7.0", "8.0", "7.1", "7.2"].map(item => lastSaid(notes, item)), [1, 2, 60, "so"])
    assert.deepEqual(givenTo(notes, "7.0").map(each => [each.attempt ?? 1, each.answer?.option]), [[1, 0], [2, 1]])
    assert.equal(givenTo(notes, "8.0").length, 1)
    assert.deepEqual(passedTasks(notes), { hold: { best: 1.5, way: 1 } })
})
