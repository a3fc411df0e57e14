// The log of a real arm from a file: which columns are read as what, in which units, and why it cannot be read. It is drawn
// over the plots.

import type { Answer, Files } from "../channel/files"
import type { LogFile, LogQuantity } from "../channel/messages"
import { made, refuse, tell } from "../core/dom"
import { phrase, type Texts } from "../core/words"
import { FileReading } from "./file_reading"
import { pressed, SheetDialog } from "./sheet"

const KINDS = ".csv,.txt,.tsv,.npy,.npz,.mat"
const ARRAYS = /\.(npy|npz|mat)$/i

/** Whether a file can only be a log. */
export const isLog = ({ name }: File): boolean => ARRAYS.test(name)

/** What can be read as a log, although it may be a path, too. */
export const mayBeLog = ({ name }: File): boolean => isLog({ name } as File) || /\.(csv|txt|tsv)$/i.test(name)

/** The log that was chosen last, and how it is read. */
export interface ChosenLog {
    file: File | null
    columns: Record<string, string>
    units: Record<string, string>
}

export const noLog = (): ChosenLog => ({ file: null, columns: {}, units: {} })

/** A sheet that takes a log, or has been given one. `shown`: the name of the log that is drawn now; `remove` removes it. */
export function logFromFile(texts: Texts, files: Files, chosen: ChosenLog, shown: () => string, remove: () => void, dropped?: File): SheetDialog {
    const given = new AbortController()
    const sheet = new SheetDialog(texts, "log", phrase(texts, "log.title"), () => given.abort())
    const reading = new FileReading(texts, files, sheet, phrase(texts, "log.file"), KINDS, file => {
        Object.assign(chosen, { ...noLog(), file })
        rows.replaceChildren()
        void read()
    })
    const { choose, chooser, bar, state, refusal } = reading, rows = made("div", "columns")
    const gone = pressed("", phrase(texts, "chart.remove_log"), () => {
        remove()
        gone.hidden = true
        tell(state, "")
        choose.focus()
    })
    gone.hidden = !shown()

    const use = (): LogFile => ({ kind: "log", columns: chosen.columns, units: chosen.units })
    const read = async () => {
        const answer = await reading.read(chosen.file, use, given.signal)
        if (!answer) return
        show(answer)
        if (document.activeElement === document.body) choose.focus() // it was not to be pressed meanwhile
    }
    const show = ({ state: found, why, columns, quantities }: Answer) => {
        const isDrawn = found === "used"
        if (isDrawn) gone.hidden = false
        tell(state, isDrawn ? phrase(texts, "log.drawn", { file: chosen.file!.name }) : "")
        refuse(refusal, why)
        const focused = document.activeElement instanceof HTMLElement && rows.contains(document.activeElement) ? document.activeElement.dataset["key"] : undefined
        rows.replaceChildren(...quantities.map(each => row(each, columns)))
        if (focused) rows.querySelector<HTMLElement>(`[data-key="${CSS.escape(focused)}"]`)?.focus()
    }
    /** The column and the unit of a quantity. */
    const row = ({ name, column, unit, units, is_optional }: LogQuantity, columns: readonly string[]): HTMLElement => {
        const select = made("select", ""), box = made("input", "unit"), list = made("datalist", "")
        const options = [["", phrase(texts, is_optional ? "log.none" : "log.which")], ...columns.map(each => [each, each])] as const
        select.append(...options.map(([value, text]) => Object.assign(made("option", "", text), { value })))
        select.value = column
        select.dataset["key"] = `column ${name}`
        select.ariaLabel = phrase(texts, "log.column", { name })
        select.addEventListener("change", () => {
            chosen.columns = { ...chosen.columns, [name]: select.value }
            void read()
        })
        list.id = `op-units-${name}`
        list.append(...units.map(value => Object.assign(made("option", ""), { value })))
        Object.assign(box, { type: "text", value: unit, autocomplete: "off", spellcheck: false, ariaLabel: phrase(texts, "log.unit", { name }), title: phrase(texts, "log.unit_hint") })
        box.setAttribute("list", list.id)
        box.dataset["key"] = `unit ${name}`
        box.addEventListener("change", () => {
            chosen.units = { ...chosen.units, [name]: box.value.trim() || units[0]! }
            void read()
        })
        return made("div", "row", made("b", "", name), select, box, list)
    }
    if (shown()) tell(state, phrase(texts, "log.drawn", { file: shown() }))
    sheet.body.append(
        made("p", "note", phrase(texts, "log.hint")), made("div", "row", choose, chooser, gone, bar), state, refusal, rows,
    )
    sheet.open(choose)
    reading.give(dropped)
    return sheet
}
