// The symbols in a lesson's texts: pointing at one, or choosing it in the list, shows it on the robots.

import { made } from "../core/dom"
import type { PageData } from "../core/lesson_data"
import { phrase } from "../core/words"

const MARKED = "[data-symbol]"

export class Legend {
    private lit = ""
    private readonly meaning = made("p", "meaning")

    /** `light` shows a symbol on the robots; none if it is empty. */
    constructor(private readonly page: PageData, private readonly light: (symbol: string) => void, ended?: AbortSignal) {
        this.meaning.setAttribute("aria-hidden", "true") // the list says it
        document.addEventListener("pointerdown", event => this.show(nameAt(event)), ended ? { signal: ended } : {})
    }

    /** Let the symbols of a step be shown, and list them below its text. */
    add(section: HTMLElement): void {
        const words = section.querySelector<HTMLElement>(".words")!
        words.addEventListener("pointerover", event => event.pointerType === "mouse" && this.show(nameAt(event)))
        words.addEventListener("pointerleave", event => event.pointerType === "mouse" && this.show(""))
        const names = [...new Set([...words.querySelectorAll<HTMLElement>(MARKED)].map(nameOf))]
        if (!names.length) return
        const entries = names.map(name => made("li", "", this.button(words, name)))
        const summary = made("summary", "", phrase(this.page, "site.symbols"))
        words.append(made("details", "symbols script-only", summary, made("ul", "", ...entries)))
    }

    /** Show no symbol, as when a step is left. */
    clear(): void {
        this.show("")
    }

    private button(words: HTMLElement, name: string): HTMLElement {
        const sign = words.querySelector(`[data-symbol="${name}"]`)!.cloneNode(true) as HTMLElement
        const inMath = sign.namespaceURI !== document.documentElement.namespaceURI
        const shown = inMath ? document.createElementNS(sign.namespaceURI, "math") : made("b", "")
        shown.append(sign)
        const button = made("button", "", shown, ` ${this.page.symbols[name]}`)
        button.type = "button"
        button.dataset["lights"] = name
        button.addEventListener("focus", () => this.show(name))
        button.addEventListener("blur", () => this.show(""))
        return button
    }

    private show(name: string): void {
        if (name === this.lit) return
        this.lit = name
        const open = document.querySelector(".step.open")
        open?.querySelectorAll(MARKED).forEach(each => each.classList.toggle("lit", nameOf(each as HTMLElement) === name))
        const sign = open?.querySelector(`[data-symbol="${name}"]`)?.textContent ?? ""
        this.meaning.textContent = name && `${sign}: ${this.page.symbols[name]}`
        if (name) open?.querySelector(".pager")?.before(this.meaning)
        else this.meaning.remove()
        this.light(name)
    }
}

/** The symbol under a pointer, or that of its button in the list; may be empty. */
function nameAt(event: Event): string {
    const found = (event.target as Element).closest<HTMLElement>(`${MARKED}, [data-lights]`)
    return found ? nameOf(found) : ""
}

function nameOf(element: HTMLElement): string {
    return element.getAttribute("data-symbol") ?? element.getAttribute("data-lights")!
}
