// Buttons for time and for the brake: hold, pause, step, reset, rate; and back from the past.

import { made } from "../core/dom"
import type { Engine } from "../core/engine"
import { phrase, written, type Texts } from "../core/words"

const RATES = [1, 0.5, 0.25, 0.1]
const KEPT = 800 // [ms]; a press on Hold that is longer lets go at its end

export class Transport {
    readonly element: HTMLElement
    /** The brake; while one looks at the past, the buttons of the past stand in its place. */
    readonly brake: HTMLElement
    /** How fast time runs; may be put elsewhere. */
    readonly rate: HTMLSelectElement
    private readonly step: HTMLButtonElement // there while time stands still, so it is the last one
    private readonly held: HTMLButtonElement
    private readonly run: HTMLButtonElement
    private readonly past: HTMLElement
    private readonly goes: HTMLButtonElement
    private readonly hints = new Map<HTMLElement, string>()

    /** `offered`: names of the controls, "hold", "run", "step", and "reset". */
    constructor(
        private readonly texts: Texts,
        private readonly engine: Engine,
        offered: readonly string[],
        ended?: AbortSignal,
        private readonly offers: readonly number[] = RATES,
    ) {
        const both = engine.texts.length > 1 ? "_both" : ""
        this.held = this.button("main", [`run.hold${both}`, `run.let${both}_go`], "run.hold_hint", () => {})
        this.brakes(this.held)
        this.run = this.button("", ["run.run", "run.pause"], "run.run_hint", () => this.toggleRun())
        this.rate = this.rates()
        this.step = this.button("advance", ["run.step"], "key.right", () => this.engine.act({ do: "step" }))
        const every: Record<string, HTMLElement[]> = {
            run: [this.run],
            reset: [this.button("reset", ["run.reset"], "key.reset", () => this.engine.act({ do: "reset" }))],
        }
        const buttons = Object.keys(every).filter(name => offered.includes(name)).flatMap(name => every[name]!)
        if (offered.includes("run")) buttons.push(this.rate)
        if (offered.includes("step")) buttons.push(this.step)
        this.goes = this.button("", ["past.go_on"], "transport.go_on_hint", () => this.engine.act({ do: "goOn" }))
        const back = this.button("", ["transport.back"], "transport.back_hint", () => this.engine.act({ do: "seek", at: null }))
        this.past = made("div", "past", back, this.goes)
        this.brake = made("div", "brake", this.past, ...(offered.includes("hold") ? [this.held] : []))
        this.element = made("div", "transport", this.brake, ...buttons)
        engine.on(change => change !== "samples" && this.show(), ended)
        this.show()
    }

    /** Whether something else is the main thing to press now. */
    set subdued(subdued: boolean) {
        this.held.classList.toggle("main", !subdued)
    }

    /** Whether one is asked to hold the robots back, or to let them go. */
    set invited(invited: boolean) {
        this.held.classList.toggle("invited", invited)
    }

    /** Put further buttons after its own. */
    add(...buttons: HTMLElement[]): void {
        if (this.step.parentElement) this.step.before(...buttons)
        else this.element.append(...buttons)
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
        const { engine, held, run, rate, past, goes } = this
        const { state } = engine
        label(held, Number(state.held))
        held.ariaPressed = String(state.held)
        label(run, Number(state.running))
        this.step.classList.toggle("off", state.running)
        const chosen = this.offers.indexOf(state.rate)
        if (rate.selectedIndex !== chosen) rate.selectedIndex = chosen
        past.hidden = state.past === null
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

    /** A button with the width of the longest of its labels, so that nothing beside it moves. */
    private button(name: string, labels: string[], hint: string, act: () => void): HTMLButtonElement {
        const button = made("button", name, ...labels.map(each => made("span", "", phrase(this.texts, each))))
        button.type = "button"
        button.title = phrase(this.texts, hint)
        button.addEventListener("click", act)
        label(button, 0)
        return button
    }

    /** Pressed, it holds; pressed again, it lets go. It also lets go at the end of a long press, with the mouse, a finger or a
     * key. */
    private brakes(button: HTMLButtonElement): void {
        let began: number | null = null // [ms], when a press that holds began
        let pressed = false
        const press = (at: number) => {
            pressed = true
            began = this.engine.state.held ? null : at
            if (began !== null) this.hold(true)
        }
        const release = (at: number) => {
            if (!pressed) return
            pressed = false
            if (began === null || at > began + KEPT) this.hold(false)
        }
        button.addEventListener("pointerdown", event => {
            if (event.button !== 0) return
            button.setPointerCapture(event.pointerId)
            press(event.timeStamp)
        })
        for (const end of ["pointerup", "pointercancel", "lostpointercapture", "blur"]) button.addEventListener(end, event => release(event.timeStamp))
        button.addEventListener("contextmenu", event => event.preventDefault()) // of a long touch
        button.addEventListener("click", event => event.detail === 0 && !event.pointerType && this.toggleHold()) // by a screen reader
        button.addEventListener("keydown", event => {
            if (event.key !== " " && event.key !== "Enter") return
            event.preventDefault()
            event.stopPropagation()
            if (!event.repeat) press(event.timeStamp)
        })
        button.addEventListener("keyup", event => {
            if (event.key !== " " && event.key !== "Enter") return
            event.preventDefault() // else a click follows
            release(event.timeStamp)
        })
    }

    private rates(): HTMLSelectElement {
        const select = made("select", "", ...this.offers.map(rate => made("option", "", `×${written(this.texts, rate)}`)))
        select.title = select.ariaLabel = phrase(this.texts, "run.rate")
        select.addEventListener("change", () => this.engine.act({ do: "rate", rate: this.offers[select.selectedIndex]! }))
        return select
    }
}

/** Show one of a button's labels; the others keep their room. */
function label(button: HTMLButtonElement, shown: number): void {
    for (const [i, each] of [...button.children].entries()) each.classList.toggle("off", i !== shown)
}
