// Reads a formula as a student types it, exactly as lessons/derivation/typed.py does. Nothing is ever executed.

const LONGEST = 80
const LARGEST_EXPONENT = 4
const FUNCTIONS: Record<string, (x: number) => number> = { sin: Math.sin, cos: Math.cos, sqrt: Math.sqrt, abs: Math.abs, tanh: Math.tanh, sign: Math.sign }
const SIGNS: Record<string, string> = {
    ...Object.fromEntries(Array.from("+-*/^()√").map(sign => [sign, sign])),
    "−": "-", "–": "-", "—": "-", "\u2011": "-", "×": "*", "·": "*", "⋅": "*", "∙": "*", "÷": "/", ":": "/",
}
const BLANKS = [" ", "\t", "\u00a0"]
const POWERS: Record<string, string> = { "²": "^2", "³": "^3" }
const STRENGTH: Record<string, number> = { "+": 1, "-": 1, "*": 2, "/": 2, negative: 3 }

/** In postfix form: numbers, names, functions, and operators. */
export type Formula = (number | string)[]

/** What is not understood: its place, from 0, and why. */
export class Refused extends Error {
    constructor(readonly place: number, readonly reason: string, readonly values: Record<string, string> = {}) {
        super(reason)
    }
}

/** Read a formula; `known` has the spellings of names and functions, the longest first. */
export function readFormula(text: string, known: Record<string, string>, point: string): Formula {
    return new Reader(text, known, point).formula()
}

/** The values of a formula at some points. */
export function evaluated(formula: Formula, values: Record<string, number[]>, count: number): number[] {
    const stack: number[][] = []
    const all = (value: number) => Array.from({ length: count }, () => value)
    for (const item of formula) {
        const pop = () => stack.pop()!
        if (typeof item === "number") stack.push(all(item))
        else if (item === "pi") stack.push(all(Math.PI))
        else if (values[item]) stack.push(values[item])
        else if (FUNCTIONS[item]) stack.push(pop().map(FUNCTIONS[item]))
        else if (item === "negative") stack.push(pop().map(each => -each))
        else if (item.startsWith("^")) stack.push(pop().map(each => each ** Number(item.slice(1))))
        else {
            const right = pop(), left = pop()
            stack.push(left.map((a, i) => binary(item, a, right[i]!)))
        }
    }
    return stack.pop()!
}

function binary(sign: string, a: number, b: number): number {
    if (sign === "+") return a + b
    if (sign === "-") return a - b
    return sign === "*" ? a * b : a / b
}

class Reader {
    private at = 0
    private readonly number: RegExp
    private readonly read: Formula = []
    private readonly waiting: string[] = [] // operators, functions and brackets that are still open
    private ended = false // whether an operand has just ended
    private begins = true // whether a sign may stand here
    private power = false // whether an exponent has just ended
    private readonly unclear = [false] // in each bracket: whether a factor without a sign would be unclear
    private readonly letters: string[] // as Python counts places

    constructor(text: string, private readonly known: Record<string, string>, point: string) {
        this.letters = Array.from(text)
        this.number = point === "." ? /^(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)/ : /^(?:[0-9]+(?:[.,][0-9]*)?|[.,][0-9]+)/
    }

    formula(): Formula {
        if (this.letters.length > LONGEST) {
            this.at = LONGEST
            throw this.refused("formula.long", { most: String(LONGEST) })
        }
        while (this.blanks() < this.letters.length) this.next()
        if (!this.ended) throw this.refused("formula.missing")
        while (this.waiting.length) {
            if (this.waiting.at(-1) === "(") throw this.refused("formula.bracket")
            this.read.push(this.waiting.pop()!)
        }
        return this.read
    }

    private refused(reason: string, values: Record<string, string> = {}): Refused {
        return new Refused(this.at, reason, values)
    }

    private get here(): string { return this.letters.slice(this.at).join("") }

    private blanks(): number {
        while (BLANKS.includes(this.letters[this.at] ?? "")) this.at++
        return this.at
    }

