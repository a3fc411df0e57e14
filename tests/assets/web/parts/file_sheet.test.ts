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

test("what is set goes with the file, within its bounds; once it is followed the sheet closes", async () => {
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
    assert.equal(sheet(), null)
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
