// One search for everything that the lab has: settings, robots, laws, paths, lessons, and what keys do.

import { made, tell } from "../core/dom"
import { phrase, type Texts } from "../core/words"
import { SheetDialog } from "./sheet"

const MOST = 12 // results that are shown

/** Something to be found. */
export interface Entry {
    /** What it is, or where it stands. */
    kind: string
    label: string
    text: string
    go: () => void
}

export class Search {
    private readonly sheet: SheetDialog
    private readonly input = made("input", "")
    private readonly list = made("ul", "results")
    private readonly none = made("p", "none")
    private found: Entry[] = []
    private chosen = 0

    /** `entries`: everything, asked for whenever the search is opened. */
    constructor(private readonly texts: Texts, private readonly entries: () => Entry[]) {
        const { input, list, none } = this
        this.sheet = new SheetDialog(texts, "search", phrase(texts, "search.title"))
        Object.assign(input, { type: "text", autocomplete: "off", enterKeyHint: "search", spellcheck: false, ariaLabel: phrase(texts, "search.title") })
        input.placeholder = phrase(texts, "search.hint")
        const told = { role: "combobox", "aria-expanded": "true", "aria-controls": "op-results", "aria-autocomplete": "list" }
        for (const [name, value] of Object.entries(told)) input.setAttribute(name, value)
        list.id = "op-results"
        list.role = "listbox"
        list.ariaLabel = phrase(texts, "search.found")
        none.setAttribute("role", "status")
        input.addEventListener("input", () => this.find())
        input.addEventListener("keydown", event => this.key(event))
        this.sheet.body.append(input, list, none)
    }

    open(): void {
        this.input.value = ""
        this.find()
        this.sheet.open(this.input)
    }

    /** Show what was found when more is known. */
    renew(): void {
        if (this.sheet.isOpen) this.find()
    }

    private find(): void {
        const { texts, input, list, none } = this
        this.found = ranked(this.entries(), input.value).slice(0, MOST)
        this.chosen = 0
        list.replaceChildren(...this.found.map((entry, i) => {
            const row = made("li", "", made("span", "what", entry.kind), made("b", "", entry.label), made("span", "text", entry.text))
            row.id = `op-result-${i}`
            row.role = "option"
            row.addEventListener("click", () => this.take(i))
            row.addEventListener("pointermove", () => this.choose(i))
            return row
        }))
        this.choose(0)
        tell(none, this.found.length ? "" : phrase(texts, "search.none"))
    }

    private choose(at: number): void {
        this.chosen = at
        ;[...this.list.children].forEach((row, i) => (row.ariaSelected = String(i === at)))
        const row = this.list.children[at]
        row?.scrollIntoView({ block: "nearest" })
        if (row) this.input.setAttribute("aria-activedescendant", row.id)
        else this.input.removeAttribute("aria-activedescendant")
    }

    private key(event: KeyboardEvent): void {
        const by = { ArrowDown: 1, ArrowUp: -1 }[event.key], { length } = this.found
        if (by && length) this.choose((this.chosen + by + length) % length)
        else if (event.key === "Enter") this.take(this.chosen)
        else return
        event.preventDefault()
    }

    private take(at: number): void {
        const entry = this.found[at]
        if (!entry) return
        this.sheet.close()
        entry.go()
    }
}

/** The entries that match all words, the best first; in their order without a word. */
export function ranked(entries: readonly Entry[], typed: string): Entry[] {
    const words = plain(typed).split(" ").filter(Boolean)
    const scored = entries.map((entry, i) => {
        const label = plain(entry.label), whole = `${label} ${plain(entry.kind)} ${plain(entry.text)}`
        const scores = words.map(word => {
            if (label === word) return 8
            if (label.startsWith(word)) return 6
            if (` ${label}`.includes(` ${word}`)) return 4
            if (label.includes(word)) return 2
            return ` ${whole}`.includes(` ${word}`) ? 1 : -Infinity
        })
        return { entry, i, score: scores.reduce((sum, score) => sum + score, 0) }
    })
    return scored.filter(each => each.score >= 0).sort((a, b) => b.score - a.score || a.i - b.i).map(each => each.entry)
}

/** Small letters without accents; K₁ is k1. */
export function plain(text: string): string {
    return text.normalize("NFKD").replaceAll(/\p{M}/gu, "").toLowerCase().replaceAll(/[^\p{L}\p{N}]+/gu, " ").trim()
}
