// One row of the plots under the stage: a chart of one quantity of all robots.

import type { Engine, LogCurves, RowData, Sample } from "../core/engine"
import { phrase, written, type Texts } from "../core/words"
import { axisFor } from "./axis"
import { Chart, type Line } from "./chart"
import { firstAfter } from "./curves"

const READ = 150 // [ms] between changes of the numbers, so that they can be read

export class Row {
    readonly chart: Chart
    readonly fields: string[]
    private readonly values: number[][] // of each line of each robot, in the row's unit
    private logged: { log: LogCurves | null; lines: Line[] } = { log: null, lines: [] }
    private read = -Infinity // when the numbers were last changed

    constructor(private readonly texts: Texts, private readonly engine: Engine, readonly data: RowData, changed: () => void) {
        const { label, unit, least, lines } = data
        this.chart = new Chart(texts, { label, unit, bottom: least[0], top: least[1] }, changed)
        this.chart.sheet.canvas.setAttribute("aria-label", `${label} [${unit}]`)
        this.fields = lines.map(line => line.field)
        this.values = engine.texts.flatMap(() => lines.map(() => []))
    }

    /** Add a sample to the curves; what is not known of it is NaN. */
    add(sample: Sample): void {
        const { engine, values, data: { lines, scale } } = this
        values.forEach((line, i) => {
            const { field, at } = lines[i % lines.length]!
            line.push((engine.field(sample, Math.floor(i / lines.length), field)?.[at] ?? NaN) * scale)
        })
    }

    /** Forget some of the first samples, or of the last ones. */
    shorten(by: number, last: boolean): void {
        for (const each of this.values) each.splice(last ? each.length - by : 0, by)
    }

    /** Show the curves at these times. */
    follow(times: readonly number[]): void {
        const { chart, engine, data } = this
        const { lines } = data
        const robots = engine.texts
        const robotLines = this.values.map((values, i): Line => {
            const { name, side } = robots[Math.floor(i / lines.length)]!, own = lines[i % lines.length]!
            const both = own.name ? `${name} ${own.name}` : name
            return { name: both, tone: `side${side}`, dashed: side === 1, thin: i % lines.length > 0, times, values }
        }).filter(line => !Number.isNaN(line.values[line.values.length - 1]))
        chart.lines = [...robotLines, ...this.log().filter(line => line.times[line.times.length - 1]! > chart.from)]
        const [low, high] = this.extent(robotLines)
        const range = axisFor(chart.axes, low, high, this.least(low, high))
        chart.axes = { ...chart.axes, ...range }
    }

    /** The values now, beside the title; none if they stand elsewhere. */
    tell(sample: Sample, now: number, stands: boolean): void {
        if (stands) return void (this.chart.readings = [])
        if (now < this.read + READ) return
        this.read = now
        const { engine, texts, data: { lines, scale }, chart } = this
        chart.readings = engine.texts.map(({ name, side }, i) => {
            const values = lines.map(({ field, at }) => engine.field(sample, i, field)?.[at])
            const known = values.filter(value => value !== undefined).map(value => significantly(texts, value * scale, chart.axes))
            return { name, value: known.join(" · "), tone: `side${side}` }
        })
    }

    /** What a screen reader is told of it. */
    spoken(sample: Sample): string {
        const { engine, texts, data: { lines, scale, unit } } = this
        return engine.texts.map(({ name }, i) => {
            const values = lines.map(({ field, at }) => engine.field(sample, i, field)?.[at])
            const known = values.filter(value => value !== undefined).map(value => written(texts, value * scale, 1))
            return `${name} ${known.join(" · ")} ${unit}`
        }).join(", ")
    }

    /** The curves of the log of a real arm, where there is one that has this quantity. */
    private log(): readonly Line[] {
        const { engine: { log }, texts, data: { lines, scale } } = this
        if (log !== this.logged.log) {
            const name = phrase(texts, "chart.log"), curves = lines.flatMap(({ field, at, name: own }): Line[] => {
                const values = log?.fields.get(field)?.[at]?.map(value => value * scale)
                return values ? [{ name: own ? `${name} ${own}` : name, tone: "ink", dashed: false, thin: true, logged: true, times: log!.times, values }] : []
            })
            this.logged = { log, lines: curves }
        }
        return this.logged.lines
    }

    private extent(robotLines: readonly Line[]): [number, number] {
        const { from, until } = this.chart
        let [low, high] = [Infinity, -Infinity]
        for (const { times, values } of [...robotLines, ...this.log()]) {
            const last = firstAfter(times, until)
            for (let i = firstAfter(times, from); i <= last && i < values.length; i++) {
                if (values[i]! < low) low = values[i]!
                if (values[i]! > high) high = values[i]!
            }
        }
        return low <= high ? [low, high] : [0, 0]
    }

    /** The least range of the axis, with what a task wants. */
    private least(low: number, high: number): [number, number] {
        const { chart, data } = this
        const wanted = chart.limits.flatMap(({ below, above }) => [below, above]).filter(each => each !== null)
        if (wanted.length) return [Math.min(0, ...wanted.map(each => 1.5 * each)), Math.max(0, ...wanted.map(each => 1.5 * each))]
        return data.floats ? [(low + high - data.least[1]) / 2, (low + high + data.least[1]) / 2] : [...data.least]
    }
}

/** A number with as many decimals as its axis can tell apart; 0 has none. */
export function significantly(texts: Texts, value: number, { bottom, top }: { bottom: number; top: number }): string {
    const decimals = Math.min(4, Math.max(0, 2 - Math.floor(Math.log10(top - bottom))))
    return written(texts, value, Math.abs(value) < 0.5 * 10 ** -decimals ? 0 : decimals)
}
