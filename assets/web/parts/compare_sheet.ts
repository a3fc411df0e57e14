// A comparison of laws under one obstruction: a table in an order that one chooses, the curves beside it, and a way from
// each row to a robot on the stage.

import type { Command, Compared, ComparedLaw, CompareSheet, PageMessage } from "../channel/messages"
import { made, svg, tell } from "../core/dom"
import { niceStep } from "../core/numbers"
import { phrase, written, type Texts } from "../core/words"
import { pressed, SheetDialog } from "./sheet"

const [WIDTH, HEIGHT, LEFT, BELOW] = [560, 260, 44, 30] // [px] of the picture, and of its margins
const MEASURES = ["distance", "delay", "force"] as const
type Measure = (typeof MEASURES)[number]

interface Comparing {
    /** The laws of the two robots now. */
    readonly laws: readonly string[]
    send(message: Command | PageMessage): void
    /** Show what there is to say about the laws. */
    about(): void
}

/** The sheet, which keeps its last results while it is closed. */
export class LawComparison {
    private readonly sheet: SheetDialog
    private readonly laws = made("fieldset", "laws")
    private readonly what = made("select", "")
    private readonly start: HTMLButtonElement
    private readonly state = made("p", "state")
    private readonly result = made("div", "result")
    private data: CompareSheet = { is: "compare", laws: [], obstructions: [], most: 0 }
    private rows: readonly ComparedLaw[] = []
    private acts: readonly [number, number] = [0, 0]
    private by: Measure = "distance"
    private staged = ""

    constructor(private readonly texts: Texts, private readonly host: Comparing) {
        this.sheet = new SheetDialog(texts, "compare", phrase(texts, "compare.title"))
        this.state.setAttribute("role", "status")
        this.start = pressed("main", phrase(texts, "compare.run"), () => this.run())
        const what = made("label", "", made("span", "", phrase(texts, "compare.obstruction")), this.what)
        const about = pressed("", phrase(texts, "laws.about"), () => host.about())
        this.sheet.body.append(made("p", "", phrase(texts, "compare.text")), this.laws, made("div", "row", what, this.start, about), this.state, this.result)
    }

    /** Open it with what can be compared now; the last results are still there. */
    open(data: CompareSheet): SheetDialog {
        const { texts, laws, what } = this
        if (JSON.stringify(data) !== JSON.stringify(this.data)) {
            this.data = data
            const boxes = data.laws.map(law => {
                const box = Object.assign(made("input", ""), { type: "checkbox", value: law.name, checked: law.chosen })
                return Object.assign(made("label", "", box, law.label), { title: law.text })
            })
            laws.replaceChildren(made("legend", "", phrase(texts, "compare.laws")), ...boxes)
            const chosen = what.value || "brake"
            what.replaceChildren(...data.obstructions.map(({ name, label }) => Object.assign(made("option", "", label), { value: name })))
            what.value = chosen
        }
        this.sheet.open(this.start)
        this.follow()
        return this.sheet
    }

    /** Show which laws are on the stage. */
    follow(): void {
        const now = JSON.stringify(this.host.laws)
        if (now !== this.staged && this.sheet.isOpen) this.draw()
        this.staged = now
    }

    /** Show the results so far. */
    show({ rows, all, acts }: Compared): void {
        const { texts } = this
        this.rows = rows
        this.acts = acts
        this.start.disabled = rows.length < all
        tell(this.state, rows.length < all ? phrase(texts, "compare.computing", { done: String(rows.length), all: String(all) }) : "")
        this.draw()
        if (rows.length === 1) this.result.scrollIntoView({ block: "nearest" })
    }

    /** Say why nothing is compared. */
    refuse(why: string): void {
        this.start.disabled = false
        tell(this.state, why)
    }

    private run(): void {
        const laws = [...this.laws.querySelectorAll<HTMLInputElement>("input:checked")].map(box => box.value)
        if (laws.length < 1 || laws.length > this.data.most) return tell(this.state, phrase(this.texts, "compare.count", { most: String(this.data.most) }))
        this.start.disabled = true
        this.rows = []
        tell(this.state, phrase(this.texts, "compare.computing", { done: "0", all: String(laws.length) }))
        this.host.send({ is: "compare_laws", laws, obstruction: this.what.value })
    }

