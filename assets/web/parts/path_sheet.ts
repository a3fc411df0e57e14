// A path from a file: how it is placed, the file, how far it has come, and why it was refused.

import type { RemoteEngine } from "../channel/channel"
import { made, tell } from "../core/dom"
import { said, type Texts } from "../core/words"
import { pressed, SheetDialog } from "./sheet"

const READ = ".svg,.csv,.tsv,.txt,.nc,.gcode,.ngc,.tap"

export function openPath(texts: Texts, engine: RemoteEngine): SheetDialog {
    const ended = new AbortController()
    const sheet = new SheetDialog(texts, "path", said(texts, "design.files"), () => ended.abort())
    const number = (key: string, value: number, most: number, step: number) => {
        const input = Object.assign(made("input", ""), { type: "number", min: "0", max: String(most), step: String(step), value: String(value) })
        const label = Object.assign(made("label", "row", made("span", "", said(texts, key)), input), { title: said(texts, `${key}_hint`) })
        return { input, label }
    }
    const size = number("design.size", 100, 400, 5), radius = number("design.radius", 0, 100, 1)
    const open = Object.assign(made("input", "switch"), { type: "checkbox" })
    open.setAttribute("role", "switch")
    const opened = Object.assign(made("label", "row", made("span", "", said(texts, "design.open")), open), { title: said(texts, "design.open_hint") })
    const file = Object.assign(made("input", ""), { type: "file", accept: READ, hidden: true })
    const refusal = made("p", "refusal"), state = made("p", "note", said(texts, "setup.file_hint"))
    refusal.setAttribute("role", "alert")
    state.setAttribute("role", "status")
    const within = ({ input }: { input: HTMLInputElement }) => Math.min(Math.max(input.valueAsNumber || 0, 0), Number(input.max))
    const choose = pressed("main", said(texts, "design.upload"), () => file.click())
    file.addEventListener("change", () => {
        const chosen = file.files?.[0]
        file.value = "" // the same file may be chosen again
        if (!chosen) return
        tell(refusal, "")
        tell(state, said(texts, "design.reading"))
        choose.disabled = true
        const use = { kind: "path" as const, size: within(size), radius: within(radius), opened: open.checked }
        void engine.files.send(chosen, use, undefined, ended.signal).then(why => {
            choose.disabled = false
            tell(state, "")
            tell(refusal, why)
            if (!why) sheet.close()
        })
    })
    sheet.body.append(size.label, radius.label, opened, state, refusal, choose, file)
    sheet.open(choose)
    return sheet
}
