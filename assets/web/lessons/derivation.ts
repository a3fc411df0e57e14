// Judges what a student has typed in a derivation, as lessons/derivation/judged.py does.

import type { DerivationData, LineData, LineState } from "../core/lesson_data"
import { evaluated, readFormula, Refused, type Formula } from "./typed"

const POINTS = 20
const SAME = 1e-6
const TRIES = 2

type Values = Record<string, number[]>

/** What has become of each line. */
export function statesOf({ known, lines = [], values = {}, states }: DerivationData, text: string): LineState[] {
    if (states) return states
    const right: Values = { ...values }, own: Values = { ...values }, found: LineState[] = []
    const rows = text.split("\n").flatMap(row => {
        const formula = readOr(row, known)
        return formula ? [[row, formula] as const] : []
    })
    let missed = false
    for (const line of lines) {
        const tries: LineState["tries"] = []
        let latest: number[] | null = null
        while (!isClosed(tries) && rows.length) {
            const [typed, formula] = rows.shift()!
            if (tries.at(-1)?.typed === typed) continue
            latest = evaluated(formula, values, POINTS)
            tries.push(judged(line, typed, latest, right, own, missed))
        }
        found.push({ tries, closed: isClosed(tries) })
        missed ||= (tries.at(-1)?.verdict ?? "wrong") === "wrong"
        if (!line.name) continue
        right[line.name] = valueOf(line.formula, right)
        own[line.name] = latest ?? right[line.name]!
    }
    return found
}

function readOr(row: string, known: Record<string, string>): Formula | null {
    try {
        return readFormula(row, known, ",")
    } catch (error) {
        if (error instanceof Refused) return null
        throw error
    }
}

function isClosed(tries: LineState["tries"]): boolean {
    return tries.length > 0 && (tries.length === TRIES || tries.at(-1)!.verdict !== "wrong")
}

/** The values of an author's formula, whose names are spelt as they are. */
function valueOf(formula: string, values: Values): number[] {
    const names = [...Object.keys(values), "sin", "cos", "sqrt", "abs", "tanh", "sign", "pi"].sort((a, b) => b.length - a.length)
    return evaluated(readFormula(formula, Object.fromEntries(names.map(name => [name, name])), "."), values, POINTS)
}

function judged(line: LineData, typed: string, given: number[], right: Values, own: Values, missed: boolean): LineState["tries"][number] {
    const largest = (values: number[]) => Math.max(...values.map(Math.abs))
    const gives = (formula: string, values: Values) => {
        const wanted = valueOf(formula, values)
        const size = largest(wanted) / (largest(valueOf(line.formula, right)) || 1)
        const most = line.tolerance * Math.max(1, size) || SAME * largest(wanted)
        return given.every((each, i) => Math.abs(each - wanted[i]!) <= most * (1 + 1e-9))
    }
    if (gives(line.formula, right)) return { typed, verdict: "right", known: null }
    if (gives(line.formula, own)) return { typed, verdict: missed ? "carried" : "right", known: null }
    const known = line.wrong.findIndex(formula => gives(formula, right) || gives(formula, own))
    return { typed, verdict: "wrong", known: known < 0 ? null : known }
}
