import { inkOf, resize, TEXTS } from "../page"
import assert from "node:assert/strict"
import { test } from "node:test"
import { planeOf, PolePlane, polesIn } from "../../../../assets/web/parts/pole_plane"
import { chance } from "../random"

const [WIDTH, HEIGHT] = [280, 136]

test("poles stand in proportion to 0, all within the plane that do not grow", () => {
    const draw = chance(5)
    for (let k = 0; k < 300; k++) {
        const size = 10 ** (4 * draw() - 1)
        const poles = Array.from({ length: 1 + Math.floor(4 * draw()) }, () => ({ along: draw() < 0.5, real: -size * draw(), imaginary: size * (2 * draw() - 1) }))
        const { zero: [x, y], scale } = planeOf(poles, WIDTH, HEIGHT)
        assert.ok(scale > 0 && Number.isFinite(scale))
        for (const { real, imaginary } of poles) {
            assert.ok(x + scale * real >= 0 && x + scale * real <= x)
            assert.ok(y - scale * imaginary >= 0 && y - scale * imaginary <= HEIGHT)
        }
    }
})

test("each pole is a mark of its channel's, where it belongs, and far to the right there is none", () => {
    const plane = new PolePlane(TEXTS), { canvas } = plane.sheet
    resize(canvas, WIDTH, HEIGHT)
    const text = "across -20 15\nacross -20 -15\nalong -5 0\nalong 900 0"
    plane.show(text)
    const poles = polesIn(text), { zero: [x, y], scale } = planeOf(poles, WIDTH, HEIGHT)
    const middles = inkOf(canvas).lines.filter(line => line.length === 2).map(([from, to]) => [(from![0] + to![0]) / 2, (from![1] + to![1]) / 2] as const)
    const marks = poles.map(({ real, imaginary }) => middles.filter(([a, b]) => Math.hypot(a - x - scale * real, b - y + scale * imaginary) < 1e-6).length)
    assert.deepEqual(marks, [2, 2, 2, 0])
    assert.ok(inkOf(canvas).texts.some(each => each.text === "gains.rate"))
})
