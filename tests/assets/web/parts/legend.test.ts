import { press, TEXTS } from "../page"
import assert from "node:assert/strict"
import { test } from "node:test"
import type { PageData } from "../../../../assets/web/core/lesson_data"
import { made } from "../../../../assets/web/core/dom"
import { Legend } from "../../../../assets/web/parts/legend"

const EVIL = "<img src=x>"
const SYMBOLS = { lambda: "distance", K_1: "spring", theta: EVIL }

/** A step whose text has symbols, one of them twice; what is shown on the robots is noted. */
function opened(...names: string[]): { lit: string[]; words: HTMLElement; legend: Legend; sign: (name: string) => HTMLElement } {
    const lit: string[] = []
    const signs = [...names, ...names.slice(0, 1)].map(name => {
        const sign = made("i", "", name)
        sign.dataset["symbol"] = name
        return sign
    })
    const words = made("div", "words", ...signs), section = made("section", "step open", words, made("div", "pager"))
    document.body.replaceChildren(section)
    const legend = new Legend({ ...TEXTS, symbols: SYMBOLS } as unknown as PageData, symbol => lit.push(symbol))
    legend.add(section)
    return { lit, words, legend, sign: name => words.querySelector<HTMLElement>(`[data-symbol=${name}]`)! }
}

const point = (element: Element, kind: string, pointerType = "mouse") => element.dispatchEvent(new PointerEvent(kind, { bubbles: true, pointerType }))
const marked = () => [...document.querySelectorAll<HTMLElement>(".words > [data-symbol].lit")].map(each => each.dataset["symbol"])

test("a text lists each of its symbols once, with what it means, and no text becomes an element", () => {
    const { words } = opened("lambda", "K_1", "theta")
    const buttons = [...words.querySelectorAll<HTMLElement>("[data-lights]")]
    assert.deepEqual(buttons.map(each => each.textContent), ["lambda distance", "K_1 spring", `theta ${EVIL}`])
    assert.equal(document.querySelectorAll("img").length, 0)
})

test("a text without symbols has no list", () => {
    assert.equal(opened().words.querySelectorAll("details").length, 0)
})

test("what the mouse points at is shown until it leaves, everywhere in the text, with what it means", () => {
    const { lit, words, sign } = opened("lambda", "K_1")
    point(sign("lambda"), "pointerover")
    assert.deepEqual(marked(), ["lambda", "lambda"])
    assert.equal(document.querySelector(".meaning")!.textContent, "lambda: distance")
    point(sign("K_1"), "pointerover")
    point(sign("K_1"), "pointerover") // nothing new
    point(words, "pointerleave")
    assert.deepEqual(lit, ["lambda", "K_1", ""])
    assert.deepEqual(marked(), [])
    assert.equal(document.querySelector(".meaning"), null)
})

test("a finger shows a symbol by a touch, until it touches something else", () => {
    const { lit, sign } = opened("lambda")
    point(sign("lambda"), "pointerover", "touch")
    point(sign("lambda"), "pointerdown", "touch")
    point(document.body, "pointerdown", "touch")
    assert.deepEqual(lit, ["lambda", ""])
})

test("with keys, the focus in the list shows a symbol; a step that is left shows none", () => {
    const { lit, legend, words } = opened("lambda", "K_1")
    words.querySelector("details")!.open = true
    const [first, second] = words.querySelectorAll<HTMLElement>("[data-lights]")
    first!.focus()
    press(first!, "Tab")
    second!.focus()
    legend.clear()
    assert.deepEqual(lit.filter(Boolean), ["lambda", "K_1"])
    assert.equal(lit.at(-1), "")
})
