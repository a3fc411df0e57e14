import assert from "node:assert/strict"
import { test } from "node:test"
import type { DerivationData, LineData } from "../../../../assets/web/core/lesson_data"
import { statesOf } from "../../../../assets/web/lessons/derivation"
import { readFormula, Refused } from "../../../../assets/web/lessons/typed"
import chains from "../../../lessons/derivation/chains.json"
import questions from "../../../lessons/derivation/formulas.json"

// The same answers as in tests/lessons/derivation, with the same verdicts.

interface Question {
    names: Record<string, number[]>
    formula: string
    values: Record<string, number[]>
    cases: [string, string][]
}

/** How names are typed, as `spellings` in lessons/derivation/typed.py has it. */
function known(names: string[]): Record<string, string> {
    const greek: Record<string, string> = { theta: "θ", phi: "φ", pi: "π" }
    const found: Record<string, string> = {}
    for (const name of [...names, "sin", "cos", "sqrt", "abs", "tanh", "sign", "pi"]) {
        const letters = name.replaceAll(/\d/g, ""), digits = name.slice(letters.length)
        const ends = digits ? [digits, `_${digits}`, String.fromCodePoint(0x2080 + Number(digits))] : [""]
        for (const start of [letters, greek[letters] ?? letters]) for (const end of ends) found[start + end] = name
    }
    return Object.fromEntries(Object.entries(found).sort((a, b) => b[0].length - a[0].length))
}

function verdict(data: DerivationData, typed: string): string {
    try {
        readFormula(typed, data.known, ",")
    } catch (error) {
        assert.ok(error instanceof Refused)
        return `${error.reason.replace("formula.", "")} ${error.place}`
    }
    return statesOf(data, typed)[0]!.tries[0]!.verdict
}

for (const { names, formula, values, cases } of questions as unknown as Question[]) test(formula, () => {
    const lines: LineData[] = [{ name: "", formula, tolerance: 0, wrong: [] }]
    const data: DerivationData = { kind: "derivation", known: known(Object.keys(names)), lines, values }
    for (const [typed, wanted] of cases) assert.equal(verdict(data, typed), wanted, typed)
})

test("rows are judged in their order", () => {
    const lines: LineData[] = chains.derivation.line.map(({ name = "", formula, tolerance, wrong = [] }) =>
        ({ name, formula, tolerance, wrong: wrong.map(each => each.formula) }))
    for (const [rows, wanted] of chains.cases as [string[], string[]][]) {
        const found = statesOf({ kind: "derivation", known: known([]), lines, values: {} }, rows.join("\n")).map(({ tries, closed }) =>
            [...tries.map(each => `${each.verdict}${each.known ?? ""}`), ...(closed ? ["closed"] : [])].join(" "))
        assert.deepEqual(found, wanted)
    }
})
