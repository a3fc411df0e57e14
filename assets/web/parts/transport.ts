// Buttons for time and for the brake: hold, hold while pressed, pause, step, reset, rate; and back from the past.

import { made, tell } from "../core/dom"
import type { Engine } from "../core/engine"
import { said, written, type Texts } from "../core/words"

const RATES = [1, 0.5, 0.25, 0.1]

export class Transport {
    readonly element: HTMLElement
    private readonly held: HTMLButtonElement
    private readonly run: HTMLButtonElement
    private readonly rate: HTMLSelectElement
    /** Shown in place of the brakes while one looks at the past. */
    readonly past: HTMLElement
    private readonly goes: HTMLButtonElement
    readonly brakes: HTMLButtonElement[]
    private readonly hints = new Map<HTMLElement, string>()

    /** `offered`: names of the controls, "hold", "run", "step", and "reset". */
    constructor(
        private readonly texts: Texts,
        private readonly engine: Engine,
        offered: readonly string[],
        ended?: AbortSignal,
        private readonly offers: readonly number[] = RATES,
    ) {
        this.held = this.button("main", "", "run.hold_hint", () => this.toggleHold())
        this.brakes = [this.held, this.press()]
        this.run = this.button("", "run.run", "run.run_hint", () => this.toggleRun())
        this.rate = this.rates()
        const every: Record<string, HTMLElement[]> = {
            hold: this.brakes,
            run: [this.run],
            step: [this.button("", "run.step", "key.right", () => this.engine.act({ do: "step" }))],
            reset: [this.button("", "run.reset", "key.reset", () => this.engine.act({ do: "reset" }))],
        }
        const buttons = Object.keys(every).filter(name => offered.includes(name)).flatMap(name => every[name]!)
        if (offered.includes("run")) buttons.push(this.rate)
        this.goes = this.button("", "past.go_on", "transport.go_on_hint", () => this.engine.act({ do: "goOn" }))
        const back = this.button("", "transport.back", "transport.back_hint", () => this.engine.act({ do: "look", at: null }))
        this.past = made("div", "past", back, this.goes)
        this.element = made("div", "transport", this.past, ...buttons)
        engine.on(change => change !== "samples" && this.show(), ended)
        this.show()
    }

    toggleHold(): void {
        this.hold(!this.engine.state.held)
    }

    toggleRun(): void {
        this.engine.act({ do: "run", on: !this.engine.state.running })
    }

    private hold(on: boolean): void {
        this.engine.act({ do: "hold", on })
    }

    private show(): void {
        const { texts, engine, held, run, rate, past, goes } = this
        const { state } = engine
        const both = engine.texts.length > 1 ? "_both" : ""
        tell(held, said(texts, state.held ? `run.let${both}_go` : `run.hold${both}`))
        held.ariaPressed = String(state.held)
        tell(run, said(texts, state.running ? "run.pause" : "run.run"))
        const chosen = this.offers.indexOf(state.rate)
        if (rate.selectedIndex !== chosen) rate.selectedIndex = chosen
        past.hidden = state.past === null
        for (const brake of this.brakes) brake.hidden = !past.hidden // the buttons of the past take their place
        goes.hidden = !state.branches
        this.freeze(state.frozen)
    }

    /** Say on each button why it does nothing now. It keeps the focus, and pressing it repeats the reason. */
    private freeze(why: string): void {
        for (const button of this.element.querySelectorAll<HTMLButtonElement>("button")) {
            const hint = this.hints.get(button) ?? button.title
            this.hints.set(button, hint)
            button.ariaDisabled = why ? "true" : null
            button.title = why || hint
        }
        this.rate.disabled = Boolean(why)
        this.rate.title = why || this.rate.ariaLabel!
    }

    private button(name: string, text: string, hint: string, act: () => void): HTMLButtonElement {
        const button = made("button", name, text && said(this.texts, text))
        button.type = "button"
        button.title = said(this.texts, hint)
        button.addEventListener("click", act)
        return button
    }

    /** A button that holds as long as it is pressed, with the mouse, a finger or a key. */
    private press(): HTMLButtonElement {
        const button = this.button("", "run.press", "run.press_hint", () => {})
        let pressed = false
        const press = (on: boolean) => {
            if (pressed !== on) this.hold((pressed = on))
        }
        button.addEventListener("pointerdown", event => {
            if (event.button !== 0) return
            button.setPointerCapture(event.pointerId)
            press(true)
        })
        for (const end of ["pointerup", "pointercancel", "lostpointercapture", "blur"]) button.addEventListener(end, () => press(false))
        button.addEventListener("contextmenu", event => event.preventDefault()) // of a long touch
        button.addEventListener("keydown", event => {
            if (event.key !== " " && event.key !== "Enter") return
            event.preventDefault()
            event.stopPropagation()
            press(true)
        })
        button.addEventListener("keyup", event => [" ", "Enter"].includes(event.key) && press(false))
        return button
    }

    private rates(): HTMLSelectElement {
        const select = made("select", "", ...this.offers.map(rate => made("option", "", `×${written(this.texts, rate)}`)))
        select.title = select.ariaLabel = said(this.texts, "run.rate")
        select.addEventListener("change", () => this.engine.act({ do: "rate", rate: this.offers[select.selectedIndex]! }))
        return select
    }
}
