import { found, press, TEXTS } from "../page"
import { pass, time } from "../clock"
import assert from "node:assert/strict"
import { afterEach, test } from "node:test"
import { setImmediate as turn } from "node:timers/promises"
import type { SetField } from "../../../../assets/web/channel/messages"
import { RemoteSettings } from "../../../../assets/web/channel/settings"
import type { FormField, FormMessage, ValuesMessage } from "../../../../assets/web/core/form_data"
import type { FormHost, Value } from "../../../../assets/web/parts/fields"
import { Form } from "../../../../assets/web/parts/form"
import { chance } from "../random"

const K1: FormField = { name: "K1", kind: "number", label: "K1 across", symbol: "K₁", unit: "1/s²", low: 0, high: 2500, step: 5, scale: "log", default: 400 }
const SPEED: FormField = { name: "speed", kind: "number", label: "Speed", low: -20, high: 20, step: 0.1, default: 2, mark: 3 }
const LIMIT: FormField = { name: "limit", kind: "number", label: "Limit", low: 0, high: 5, step: 0.05, on: 0.5, default: 0 }
const CUT: FormField = {
    name: "cut", kind: "choice", label: "At the limit", default: "slow", needs: [[{ name: "limit" }]],
    options: [{ value: "slow", label: "slow down" }, { value: "cut", label: "cut" }],
}
const TURNED: FormField = { name: "turned", kind: "number", label: "Angle", unit: "°", low: -Math.PI, high: Math.PI, step: Math.PI / 36, factor: 180 / Math.PI, default: 0 }
const LARGE: FormField = { name: "large", kind: "switch", label: "Large", default: false }
const LAW: FormField = { name: "law", kind: "text", label: "Law" }
const FORM: FormMessage = {
    is: "form", place: "lab", groups: [
        { name: "first", title: "First", fields: [SPEED, TURNED, LARGE, LAW] },
        { name: "more", title: "More", level: "deeper", fields: [K1, LIMIT, CUT], states: ["K1", "limit", "cut"] },
    ],
}
const BEGIN: Record<string, Value> = { K1: 400, speed: 3, limit: 0, cut: "slow", turned: 0, large: false, law: "" }

afterEach(() => sessionStorage.clear())

/** A form of settings that are here at once. */
function opened(data = FORM, refused: Record<string, string> = {}) {
    const values = { ...BEGIN }, sets: [string, Value][] = []
    const host: FormHost = {
        texts: TEXTS,
        value: name => values[name],
        set: (name, value) => {
            sets.push([name, value])
            values[name] = value
        },
        act: () => {},
        refused: name => refused[name] ?? "",
    }
    const form = new Form(data, host, new AbortController().signal)
    document.body.replaceChildren(form.element)
    return { form, values, sets, refused, row: (name: string) => form.element.querySelector<HTMLElement>(`[data-name="${name}"]`)! }
}

function drag(slider: HTMLInputElement, value: number): void {
    slider.value = String(value)
    slider.dispatchEvent(new Event("input", { bubbles: true }))
}

const box = (within: Element) => within.querySelector<HTMLInputElement>("input.typed")!
const slider = (within: Element) => within.querySelector<HTMLInputElement>("input[type=range]")!

function type(field: HTMLInputElement, text: string): void {
    field.focus()
    field.value = text
    field.dispatchEvent(new Event("input", { bubbles: true }))
}

test("keys move a slider, go to its ends, and back to where it began", () => {
    const { row, values } = opened()
    const speed = found(row("speed"), "slider", "Speed")
    for (const [key, expected] of [["ArrowRight", 3.1], ["ArrowDown", 3], ["PageUp", 4], ["Home", -20], ["End", 20], ["Backspace", 3]] as const) {
        assert.equal(press(speed, key), false) // it is the slider's, and nobody else's
        assert.equal(values["speed"], expected, key)
    }
    assert.equal(press(speed, "w"), true)
    assert.equal(speed.getAttribute("aria-valuetext") ?? speed.ariaValueText, "3")
})

