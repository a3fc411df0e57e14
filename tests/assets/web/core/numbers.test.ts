import assert from "node:assert/strict"
import { test } from "node:test"
import { fixed, general, sum } from "../../../../assets/web/core/numbers"
import { chance } from "../random"

const draw = chance(1)
const values = Array.from({ length: 2000 }, () => (draw() - 0.5) * 10 ** Math.floor(24 * draw() - 12))

test("a number with significant digits is the nearest one that has no more", () => {
    for (const value of values)
        for (const digits of [1, 3, 6]) {
            const text = general(value, digits)
            assert.ok(text.replace(/e.*/, "").replace(/^-?0?\.?0*/, "").replaceAll(/[.-]/g, "").length <= digits, text)
            assert.ok(Math.abs(Number(text) - Number(value.toPrecision(digits))) <= 1e-12 * Math.abs(value), `${value} ${text}`)
        }
})

test("numbers are written as Python does", () => {
    // f"{value:.3g}"
    const cases: [number, string][] = [
        [0, "0"], [-0, "-0"], [1234.5, "1.23e+03"], [0.00012345, "0.000123"], [0.000012345, "1.23e-05"], [-2.5, "-2.5"],
        [999.9, "1e+03"], [1, "1"], [0.1, "0.1"], [100, "100"], [1e22, "1e+22"],
    ]
    for (const [value, text] of cases) assert.equal(general(value, 3), text)
    assert.equal(general(2.5, 1), "2") // ties go to the even digit
    assert.equal(general(3.5, 1), "4")
    // f"{value:.2f}"
    for (const [value, text] of [[0.125, "0.12"], [0.375, "0.38"], [-0.001, "0.00"], [-0.25, "-0.25"], [0.999, "1.00"]] as const)
        assert.equal(fixed(value, 2), text)
})

test("a sum of numbers is exact up to rounding, whatever their number", () => {
    for (const count of [0, 1, 7, 8, 9, 127, 128, 129, 130, 1000, 4097]) {
        const all = Array.from({ length: count }, () => draw() - 0.5)
        const exact = Number(all.reduce((total, each) => total + BigInt(Math.round(each * 2 ** 50)), 0n)) / 2 ** 50
        assert.ok(Math.abs(sum(all) - exact) < 1e-12 * Math.max(1, count))
    }
    assert.equal(sum(Array.from({ length: 300 }, () => 0.1)), 29.999999999999996) // np.full(300, 0.1).sum()
})
