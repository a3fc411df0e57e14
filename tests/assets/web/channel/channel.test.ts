import "../page"
import assert from "node:assert/strict"
import { test } from "node:test"
import { ServerEngine } from "../../../../assets/web/channel/channel"
import { chance } from "../random"

/** An engine, and what its server says to it. */
function heard(): { engine: ServerEngine; say: (message: unknown) => void } {
    const engine = new ServerEngine(() => ({ dark: false, plain: false, upright: false }))
    const say = (message: unknown) => (engine as unknown as { hear(message: unknown): void }).hear(structuredClone(message))
    say(WORDS)
    return { engine, say }
}

const row = (ms: number, flags = 0) => [10 * ms, flags, ...[100, 0, 0, 1000, 2000, 0, 0], ...[200, 0, 0, 3000, 4000, 50, 0]]
const WORDS = { is: "words", language: "en", words: { a: "b" } }
const FRAME = { is: "frame", rows: [row(0), row(16)], running: true, past: null, anew: true, fields: [] }
const PATH = { is: "path", points: [[0, 0], [1000, 0], [1000, 1000], [0, 0]], closed: true, raised: [], right: [1, 0], up: [0, 1] }
const STATE = {
    is: "state", language: "en", robot: "five_bar", titles: ["a", "b"], names: ["a", "b"], texts: ["", ""], captions: ["", ""], clocks: [true, false],
    stopped: [false, false], rate: 1, achieved: 1, together: true, undo: false, message: "", level: "", messages: 0, presenting: false, height: 1,
    said: { voice: "", summary: "", summaries: 0, stopped: false, replays: false, earlier: "", sounds: false, invitation: "", act: null },
    cameras: [], arrow: 1, frozen: "", own: true, rows: [], laws: ["", ""], shared: "",
}
const MESSAGES: Record<string, unknown>[] = [
    WORDS, { is: "lab", code: "abcdefghijkl" }, { is: "store", key: "speaks", value: "no" }, { is: "wait", text: "full" },
    FRAME, { ...FRAME, anew: false, rows: [row(33, 3)] }, PATH, STATE, { is: "state", rate: 0.5 },
    { is: "lit", symbol: "rho", lines: [[[0, 0]], [[0, 0]]] }, { is: "alive" }, { is: "refused", why: "so" },
    { is: "lesson", lesson: "", version: 1, index: 0, ended: false, test: false, playing: false, symbols: {}, head: "", pager: "", sections: {}, steps: [], charts: [] },
    { is: "measured", verdicts: {}, truth: null },
    { is: "file", number: 1, state: "awaited", received: 0, why: "" },
    { is: "download", number: 1, name: "a", state: "coming", text: "", size: 10 }, { is: "part", number: 1, content: "AAAA" },
]

test("samples replace those from their time on, and are what was sent", () => {
    const { engine, say } = heard()
    const changes: string[] = []
    engine.on(change => changes.push(change))
    for (const message of [STATE, PATH, FRAME]) say(message)
    assert.equal(engine.present.time, 0.016)
    const [left, right] = engine.present.sides
    assert.deepEqual([left!.tip, right!.tip, left!.distance], [[0.01, 0.02], [0.03, 0.04], 0.001])
    assert.deepEqual([right!.force, right!.held, right!.pulled], [[0.5, 0], false, false])
    say({ ...FRAME, anew: false, rows: [row(8, 3), row(24, 12)] })
    assert.deepEqual(engine.since(-1).map(each => each.time), [0, 0.008])
    assert.deepEqual([engine.state.held, engine.state.pulled], [false, true])
    assert.deepEqual([...new Set(changes)].sort(), ["history", "samples", "state"])
    say({ ...FRAME, rows: [row(5)] })
    assert.deepEqual([engine.since(-1).length, engine.present.time], [0, 0.005])
})

test("what a page plots is told of the past, too, whatever was plotted before", () => {
    const { engine, say } = heard(), draw = chance(3)
    for (const message of [STATE, PATH, FRAME]) say(message)
    for (let round = 0; round < 30; round++) {
        const names = ["xi", "xi_rate", "u"].filter(() => draw() < 0.5)
        const sizes = names.map(() => 1 + Math.floor(3 * draw())), total = sizes.reduce((sum, size) => sum + size, 0)
        const numbers = [0, 1, 2].map(() => Array.from({ length: 2 * total }, () => Math.round(1000 * draw())))
        say({ ...FRAME, rows: numbers.map((more, i) => [...row(16 * i), ...more]), fields: names.map((name, i) => [name, sizes[i], 1000]) })
        const samples = [...engine.since(-1), engine.present]
        assert.deepEqual(samples.map(({ sides }) => sides.map(side => side.tip)), numbers.map(() => [[0.01, 0.02], [0.03, 0.04]]))
        samples.forEach((sample, i) => [0, 1].forEach(side => {
            const told = names.flatMap(name => engine.field(sample, side, name) ?? [])
            assert.deepEqual(told, numbers[i]!.slice(side * total, (side + 1) * total).map(each => each / 1000))
        }))
    }
})

test("a state has what it had, but for what is said of it anew", () => {
    const { engine, say } = heard()
    say(STATE)
    say({ is: "state", rate: 0.25, titles: ["c", "d"] })
    assert.deepEqual({ ...engine.lab }, { ...STATE, rate: 0.25, titles: ["c", "d"] })
})

test("no message, whatever is wrong with it, ends the page", () => {
    const draw = chance(7)
    const pick = <T>(all: readonly T[]) => all[Math.floor(all.length * draw())]!
    const { warn } = console
    console.warn = () => {}
    for (let run = 0; run < 400; run++) {
        const { engine, say } = heard()
        for (const message of [STATE, PATH, FRAME]) say(message)
        for (let k = 0; k < 6; k++) {
            const message = structuredClone(pick(MESSAGES))
            const name = pick(Object.keys(message))
            const nonsense = pick([null, 0, -1, 1e300, "", "x", [], [[]], {}, [null], true, undefined])
            if (draw() < 0.3) delete message[name]
            else message[name] = nonsense
            say(draw() < 0.1 ? nonsense : message)
        }
        for (const message of [STATE, PATH, { ...FRAME, rows: [row(50)] }]) say(message)
        assert.equal(engine.present.time, 0.05)
        assert.deepEqual(engine.texts.map(each => each.title), ["a", "b"])
        assert.ok(engine.route.at(1).every(Number.isFinite))
    }
    console.warn = warn
})
