import { inkOf, resize, TEXTS } from "../page"
import assert from "node:assert/strict"
import { test } from "node:test"
import { enlarge, Sheet } from "../../../../assets/web/core/ink"
import { niceStep } from "../../../../assets/web/core/numbers"
import { Chart } from "../../../../assets/web/parts/chart"
import { firstAfter, valueAt } from "../../../../assets/web/parts/curves"
import { Drawing } from "../../../../assets/web/parts/drawing"
import { chance } from "../random"

function random(seed: number, count: number): { times: number[]; values: number[] } {
    const draw = chance(seed)
    let time = 0
    const times = Array.from({ length: count }, () => (time += 0.001 + draw()))
    return { times, values: times.map(() => 100 * draw() - 50) }
}

test("a value between two points lies between theirs; outside there is none", () => {
    for (let seed = 1; seed < 50; seed++) {
        const curve = random(seed, 40), { times, values } = curve, draw = chance(seed + 1000)
        for (let k = 0; k < 50; k++) {
            const time = times[0]! + draw() * (times.at(-1)! - times[0]!)
            const next = firstAfter(times, time)
            assert.ok(times[next]! >= time - 1e-9 && (next === 0 || times[next - 1]! < time))
            const [low, high] = [values[next - 1] ?? values[next]!, values[next]!].sort((a, b) => a - b)
            const value = valueAt(curve, time)!
            assert.ok(value >= low! - 1e-9 && value <= high! + 1e-9)
        }
        times.forEach((time, i) => assert.equal(valueAt(curve, time), values[i]))
        assert.equal(valueAt(curve, times[0]! - 1), null)
        assert.equal(valueAt(curve, times.at(-1)! + 1), null)
    }
})

test("the step of a scale is 1, 2 or 5 times a power of ten, and never more than 2.5 times too large", () => {
    const draw = chance(5)
    for (let k = 0; k < 1000; k++) {
        const least = 10 ** (8 * draw() - 4), step = niceStep(least)
        assert.ok(step >= least * (1 - 1e-8) && step <= 2.5 * least * (1 + 1e-8), `${least} ${step}`)
        assert.match(step.toExponential(6), /^[125]\.0+e/)
    }
})

function drawn(seed: number, width = 600, height = 200): { chart: Chart; texts: { text: string; x: number; y: number }[]; lines: readonly (readonly [number, number])[][] } {
    const axes = { label: "Distance", unit: "mm", bottom: -60, top: 60 }
    const chart = new Chart(TEXTS, axes, () => {})
    const line = (k: number) => ({ ...random(seed + k, 20), name: `line ${k}`, tone: `side${k}` as "side0" | "side1", dashed: k === 1 })
    chart.lines = [line(0), line(1)]
    chart.spans = [{ from: 2, until: 4, kind: "held" }, { from: 6, until: 7, kind: "pulled" }]
    resize(chart.sheet.canvas, width, height)
    chart.draw()
    const { texts, lines } = inkOf(chart.sheet.canvas)
    return { chart, texts, lines }
}

test("a line is open where its values are not known, and its name is elsewhere", () => {
    for (let seed = 1; seed < 30; seed++) {
        const draw = chance(seed), { times, values } = random(seed, 30), chart = drawn(seed).chart
        const known = values.map(value => (draw() < 0.2 ? NaN : value))
        chart.lines = [{ name: "log", times, values: known, tone: "ink", dashed: false }]
        Object.assign(chart, { from: times[0], until: times.at(-1) })
        chart.draw()
        const pieces: (readonly [number, number])[][] = [[]]
        known.forEach((value, i) => Number.isNaN(value) ? pieces.push([]) : pieces.at(-1)!.push([chart.x(times[i]!), chart.y(value)]))
        const { lines, texts } = inkOf(chart.sheet.canvas)
        for (const piece of pieces.filter(each => each.length)) assert.ok(lines.some(line => JSON.stringify(line) === JSON.stringify(piece)))
        const places = new Set(lines.flat().map(([x]) => x))
        assert.ok(places.size >= known.filter(Number.isFinite).length)
        for (const { text, y } of texts) if (text === "log") assert.ok(Number.isFinite(y))
    }
})

