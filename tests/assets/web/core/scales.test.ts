import assert from "node:assert/strict"
import { test } from "node:test"
import { Scale, typedNumber } from "../../../../assets/web/core/scales"
import { chance } from "../random"

const random = chance(1)
const CASES = Array.from({ length: 300 }, () => {
    const step = [0.0005, 0.01, 0.05, 0.1, 0.5, 1, 5, 50][Math.floor(8 * random())]!
    const low = random() < 0.4 ? 0 : Math.round(40 * (random() - 0.7)) * step
    const high = low + Math.ceil(1 + 2000 * random() ** 2) * step
    return { low, high, step, scale: random() < 0.5 ? "log" as const : "linear" as const }
})

test("a slider gives multiples of the step within its range, and every place is where its number is", () => {
    for (const spec of CASES) {
        const scale = new Scale(spec)
        let before = -Infinity
        for (let place = 0; place <= 1; place += 1 / 64) {
            const value = scale.at(place)
            assert.ok(value >= scale.low && value <= scale.high && value >= before)
            assert.ok(Math.abs(value / spec.step - Math.round(value / spec.step)) < 1e-6, `${value} of ${spec.step}`)
            assert.ok(Math.abs(scale.at(scale.place(value)) - value) <= 1e-9 * Math.abs(value))
            before = value
        }
        assert.equal(scale.at(0), scale.low)
        assert.equal(scale.at(1), scale.high)
        assert.ok(scale.place(scale.low - 1) === 0 && scale.place(scale.high + 1) === 1)
    }
})

test("keys reach both ends by steps that bring them nearer, and go back the same way", () => {
    for (const spec of CASES) {
        const scale = new Scale(spec)
        let value = scale.rounded(scale.low + random() * (scale.high - scale.low)), presses = 0
        for (; value < scale.high; presses++) {
            const next = scale.moved(value, 1)
            assert.ok(next > value, `${next} after ${value}`)
            assert.ok(scale.moved(next, -1) < next)
            value = next
        }
        assert.ok(presses <= (scale.isLog ? 1100 : 2001), String(presses))
        assert.equal(scale.moved(value, 1), scale.high)
    }
})

test("a number that one means can be met, and its neighbours by keys", () => {
    const scale = new Scale({ low: 0, high: 2500, step: 5, scale: "log" })
    assert.equal(scale.settled(scale.at(scale.place(400) + 0.004), [400]), 400)
    assert.notEqual(scale.settled(scale.at(scale.place(400) + 0.05), [400]), 400)
    assert.equal(scale.moved(400, 1), 405)
    assert.ok(scale.place(900) - scale.place(100) > 0.4) // useful gains have room
    const friction = new Scale({ low: 0, high: 500, step: 0.005, scale: "log" })
    for (const [small, larger] of [[0.05, 0.5], [0.5, 5], [5, 50]] as const)
        assert.ok(friction.place(larger) - friction.place(small) > 0.15) // of a small arm, and of a large one
})

test("a slider from -π has 0 in its range", () => {
    const scale = new Scale({ low: -Math.PI, high: Math.PI, step: 0.01 })
    assert.deepEqual([scale.low, scale.high, scale.at(0.5)], [-3.14, 3.14, 0])
})

test("numbers are read with a decimal comma or point, whatever minus a phone writes", () => {
    const cases: [string, string, number | null][] = [
        ["1,5", ".", 1.5], ["1.5", ",", 1.5], ["−2", ".", -2], [" 1 000 ", ",", 1000], ["1,000", ".", 1000], ["1,000", ",", 1],
        ["0,125", ".", 0.125], ["1,000,000.5", ".", 1000000.5], [".5", ".", 0.5], ["2e3", ".", 2000], ["", ".", null], ["1.000,5", ",", null],
        ["K1", ".", null], ["1e999", ".", null], ["NaN", ".", null], ["-0", ".", 0], ["0x10", ".", null],
    ]
    for (const [text, point, number] of cases) assert.equal(typedNumber(text, point), number, text)
    for (const { low, high } of CASES) {
        const value = Number((low + random() * (high - low)).toPrecision(6))
        for (const point of [".", ","]) {
            const written = String(value).replace("-", "−")
            if (!written.includes("e")) assert.equal(typedNumber(written.replace(".", point), point), value)
        }
    }
})
