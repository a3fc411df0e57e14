// Buttons, menus and sliders of a figure.

import { isTyped, keyOf, made } from "../core/dom"
import type { Point, SliderData } from "../core/figure_data"
import { said, significant } from "../core/words"
import type { Simulation } from "../simulation/simulation"
import { Transport } from "../parts/transport"
import type { Figure } from "./figure"

const DIRECTIONS: Record<string, Point> = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }

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
