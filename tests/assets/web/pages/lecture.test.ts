import "../page"
import assert from "node:assert/strict"
import { test } from "node:test"
import { made } from "../../../../assets/web/core/dom"
import { hearNotes } from "../../../../assets/web/pages/lecture"

test("the button and N show and hide the notes, and N is not the figure's then", () => {
    const button = Object.assign(made("button", ""), { id: "notes" }), field = made("textarea", "")
    document.body.replaceChildren(button, field)
    hearNotes()
    let heard = 0
    document.addEventListener("keydown", () => heard++)
    const press = (target: HTMLElement, more: KeyboardEventInit = {}): boolean => {
        target.dispatchEvent(new KeyboardEvent("keydown", { key: "n", bubbles: true, ...more }))
        return document.body.classList.contains("noted")
    }
    button.click()
    assert.equal(document.body.classList.contains("noted"), true)
    assert.equal(press(document.body), false)
    assert.equal(press(document.body, { repeat: true }), false)
    assert.equal(press(document.body, { ctrlKey: true }), false)
    assert.equal(press(field), false)
    assert.equal(press(document.body), true)
    assert.equal(button.ariaPressed, "true")
    assert.equal(heard, 3) // what is not for the notes
})
