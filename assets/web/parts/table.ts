// Curves as a table, for those who do not see the chart.

import { made } from "../core/dom"
import { niceStep } from "../core/numbers"
import { phrase, written, type Texts } from "../core/words"
import { valueAt, type Curve, type Span } from "./curves"

/** A curve with a heading. */
export interface TableColumn extends Curve {
    name: string
    unit: string
}

const ROWS = 60 // number of rows, about

/** A table that is made when it is opened. */
export function tableOf(texts: Texts, label: () => string, columns: () => readonly TableColumn[], spans: () => readonly Span[]): HTMLDetailsElement {
    const body = made("div", "wide")
    body.tabIndex = 0 // so that keys scroll it
    const details = made("details", "table", made("summary", "", phrase(texts, "chart.table")), body)
    const show = () => {
        const table = rowsOf(texts, columns(), spans())
        table.setAttribute("aria-label", label())
        body.replaceChildren(table)
    }
    details.addEventListener("toggle", () => (details.open ? show() : body.replaceChildren()))
    return details
}

function rowsOf(texts: Texts, columns: readonly TableColumn[], spans: readonly Span[]): HTMLElement {
    const heads = [phrase(texts, "chart.time"), ...columns.map(({ name, unit }) => `${name} [${unit}]`), phrase(texts, "chart.acts")]
    const row = (tag: "th" | "td", cells: string[]) => made("tr", "", ...cells.map(cell => made(tag, "", cell)))
    const all = columns.flatMap(({ times }) => [times[0] ?? Infinity, times[times.length - 1] ?? -Infinity])
    const [first, last] = [Math.min(...all), Math.max(...all)]
    const step = niceStep(Math.max((last - first) / ROWS, 0.5))
    const seconds = Array.from({ length: Math.max(0, Math.floor((last - first) / step + 1e-9)) + 1 }, (_, i) => first + i * step)
    const body = seconds.filter(Number.isFinite).map(time => {
        const values = columns.map(column => valueAt(column, time)).map(value => (value === null ? "" : written(texts, value, decimals(value))))
        const acts = spans.filter(span => span.from <= time && time < span.until).map(span => phrase(texts, `chart.${span.kind}`))
        return row("td", [written(texts, time, 1), ...values, acts.join(", ")])
    })
    return made("table", "", made("thead", "", row("th", heads)), made("tbody", "", ...body))
}

/** One, or so many that three digits are told of a small number. */
function decimals(value: number): number {
    const size = Math.abs(value)
    return size >= 0.1 || size < 1e-9 ? 1 : Math.min(6, 2 - Math.floor(Math.log10(size)))
}
