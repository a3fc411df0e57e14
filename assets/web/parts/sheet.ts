// A sheet over the page: one look for everything that opens. It closes by its cross, Escape, or a press beside it, and
// the focus goes back to what has opened it.

import { made, tell } from "../core/dom"
import { phrase, type Texts } from "../core/words"
import { icon } from "./icons"

export class SheetDialog {
    readonly element: HTMLDialogElement
    readonly body: HTMLElement
    private readonly heading: HTMLElement
    private opener: HTMLElement | null = null

    /** `name`: of its style, such as "wide". `closed` is called whenever it has been closed. */
    constructor(texts: Texts, name: string, title: string, private readonly closed: () => void = () => {}) {
        const heading = (this.heading = made("h2", "", title))
        heading.id = `op-sheet-${name}`
        const cross = pressed("op-cross", icon("close"), () => this.close())
        cross.ariaLabel = cross.title = phrase(texts, "help.close")
        this.body = made("div", "body")
        this.element = made("dialog", `op-sheet ${name}`, made("header", "", heading, cross), this.body)
        this.element.setAttribute("aria-labelledby", heading.id)
        let beside = false // whether a press has begun beside the sheet
        this.element.addEventListener("pointerdown", event => (beside = event.target === this.element))
        this.element.addEventListener("click", event => event.target === this.element && beside && this.close())
        this.element.addEventListener("close", () => this.leave())
    }

    get isOpen(): boolean { return this.element.open }

    set title(text: string) { tell(this.heading, text) }

    /** `first`: what gets the focus; else the first control after the cross, or the cross. */
    open(first?: HTMLElement | null): void {
        if (this.isOpen) return
        const { activeElement } = document
        this.opener = activeElement instanceof HTMLElement && activeElement !== document.body ? activeElement : null
        document.body.append(this.element)
        this.element.showModal()
        const control = this.body.querySelector<HTMLElement>("input, select, textarea, button, summary, a[href], [tabindex='0']")
        ;(first ?? control)?.focus()
    }

    close(): void {
        this.element.close()
    }

    private leave(): void {
        const { activeElement } = document
        const lost = activeElement === document.body || activeElement === null || this.element.contains(activeElement)
        this.element.remove()
        if (lost) this.opener?.focus()
        this.closed()
    }
}

/** A button of a sheet or panel. */
export function pressed(name: string, text: string | Node, act: () => void): HTMLButtonElement {
    const button = made("button", name, text)
    button.type = "button"
    button.addEventListener("click", act)
    return button
}

/** Whether a sheet is open: it has the keys then. */
export function isSheetOpen(): boolean {
    return document.querySelector("dialog[open]") !== null
}
