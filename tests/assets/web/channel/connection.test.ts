import "../page"
import { pass, time } from "../clock"
import assert from "node:assert/strict"
import { test } from "node:test"
import type { ServerEngine } from "../../../../assets/web/channel/channel"
import { chance } from "../random"

const CHECKED = 100 // [ms] between checks
const PATIENT = 37_000 // [ms], at most, until a picture that was lost is asked for again, with what chance adds
let date = 1.7e12
Date.now = () => date

/** viser's worker, which opens its websocket when it is told to. */
class FakeWorker extends EventTarget {
    static now: FakeWorker
    opened = 0
    constructor() {
        super()
        FakeWorker.now = this
    }
    postMessage({ type }: { type: string }): void {
        if (["retry", "set_server"].includes(type)) this.opened++
    }
    tell(type: string): void {
        this.dispatchEvent(Object.assign(new Event("message"), { data: { type } }))
    }
}
Object.assign(globalThis, {
    Worker: FakeWorker, webgl: { works: true, plain: false }, ownWords: { text: () => new Proxy({}, { get: (_, key) => String(key) }), language: () => "en" },
})
const { Connection, PictureLink } = await import("../../../../assets/web/channel/connection")

/** A page with a lab whose websocket is open, and its worker. */
function opened(): { wait: (ms: number, jump?: number) => void; worker: FakeWorker; engine: { heard: number; closed: number } } {
    const engine = {
        connected: true, isOpen: true, outdated: false, refused: 0, waits: "", page: "a", heard: 0, closed: 0, state: { running: true },
        lab: { rate: 1, achieved: 1, scene: 0 }, open: () => {}, close: () => engine.closed++,
    }
    const connection = new Connection(engine as unknown as ServerEngine, new PictureLink())
    new Worker("viser.js").postMessage({ type: "set_server" }) // oxlint-disable-line unicorn/require-post-message-target-origin
    const wait = (ms: number, jump = 0) => {
        date += jump
        for (let passed = 0; passed < ms; passed += CHECKED) {
            date += CHECKED
            pass(CHECKED)
            connection.check(true)
        }
    }
    return { wait, worker: FakeWorker.now, engine }
}

test("a picture that is lost is asked for again, whatever becomes of the clock", () => {
    const draw = chance(3)
    const { wait, worker, engine } = opened()
    for (let round = 0; round < 30; round++) {
        const before = worker.opened, began = time()
        while (worker.opened === before) {
            engine.heard++
            wait(CHECKED, draw() < 0.1 ? (draw() - 0.5) * 1e9 : 0)
            assert.ok(time() - began < PATIENT, `round ${round}`)
        }
        worker.tell("closed")
    }
})

test("a connection that died is opened anew, whatever becomes of the clock", () => {
    const draw = chance(5)
    const { wait, engine } = opened()
    for (let round = 0; round < 20; round++) {
        engine.heard++
        wait(CHECKED)
        const before = engine.closed
        for (let waited = 0; engine.closed === before; waited += 1000) {
            wait(1000, draw() < 0.2 ? (draw() - 0.7) * 1e8 : 0)
            assert.ok(waited < 80_000, `round ${round}`)
        }
    }
})
