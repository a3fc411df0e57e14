// A path from a file: what is made of its line, how far it has come, and why it cannot be followed. What is set acts on the
// file that was chosen until the sheet is closed.

import type { Files } from "../channel/files"
import { made, refuse, switchInput, tell } from "../core/dom"
import { phrase, type Texts } from "../core/words"
import { pressed, SheetDialog } from "./sheet"

const KINDS = ".csv,.txt,.tsv,.svg,.gcode,.nc,.ngc"

/** A sheet that takes a file, or has been given one. */
export function pathFromFile(texts: Texts, files: Files, dropped?: File): SheetDialog {
    const given = new AbortController()
    const sheet = new SheetDialog(texts, "file", phrase(texts, "design.files"), () => given.abort())
    const number = (key: string, value: number, max: number, step: number) => {
        const box = Object.assign(made("input", ""), { type: "number", min: "0", max: String(max), step: String(step), valueAsNumber: value })
        box.title = phrase(texts, `design.${key}_hint`)
        return { box, label: made("label", "row", made("span", "", phrase(texts, `design.${key}`)), box) }
    }
    const size = number("size", 100, 400, 5), radius = number("radius", 0, 100, 1)
    const opened = switchInput({ title: phrase(texts, "design.open_hint") })
    const chooser = Object.assign(made("input", ""), { type: "file", accept: KINDS, hidden: true })
    const choose = pressed("main", phrase(texts, "design.upload"), () => chooser.click())
    const state = made("p", "state"), refusal = made("p", "refusal")
    const bar = Object.assign(made("progress", ""), { max: 1, hidden: true, ariaLabel: phrase(texts, "design.reading") })
    state.role = "status"
    refusal.role = "alert"

    let file: File | null = null, isBusy = false, isStale = false
    const use = () => {
        const limit = (box: HTMLInputElement) => Math.min(Math.max(box.valueAsNumber || 0, 0), Number(box.max))
        return { kind: "path", size: limit(size.box), radius: limit(radius.box), opened: opened.checked } as const
    }
    const follow = async () => {
        isStale = true
        if (!file || isBusy) return
        isBusy = choose.disabled = true
        bar.hidden = false
        refuse(refusal, "")
        tell(state, phrase(texts, "design.reading"))
        let why = ""
        while (isStale && !given.signal.aborted) {
            isStale = false
            why = await files.send(file, use(), share => (bar.value = share), given.signal)
        }
        isBusy = choose.disabled = false
        bar.hidden = true
        tell(state, why ? "" : phrase(texts, "design.followed", { file: file.name }))
        refuse(refusal, why)
        sheet.element.classList.toggle("followed", !why)
        if (document.activeElement === document.body) choose.focus() // it was not to be pressed meanwhile
    }
    const take = (chosen: File | undefined) => {
        if (!chosen || isBusy) return
        file = chosen
        void follow()
    }
    chooser.addEventListener("change", () => {
        take(chooser.files?.[0])
        chooser.value = "" // the same file may be chosen again
    })
    for (const input of [size.box, radius.box, opened]) input.addEventListener("change", () => void follow())
    sheet.element.addEventListener("dragover", event => event.preventDefault())
    sheet.element.addEventListener("drop", event => {
        event.preventDefault()
        take(event.dataTransfer?.files[0])
    })
    const open = made("label", "row", made("span", "", phrase(texts, "design.open")), opened)
    sheet.body.append(made("p", "note", phrase(texts, "design.upload_hint")), size.label, radius.label, open, made("div", "row", choose, chooser, bar), state, refusal)
    sheet.open(choose)
    take(dropped)
    return sheet
}
