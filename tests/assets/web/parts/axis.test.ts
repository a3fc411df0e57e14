import assert from "node:assert/strict"
import { test } from "node:test"
import { axisFor, type Range } from "../../../../assets/web/parts/axis"
import { chance } from "../random"

const draw = chance(46)
const LEAST = [[0, 5], [-1, 1], [-0.01, 0.01], [0, 10]] as const
const any = <T>(all: readonly T[]): T => all[Math.floor(all.length * draw())]!

/** Values to be shown: from a part of their unit to a thousand times as much, on one side of zero or on both. */
function values(): [number, number] {
    const size = 10 ** (6 * draw() - 3)
    const [one, other] = [size * (draw() - 0.5), size * (draw() - any([0, 0.5]))]
    return [Math.min(one, other), Math.max(one, other)]
}

const shows = ({ bottom, top }: Range, low: number, high: number) => bottom <= low && high <= top

test("an axis shows all values and its least range, whatever it was before", () => {
    for (let i = 0; i < 3000; i++) {
        const least = any(LEAST)
        let axis: Range = { bottom: least[0], top: least[1] }
        for (let k = 0; k < 5; k++) {
            const [low, high] = values()
            axis = axisFor(axis, low, high, least)
            assert.ok(shows(axis, low, high) && shows(axis, least[0], least[1]), JSON.stringify([axis, low, high]))
            const needed = Math.max(high, least[1]) - Math.min(low, least[0])
            assert.ok(axis.top - axis.bottom <= 3 * needed, JSON.stringify([axis, low, high])) // and not much else
            assert.equal(axisFor(axis, low, high, least), axis) // it rests
        }
    }
})

test("an axis neither flickers with its values nor creeps after them", () => {
    for (let i = 0; i < 500; i++) {
        const [least, size] = [any(LEAST), 10 ** (4 * draw() - 2)]
        let axis: Range = { bottom: least[0], top: least[1] }
        let changes = 0
        for (let k = 0; k < 200; k++) {
            const next = axisFor(axis, 0, size * (1 + 0.3 * draw()), least)
            if (next !== axis) changes++
            axis = next
        }
        assert.ok(changes <= 3, `${size}: ${changes}`)
        const before = axis
        let shrinks = 0
        for (let share = 1; share > 0.1; share -= 0.001) {
            const next = axisFor(axis, 0, share * size, least)
            if (next !== axis) shrinks++
            axis = next
        }
        assert.ok(shrinks <= 4, `${size}: ${shrinks}`) // each time by half or more
        assert.ok(axis.top <= before.top)
    }
})
