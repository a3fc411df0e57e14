// Buttons, menus and sliders of a figure.

import { said, significant, type FigureData, type Point, type SliderData } from "./figure_data"
import type { Figure } from "./figure"
import type { Simulation } from "./simulation"

const WAYS: Record<string, Point> = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }

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

/** What has not changed is not announced again. */
export function written(element: HTMLElement, text: string): void {
    if (element.textContent !== text) element.textContent = text
}

/** Whether a key belongs to the browser or to the focused field. */
export function isTyped({ ctrlKey, metaKey, altKey, target }: KeyboardEvent): boolean {
    const field = (target as Partial<HTMLElement>).closest?.("textarea, select, input:not([type=range])")
    return ctrlKey || metaKey || altKey || Boolean(field)
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
    private readonly held = this.button("main", "", () => this.toggleHold(), "run.hold_hint")
    private readonly run = this.button("", "", () => this.toggleRun(), "run.run_hint")

    constructor(private readonly simulation: Simulation, private readonly page: Figure, ended: AbortSignal) {
        const { data } = simulation
        const every: Record<string, HTMLElement> = {
            hold: this.held,
            run: this.run,
            step: this.button("", said(data, "run.step"), () => this.step(), "key.right"),
            reset: this.button("", said(data, "run.reset"), () => this.reset(), "key.reset"),
            ...(data.paths.length > 1 ? { path: this.paths() } : {}),
        }
        const shown = Object.keys(every).filter(name => data.controls.includes(name))
        const laws = data.choices.length ? simulation.sides.map((_, i) => this.laws(i)) : []
        const buttons = made("div", "buttons", ...shown.map(name => every[name]!), ...laws)
        const sliders = data.sliders.map((slider, i) => this.slider(slider, i))
        this.element = made("div", "controls", buttons, made("div", "sliders", ...sliders))
        this.show()
        document.addEventListener("keydown", event => this.key(event), { signal: ended })
    }

    /** Show the present state on the buttons. */
    show(): void {
        const { data, held } = this.simulation
        const both = data.sides.length > 1 ? "_both" : ""
        written(this.held, said(data, held ? `run.let${both}_go` : `run.hold${both}`))
        this.held.ariaPressed = String(held)
        written(this.run, said(data, this.page.running ? "run.pause" : "run.run"))
    }

    toggleHold(): void {
        this.simulation.hold(!this.simulation.held)
        this.toggleRun(true)
    }

    toggleRun(on = !this.page.running): void {
        this.page.engine.act({ do: "run", on })
        this.show()
    }

    step(): void {
        this.page.engine.act({ do: "step" })
        this.show()
    }

    reset(): void {
        this.simulation.reset()
        this.begun()
    }

    private begun(): void {
        this.page.changed()
        this.show()
    }

    private button(name: string, text: string, act: () => void, hint: string): HTMLButtonElement {
        const button = made("button", name, text)
        button.type = "button"
        button.title = said(this.simulation.data, hint)
        button.addEventListener("click", act)
        return button
    }

    private paths(): HTMLElement {
        const { data } = this.simulation
        return this.choice(said(data, "standalone.path"), data.paths.map(path => path.label), 0, path => {
            this.simulation.choose(path)
            this.begun()
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
        if (isTyped(event) || target.closest("input")) return
        if (event.key === " " && target.closest("button")) return
        const { simulation } = this
        const { selected, followed } = simulation
        const acts: Record<string, [string, () => void]> = {
            h: ["hold", () => this.toggleHold()],
            " ": ["run", () => this.toggleRun()],
            ArrowRight: ["step", () => this.step()],
            r: ["reset", () => this.reset()],
            n: ["drag", () => simulation.select(((selected ?? -1) + 1) % followed.data.points.length)],
        }
        const way = WAYS[event.key]
        if (selected !== null && way) acts[event.key] = ["drag", () => followed.nudge(selected, ...way)]
        if (selected !== null) acts["Escape"] = ["drag", () => simulation.select(null)]
        const [name, act] = acts[event.key] ?? acts[event.key.toLowerCase()] ?? []
        if (!name || !act || !simulation.data.controls.includes(name) || (event.repeat && !way)) return
        event.preventDefault()
        act()
        this.page.changed()
    }
}