test("a typed number counts with Enter, and Escape forgets it", () => {
    const { row, values, form } = opened()
    const field = box(row("speed"))
    type(field, "−4,5")
    form.update() // the lab tells something meanwhile
    assert.equal(field.value, "−4,5")
    press(field, "Enter")
    assert.equal(values["speed"], -4.5)
    type(field, "7")
    press(field, "Escape")
    assert.deepEqual([values["speed"], field.value], [-4.5, "−4.5"])
})

test("half a number is there with the focus after a reload, and counts or is forgotten as before", async () => {
    for (const [key, value] of [["Enter", 5.5], ["Escape", 3]] as const) {
        const first = opened()
        type(box(first.row("speed")), "5.5")
        const { row, values } = opened()
        await turn() // it is on the page
        const field = box(row("speed"))
        assert.ok(document.activeElement === field)
        assert.deepEqual([field.value, values["speed"]], ["5.5", 3])
        press(field, key)
        assert.equal(values["speed"], value)
        assert.equal(sessionStorage.length, 0)
        const again = opened()
        await turn()
        assert.ok(document.activeElement === document.body && box(again.row("speed")).value === "3")
    }
})

test("what is no number, or too large, is refused beside its field, and said", () => {
    const { row, values } = opened()
    const field = box(row("speed"))
    for (const [text, why] of [["fast", "form.no_number"], ["21", "form.range"]] as const) {
        type(field, text)
        press(field, "Enter")
        const alert = row("speed").querySelector("[role=alert]")!
        assert.equal(alert.textContent, why)
        assert.equal(field.getAttribute("aria-describedby"), alert.id)
        assert.equal(field.value, text) // to be mended
    }
    assert.equal(values["speed"], 3)
    press(field, "Escape")
    assert.equal(row("speed").querySelector("[role=alert]")!.textContent, "")
})

test("only a drawn button stands among the pictures of a choice, and one of words below them", () => {
    const path: FormField = {
        name: "path", kind: "choice", label: "Path", default: "circle",
        options: [{ value: "circle", label: "Circle", picture: "c.svg" }, { value: "line", label: "Line", picture: "l.svg" }],
    }
    const fields = [path, ...["draw", "undo", "controls"].map((name): FormField => {
        const button = { name, kind: "button" as const, label: name.toUpperCase() }
        return name === "controls" ? button : Object.assign(button, { icon: name as "draw" | "undo" })
    })]
    const { form } = opened({ is: "form", place: "step", groups: [{ name: "step", title: "Here", fields }] })
    const among = [...form.element.querySelectorAll(".pictures button.do")].map(each => each.textContent)
    const below = [...form.element.querySelectorAll("button.do")].filter(each => !each.closest(".pictures"))
    assert.deepEqual(among, ["DRAW", "UNDO"])
    assert.deepEqual(below.map(each => [each.textContent, each.querySelector("svg")]), [["CONTROLS", null]])
})

test("what the lab refuses stands beside the field until it takes a value", () => {
    const { row, form, refused } = opened(FORM, { K1: "too hard" })
    assert.equal(row("K1").querySelector("[role=alert]")!.textContent, "too hard")
    delete refused["K1"]
    form.update()
    assert.equal(row("K1").querySelector("[role=alert]")!.textContent, "")
})

test("a number has its unit on the page, and its own in the lab", () => {
    const { row, values } = opened()
    type(box(row("turned")), "90")
    press(box(row("turned")), "Enter")
    assert.ok(Math.abs((values["turned"] as number) - Math.PI / 2) < 1e-12)
    press(slider(row("turned")), "ArrowLeft")
    assert.ok(Math.abs((values["turned"] as number) - (85 * Math.PI) / 180) < 1e-12)
    assert.equal(box(row("turned")).value, "85")
})

test("a setting is there only while it acts", () => {
    const { row, values } = opened()
    assert.ok(row("cut").classList.contains("idle"))
    const on = found(row("limit"), "switch", "Limit") as HTMLInputElement
    on.click()
    assert.deepEqual([values["limit"], row("cut").className], [0.5, "field under"])
    on.click()
    assert.deepEqual([values["limit"], row("cut").className], [0, "field under idle"])
})

