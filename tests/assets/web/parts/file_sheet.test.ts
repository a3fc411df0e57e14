import { found, TEXTS } from "../page"
import assert from "node:assert/strict"
import { test } from "node:test"
import { Files } from "../../../../assets/web/channel/files"
import type { PageMessage, PathFile, SendFile } from "../../../../assets/web/channel/messages"
import { noFile, pastedFile, pathFromFile } from "../../../../assets/web/parts/file_sheet"

const NOTHING = { received: 3, why: "", lines: [], helps: [], columns: [], quantities: [] }

function opened(chosenLast = noFile()): { sent: PageMessage[]; files: Files; body: HTMLElement; chosen: (file: File) => void } {
    const sent: PageMessage[] = [], files = new Files(message => sent.push(message))
    const { body } = pathFromFile(TEXTS, files, chosenLast, () => {})
    const chooser = body.querySelector<HTMLInputElement>("input[type=file]")!
    const chosen = (file: File) => {
        Object.defineProperty(chooser, "files", { value: [file], configurable: true })
        chooser.dispatchEvent(new Event("change"))
    }
    return { sent, files, body, chosen }
}

const numberOf = (body: HTMLElement, name: string) => body.querySelector<HTMLInputElement>(`input[title="design.${name}_hint"]`)!
const settled = () => new Promise(done => setTimeout(done))
const sheet = () => document.querySelector("dialog[open]")

test("what is set goes with the file, within its bounds", async () => {
    const { sent, files, body, chosen } = opened()
    const [size, radius] = [numberOf(body, "size"), numberOf(body, "radius")]
    assert.equal(size.valueAsNumber, 100)
    size.value = "1e9"
    radius.value = ""
    body.querySelector<HTMLInputElement>("[role=switch]")!.checked = true
    chosen(new File(["x,y"], "a.csv"))
    const { number, use } = sent[0] as SendFile
    assert.deepEqual(use, { kind: "path", size: 400, radius: 0, opened: true, turn: 0, right: 0, up: 0, parts: [] })
    assert.ok((found(body, "button", "design.upload") as HTMLButtonElement).disabled)
    assert.equal(body.querySelector("[role=status]")!.textContent, "design.reading")
    files.hear({ is: "file", number, state: "used", ...NOTHING })
    await settled()
    assert.equal(body.querySelector("[role=status]")!.textContent, "design.followed")
    sheet()!.remove()
})

test("what is set acts on the file that is followed, while the sheet is open; the last value counts", async () => {
    const { sent, files, body, chosen } = opened()
    const radius = numberOf(body, "radius")
    const set = (value: number) => {
        radius.valueAsNumber = value
        radius.dispatchEvent(new Event("change"))
    }
    const used = async () => {
        const { number } = begun().at(-1)!
        files.hear({ is: "file", number, state: "used", ...NOTHING })
        await settled()
    }
    const begun = () => sent.filter((each): each is SendFile => each.is === "send")
    const radii = () => begun().map(({ use }) => (use as PathFile).radius)
    set(3) // there is no file yet
    assert.deepEqual(radii(), [])
    chosen(new File(["x,y"], "a.csv"))
    for (const value of [5, 7, 8]) set(value)
    assert.deepEqual(radii(), [3])
    await used()
    assert.deepEqual(radii(), [3, 8])
    await used()
    set(9)
    assert.deepEqual(radii(), [3, 8, 9])
    ;(body.closest("dialog") as HTMLDialogElement).close()
    await settled()
    set(10)
    await settled()
    assert.deepEqual(radii(), [3, 8, 9])
})

test("a file that was dropped on the page is taken at once", () => {
    const sent: PageMessage[] = []
    const { element } = pathFromFile(TEXTS, new Files(message => sent.push(message)), noFile(), () => {}, new File(["x,y"], "star.svg"))
    assert.equal((sent[0] as SendFile).name, "star.svg")
    element.remove()
})

test("a refusal is a sentence beside the button, and is no markup", async () => {
    const { sent, files, body, chosen } = opened()
    chosen(new File(["x,y"], "<img src=x>.csv"))
    files.hear({ is: "file", number: (sent[0] as SendFile).number, state: "refused", ...NOTHING, why: "<b>too large</b>" })
    await settled()
    assert.equal(body.querySelector("[role=alert]")!.textContent, "<b>too large</b>")
    assert.equal(body.querySelector("b, img"), null)
    assert.equal((found(body, "button", "design.upload") as HTMLButtonElement).disabled, false)
    sheet()!.remove()
})

test("a sheet that is closed gives its file up", async () => {
    const { sent, body, chosen } = opened()
    chosen(new File(["x,y"], "a.csv"))
    ;(body.closest("dialog") as HTMLDialogElement).close()
    await settled()
    assert.ok(sent.some(each => each.is === "drop"))
})

