// The menu of the plots: which quantities are shown under the stage, and their table.

import { made } from "../core/dom"
import { phrase, type Texts } from "../core/words"
import { Menu } from "./menu"
import { pressed } from "./sheet"

/** What one can do with the log of a real arm. */
export interface LogActs {
    choose: () => void
    remove: () => void
}

export class PlotMenu {
    private readonly menu: Menu
    /** The button that opens it, and its list. */
    readonly element: HTMLElement
    /** Removes the log of an arm; hidden while there is none. */
    readonly remove: HTMLButtonElement
    private readonly last: HTMLButtonElement[]
    private readonly before: HTMLElement[] = [] // the rows

    /** `choose` is called with the name of a row, and whether it is wanted; `tell` shows the curves as a table. */
    constructor(texts: Texts, private readonly choose: (name: string, on: boolean) => void, tell: () => void, log?: LogActs) {
        const name = phrase(texts, "plots.menu"), menu = (this.menu = new Menu(name))
        Object.assign(menu.button, { textContent: name, title: phrase(texts, "plots.menu_hint") })
        const table = pressed("", phrase(texts, "chart.table"), () => menu.leave(tell))
        this.remove = pressed("", phrase(texts, "chart.remove_log"), () => menu.leave(() => log?.remove()))
        this.last = [table, ...(log ? [pressed("", phrase(texts, "log.choose"), () => menu.leave(log.choose)), this.remove] : [])]
        this.element = made("div", "plots", menu.button, menu.list)
    }

    /** Begin with something else, of which its name tells. */
    begin(first: HTMLElement, name: string, hint: string): void {
        const { button, list } = this.menu
        Object.assign(button, { textContent: name, title: hint })
        list.ariaLabel = name
        list.prepend(first)
        this.before.push(first)
    }

    /** Show the rows that there can be. */
    show(rows: readonly { name: string; menu: string; on: boolean }[]): void {
        const { list } = this.menu
        const focused = list.contains(document.activeElement) ? (document.activeElement as HTMLInputElement).value : null
        list.replaceChildren(...this.before, ...rows.map(({ name, menu, on }) => {
            const box = made("input", "")
            Object.assign(box, { type: "checkbox", checked: on, value: name })
            box.addEventListener("change", () => this.choose(name, box.checked))
            return made("label", "", box, menu)
        }), ...this.last)
        if (focused !== null) list.querySelector<HTMLInputElement>(`input[value="${focused}"]`)?.focus()
    }
}