test("a closed group says its state, whether it is changed, and goes back with one press", () => {
    const { row, values, sets } = opened()
    const group = row("more"), state = group.querySelector(".state")!, back = group.querySelector<HTMLButtonElement>(":scope > .back")!
    assert.equal(state.textContent, "K₁ 400")
    assert.ok(back.hidden)
    type(box(row("K1")), "900")
    press(box(row("K1")), "Enter")
    found(row("limit"), "switch", "Limit").click()
    assert.equal(state.textContent, "K₁ 900 · slow down · form.count_on")
    assert.ok(!back.hidden)
    back.click()
    assert.deepEqual([values["K1"], values["limit"]], [400, 0])
    assert.equal(sets.length, 4)
    assert.ok(back.hidden)
})

test("groups stay as they were opened, also on the next visit", () => {
    const details = opened().row("more").querySelector("details")!
    assert.ok(!details.open)
    details.open = true
    details.dispatchEvent(new Event("toggle"))
    assert.ok(opened().row("more").querySelector("details")!.open)
    localStorage.setItem("onpath-groups", "null")
    assert.ok(!opened().row("more").querySelector("details")!.open)
    localStorage.clear()
})

test("other fields leave the focus and what is half typed as they are", () => {
    const { form, row } = opened()
    const field = box(row("speed")), random = chance(3)
    type(field, "1.")
    for (let i = 0; i < 50; i++) {
        const [first, more] = FORM.groups as [typeof FORM.groups[0], typeof FORM.groups[0]]
        const fields = [...first.fields].filter(each => each.name === "speed" || random() < 0.7).sort(() => random() - 0.5)
        form.show({ ...FORM, groups: random() < 0.5 ? [{ ...first, fields }, more] : [more, { ...first, fields }] })
        assert.ok(document.activeElement === field && field.value === "1.")
        const order = [...row("first").querySelectorAll<HTMLElement>(".field")].map(each => each.dataset["name"])
        assert.deepEqual(order, fields.map(each => each.name))
    }
})

test("another language renames all that stays", () => {
    const { form } = opened()
    const german = (text: string) => `${text} auf Deutsch`
    const groups = FORM.groups.map(group => ({
        ...group, title: german(group.title), fields: group.fields.map(field => ({ ...field, label: german(field.label) })),
    }))
    form.show({ ...FORM, groups })
    for (const { fields } of groups)
        for (const { name, label } of fields) {
            const row = form.element.querySelector(`[data-name="${name}"]`)!
            assert.ok(row.textContent.includes(label.split(" ").slice(1).join(" ")), `${name}: ${row.textContent}`) // a symbol is written as such
        }
})

test("a text counts when it is used, and Escape forgets it", () => {
    const { row, values } = opened()
    const area = row("law").querySelector("textarea")!, use = row("law").querySelector<HTMLButtonElement>(".use")!
    assert.ok(use.hidden)
    area.value = "across = -K1*xi"
    area.dispatchEvent(new Event("input"))
    assert.ok(!use.hidden && values["law"] === "")
    use.click()
    assert.equal(values["law"], "across = -K1*xi")
    assert.equal(sessionStorage.length, 0)
})

test("a text that is not used yet survives a reload, and one that is refused stays to be mended", () => {
    const area = (of: Element) => of.querySelector("textarea")!
    const first = opened(), typed = area(first.row("law"))
    typed.value = "across = 1"
    typed.dispatchEvent(new Event("input"))
    const { form, row, refused, values } = opened()
    assert.equal(area(row("law")).value, "across = 1")
    refused["law"] = "no"
    press(area(row("law")), "Enter")
    values["law"] = "" // as before
    pass(1000)
    form.update()
    assert.equal(area(row("law")).value, "across = 1")
    refused["law"] = ""
    form.update()
    assert.equal(area(row("law")).value, "")
    assert.equal(sessionStorage.length, 0)
})

