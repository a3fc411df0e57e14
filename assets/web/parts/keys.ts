// The lab's keys. A control that has the focus gets its own keys first; what is typed into a field is never a command.

import type { ShownKey } from "../channel/messages"
import { keyOf } from "../core/dom"
import { isSheetOpen } from "./sheet"

const PRESS = [" ", "enter"], MOVE = ["arrowleft", "arrowright", "arrowup", "arrowdown", "home", "end", "pageup", "pagedown"]
/** Which keys a control uses itself. */
const OWN: [string, string[]][] = [
    ["[role=slider], input[type=range], input[type=radio], [role=option], [role=tab]", [...MOVE, ...PRESS]],
    ["button, summary, a[href], input[type=checkbox]", PRESS],
]
const FIELD = "textarea, select, [contenteditable], input:not([type=range], [type=checkbox], [type=radio])"
const REPEATS = /^(right|left|up|down|pull_|wall_|back|forward|undo$|redo$)/ // what goes on while its key is held down

export class Keys {
    /** All shortcuts, once they are known. */
    known: readonly ShownKey[] = []

    /** Keys are heard at the body, before whatever else listens at the document. */
    constructor(private readonly send: (message: ShownKey["send"]) => void, search: () => void, signal: AbortSignal) {
        document.body.addEventListener("keydown", event => {
            if (event.defaultPrevented) return
            if (isSheetOpen()) return event.stopPropagation() // what listens beyond would take Escape from it
            if (searches(event)) search()
            else if (!this.press(event)) return
            event.preventDefault()
            event.stopPropagation()
        }, { signal })
    }

    private press(event: KeyboardEvent): boolean {
        const key = keyOf(event), control = event.ctrlKey || event.metaKey, { target } = event
        if (!(target instanceof Element) || event.altKey || event.isComposing) return false
        if (target.closest(FIELD) || OWN.some(([selector, keys]) => keys.includes(key) && target.closest(selector))) return false
        const found = this.known.find(each => each.key === key && each.control === control)
        if (!found) return false
        if (!event.repeat || REPEATS.test(found.name)) this.send(found.send)
        return true
    }
}

/** Whether a key opens the search: that of most products. */
function searches(event: KeyboardEvent): boolean {
    const { ctrlKey, metaKey, altKey, shiftKey } = event, key = keyOf(event)
    return (ctrlKey || metaKey) && !altKey && (key === "k" || (shiftKey && key === "p"))
}
