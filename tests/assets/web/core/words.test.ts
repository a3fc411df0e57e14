import assert from "node:assert/strict"
import { test } from "node:test"
import { filled, localized, phrase, significant, withoutNumbers, written } from "../../../../assets/web/core/words"

const GERMAN = { words: { point: ",", told: "{name} ist {mm} mm entfernt, {name}" } }

test("values stand where a text names them, and only there", () => {
    assert.equal(phrase(GERMAN, "told", { name: "<b>", mm: "{name}" }), "<b> ist {name} mm entfernt, <b>")
    assert.equal(filled("{a} {b}", { a: "1" }), "1 {b}")
    assert.throws(() => phrase(GERMAN, "missing"), /no words for missing/)
})

test("numbers are written as the language does", () => {
    assert.equal(written(GERMAN, -1.25, 1), "−1,3")
    assert.equal(written(GERMAN, -0.04, 1), "0,0")
    assert.equal(written({ words: {} }, 0.5), "0.5")
    assert.equal(significant(GERMAN, 1234.567, 3), "1230")
    assert.equal(localized("1.5", GERMAN), "1,5")
})

test("texts that differ in numbers only are the same without them", () => {
    assert.equal(withoutNumbers("held, 12.5 mm"), withoutNumbers("held, 3.25 mm"))
})
