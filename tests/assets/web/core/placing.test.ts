import assert from "node:assert/strict"
import { test } from "node:test"
import { shares } from "../../../../assets/web/core/placing"
import { chance } from "../random"

const draw = chance(3)
const SLACK = 1e-6

test("the parts of the robots fill the picture, and each robot is in its own", () => {
    for (let i = 0; i < 5000; i++) {
        const width = 200 + 2400 * draw()
        const middles = Array.from({ length: 1 + Math.floor(3 * draw()) }, () => width * (1.6 * draw() - 0.3))
        const given = shares(middles, width)
        assert.ok(Math.abs(given.reduce((sum, each) => sum + each.width, 0) - width) < SLACK)
        for (const [k, { left, width: wide, middle }] of given.entries()) {
            assert.ok(left >= 0 && wide >= 0 && left + wide <= width + SLACK && middle >= 0 && middle <= wide)
            if (middles[k]! >= 0 && middles[k]! <= width) assert.ok(Math.abs(left + middle - middles[k]!) < SLACK)
            for (const [j, other] of given.entries())
                assert.ok(j === k || left >= other.left + other.width - SLACK || other.left >= left + wide - SLACK)
        }
    }
})

test("the border is in the middle between two robots", () => {
    assert.deepEqual(shares([300, 100], 500), [{ left: 200, width: 300, middle: 100 }, { left: 0, width: 200, middle: 100 }])
})
