// The menu of the plots: which quantities are shown under the stage, and their table.

import { made } from "../core/dom"
import { phrase, type Texts } from "../core/words"
import { pressed } from "./sheet"

export class PlotMenu {
    private readonly button = made("button", "")
    private readonly list = made("div", "op-menu")
    /** The button that opens it, and its list. */
    readonly element = made("div", "plots", this.button, this.list)

    private readonly table: HTMLButtonElement

    /** `choose` is called with the name of a row, and whether it is wanted; `tell` shows the curves as a table. */
    constructor(texts: Texts, private readonly choose: (name: string, on: boolean) => void, tell: () => void) {
        const { button, list } = this
        Object.assign(button, { type: "button", textContent: phrase(texts, "plots.menu"), title: phrase(texts, "plots.menu_hint") })
        Object.assign(list, { popover: "auto", role: "group", ariaLabel: phrase(texts, "plots.menu") })
        this.table = pressed("", phrase(texts, "chart.table"), () => {
            list.hidePopover()
            tell()
        })
        button.ariaHasPopup = "true"
        button.ariaExpanded = "false"
        button.popoverTargetElement = list
        list.addEventListener("beforetoggle", event => this.place(event.newState === "open"))
    }

    /** Show the rows that there can be. */
    show(rows: readonly { name: string; menu: string; on: boolean }[]): void {
        const { list } = this
        const focused = list.contains(document.activeElement) ? (document.activeElement as HTMLInputElement).value : null
        list.replaceChildren(...rows.map(({ name, menu, on }) => {
            const box = made("input", "")
            Object.assign(box, { type: "checkbox", checked: on, value: name })
            box.addEventListener("change", () => this.choose(name, box.checked))
            return made("label", "", box, menu)
        }), this.table)
        if (focused !== null) list.querySelector<HTMLInputElement>(`input[value="${focused}"]`)?.focus()
    }

    /** The list stands above the button, or below it where there is more room. */
    private place(open: boolean): void {
        const { button, list } = this
        button.ariaExpanded = String(open)
        if (!open) return
        const { left, top, bottom } = button.getBoundingClientRect()
        const above = top > innerHeight / 2
        Object.assign(list.style, {
            left: `${Math.max(8, Math.min(left, innerWidth - 280))}px`,
            top: above ? "auto" : `${bottom + 4}px`,
            bottom: above ? `${innerHeight - top + 4}px` : "auto",
            maxHeight: `${(above ? top : innerHeight - bottom) - 16}px`,
        })
    }
}
