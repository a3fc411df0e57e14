// A path from a file: what is made of its lines, how far it has come, and why it cannot be followed. What is set acts on the
// file that was chosen last, also when the sheet is opened again.

import type { Answer, Files } from "../channel/files"
import type { FileMessage, PathFile as Wished } from "../channel/messages"
import { made, refuse, svg, switchInput, tell } from "../core/dom"
import { phrase, type Texts } from "../core/words"
import { FileReading } from "./file_reading"
import { mayBeLog } from "./log_sheet"
import { pressed, SheetDialog } from "./sheet"

const KINDS = ".csv,.txt,.tsv,.svg,.gcode,.nc,.ngc,.gc,.tap,.cnc"
const SIZE = 1000 // of the square in which lines are told
const MARGIN = 40 // around it
type PathFile = Required<Wished>
const USUAL: PathFile = { kind: "path", size: 100, radius: 0, opened: false, turn: 0, right: 0, up: 0, parts: [] }
const NUMBERS = { size: [0, 400, 5], radius: [0, 100, 1], turn: [-360, 360, 5], right: [-400, 400, 5], up: [-400, 400, 5] } as const
type NumberName = keyof typeof NUMBERS
const NAMES = Object.keys(NUMBERS) as NumberName[]

/** The file that was chosen last, and what is made of it. */
export interface ChosenFile {
    file: File | null
    use: PathFile
    lines: FileMessage["lines"]
}

export const noFile = (): ChosenFile => ({ file: null, use: USUAL, lines: [] })

/** A sheet that takes a file, or has been given one. `asLog` shows a file as the log of an arm instead. */
export function pathFromFile(texts: Texts, files: Files, chosen: ChosenFile, asLog: (file: File) => void, dropped?: File): SheetDialog {
    const given = new AbortController()
    const sheet = new SheetDialog(texts, "file", phrase(texts, "design.files"), () => given.abort())
    const number = (key: string, [min, max, step]: readonly [number, number, number]) => {
        const box = Object.assign(made("input", ""), { type: "number", min: String(min), max: String(max), step: String(step) })
        box.title = phrase(texts, `design.${key}_hint`)
        box.addEventListener("change", () => void follow())
        return { box, label: made("label", "row", made("span", "", phrase(texts, `design.${key}`)), box) }
    }
    const fields = Object.fromEntries(NAMES.map(name => [name, number(name, NUMBERS[name])])) as Record<NumberName, ReturnType<typeof number>>
    const parts = Object.assign(made("input", ""), { type: "text", title: phrase(texts, "design.parts_hint"), autocomplete: "off" })
    parts.inputMode = "numeric"
    parts.addEventListener("change", () => void follow())
    const partsRow = made("label", "row", made("span", "", phrase(texts, "design.parts")), parts)
    const opened = switchInput({ title: phrase(texts, "design.open_hint") })
    opened.addEventListener("change", () => void follow())
    const reading = new FileReading(texts, files, sheet, phrase(texts, "design.upload"), KINDS, file => {
        Object.assign(chosen, { file, lines: [] })
        draw()
        void follow()
    })
    const { choose, chooser, bar, state, refusal } = reading, helps = made("div", "row helps")
    const edge = `${-MARGIN} ${-MARGIN} ${SIZE + 2 * MARGIN} ${SIZE + 2 * MARGIN}`
    const picture = svg("svg", { class: "lines", viewBox: edge, role: "img", "aria-label": phrase(texts, "design.lines") })

    const put = (use: PathFile) => {
        for (const name of NAMES) fields[name].box.valueAsNumber = use[name]
        opened.checked = use.opened
    }
    const use = (): PathFile => {
        const limit = ({ box }: { box: HTMLInputElement }) => Math.min(Math.max(box.valueAsNumber || 0, Number(box.min)), Number(box.max))
        const numbers = Object.fromEntries(NAMES.map(name => [name, limit(fields[name])])) as Record<NumberName, number>
        return { ...numbers, kind: "path", opened: opened.checked, parts: numbersIn(parts.value, chosen.lines.length) }
    }
    const follow = async () => {
        if (chosen.file && !reading.isBusy) helps.replaceChildren()
        const answer = await reading.read(chosen.file, () => (chosen.use = use()), given.signal)
        if (!answer) return
        show(answer)
        if (document.activeElement === document.body) choose.focus() // it was not to be pressed meanwhile
    }
    const show = (answer: Answer) => {
        const isFollowed = answer.state === "used"
        if (answer.lines.length) chosen.lines = answer.lines
        draw()
        tell(state, isFollowed ? phrase(texts, "design.followed", { file: chosen.file!.name }) : "")
        refuse(refusal, answer.why)
        const { file } = chosen
        const log = answer.state === "refused" && file && mayBeLog(file) ? [pressed("", phrase(texts, "log.instead"), () => asLog(file))] : []
        helps.replaceChildren(...log, ...answer.helps.map(({ text, size, radius }) => pressed("", text, () => {
            put({ ...use(), size, radius })
            void follow()
        })))
        sheet.element.classList.toggle("followed", isFollowed)
    }
    /** Draw the lines of the file. */
    const draw = () => {
        const { lines, use: { parts: taken } } = chosen, isOne = lines.length < 2
        partsRow.hidden = isOne
        parts.value = taken.join(", ")
        picture.style.display = lines.length ? "" : "none"
        picture.classList.toggle("many", !isOne)
        picture.replaceChildren(...lines.map((line, i) => svg("polyline", {
            points: line.map((each, k) => (k % 2 ? SIZE - each : each)).join(" "), class: !taken.length || taken.includes(i + 1) ? "taken" : "",
        })))
    }
    picture.addEventListener("click", ({ clientX, clientY }) => {
        if (reading.isBusy || chosen.lines.length < 2) return
        const { left, top, width, height } = picture.getBoundingClientRect()
        const scale = (SIZE + 2 * MARGIN) / Math.min(width, height)
        const at = [(clientX - left - width / 2) * scale + SIZE / 2, SIZE / 2 - (clientY - top - height / 2) * scale] as const
        const line = nearest(chosen.lines, at) + 1, others = chosen.use.parts.filter(each => each !== line)
        const isTaken = others.length < chosen.use.parts.length
        parts.value = (isTaken ? others : [...others, line].sort((a, b) => a - b)).join(", ")
        void follow()
    })
    sheet.element.addEventListener("paste", event => {
        if (event.target instanceof HTMLInputElement && event.target.type === "number") return
        reading.give(pastedFile(event))
    })
    put(chosen.use)
    draw()
    if (chosen.file) tell(state, phrase(texts, "design.chosen", { file: chosen.file.name }))
    const open = made("label", "row", made("span", "", phrase(texts, "design.open")), opened)
    const rows = NAMES.map(name => fields[name].label)
    sheet.body.append(
        made("p", "note", phrase(texts, "design.upload_hint")), made("div", "row", choose, chooser, bar), state, refusal, helps,
        picture, partsRow, ...rows, open,
    )
    sheet.open(choose)
    reading.give(dropped)
    return sheet
}