    /** Read one number, name or sign. */
    private next(): void {
        const number = this.number.exec(this.here)?.[0]
        if (number !== undefined) {
            if (this.ended) throw this.refused("formula.between")
            return this.operand(Number(number.replace(",", ".")), number.length)
        }
        const typed = this.name()
        if (typed) return this.named(this.known[typed]!, Array.from(typed).length)
        const letter = this.letters[this.at]!
        const power = POWERS[letter]
        if (power) return this.raise(power, 1)
        const sign = this.here.startsWith("**") ? "^" : SIGNS[letter]
        if (sign === undefined) throw this.refused("formula.unknown", { names: [...new Set(Object.values(this.known))].join(", ") })
        this.sign(sign)
    }

    /** The longest known name that is typed here; with other capitals, if there is none. */
    private name(): string {
        const { here } = this, names = Object.keys(this.known)
        return names.find(name => here.startsWith(name)) ?? names.find(name => here.toLowerCase().startsWith(name.toLowerCase())) ?? ""
    }

    private operand(item: number | string, length: number): void {
        this.read.push(item)
        this.at += length
        this.ended = true
        this.begins = this.power = false
    }

    private named(name: string, length: number): void {
        if (this.ended) this.factor()
        if (!FUNCTIONS[name]) return this.operand(name, length)
        this.at += length
        if (this.letters[this.blanks()] !== "(") throw this.refused("formula.function", { name })
        this.waiting.push(name)
        this.open()
    }

    private sign(sign: string): void {
        if (sign === "(") {
            if (this.ended) this.factor()
            this.open()
        } else if (sign === ")") this.close()
        else if (sign === "√") this.root()
        else if (sign === "^") {
            this.checkBase()
            this.at += this.letters[this.at] === "*" ? 2 : 1
            this.blanks()
            const digits = this.number.exec(this.here)?.[0] ?? ""
            if (!/^[0-9]$/.test(digits) || Number(digits) > LARGEST_EXPONENT) throw this.refused("formula.exponent", { most: String(LARGEST_EXPONENT) })
            this.raise(`^${digits}`, 1)
        } else if (this.ended) {
            this.unclear[this.unclear.length - 1] = sign === "/"
            this.operator(sign)
            this.at++
        } else if (this.begins && (sign === "+" || sign === "-")) {
            if (sign === "-") this.waiting.push("negative")
            this.begins = false
            this.at++
        } else throw this.refused("formula.missing")
    }

    private open(): void {
        this.waiting.push("(")
        this.unclear.push(false)
        this.at++
        this.ended = false
        this.begins = true
    }

    private close(): void {
        if (!this.ended) throw this.refused("formula.missing")
        if (!this.waiting.includes("(")) throw this.refused("formula.bracket")
        for (let item = this.waiting.pop()!; item !== "("; item = this.waiting.pop()!) this.read.push(item)
        if (FUNCTIONS[this.waiting.at(-1) ?? ""]) this.read.push(this.waiting.pop()!)
        this.unclear.pop()
        this.at++
        this.power = false
    }

    /** A root of a bracket, or of a single number or name. */
    private root(): void {
        if (this.ended) this.factor()
        this.at++
        if (this.letters[this.blanks()] === "(") {
            this.waiting.push("sqrt")
            return this.open()
        }
        const number = this.number.exec(this.here)?.[0], typed = this.name()
        if (number === undefined && FUNCTIONS[this.known[typed] ?? "sqrt"]) throw this.refused("formula.function", { name: "√" })
        if (number === undefined) this.operand(this.known[typed]!, Array.from(typed).length)
        else this.operand(Number(number.replace(",", ".")), number.length)
        this.read.push("sqrt")
        this.unclear[this.unclear.length - 1] = true
    }

    private checkBase(): void {
        if (!this.ended) throw this.refused("formula.missing")
        if (this.power) throw this.refused("formula.unclear")
    }

    /** A power of what has just ended. */
    private raise(power: string, length: number): void {
        this.checkBase()
        this.read.push(power)
        this.at += length
        this.power = true
    }

    /** A factor begins here without a sign before it. */
    private factor(): void {
        if (this.unclear.at(-1)) throw this.refused("formula.unclear")
        this.operator("*")
    }

    private operator(sign: string): void {
        while (this.waiting.length && (STRENGTH[this.waiting.at(-1)!] ?? 0) >= STRENGTH[sign]!) this.read.push(this.waiting.pop()!)
        this.waiting.push(sign)
        this.ended = this.begins = this.power = false
    }
}