test("place and value are each other's inverse", () => {
    const { chart } = drawn(1), draw = chance(2)
    for (let k = 0; k < 100; k++) {
        const time = 10 * draw(), value = 120 * draw() - 60
        const [back, again] = chart.inverse(chart.x(time), chart.y(value))
        assert.ok(Math.abs(back - time) < 1e-9 && Math.abs(again - value) < 1e-9)
    }
})

test("lines are drawn within the axes, and each is named once at most, by itself", () => {
    for (let seed = 1; seed < 60; seed++) {
        const { chart, texts, lines } = drawn(7 * seed, 250 + 20 * seed)
        for (const name of ["line 0", "line 1"]) assert.ok(texts.filter(each => each.text === name).length <= 1)
        for (const { x, y } of texts) assert.ok(x >= 0 && x <= chart.sheet.width + 40 && y >= 0 && y <= chart.sheet.height)
        const named = texts.filter(each => each.text.startsWith("line"))
        for (const one of named) for (const other of named)
            if (one !== other) assert.ok(Math.abs(one.x - other.x) > 40 || Math.abs(one.y - other.y) >= 15, JSON.stringify(named))
        assert.ok(lines.length > 4)
    }
})

test("lines that lie on each other are named together, others apart, and none that is named above the plot", () => {
    const draw = chance(6)
    for (let k = 0; k < 60; k++) {
        const same = draw() < 0.5, value = 100 * draw() - 50, other = same ? value + 1.4 * draw() - 0.7 : value > 0 ? value - 20 : value + 20
        const chart = new Chart(TEXTS, { label: "Distance", unit: "mm", bottom: -60, top: 60 }, () => {})
        chart.lines = [value, other].map((each, i) => ({ name: `line ${i}`, tone: `side${i as 0 | 1}`, dashed: i === 1, times: [0, 10], values: [each, each] }))
        const write = (width: number) => {
            resize(chart.sheet.canvas, width, 200)
            chart.draw()
            return inkOf(chart.sheet.canvas).texts.filter(each => each.text.includes("line"))
        }
        const [one, two] = write(600)
        assert.deepEqual([one!.text, two!.text], same ? ["line 0, ", "line 1"] : ["line 0", "line 1"])
        if (same) assert.ok(one!.y === two!.y && Math.abs(two!.x - one!.x - 7 * 7) < 1e-9)
        chart.readings = [0, 1].map(i => ({ name: `line ${i}`, value: "0", tone: `side${i as 0 | 1}` }))
        assert.deepEqual(write(600).map(each => each.text), ["line 0 0", "line 1 0"])
        assert.ok(!write(200).some(each => /line \d 0/.test(each.text)))
    }
})

test("a chart that cannot be seen draws nothing", () => {
    assert.deepEqual(drawn(1, 0, 0).texts, [])
})

test("what has letters is drawn larger for a projector, and is drawn on where one points; a picture is not", () => {
    const { chart } = drawn(3), picture = new Sheet(() => {}), draw = chance(9)
    new Drawing(chart, () => {})
    document.body.append(chart.element, picture.canvas)
    resize(picture.canvas, 600, 200)
    for (const times of [1.7, 1, 2]) {
        enlarge(times)
        assert.ok(Math.abs(times * chart.sheet.width - 600) < 1e-9 && Math.abs(times * chart.sheet.height - 200) < 1e-9)
        assert.equal(picture.width, 600)
        for (let k = 0; k < 20; k++) {
            const [time, value] = [10 * draw(), 120 * draw() - 60]
            const at = { button: 0, pointerId: 1, clientX: times * chart.x(time), clientY: times * chart.y(value), bubbles: true }
            chart.plot.setPointerCapture = () => {}
            chart.plot.dispatchEvent(new PointerEvent("pointerdown", at))
            assert.ok(Math.abs(chart.ghost!.times[0]! - time) < 2e-3 && Math.abs(chart.ghost!.values[0]! - value) < 2e-3)
            chart.plot.dispatchEvent(new PointerEvent("pointerup", at))
            const points = [...chart.plot.querySelectorAll<HTMLElement>(".point")]
            const places = points.map(point => Number(/translate\((.*?)px/.exec(point.style.transform)![1]))
            places.forEach((x, i) => assert.ok(Math.abs(x - times * chart.x((10 * i) / (places.length - 1))) < 0.1))
        }
    }
    enlarge(1)
})
