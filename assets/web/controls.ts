// Buttons, menus and sliders of a figure.

import type { FigureData, Point, SliderData } from "./figure_data"
import { said, significant } from "./words"
import type { Figure } from "./figure"
import type { Simulation } from "./simulation"
import { Transport } from "./transport"

const DIRECTIONS: Record<string, Point> = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }

export function made<T extends keyof HTMLElementTagNameMap>(
    tag: T,
    name: string,
    ...inside: (Node | string)[]
): HTMLElementTagNameMap[T] {
    const element = document.createElement(tag)
    if (name) element.className = name
    element.append(...inside)
    return element
}

/** Set an element's text if it differs, so that a screen reader does not repeat it. */
export function tell(element: HTMLElement, text: string): void {
    if (element.textContent !== text) element.textContent = text
}

/** Whether a key belongs to the browser or to the focused field. */
export function isTyped({ ctrlKey, metaKey, altKey, target }: KeyboardEvent): boolean {
    const field = (target as Partial<HTMLElement>).closest?.("textarea, select, input:not([type=range])")
    return ctrlKey || metaKey || altKey || Boolean(field)
}

/** The name of a key in small letters; a letter of another alphabet counts as the Latin one on its key,
 * as in assets/page/keys.js for the lab. */
export function keyOf({ key, code }: KeyboardEvent): string {
    const foreign = /^\p{L}+$/u.test(key) && !/[a-z]/i.test(key)
    return ((foreign && /^Key([A-Z])$/.exec(code)?.[1]) || key).toLowerCase()
}

/** Show why a figure does not run, in its place. */
export function refused(data: FigureData, error: unknown): HTMLElement {
    console.error(error)
    const line = made("p", "note", said(data, "standalone.refused", { reason: String(error) }))
    line.setAttribute("role", "alert")
    return line
}

export class Controls {
    readonly element: HTMLElement
    readonly transport: Transport

    constructor(private readonly simulation: Simulation, private readonly page: Figure, ended: AbortSignal) {
        const { data } = simulation
        this.transport = new Transport(data, page.engine, data.controls, ended)
        const paths = data.paths.length > 1 && data.controls.includes("path") ? [this.paths()] : []
        const laws = data.choices.length ? simulation.sides.map((_, i) => this.laws(i)) : []
        const sliders = data.sliders.map((slider, i) => this.slider(slider, i))
        this.element = made("div", "controls", made("div", "buttons", ...paths, ...laws), made("div", "sliders", ...sliders))
        document.addEventListener("keydown", event => this.key(event), { signal: ended })
    }

    private paths(): HTMLElement {
        const { data } = this.simulation
        return this.choice(said(data, "standalone.path"), data.paths.map(path => path.label), 0, path => {
            this.simulation.choose(path)
            this.page.changed()
        })
    }

    private laws(side: number): HTMLElement {
        const { data, sides } = this.simulation
        const suffix = sides.length > 1 ? `, ${this.simulation.sideName(side)}` : ""
        const titles = data.choices.map(law => data.laws[law]!.title)
        const first = data.choices.indexOf(sides[side]!.law)
        return this.choice(said(data, "standalone.law") + suffix, titles, first, chosen => {
            sides[side]!.change(data.choices[chosen]!)
            this.page.changed()
        })
    }

    private choice(label: string, options: string[], first: number, act: (chosen: number) => void): HTMLElement {
        const select = made("select", "", ...options.map(option => made("option", "", option)))
        select.selectedIndex = first
        select.addEventListener("change", () => act(select.selectedIndex))
        return made("label", "choice", `${label} `, select)
    }

    private slider(slider: SliderData, number: number): HTMLElement {
        const { data } = this.simulation
        const input = made("input", "")
        const shown = made("span", "value")
        const show = () => {
            shown.textContent = `${significant(data, this.simulation.values[number]!, 4)} ${slider.unit}`.trim()
            input.setAttribute("aria-valuetext", shown.textContent)
        }
        shown.setAttribute("aria-hidden", "true")
        const { low, high, step, value, help } = slider
        Object.assign(input, { type: "range", min: low, max: high, step, value, title: help })
        input.addEventListener("input", () => {
            this.simulation.set(number, input.valueAsNumber)
            this.page.changed()
            show()
        })
        input.addEventListener("told", show) // the value was set by something else
        show()
        return made("label", "slider", made("span", "", slider.label), input, shown)
    }

    /** The lab's keys, unless the focused control uses them. */
    private key(event: KeyboardEvent): void {
        const target = event.target as HTMLElement
        if (isTyped(event) || target.closest("input, [role=slider]")) return
        if (event.key === " " && target.closest("button")) return
        const { simulation, transport, page } = this
        const { selected, followed } = simulation
        const acts: Record<string, [string, () => void]> = {
            h: ["hold", () => transport.toggleHold()],
            " ": ["run", () => transport.toggleRun()],
            ArrowRight: ["step", () => page.engine.act({ do: "step" })],
            r: ["reset", () => page.engine.act({ do: "reset" })],
            g: ["run", () => page.engine.act({ do: "goOn" })],
            n: ["drag", () => simulation.select(((selected ?? -1) + 1) % followed.data.points.length)],
        }
        const direction = DIRECTIONS[event.key]
        if (selected !== null && direction) acts[event.key] = ["drag", () => followed.nudge(selected, ...direction)]
        if (selected !== null) acts["Escape"] = ["drag", () => simulation.select(null)]
        const [name, act] = acts[event.key] ?? acts[keyOf(event)] ?? []
        if (!name || !act || !simulation.data.controls.includes(name) || (event.repeat && !direction)) return
        event.preventDefault()
        act()
        this.page.changed()
    }
}