test("buttons that follow each other stand in a row, and a search finds what acts", () => {
    const button = (name: string, more: Partial<FormField> = {}): FormField => ({ name, kind: "button", label: name, act: { do: name }, ...more })
    const { form, row } = opened({
        is: "form", place: "lab", groups: [{
            name: "first", title: "First",
            fields: [button("robot", { picture: "data:,", act: null }), button("draw"), button("undo"), SPEED, button("redo"), LIMIT, CUT],
        }],
    })
    const rows = [...form.element.querySelectorAll(".acts")].map(each => [...each.children].map(field => (field as HTMLElement).dataset["name"]))
    assert.deepEqual(rows, [["draw", "undo"], ["redo"]])
    assert.deepEqual(form.settings.map(({ name, group }) => `${group} ${name}`), ["draw", "undo", "speed", "redo", "limit"].map(name => `First ${name}`))
    assert.equal(found(row("robot"), "button", "robot").querySelectorAll("img").length, 1)
})

test("no text becomes an element", () => {
    const evil = "<img src=x onerror=alert(1)><b>"
    const field = (kind: FormField["kind"], name: string): FormField => ({
        name, kind, label: evil, symbol: evil, unit: evil, help: evil, section: evil, low: 0, high: 1, step: 0.1, default: evil,
        options: [{ value: evil, label: evil, help: evil, picture: name === "drawn" ? `${evil}"/>` : "" }],
    })
    const kinds = ["number", "choice", "switch", "button", "text", "note"] as const
    const data: FormMessage = {
        is: "form", place: "lab", groups: [
            { name: "a", title: evil, level: "deeper", states: ["choice"], fields: [...kinds.map(kind => field(kind, kind)), field("choice", "drawn")] },
        ],
    }
    const { form, values } = opened(data, { number: evil, text: evil })
    for (const name of [...kinds, "drawn"]) values[name] = evil
    form.update()
    assert.ok(form.element.textContent.includes(evil))
    assert.equal(form.element.querySelectorAll("img, b, script").length, 0)
})

/** A lab at a distance: what is sent arrives in order, later, and one in twenty messages not at all; what it tells is late, but
 * is not lost. */
class FarLab {
    readonly values: Record<string, Value> = { ...BEGIN }
    readonly arrived: { at: number; message: SetField }[] = []
    private readonly up: { at: number; message: SetField }[] = []
    private readonly down: { at: number; message: ValuesMessage }[] = []
    private readonly heard: Record<string, number> = {}
    private told = ""
    count = 0
    readonly settings = new RemoteSettings(message => {
        this.count++
        if (this.random() > 0.05) this.up.push({ at: this.later(this.up), message })
    })
    readonly form: Form

    constructor(private readonly random: () => number) {
        const { settings } = this
        this.form = new Form(FORM, {
            texts: TEXTS, act: () => {}, value: settings.value, refused: settings.refused, waits: settings.waits,
            set: (name, value) => settings.set(name, value),
        }, new AbortController().signal)
        this.settings.hear({ is: "values", values: this.values })
        this.form.update()
    }

    /** When something arrives that is sent now: after 0.5 s there and back, or more. */
    private later(line: { at: number }[]): number {
        return Math.max(time() + 200 + 100 * this.random() + (this.random() < 0.05 ? 400 : 0), line.at(-1)?.at ?? 0)
    }

    pass(milliseconds: number): void {
        for (let i = 0; i < milliseconds; i += 20) {
            pass(20)
            while (this.up[0] && this.up[0].at <= time()) this.take(this.up.shift()!.message)
            const told = JSON.stringify([this.values, this.heard])
            if (time() % 100 === 0 && told !== this.told) {
                this.told = told
                this.down.push({ at: this.later(this.down), message: { is: "values", values: { ...this.values }, heard: { ...this.heard } } })
            }
            while (this.down[0] && this.down[0].at <= time()) {
                this.settings.hear(this.down.shift()!.message)
                this.form.update()
            }
        }
    }

    private take(message: SetField): void {
        this.values[message.name] = message.value
        this.heard[message.name] = message.number
        this.arrived.push({ at: time(), message })
    }
}

