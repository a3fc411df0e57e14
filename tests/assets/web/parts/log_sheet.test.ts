import { found, TEXTS } from "../page"
import assert from "node:assert/strict"
import { test } from "node:test"
import { Files } from "../../../../assets/web/channel/files"
import type { LogFile, LogQuantity, PageMessage, SendFile } from "../../../../assets/web/channel/messages"
import { isLog, logFromFile, mayBeLog, noLog } from "../../../../assets/web/parts/log_sheet"

const NOTHING = { received: 3, why: "", lines: [], helps: [], columns: [], quantities: [] }
const QUANTITIES: LogQuantity[] = [
    { name: "t", column: "ms", unit: "s", units: ["s", "ms"], is_optional: false },
    { name: "force1", column: "", unit: "N", units: ["N", "kN"], is_optional: true },
]
const settled = () => new Promise(done => setTimeout(done))

test("a column or a unit that is chosen has the same file read again, and what was chosen stays", async () => {
    const sent: PageMessage[] = [], files = new Files(message => sent.push(message))
    const { body, element } = logFromFile(TEXTS, files, noLog(), () => "", () => {}, new File(["1,2"], "arm.csv"))
    const sends = () => sent.filter((each): each is SendFile => each.is === "send")
    const uses = () => sends().map(({ use }) => use as LogFile)
    assert.deepEqual(uses(), [{ kind: "log", columns: {}, units: {} }])
    const answer = async (state: "used" | "refused") => {
        files.hear({ is: "file", number: sends().at(-1)!.number, state, ...NOTHING, why: state === "used" ? "" : "no", columns: ["ms", "F"], quantities: QUANTITIES })
        await settled()
    }
    await answer("refused")
    assert.equal(body.querySelector("[role=alert]")!.textContent, "no")
    const rows = body.querySelectorAll(".columns .row")
    assert.deepEqual([...rows].map(row => row.querySelector("select")!.value), ["ms", ""])
    const force = rows[1]!.querySelector("select")!
    force.value = "F"
    force.dispatchEvent(new Event("change"))
    await answer("refused")
    const unit = body.querySelector<HTMLInputElement>('input.unit')!
    unit.value = " ms "
    unit.dispatchEvent(new Event("change"))
    assert.deepEqual(uses().at(-1), { kind: "log", columns: { force1: "F" }, units: { t: "ms" } })
    assert.equal(sends().at(-1)!.again, sends().at(-2)!.number)
    await answer("used")
    assert.equal(body.querySelector("[role=alert]")!.textContent, "")
    assert.equal(body.querySelector("[role=status]")!.textContent, "log.drawn")
    element.close()
})

test("the log that is drawn is removed by one button", () => {
    let shown = "arm.csv"
    const { body, element } = logFromFile(TEXTS, new Files(() => {}), noLog(), () => shown, () => (shown = ""))
    const remove = found(body, "button", "chart.remove_log") as HTMLButtonElement
    assert.ok(!remove.hidden)
    remove.click()
    assert.equal(shown, "")
    assert.ok(remove.hidden)
    element.close()
})

test("arrays can only be logs, tables may be either, drawings never", () => {
    const kinds = (name: string) => [isLog(new File([], name)), mayBeLog(new File([], name))]
    assert.deepEqual(["a.npz", "A.MAT", "a.csv", "a.svg", "a.nc"].map(kinds), [[true, true], [true, true], [false, true], [false, false], [false, false]])
})
