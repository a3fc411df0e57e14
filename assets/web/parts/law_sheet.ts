// What there is to say about the laws, and how to type one.

import type { LawSheet } from "../channel/messages"
import { made } from "../core/dom"
import { phrase, type Texts } from "../core/words"
import { SheetDialog } from "./sheet"

/** `present`: the laws of the two robots; a typed one is its own name. */
export function aboutLaws(texts: Texts, { laws, bounds, own, names }: LawSheet, present: readonly string[]): SheetDialog {
    const sheet = new SheetDialog(texts, "laws", phrase(texts, "laws.about"))
    const typing = present.some(law => !laws.some(each => each.name === law))
    const described = laws.map(law => {
        const heading = made("summary", "", made("b", "", law.label), " ", made("span", "", law.does))
        const whole = made("details", "law", heading, ...[law.good, law.limits, law.objection].filter(Boolean).map(each => made("p", "", each)),
            made("p", "source", law.source))
        const side = present.indexOf(law.name)
        if (side >= 0) whole.classList.add(`side${side}`)
        whole.open = side >= 0
        return whole
    })
    const rows = names.map(({ names: spelt, means, unit }) => {
        const code = made("code", "", spelt)
        code.translate = false
        return made("tr", "", made("td", "", code), made("td", "", means), made("td", "", unit))
    })
    const heads = ["laws.name", "laws.meaning", "laws.unit"].map(key => Object.assign(made("th", "", phrase(texts, key)), { scope: "col" }))
    const table = made("table", "", made("thead", "", made("tr", "", ...heads)), made("tbody", "", ...rows))
    const typed = made("section", "", made("h3", "", phrase(texts, "laws.own_heading")), ...own.map(each => made("p", "", each)), made("div", "wide", table))
    const known = made("section", "", ...described, made("p", "", bounds))
    sheet.body.append(...(typing ? [typed, known] : [known, typed]))
    sheet.open()
    return sheet
}
