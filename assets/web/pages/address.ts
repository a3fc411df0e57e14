// The settings of a figure in the address of its page: who sends the address sends the figure as it is.

import type { FormField } from "../core/form_data"
import { same, type Value } from "../parts/fields"
import type { Figure } from "./figure"

const RESTS = 500 // [ms] without a change until the address is another one; browsers refuse to have it changed all the time

/** Begin with the settings of the page's address, and keep them there from then on. */
export function keepInAddress({ settings, engine, own, simulation: { data } }: Figure): void {
    const fields = data.form.groups.flatMap(group => group.fields).filter(each => ["number", "choice", "switch"].includes(each.kind))
    const begun = new Map(fields.map(({ name }) => [name, settings.value(name)]))
    const read = () => {
        const given = new URLSearchParams(location.hash.slice(1))
        for (const field of fields) {
            const { name } = field, value = valueOf(field, given.get(name)) ?? begun.get(name)
            if (value !== undefined && !same(value, settings.value(name))) settings.set(name, value)
        }
    }
    read()
    if (own) own.plays = true // nobody has done anything yet
    addEventListener("hashchange", read)
    let resting: ReturnType<typeof setTimeout> | undefined
    const keep = () => {
        const changed = fields.map(({ name }) => [name, settings.value(name)] as const).filter(([name, value]) => !same(value, begun.get(name)))
        const hash = new URLSearchParams(changed.map(([name, value]) => [name, String(value)])).toString()
        if (hash !== location.hash.slice(1)) history.replaceState(history.state, "", hash ? `#${hash}` : location.pathname + location.search)
    }
    engine.on(change => {
        if (change !== "state") return
        clearTimeout(resting)
        resting = setTimeout(keep, RESTS)
    })
}

/** The value that a text means for a field; null: none. */
function valueOf({ kind, low, high, options }: FormField, text: string | null): Value | null {
    if (text === null) return null
    if (kind === "switch") return text === "true"
    if (kind === "choice") return options!.find(({ value }) => String(value) === text)?.value ?? null
    const value = Number(text)
    return text.trim() && value >= low! && value <= high! ? value : null
}
