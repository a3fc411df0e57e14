// A menu: a button, and what it opens beside itself.

import { made } from "../core/dom"

export class Menu {
    readonly button = made("button", "")
    readonly list = made("div", "op-menu")

    /** `name`: of the menu; its button has it, too. */
    constructor(name: string) {
        const { button, list } = this
        Object.assign(button, { type: "button", ariaHasPopup: "true", ariaExpanded: "false", popoverTargetElement: list })
        Object.assign(list, { popover: "auto", role: "group", ariaLabel: name })
        list.addEventListener("beforetoggle", event => this.place(event.newState === "open"))
    }

    /** Close it and do something; the focus is on the button then. */
    leave(act: () => void): void {
        this.list.hidePopover()
        act()
    }

    /** The list stands above or below the button, and goes to the left or to the right, where there is more room. */
    private place(open: boolean): void {
        const { button, list } = this
        button.ariaExpanded = String(open)
        if (!open) return
        const { left, right, top, bottom } = button.getBoundingClientRect()
        const above = top > innerHeight / 2, before = left > innerWidth / 2
        Object.assign(list.style, {
            left: before ? "auto" : `${left}px`,
            right: before ? `${innerWidth - right}px` : "auto",
            top: above ? "auto" : `${bottom + 4}px`,
            bottom: above ? `${innerHeight - top + 4}px` : "auto",
            maxHeight: `${(above ? top : innerHeight - bottom) - 16}px`,
        })
    }
}