    private draw(): void {
        const { texts, rows, by } = this
        if (!rows.length) return this.result.replaceChildren()
        const ordered = [...rows].sort((a, b) => Number(a.stopped) - Number(b.stopped) || a[by] - b[by])
        const heads = MEASURES.map(measure => {
            const sort = pressed("sort", phrase(texts, `compare.${measure}`), () => {
                this.by = measure
                this.draw()
                this.result.querySelector<HTMLElement>(`.sort[data-by=${measure}]`)?.focus()
            })
            sort.dataset["by"] = measure
            const head = Object.assign(made("th", "", sort), { scope: "col" })
            if (measure === by) head.ariaSort = "ascending"
            return head
        })
        const body = ordered.map(row => this.row(row))
        const table = made("table", "", made("thead", "", made("tr", "", Object.assign(made("th", "", phrase(texts, "compare.law")), { scope: "col" }), ...heads, made("th", "", made("span", "op-unseen", phrase(texts, "compare.put"))))), made("tbody", "", ...body))
        const notes = [...(rows.some(row => row.stopped) ? [phrase(texts, "compare.stopped_text")] : []), ...rows.map(row => row.beyond).filter(Boolean)]
        this.result.replaceChildren(this.curves(ordered), made("div", "wide", table), ...notes.map(each => made("p", "note", each)))
    }

    private row(row: ComparedLaw): HTMLElement {
        const { texts, host } = this
        const side = host.laws.indexOf(row.law)
        const cells = [written(texts, row.distance, 1), written(texts, row.delay, 1), written(texts, row.force, 0)]
        const put = ([0, 1] as const).map(i => {
            const button = pressed(`put side${i}`, phrase(texts, i ? "compare.put_right" : "compare.put_left"), () => {
                host.send({ do: "ChooseLaw", side: i ? "right" : "left", law: row.law })
            })
            button.ariaLabel = `${row.label}: ${button.textContent}`
            button.disabled = host.laws[i] === row.law
            return button
        })
        const name = Object.assign(made("th", "", made("i", "swatch"), row.label), { scope: "row" })
        name.style.setProperty("--colour", this.colour(row.law))
        if (side >= 0) name.append(" ", made("small", "", phrase(texts, host.laws.every(each => each === row.law) ? "compare.on_both" : side ? "compare.on_right" : "compare.on_left")))
        const line = made("tr", side >= 0 ? `side${side}` : "", name, ...cells.map(cell => made("td", "", row.stopped ? phrase(texts, "compare.stopped") : cell)), made("td", "", ...put))
        line.addEventListener("pointerenter", () => this.point(row.law))
        line.addEventListener("pointerleave", () => this.point(""))
        return line
    }

    private point(law: string): void {
        for (const line of this.result.querySelectorAll<SVGElement>("polyline")) line.classList.toggle("faint", law !== "" && line.dataset["law"] !== law)
    }

    /** A robot on the stage has its own colour; others have those of the series. */
    private colour(law: string): string {
        const side = this.host.laws.indexOf(law)
        if (side >= 0) return `var(--tone-side${side})`
        const others = this.data.laws.map(each => each.name).filter(name => !this.host.laws.includes(name))
        return `var(--tone-other${Math.max(others.indexOf(law), 0) % 6})`
    }

    /** The distance to the path over time, at the worst place of each law. */
    private curves(rows: readonly ComparedLaw[]): Element {
        const { texts } = this
        const picture = svg("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "aria-label": phrase(texts, "compare.picture") })
        const until = Math.max(...rows.map(row => row.step * (row.curve.length - 1)), 1)
        const finite = rows.flatMap(row => row.curve).filter(Number.isFinite)
        const top = niceStep(Math.max(...finite.map(each => Math.min(each, 500)), 1))
        const x = (time: number) => LEFT + (time / until) * (WIDTH - LEFT - 8), y = (value: number) => HEIGHT - BELOW - (Math.min(value, top) / top) * (HEIGHT - BELOW - 10)
        const [from, to] = this.acts
        picture.append(svg("rect", { class: "acts", x: x(from), y: 10, width: Math.max(x(Math.min(to, until)) - x(from), 0), height: HEIGHT - BELOW - 10 }))
        for (const part of [0, 0.5, 1]) {
            picture.append(svg("line", { class: "grid", x1: LEFT, x2: WIDTH - 8, y1: y(part * top), y2: y(part * top) }))
            picture.append(letters(LEFT - 6, y(part * top) + 4, written(texts, part * top), "end"))
        }
        for (let time = 0; time <= until; time++) picture.append(letters(x(time), HEIGHT - BELOW + 16, written(texts, time), "middle"))
        picture.append(letters(WIDTH - 8, HEIGHT - 2, phrase(texts, "compare.time"), "end"), letters(LEFT - 40, 8, "mm", "start"))
        for (const row of [...rows].reverse()) {
            const points = row.curve.map((value, i) => `${x(i * row.step).toFixed(1)},${y(value).toFixed(1)}`).join(" ")
            const line = svg("polyline", { points })
            line.style.stroke = this.colour(row.law)
            line.dataset["law"] = row.law
            picture.append(line)
        }
        return made("figure", "", picture, made("figcaption", "", phrase(texts, "compare.curves")))
    }
}

function letters(x: number, y: number, text: string, anchor: string): SVGElement {
    return svg("text", { x, y, "text-anchor": anchor }, text)
}
