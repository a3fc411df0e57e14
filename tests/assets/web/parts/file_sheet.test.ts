import { found, TEXTS } from "../page"
import assert from "node:assert/strict"
import { test } from "node:test"
import { Files } from "../../../../assets/web/channel/files"
import type { PageMessage, SendFile } from "../../../../assets/web/channel/messages"
import { pathFromFile } from "../../../../assets/web/parts/file_sheet"

function opened(): { sent: PageMessage[]; files: Files; body: HTMLElement; chosen: (file: File) => void } {
    const sent: PageMessage[] = [], files = new Files(message => sent.push(message))
    const { body } = pathFromFile(TEXTS, files)
    const chooser = body.querySelector<HTMLInputElement>("input[type=file]")!
    const chosen = (file: File) => {
        Object.defineProperty(chooser, "files", { value: [file], configurable: true })
        chooser.dispatchEvent(new Event("change"))
    }
    return { sent, files, body, chosen }
}

const settled = () => new Promise(done => setTimeout(done))
const sheet = () => document.querySelector("dialog[open]")

test("what is set goes with the file, within its bounds", async () => {
    const { sent, files, body, chosen } = opened()
    const [size, radius] = [...body.querySelectorAll<HTMLInputElement>("input[type=number]")]
    assert.equal(size!.valueAsNumber, 100)
    size!.value = "1e9"
    radius!.value = ""
    body.querySelector<HTMLInputElement>("[role=switch]")!.checked = true
    chosen(new File(["x,y"], "a.csv"))
    const { number, use } = sent[0] as SendFile
    assert.deepEqual(use, { kind: "path", size: 400, radius: 0, opened: true })
    assert.ok((found(body, "button", "design.upload") as HTMLButtonElement).disabled)
    assert.equal(body.querySelector("[role=status]")!.textContent, "design.reading")
    files.hear({ is: "file", number, state: "used", received: 3, why: "" })
    await settled()
    assert.equal(body.querySelector("[role=status]")!.textContent, "design.followed")
    sheet()!.remove()
})

test("once a file is followed, what is set acts on it until the sheet is closed; the last value counts", async () => {
    const { sent, files, body, chosen } = opened()
    const radius = body.querySelectorAll<HTMLInputElement>("input[type=number]")[1]!
    const set = (value: number) => {
        radius.valueAsNumber = value
        radius.dispatchEvent(new Event("change"))
    }
    const used = async () => {
        const { number } = begun().at(-1)!
        files.hear({ is: "file", number, state: "used", received: 3, why: "" })
        await settled()
    }
    const begun = () => sent.filter((each): each is SendFile => each.is === "send")
    const radii = () => begun().map(({ use }) => use.radius)
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
    const { element } = pathFromFile(TEXTS, new Files(message => sent.push(message)), new File(["x,y"], "star.svg"))
    assert.equal((sent[0] as SendFile).name, "star.svg")
    element.remove()
})

test("a refusal is a sentence beside the button, and is no markup", async () => {
    const { sent, files, body, chosen } = opened()
    chosen(new File(["x,y"], "<img src=x>.csv"))
    files.hear({ is: "file", number: (sent[0] as SendFile).number, state: "refused", received: 0, why: "<b>too large</b>" })
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