/** The numbers of lines in a text, each once; none of a single line. */
function numbersIn(text: string, count: number): number[] {
    const numbers = (text.match(/\d+/g) ?? []).map(Number).filter(each => each >= 1 && each <= count)
    return count > 1 ? [...new Set(numbers)] : []
}

/** Which line is the nearest to a point. */
function nearest(lines: FileMessage["lines"], [x, y]: readonly [number, number]): number {
    const away = lines.map(line => {
        let least = Infinity
        for (let i = 0; i + 1 < line.length; i += 2) {
            const [ax, ay, bx, by] = [line[i]!, line[i + 1]!, line[i + 2] ?? line[i]!, line[i + 3] ?? line[i + 1]!]
            const [dx, dy] = [bx - ax, by - ay], squared = dx * dx + dy * dy
            const share = squared ? Math.min(Math.max(((x - ax) * dx + (y - ay) * dy) / squared, 0), 1) : 0
            least = Math.min(least, Math.hypot(ax + share * dx - x, ay + share * dy - y))
        }
        return least
    })
    return away.indexOf(Math.min(...away))
}

/** A drawing in the clipboard, as a file: a copied file, or the text of one. */
export function pastedFile({ clipboardData }: ClipboardEvent): File | undefined {
    const file = clipboardData?.files[0]
    if (file) return file
    const text = clipboardData?.getData("text/plain") ?? ""
    const isDrawing = /^\s*<(\?xml|!doctype svg|!--|svg)/i.test(text) || /^[^\n]*\d[^\n]*\n[^\n]*\d/.test(text.trim())
    return isDrawing ? new File([text], "clipboard.txt", { type: "text/plain" }) : undefined
}
