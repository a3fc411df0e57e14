// The place of the controls: a column at the right. Where there is no room for one, it is a drawer over the stage, and on
// a telephone a sheet that one pulls up from below, to half the height of the window or to all of it.

import { made, tell } from "../core/dom"
import { keepScroll } from "../core/drafts"
import { phrase, type Texts } from "../core/words"
import { icon } from "./icons"
import { pressed } from "./sheet"

const MOVED = 24 // [px] from which a press on the handle is a pull

export class Panel {
    readonly element = made("aside", "")
    readonly body = made("div", "body")
    private readonly frozen = made("p", "frozen")
    private readonly handle: HTMLButtonElement

    /** `opener`: the button that opens it as a drawer. */
    constructor(texts: Texts, private readonly opener: HTMLButtonElement, signal: AbortSignal) {
        const name = phrase(texts, "lesson.controls")
        const cross = pressed("op-cross", icon("close"), () => this.show(false))
        cross.ariaLabel = cross.title = phrase(texts, "help.close")
        this.handle = pressed("handle", "", () => {})
        this.handle.ariaLabel = phrase(texts, "panel.handle")
        this.element.id = "op-panel"
        this.element.ariaLabel = name
        this.element.append(made("div", "over", this.handle, made("h2", "", name), cross), this.frozen, this.body)
        opener.setAttribute("aria-controls", this.element.id)
        this.element.addEventListener("keydown", event => {
            if (event.key === "Escape" && this.isOpen && !event.defaultPrevented) this.show(false)
        }, { signal })
        this.pull(signal)
    }

    /** Show the controls, as far down as they were. */
    fill(controls: HTMLElement): void {
        this.body.append(controls)
        keepScroll(this.body, "panel")
    }

    /** Whether it is open as a drawer; as a column it is always in sight. */
    get isOpen(): boolean { return this.element.classList.contains("open") }

    /** Open or close the drawer. */
    show(open: boolean): void {
        const { element, opener } = this
        element.classList.toggle("open", open)
        if (!open) element.classList.remove("full")
        opener.ariaExpanded = String(open)
        if (open) element.querySelector<HTMLElement>(".body :is(button, input, select, summary)")?.focus({ preventScroll: true })
        else if (element.contains(document.activeElement)) opener.focus()
    }

    /** Have it in sight: as a column it is. */
    bring(): void {
        if (!this.element.getClientRects().length) this.show(true)
    }

    /** Say why the lab takes no changes; an empty text: it does. */
    freeze(why: string): void {
        tell(this.frozen, why)
        this.body.inert = why !== ""
    }

    /** The handle: a press changes between half and full height, and a pull goes where it is let go. */
    private pull(signal: AbortSignal): void {
        const { handle, element } = this
        let from: number | null = null, by = 0
        handle.addEventListener("pointerdown", event => {
            from = event.clientY
            by = 0
            handle.setPointerCapture(event.pointerId)
        }, { signal })
        handle.addEventListener("pointermove", event => {
            if (from === null) return
            by = event.clientY - from
            element.style.translate = `0 ${Math.max(by, element.classList.contains("full") ? 0 : -MOVED)}px`
        }, { signal })
        for (const end of ["pointerup", "pointercancel"] as const)
            handle.addEventListener(end, () => {
                if (from === null) return
                from = null
                element.style.translate = ""
                if (by < -MOVED) element.classList.add("full")
                else if (by > MOVED && element.classList.contains("full")) element.classList.remove("full")
                else if (by > MOVED) this.show(false)
            }, { signal })
        handle.addEventListener("click", () => Math.abs(by) <= MOVED && element.classList.toggle("full"), { signal })
    }
}
