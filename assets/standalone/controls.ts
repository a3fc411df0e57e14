// Buttons, the choice of a path, and sliders.

import { said, type SliderData } from "./data"
import type { Simulation } from "./simulation"

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

export interface Running {
    running: boolean
    /** Simulate one frame, and stay paused. */
    step(): void
    /** What was drawn belongs to an earlier run. */
    forget(): void
}

export class Controls {
    readonly element: HTMLElement
    private readonly held: HTMLButtonElement
    private readonly run: HTMLButtonElement

    constructor(
        private readonly simulation: Simulation,
        private readonly page: Running,
        ended: AbortSignal,
    ) {
        const { data } = simulation
        this.held = this.button("main", "", () => this.toggleHold(), said(data, "run.hold_hint"))
        this.run = this.button("", "", () => this.toggleRun(), said(data, "run.run_hint"))
        const every: Record<string, HTMLElement> = {
            hold: this.held,
            run: this.run,
            step: this.button("", said(data, "run.step"), () => this.step(), said(data, "key.right")),
            reset: this.button("", said(data, "run.reset"), () => this.reset(), said(data, "key.reset")),
            ...(data.paths.length > 1 ? { path: this.paths() } : {}),
        }
        const shown = Object.keys(every).filter(name => data.controls.includes(name))
        const buttons = made("div", "buttons", ...shown.map(name => every[name]!))
        const sliders = data.sliders.map((slider, i) => this.slider(slider, i))
        this.element = made("div", "controls", buttons, made("div", "sliders", ...sliders))
        this.show()
        document.addEventListener("keydown", event => this.key(event), { signal: ended })
    }

    /** Write the present state on the buttons. */
    show(): void {
        const { data, held } = this.simulation
        const both = data.benches.length > 1 ? "_both" : ""
        this.held.textContent = said(data, held ? `run.let${both}_go` : `run.hold${both}`)
        this.held.setAttribute("aria-pressed", String(held))
        this.run.textContent = said(data, this.page.running ? "run.pause" : "run.run")
    }

    toggleHold(): void {
        this.simulation.hold(!this.simulation.held)
        this.page.running = true
        this.show()
    }

    toggleRun(): void {
        this.page.running = !this.page.running
        this.show()
    }

    step(): void {
        this.page.running = false
        this.page.step()
        this.show()
    }

    reset(): void {
        this.simulation.reset()
        this.page.forget()
        this.show()
    }

    private button(name: string, text: string, act: () => void, hint: string): HTMLButtonElement {
        const button = made("button", name, text)
        button.type = "button"
        button.title = hint
        button.addEventListener("click", act)
        return button
    }

    private paths(): HTMLElement {
        const { data } = this.simulation
        const select = made("select", "", ...data.paths.map(path => made("option", "", path.label)))
        select.addEventListener("change", () => {
            this.simulation.choose(select.selectedIndex)
            this.page.forget()
            this.show()
        })
        return made("label", "path", `${said(data, "standalone.path")} `, select)
    }

    private slider(slider: SliderData, number: number): HTMLElement {
        const { data } = this.simulation
        const input = made("input", "")
        const shown = made("span", "value")
        const unit = slider.unit ? ` ${slider.unit}` : ""
        const show = () => {
            shown.textContent = input.value.replace("-", "−").replace(".", data.words["point"] ?? ".") + unit
            input.setAttribute("aria-valuetext", shown.textContent)
        }
        shown.setAttribute("aria-hidden", "true")
        input.type = "range"
        input.min = String(slider.low)
        input.max = String(slider.high)
        input.step = String(slider.step)
        input.value = String(slider.value)
        input.title = slider.help
        input.addEventListener("input", () => {
            this.simulation.set(number, input.valueAsNumber)
            show()
        })
        show()
        return made("label", "slider", made("span", "", slider.label), input, shown)
    }

    /** The lab's keys, unless the focused control takes them. */
    private key(event: KeyboardEvent): void {
        const target = event.target as HTMLElement
        if (event.ctrlKey || event.metaKey || event.altKey || target.closest("select, input")) return
        if (event.key === " " && target.closest("button")) return
        const acts: Record<string, [string, () => void]> = {
            h: ["hold", () => this.toggleHold()],
            " ": ["run", () => this.toggleRun()],
            ArrowRight: ["step", () => this.step()],
            r: ["reset", () => this.reset()],
        }
        const [name, act] = acts[event.key] ?? acts[event.key.toLowerCase()] ?? []
        if (!name || !act || event.repeat || !this.simulation.data.controls.includes(name)) return
        event.preventDefault()
        act()
    }
}
