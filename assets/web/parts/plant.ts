// A plant elsewhere, in the place of the right robot: how it is, START, and a STOP that nothing covers.

import type { ServerEngine } from "../channel/channel"
import type { DrivePlant, PlantMessage } from "../channel/messages"
import { made, tell } from "../core/dom"
import { phrase, type Texts } from "../core/words"
import { pressed } from "./sheet"

const BEAT = 250 // [ms] between signs of life of the page that drives, as long as it is in sight
const TORQUES = ["zero", "hold", "damp"] as const

export class Plant {
    readonly element = made("section", "")
    private readonly stop: HTMLButtonElement
    private readonly start: HTMLButtonElement
    private readonly torque = made("select", "")
    private readonly text = made("p", "text")
    private readonly late = made("p", "late")
    private readonly choice: HTMLElement
    private readonly observer = new MutationObserver(() => this.rise())

    constructor(texts: Texts, private readonly engine: ServerEngine, private readonly signal: AbortSignal) {
        const { element, torque } = this
        this.stop = pressed("stop", phrase(texts, "plant.stop"), () => this.send("stop"))
        this.stop.title = phrase(texts, "plant.stop_hint")
        this.stop.addEventListener("pointerdown", () => this.send("stop")) // and not when it is let go
        this.start = pressed("start", phrase(texts, "plant.start"), () => this.send("start"))
        this.start.title = phrase(texts, "plant.start_hint")
        torque.append(...TORQUES.map(each => Object.assign(made("option", "", phrase(texts, `plant.${each}`)), { value: each })))
        torque.value = engine.lab!.plant!.at_fault
        this.choice = made("div", "choice", made("label", "", phrase(texts, "plant.at_fault"), torque), this.start)
        this.text.setAttribute("role", "status")
        const watches = made("p", "watches", phrase(texts, "plant.watching"))
        element.append(this.stop, this.text, this.late, this.choice, watches, made("p", "safety", phrase(texts, "plant.safety")))
        Object.assign(element, { id: "op-plant", popover: "manual", ariaLabel: phrase(texts, "plant.name") })
        document.documentElement.classList.add("op-plant")
        addEventListener("keydown", event => event.key === "Escape" && this.send("stop"), { capture: true, signal })
        document.addEventListener("toggle", event => event.target !== element && this.rise(), { capture: true, signal })
        this.observer.observe(document.body, { childList: true })
        signal.addEventListener("abort", () => {
            this.observer.disconnect()
            element.remove()
        })
        engine.on(change => change === "state" && this.show(), signal)
        this.show()
        this.rise()
        const beating = setInterval(() => document.visibilityState === "visible" && this.now.live && this.send("beat"), BEAT)
        signal.addEventListener("abort", () => clearInterval(beating))
    }

    private get now(): PlantMessage { return this.engine.lab!.plant! }

    /** Tell whoever drives it. What comes too late is of no use, so nothing is kept. */
    private send(what: DrivePlant["what"]): void {
        if (!this.engine.lab!.own || (what === "stop" && !this.now.live)) return
        this.engine.send({ is: "drive", what, at_fault: this.torque.value as DrivePlant["at_fault"] })
    }

    private show(): void {
        const { element, stop, choice, now } = this, { own } = this.engine.lab!
        tell(this.text, now.text)
        tell(this.late, now.late)
        element.dataset["phase"] = now.phase
        element.classList.toggle("watches", !own)
        stop.hidden = !own
        stop.ariaDisabled = String(!now.live)
        choice.hidden = !own || now.live
        this.start.disabled = !now.ready
    }

    /** Stand over all dialogs and menus; a dialog lets nobody press what is outside of it. */
    private rise(): void {
        const { element, signal } = this
        if (signal.aborted) return
        const place = document.querySelector("dialog[open]") ?? document.body
        if (element.parentElement !== place) place.append(element)
        if (element.matches(":popover-open")) element.hidePopover()
        element.showPopover()
    }
}
