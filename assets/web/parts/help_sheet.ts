// Help: what to do, in sentences that point at the page; the keys; the words of the lessons and those of the field.

import type { GlossaryEntry, HelpSheet, ShownKey } from "../channel/messages"
import { made } from "../core/dom"
import { phrase, type Texts } from "../core/words"
import { pressed, SheetDialog } from "./sheet"

/** What the help names, in this order. */
const AIDS = ["hold", "pull", "bend", "aim", "lens", "chart", "view", "search"] as const
/** Of these, what can be done with simulated robots alone. */
const SIMULATED: readonly string[] = ["hold", "pull", "bend", "chart"]
/** The keys by what they are for; the names of others begin with one of these. */
const KINDS: Record<string, readonly string[]> = {
    time: ["run", "hold", "reset", "back", "forward", "go_on", "undo_go_on"],
    hand: ["pull_left", "pull_right", "pull_up", "pull_down", "let_go"],
    path: ["next", "none", "right", "left", "up", "down", "add", "remove", "undo", "redo"],
    wall: ["wall", "wall_left", "wall_right", "wall_up", "wall_down", "wall_turn", "wall_turn_back"],
    rest: ["slowly", "earlier", "summary", "view", "lesson"],
}

/** `point`: shows on the stage what is what; null beside a plant. */
export function help(texts: Texts, { glossary }: HelpSheet, keys: readonly ShownKey[], point: (() => void) | null): SheetDialog {
    const sheet = new SheetDialog(texts, "help", phrase(texts, "help.title"))
    const show = pressed("main", phrase(texts, "help.point"), () => {
        sheet.close()
        point?.()
    })
    show.hidden = !point
    const aids = made("dl", "aids", ...AIDS.flatMap(name => (point || !SIMULATED.includes(name) ? [made("dt", "", phrase(texts, `aid.${name}`)), made("dd", "", phrase(texts, `aid.${name}_means`))] : [])))
    sheet.body.append(aids, show, keyTable(texts, keys), glossaryOf(texts, "glossary.to_terms", glossary, "plain", "term"),
        glossaryOf(texts, "glossary.to_words", [...glossary].sort((a, b) => a.term.localeCompare(b.term)), "term", "plain"))
    sheet.open(show)
    return sheet
}

function keyTable(texts: Texts, keys: readonly ShownKey[]): HTMLElement {
    const kinds = Object.entries(KINDS).map(([kind, names]) => {
        const rows = names.flatMap(name => keys.filter(key => key.name === name)).map(({ shown, does }) =>
            made("tr", "", made("td", "", ...shown.split(" ").map(each => made("kbd", "", each))), made("td", "", does)))
        return made("tbody", "", made("tr", "", Object.assign(made("th", "", phrase(texts, `keys.${kind}`)), { colSpan: 2 })), ...rows)
    })
    return folded(phrase(texts, "help.keys"), made("table", "keys", ...kinds), made("p", "", phrase(texts, "help.own_keys")))
}

function glossaryOf(texts: Texts, title: string, entries: readonly GlossaryEntry[], first: "plain" | "term", second: "plain" | "term"): HTMLElement {
    const items = entries.flatMap(entry => [made("dt", "", entry[first]), made("dd", "", made("b", "", entry[second]), ` ${entry.means} ${entry.lesson}`)])
    return folded(phrase(texts, title), made("dl", "", ...items))
}

function folded(title: string, ...inside: HTMLElement[]): HTMLElement {
    return made("details", "", made("summary", "", title), ...inside)
}