test("at half a second of latency and with lost messages no slider jumps back, and the last value stays", () => {
    for (let seed = 0; seed < 5; seed++) {
        const random = chance(100 + seed), lab = new FarLab(random)
        document.body.replaceChildren(lab.form.element)
        const input = lab.form.element.querySelector<HTMLInputElement>("[data-name=speed] input[type=range]")!
        let last = 3
        for (let touch = 0; touch < 4; touch++) {
            input.dispatchEvent(new PointerEvent("pointerdown"))
            for (let left = Math.floor(1 + 100 * random()); left > 0; left--) {
                // Few values, so that older ones come back.
                last = random() < 0.3 ? last : Math.round(8 * random()) - 4
                if (last !== input.valueAsNumber) drag(input, last)
                lab.pass(20)
                assert.equal(input.valueAsNumber, last)
            }
            window.dispatchEvent(new PointerEvent("pointerup"))
            for (let rest = Math.floor(150 * random()); rest > 0; rest--) {
                lab.pass(20)
                assert.equal(input.valueAsNumber, last)
            }
        }
        for (let i = 0; i < 400; i++) {
            lab.pass(20)
            assert.equal(input.valueAsNumber, last)
        }
        assert.equal(lab.values["speed"], last)
        assert.ok(!lab.form.element.querySelector(".differs"))
    }
})

test("a drag of five seconds sends at most ten messages a second, and its last value", () => {
    const lab = new FarLab(() => 0.5) // nothing is lost
    const input = lab.form.element.querySelector<HTMLInputElement>("[data-name=speed] input[type=range]")!
    input.dispatchEvent(new PointerEvent("pointerdown"))
    for (let i = 0; i < 250; i++) {
        drag(input, -20 + (i * 40) / 250)
        lab.pass(20)
    }
    drag(input, 7.3)
    window.dispatchEvent(new PointerEvent("pointerup"))
    lab.pass(3000)
    assert.ok(lab.count <= 50 && lab.count >= 40, String(lab.count))
    assert.equal(lab.values["speed"], 7.3)
})

test("from 0.3 s after the last touch the lab's value counts, and a row says if it is another one", () => {
    const { form, row, values } = opened()
    const input = slider(row("speed"))
    drag(input, 5)
    values["speed"] = 4 // which the lab made of it
    form.update()
    pass(250)
    form.update()
    assert.equal(input.valueAsNumber, 5)
    pass(100)
    assert.equal(input.valueAsNumber, 4)
    assert.ok(row("speed").classList.contains("differs"))
    assert.equal(row("speed").querySelector(".refusal")!.textContent, "form.differs")
    pass(6000)
    assert.ok(!row("speed").classList.contains("differs"))
})

test("a number beyond its limit is marked as unstable, and a line that warns as a warning", () => {
    const alpha: FormField = { name: "alpha", kind: "number", label: "α", symbol: "α", low: -1, high: 1, step: 0.01, limit: "critical" }
    const data: FormMessage = { is: "form", place: "lab", groups: [{ name: "a", title: "A", fields: [alpha, { name: "note", kind: "note", label: "" }] }] }
    const { form, values, row } = opened(data)
    Object.assign(values, { alpha: 0.5, note: "stable" })
    form.update()
    const track = row("alpha").querySelector<HTMLElement>(".track")!
    assert.ok(!track.classList.contains("limited")) // it is not known yet
    assert.equal(row("alpha").querySelector(".name")!.textContent, "α")
    for (const [critical, place] of [[0.5, 0.75], [-1, 0], [7, 1]] as const) {
        values["critical"] = critical
        form.update()
        assert.ok(track.classList.contains("limited"))
        assert.equal(Number(track.style.getPropertyValue("--limit")), place)
    }
    assert.equal(row("note").querySelector(".warning"), null)
    values["note"] = "a line\n⚠ unstable"
    form.update()
    assert.equal(row("note").querySelector(".warning")!.textContent.trim(), "⚠ unstable")
    assert.equal(row("note").textContent, "a line\n⚠ unstable")
    values["note"] = ""
    form.update()
    assert.ok(row("note").hidden)
})
