// A path from a file: what is made of its line, how far it has come, and why it cannot be followed.

import type { Files } from "../channel/files"
import { made, switchInput, tell } from "../core/dom"
import { said, type Texts } from "../core/words"
import { pressed, SheetDialog } from "./sheet"

const KINDS = ".csv,.txt,.tsv,.svg,.gcode,.nc,.ngc"

/** A sheet that takes a file; it closes once the robots follow its path. */
export function pathFromFile(texts: Texts, files: Files): SheetDialog {
    const given = new AbortController()
    const sheet = new SheetDialog(texts, "file", said(texts, "design.files"), () => given.abort())
    const number = (key: string, value: number, max: number, step: number) => {
        const box = Object.assign(made("input", ""), { type: "number", min: "0", max: String(max), step: String(step), valueAsNumber: value })
        box.title = said(texts, `design.${key}_hint`)
        return { box, label: made("label", "row", made("span", "", said(texts, `design.${key}`)), box) }
    }
    const size = number("size", 100, 400, 5), radius = number("radius", 0, 100, 1)
    const opened = switchInput({ title: said(texts, "design.open_hint") })
    const chooser = Object.assign(made("input", ""), { type: "file", accept: KINDS, hidden: true })
    const choose = pressed("main", said(texts, "design.upload"), () => chooser.click())
    const state = made("p", "state"), refusal = made("p", "refusal")
    const bar = Object.assign(made("progress", ""), { max: 1, hidden: true, ariaLabel: said(texts, "design.reading") })
    state.role = "status"
    refusal.role = "alert"

    const take = async (file: File) => {
        tell(refusal, "")
        tell(state, said(texts, "design.reading"))
        choose.disabled = true
        bar.hidden = false
        const limit = (box: HTMLInputElement) => Math.min(Math.max(box.valueAsNumber || 0, 0), Number(box.max))
        const use = { kind: "path", size: limit(size.box), radius: limit(radius.box), opened: opened.checked } as const
        const why = await files.send(file, use, share => (bar.value = share), given.signal)
        choose.disabled = false
        bar.hidden = true
        tell(state, "")
        tell(refusal, why)
        if (why) choose.focus()
        else sheet.close()
    }
    chooser.addEventListener("change", () => {
        const file = chooser.files?.[0]
        chooser.value = "" // the same file may be chosen again
        if (file) void take(file)
    })
    sheet.element.addEventListener("dragover", event => event.preventDefault())
    sheet.element.addEventListener("drop", event => {
        event.preventDefault()
        const file = event.dataTransfer?.files[0]
        if (file && !choose.disabled) void take(file)
    })
    const open = made("label", "row", made("span", "", said(texts, "design.open")), opened)
    sheet.body.append(made("p", "note", said(texts, "design.upload_hint")), size.label, radius.label, open, made("div", "row", choose, chooser, bar), state, refusal)
    sheet.open(choose)
    return sheet
}
