// Shows a student's own answers: numbers in texts, and texts for some answers only.

import type { NumberData, PageData } from "../core/lesson_data"
import { general } from "../core/numbers"
import { localized } from "../core/words"
import { predicted, lastSaid, type Notes } from "./notes"

const STATISTICS: Record<string, (values: number[]) => number> = {
    max: values => Math.max(...values), min: values => Math.min(...values), final: values => values[values.length - 1]!,
}

export function accepted(given: number, { number = NaN, tolerance = 0 }: NumberData): boolean {
    return Math.abs(given - number) <= tolerance * (1 + 1e-9)
}

/** The known wrong number that is given, if any. */
export function known(given: number, { wrong = [], tolerance }: NumberData): number | undefined {
    const found = wrong.findIndex(number => accepted(given, { kind: "number", number, tolerance }))
    return found < 0 ? undefined : found
}

export function showOwn(page: PageData, notes: Notes): void {
    page.steps.forEach(({ blocks }, i) => blocks.forEach((block, j) => {
        if (block.kind !== "text" || !block.when) return
        const element = document.querySelector<HTMLElement>(`#step-${i + 1} [data-block="${j}"]`)!
        element.hidden = !block.when[1].includes(answer(page, notes, block.when[0]) as number)
    }))
    for (const element of document.querySelectorAll<HTMLElement>("[data-own]")) {
        const values = predicted(notes, element.dataset["step"]!)?.values
        if (!values) continue
        const value = general(STATISTICS[element.dataset["own"]!]!(values), 3)
        element.textContent = localized(value.replace("-", "−"), page)
    }
}

/** As `answers_meant` in lessons/adaptive/branches.py numbers answers; undefined before there is one. */
function answer(page: PageData, notes: Notes, key: string): number | undefined {
    const [step, place] = key.split(".").map(Number)
    if (place === undefined) {
        const own = predicted(notes, key)
        return own && (own.option ?? -1)
    }
    const block = page.steps[step!]!.blocks[place]!, own = lastSaid(notes, key) as number | undefined
    return own === undefined || block.kind !== "number" ? own : Number(accepted(own, block))
}
