import "../page"
import assert from "node:assert/strict"
import { test } from "node:test"
import type { ShownKey } from "../../../../assets/web/channel/messages"
import { made } from "../../../../assets/web/core/dom"
import { Keys } from "../../../../assets/web/parts/keys"

const KNOWN = (["h", "d", " ", "arrowright", "home", "enter"] as const).map((key, i): ShownKey => ({
    name: key === "d" ? "pull_right" : `key${i}`, key, control: false, shown: key, does: "", send: { do: "SelectPoint", index: i },
}))
const UNDO: ShownKey = { name: "undo", key: "z", control: true, shown: "Ctrl Z", does: "", send: { do: "Undo" } }

let before = new AbortController() // ends the keys of the page before

/** The keys of a page with one control, which has the focus; what they do is noted. */
function page(control?: HTMLElement): { acts: string[]; press: (key: string, more?: KeyboardEventInit) => boolean } {
    const acts: string[] = [], ended = new AbortController()
    before.abort()
    before = ended
    const keys = new Keys(message => acts.push("index" in message ? KNOWN[Number(message.index)]!.key : String("do" in message && message.do)), () => acts.push("search"), ended.signal)
    keys.known = [...KNOWN, UNDO]
    document.body.replaceChildren(...(control ? [control] : []))
    control?.focus()
    const press = (key: string, more: KeyboardEventInit = {}) =>
        (control ?? document.body).dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true, ...more }))
    return { acts, press }
}

const input = (type: string) => Object.assign(made("input", ""), { type })

test("a known key acts once, and nothing else hears of it", () => {
    const { acts, press } = page()
    assert.equal(press("h"), false) // taken
    assert.equal(press("y"), true)
    press("h", { repeat: true })
    press("d")
    press("d", { repeat: true }) // one pulls on
    assert.deepEqual(acts, ["h", "d", "d"])
})

test("letters of another alphabet count as the Latin ones on their keys", () => {
    const { acts, press } = page()
    for (const key of ["р", "η", "ي", "ㅗ", "H"]) press(key, { code: "KeyH" })
    assert.deepEqual(acts, Array.from({ length: 5 }, () => "h"))
})

test("a control keeps the keys that it uses itself, and no letter", () => {
    for (const [control, own] of [
        [made("button", ""), [" ", "enter"]],
        [made("summary", ""), [" ", "enter"]],
        [input("checkbox"), [" ", "enter"]],
        [input("range"), [" ", "enter", "arrowright", "home"]],
        [input("radio"), [" ", "enter", "arrowright", "home"]],
    ] as const) {
        const { acts, press } = page(control)
        for (const { key } of KNOWN) press(key)
        assert.deepEqual(acts, KNOWN.map(({ key }) => key).filter(key => !(own as readonly string[]).includes(key)))
    }
})

test("what is typed into a field does nothing else", () => {
    for (const field of [input("text"), input("number"), made("textarea", ""), made("select", "")]) {
        const { acts, press } = page(field)
        for (const { key } of KNOWN) press(key)
        press("z", { ctrlKey: true })
        assert.deepEqual(acts, [])
        press("k", { ctrlKey: true }) // but the search opens from everywhere
        assert.deepEqual(acts, ["search"])
    }
})

test("a key with Control is another one, with Alt or while a word is composed none", () => {
    const { acts, press } = page()
    press("z")
    press("h", { ctrlKey: true })
    press("h", { altKey: true })
    press("h", { isComposing: true })
    assert.deepEqual(acts, [])
    press("z", { metaKey: true })
    press("p", { ctrlKey: true, shiftKey: true })
    assert.deepEqual(acts, ["Undo", "search"])
})

test("an open sheet has all keys", () => {
    const { acts, press } = page()
    const sheet = made("dialog", "")
    document.body.append(sheet)
    sheet.setAttribute("open", "")
    press("h")
    press("k", { ctrlKey: true })
    assert.deepEqual(acts, [])
})
