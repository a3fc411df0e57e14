// Buttons, menus and sliders of a figure.

import { isTyped, keyOf, made } from "../core/dom"
import type { Point, Setting, SliderData } from "../core/figure_data"
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
        const sliders = data.sliders.map(each => this.control(each))
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

    private control(data: SliderData): HTMLElement {
        return data.kind === "switch" ? this.tick(data) : data.kind === "choice" ? this.options(data) : this.slider(data)
    }

    private tick({ name, label, help }: SliderData): HTMLElement {
        const input = made("input", "")
        Object.assign(input, { type: "checkbox", role: "switch", title: help })
        const show = () => (input.checked = Boolean(this.simulation.values[name]))
        input.addEventListener("change", () => this.set(name, input.checked))
        input.addEventListener("told", show)
        show()
        return made("label", "choice", input, ` ${label}`)
    }

    private options({ name, label, options }: SliderData): HTMLElement {
        const { simulation } = this
        const values = options.map(option => option.value)
        const first = values.indexOf(simulation.values[name]!)
        const choice = this.choice(label, options.map(option => option.label), first, chosen => this.set(name, values[chosen]!))
        choice.querySelector("select")!.addEventListener("told", event => {
            (event.target as HTMLSelectElement).selectedIndex = values.indexOf(simulation.values[name]!)
        })
        return choice
    }

    private slider({ name, label, unit, low, high, step, help }: SliderData): HTMLElement {
        const { data } = this.simulation
        const input = made("input", "")
        const shown = made("span", "value")
        const value = () => Number(this.simulation.values[name])
        const show = () => {
            shown.textContent = `${significant(data, value(), 4)} ${unit}`.trim()
            input.setAttribute("aria-valuetext", shown.textContent)
        }
        shown.setAttribute("aria-hidden", "true")
        Object.assign(input, { type: "range", min: low, max: high, step, value: value(), title: help })
        input.addEventListener("input", () => {
            this.set(name, input.valueAsNumber)
            show()
        })
        input.addEventListener("told", () => {
            if (input.valueAsNumber !== value()) input.value = String(value())
            show()
        })
        show()
        return made("label", "slider", made("span", "", label), input, shown)
    }

    /** Show the values that something else has set. */
    tell(): void {
        for (const each of this.element.querySelectorAll("input, select")) each.dispatchEvent(new Event("told"))
    }

    private set(name: string, value: Setting): void {
        this.simulation.set({ [name]: value })
        this.page.changed()
    }

    /** The lab's keys, unless the focused control uses them. */
    private key(event: KeyboardEvent): void {
        const target = event.target as HTMLElement
        if (isTyped(event) || target.closest("input, [role=slider]")) return
        if (event.key === " " && target.closest("button")) return
        const { simulation, transport, page } = this
        const { selected, followed, data: { edit: { nudge } } } = simulation
        const acts: Record<string, [string, () => void]> = {
            h: ["hold", () => transport.toggleHold()],
            " ": ["run", () => transport.toggleRun()],
            ArrowRight: ["step", () => page.engine.act({ do: "step" })],
            r: ["reset", () => page.engine.act({ do: "reset" })],
            g: ["run", () => page.engine.act({ do: "goOn" })],
            n: ["drag", () => simulation.select(((selected ?? -1) + 1) % followed.data.points.length)],
        }
        const direction = DIRECTIONS[event.key]
        if (selected !== null && direction) acts[event.key] = ["drag", () => simulation.bend(selected, nudge * direction[0], nudge * direction[1])]
        if (selected !== null) acts["Escape"] = ["drag", () => simulation.select(null)]
        const [name, act] = acts[event.key] ?? acts[keyOf(event)] ?? []
        if (!name || !act || !simulation.data.controls.includes(name) || (event.repeat && !direction)) return
        event.preventDefault()
        act()
        this.page.changed()
    }
}
