// The lecturer's notes on a lecture's page (app/exports/site).

import { isTyped, keyOf } from "../core/dom"

/** Let the button and the key N show and hide the notes; a page without that button has none. */
export function hearNotes(): void {
    const button = document.querySelector<HTMLButtonElement>("#notes")
    if (!button) return
    const toggle = (): void => { button.ariaPressed = String(document.body.classList.toggle("noted")) }
    button.addEventListener("click", toggle)
    addEventListener("keydown", event => {
        if (keyOf(event) !== "n" || isTyped(event) || event.repeat) return
        event.stopPropagation() // a figure has this key, too
        toggle()
    }, { capture: true })
}