const LINES = [[0, 0, 100, 100], [0, 500, 900, 500]]

test("each line of a file is shown; those that are pressed or typed are taken, and with none all, of the file that the server has", async () => {
    const { sent, files, body, chosen } = opened()
    chosen(new File(["x,y"], "a.svg"))
    const sends = () => sent.filter((each): each is SendFile => each.is === "send")
    files.hear({ is: "file", number: sends()[0]!.number, state: "used", ...NOTHING, lines: LINES })
    await settled()
    const shown = [...body.querySelectorAll("polyline")]
    assert.deepEqual(shown.map(line => line.getAttribute("class")), ["taken", "taken"])
    assert.equal(shown[0]!.getAttribute("points"), "0 1000 100 900")
    const picture = body.querySelector("svg.lines")!
    picture.getBoundingClientRect = () => ({ left: 10, top: 20, width: 1280, height: 1080 }) as DOMRect
    const press = async (...at: number[]) => {
        if (at.length) picture.dispatchEvent(new MouseEvent("click", { clientX: 10 + 100 + 40 + at[0]!, clientY: 20 + 40 + at[1]! }))
        files.hear({ is: "file", number: sends().at(-1)!.number, state: "used", ...NOTHING, lines: LINES })
        await settled()
        return [...body.querySelectorAll("polyline")].map(line => line.getAttribute("class"))
    }
    const first = [90, 850], second = [700, 520]
    assert.deepEqual(await press(...second), ["", "taken"])
    assert.deepEqual(await press(...first), ["taken", "taken"])
    assert.deepEqual(await press(...second), ["taken", ""])
    assert.deepEqual(await press(...first), ["taken", "taken"])
    const typed = numberOf(body, "parts")
    typed.value = "2, 7, 2"
    typed.dispatchEvent(new Event("change"))
    assert.deepEqual(await press(), ["", "taken"])
    assert.equal(typed.value, "2")
    assert.deepEqual(sends().map(({ use }) => (use as PathFile).parts), [[], [2], [1, 2], [1], [], [2]])
    assert.equal(sends()[1]!.again, sends()[0]!.number)
    sheet()!.remove()
})

test("what would help is a button that does it", async () => {
    const { sent, files, body, chosen } = opened()
    chosen(new File(["x,y"], "a.svg"))
    const sends = () => sent.filter((each): each is SendFile => each.is === "send")
    const helps = [{ text: "rounder", size: 100, radius: 8 }]
    files.hear({ is: "file", number: sends()[0]!.number, state: "refused", ...NOTHING, why: "bends", lines: LINES.slice(1), helps })
    await settled()
    assert.equal(body.querySelector("[role=alert]")!.textContent, "bends")
    ;(found(body, "button", "rounder") as HTMLButtonElement).click()
    const { size, radius } = sends()[1]!.use as PathFile
    assert.deepEqual([size, radius], [100, 8])
    assert.equal(body.querySelector("[role=alert]")!.textContent, "")
    sheet()!.remove()
})

test("a sheet that is opened again has the last file and its values", async () => {
    const last = noFile(), first = opened(last)
    first.chosen(new File(["x,y"], "a.svg"))
    numberOf(first.body, "size").valueAsNumber = 60
    numberOf(first.body, "size").dispatchEvent(new Event("change"))
    const answer = async () => {
        const begun = first.sent.findLast((each): each is SendFile => each.is === "send")!
        first.files.hear({ is: "file", number: begun.number, state: "used", ...NOTHING, lines: LINES })
        await settled()
    }
    await answer()
    await answer()
    ;(first.body.closest("dialog") as HTMLDialogElement).close()
    const { body, sent } = opened(last)
    assert.equal(numberOf(body, "size").valueAsNumber, 60)
    assert.equal(body.querySelectorAll("polyline.taken").length, 2)
    assert.equal(sent.length, 0)
    numberOf(body, "size").valueAsNumber = 80
    numberOf(body, "size").dispatchEvent(new Event("change"))
    assert.equal(((sent[0] as SendFile).use as PathFile).size, 80)
    sheet()!.remove()
})

test("what is pasted is a drawing if it is a file, SVG, G-code or a table of numbers, and else is left alone", () => {
    const pasted = (text: string, files: File[] = []) => pastedFile({ clipboardData: { files, getData: () => text } } as unknown as ClipboardEvent)
    for (const text of ["<svg/>", "  <?xml version='1.0'?>", "0,0\n1,2\n", "G21\nG1 X3 Y4\n"]) assert.equal(pasted(text)?.size, text.length, text)
    for (const text of ["", "a word", "<b>bold</b>", "3.5"]) assert.equal(pasted(text), undefined, text)
    const file = new File(["x"], "a.svg")
    assert.equal(pasted("", [file]), file)
})
