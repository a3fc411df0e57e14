// The class on a teacher's page, on a laptop as on a phone: a bar with what acts on the class, the first group of its form,
// and one level deeper the other groups, a tab each.

import { made, tell } from "../core/dom"
import type { FormMessage } from "../core/form_data"
import { phrase, type Texts } from "../core/words"
import type { Form } from "./form"
import { pressed } from "./sheet"

export class ClassPanel {
    readonly element: HTMLElement
    private readonly tabs = made("div", "tabs")
    private readonly buttons = new Map<string, HTMLButtonElement>()
    private chosen = ""
    private large: boolean | null = null

    /** Nothing but the first group is seen until a tab is pressed, and when it is pressed again. */
    constructor(texts: Texts, private readonly form: Form) {
        this.tabs.role = "tablist"
        this.tabs.ariaLabel = phrase(texts, "class.title")
        this.tabs.addEventListener("keydown", event => this.turn(event))
        this.element = made("section", "class", form.element, this.tabs)
        this.element.ariaLabel = phrase(texts, "class.title")
    }

    /** Show the groups; on a projector what the class is asked is seen, which has no nicknames. */
    show({ groups }: FormMessage, large: boolean): void {
        const { form, buttons, tabs } = this, [, ...others] = groups
        for (const { name, title } of others) {
            const button = buttons.get(name) ?? pressed("", title, () => this.choose(this.chosen === name ? "" : name))
            if (!buttons.has(name)) {
                button.role = "tab"
                button.id = `op-tab-${name}`
                buttons.set(name, button)
                tabs.append(button)
            }
            tell(button, title)
            const part = form.part(name)!
            part.id = `op-tab-${name}-panel`
            part.role = "tabpanel"
            part.setAttribute("aria-labelledby", button.id)
            button.setAttribute("aria-controls", part.id)
        }
        const told = form.row("class.told")
        if (told) told.element.role = "status"
        if (large !== this.large) this.chosen = large ? others[1]!.name : ""
        this.large = large
        this.choose(this.chosen)
    }

    private choose(name: string): void {
        this.chosen = name
        for (const [each, button] of this.buttons) {
            const isChosen = each === name
            button.ariaSelected = String(isChosen)
            button.tabIndex = isChosen || !this.chosen ? 0 : -1
            const part = this.form.part(each)
            if (part) part.hidden = !isChosen
        }
    }

    /** The keys of a list of tabs. */
    private turn(event: KeyboardEvent): void {
        const names = [...this.buttons.keys()], at = names.indexOf(this.chosen), last = names.length - 1
        const to = { ArrowLeft: at ? at - 1 : last, ArrowRight: at < last ? at + 1 : 0, Home: 0, End: last }[event.key]
        if (to === undefined) return
        event.preventDefault()
        event.stopPropagation()
        this.choose(names[to]!)
        this.buttons.get(names[to]!)!.focus()
    }
}
