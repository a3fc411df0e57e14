import { TEXTS } from "../page"
import assert from "node:assert/strict"
import { test } from "node:test"
import type { ServerEngine } from "../../../../assets/web/channel/channel"
import { OverStage } from "../../../../assets/web/parts/over_stage"

test("the stage says which robot's picture is being made, and covers the one before", () => {
    Object.assign(globalThis, { webgl: { works: true } })
    const texts = { words: { ...TEXTS.words, point: ".", "stage.building": "{robot} is coming", "stage.paused": "paused" } }
    const lab = { drawn: true, machine: "One", waits: "", above: [0, 0] }, state = { past: null, running: true }
    const camera = [[0, 0, 0], [0, 0, 0], [0, 0, 1]], side = { title: "", name: "", text: "", caption: "" }
    const engine = { texts: [side, side], cameras: [camera, camera], present: { time: 1, sides: [] }, state, lab } as unknown as ServerEngine
    const stage = new OverStage(engine, texts), told = () => stage.element.querySelector("[role=status]")!.textContent
    stage.show()
    assert.equal(told(), "")
    Object.assign(lab, { drawn: false, machine: "Two" })
    stage.show()
    assert.equal(told(), "Two is coming")
    assert.ok(stage.element.classList.contains("undrawn"))
    lab.drawn = true
    stage.show()
    assert.equal(told(), "")
    assert.ok(!stage.element.classList.contains("undrawn"))
})
