import { inkOf, resize, TEXTS } from "../page"
import assert from "node:assert/strict"
import { test } from "node:test"
import type { Engine, RowData, Sample } from "../../../../assets/web/core/engine"
import { Row } from "../../../../assets/web/parts/row"
import { chance } from "../random"

const DATA = { name: "torques", label: "Torque", unit: "N m", menu: "torques", scale: 1, floats: false, least: [-1, 1],
    lines: [{ field: "u", at: 0, name: "u₁" }, { field: "u", at: 1, name: "u₂" }] } as RowData
const ROBOTS = [{ side: 0, name: "Tracker" }, { side: 1, name: "Follower" }]

/** What is written above a plot of this width, from left to right, when the robots have these torques. */
function legend(torques: number[][], width: number): { text: string; x: number }[] {
    const engine = { texts: ROBOTS, field: (_: Sample, side: number) => torques[side] } as unknown as Engine
    const row = new Row(TEXTS, engine, DATA, () => {}), sample = { time: 0, sides: [] } as unknown as Sample
    row.add(sample)
    row.follow([0])
    row.tell(sample, 0, false)
    resize(row.chart.sheet.canvas, width, 140)
    row.chart.draw()
    const { texts } = inkOf(row.chart.sheet.canvas)
    return texts.filter(({ y }) => y === Math.min(...texts.map(each => each.y))).sort((a, b) => a.x - b.x)
}

test("above a plot stand its quantity and the values of all robots, with their names where these have room", () => {
    const draw = chance(4), seen = new Set<string>()
    for (let k = 0; k < 300; k++) {
        const torques = ROBOTS.map(() => [4 * draw() - 2, 4 * draw() - 2]), width = 60 + Math.floor(700 * draw())
        const [title, ...readings] = legend(torques, width)
        assert.equal(title!.text, "Torque [N m]")
        if (!readings.length) {
            seen.add("none")
            continue
        }
        assert.equal(readings.length, ROBOTS.length) // all of them, or none
        readings.forEach(({ text, x }, i) => {
            const { name } = ROBOTS[i]!, named = text.startsWith(`${name} `)
            seen.add(named ? "named" : "values")
            const values = text.slice(named ? name.length + 1 : 0).split(" · ").map(each => Number(each.replace("\u2212", "-")))
            values.forEach((value, j) => assert.ok(Math.abs(value - torques[i]![j]!) <= 0.05, `${text} ${torques.join("; ")}`))
            assert.ok(x + 7 * text.length <= width, `${text} ends beyond ${width}`)
        })
        assert.equal(new Set(readings.map(({ text }, i) => text.startsWith(ROBOTS[i]!.name))).size, 1)
    }
    assert.deepEqual([...seen].sort(), ["named", "none", "values"])
})

test("the log of an arm is a further line on the same axis, where it has the quantity", () => {
    const times = [0, 1, 2], engine = {
        texts: ROBOTS, field: () => [0, 0], log: { name: "arm.csv", times, fields: new Map([["u", [[0, 40, 0], [0, 2, NaN]]]]) },
    }
    const row = new Row(TEXTS, engine as unknown as Engine, DATA, () => {})
    row.add({ time: 0, sides: [] })
    Object.assign(row.chart, { from: 0, until: 10 })
    row.follow([0])
    const logged = row.chart.lines.filter(line => line.logged)
    assert.deepEqual(logged.map(({ name, values }) => [name, values]), [["chart.log u₁", [0, 40, 0]], ["chart.log u₂", [0, 2, NaN]]])
    assert.ok(row.chart.axes.top >= 40)
    engine.log.fields = new Map()
    Object.assign(engine, { log: { ...engine.log } })
    row.follow([0])
    assert.equal(row.chart.lines.length, 2 * ROBOTS.length)
})
