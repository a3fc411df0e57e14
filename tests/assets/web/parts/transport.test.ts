import { found, press, TEXTS } from "../page"
import assert from "node:assert/strict"
import { test } from "node:test"
import type { Act, Change, Engine, State } from "../../../../assets/web/core/engine"
import { Transport } from "../../../../assets/web/parts/transport"

const STATE: State = { running: true, rate: 1, held: false, pulled: false, past: null, branches: false, frozen: "" }

/** The buttons over robots that do what they are told. */
function opened(): { transport: Transport; acts: string[]; show: (changes: Partial<State>) => void; state: State } {
    const state = { ...STATE }, acts: string[] = []
    let tell: (change: Change) => void = () => {}
    const engine = {
        texts: [{}, {}], state, on: (listener: typeof tell) => (tell = listener),
        act: (act: Act) => {
            acts.push("on" in act ? `${act.do} ${act.on}` : "rate" in act ? `${act.do} ${act.rate}` : act.do)
            if (act.do === "hold") state.held = act.on
            if (act.do === "run") state.running = act.on
            tell("state")
        },
    } as unknown as Engine
    const transport = new Transport(TEXTS, engine, ["hold", "run", "step", "reset"])
    document.body.replaceChildren(transport.element)
    return { transport, acts, state, show: changes => (Object.assign(state, changes), tell("state")) }
}

const brake = (transport: Transport) => transport.brake.querySelector<HTMLButtonElement>("button.main")!

/** A press that lasts some time [ms]. */
function pressFor(button: HTMLElement, time: number, end = "pointerup"): void {
    Object.assign(button, { setPointerCapture: () => {} })
    const event = (name: string, at: number) => Object.defineProperty(new PointerEvent(name, { button: 0, bubbles: true }), "timeStamp", { value: at })
    button.dispatchEvent(event("pointerdown", 1000))
    button.dispatchEvent(event(end, 1000 + time))
}

test("a short press holds and another lets go; a long one lets go in the end", () => {
    const { transport, acts, state } = opened()
    pressFor(brake(transport), 100)
    assert.ok(state.held)
    assert.equal(brake(transport).ariaPressed, "true")
    pressFor(brake(transport), 100)
    assert.ok(!state.held)
    for (const end of ["pointerup", "pointercancel", "lostpointercapture", "blur"]) pressFor(brake(transport), 1000, end)
    assert.ok(!state.held)
    assert.deepEqual(acts, Array.from({ length: 5 }, () => ["hold true", "hold false"]).flat())
})

test("a press with another button of the mouse does nothing", () => {
    const { transport, acts } = opened()
    brake(transport).dispatchEvent(new PointerEvent("pointerdown", { button: 2, bubbles: true }))
    brake(transport).dispatchEvent(new PointerEvent("pointerup", { button: 2, bubbles: true }))
    assert.deepEqual(acts, [])
})

test("keys and screen readers hold, too, and a key that repeats holds once", () => {
    const { transport, acts, state } = opened()
    press(brake(transport), " ")
    brake(transport).dispatchEvent(new KeyboardEvent("keydown", { key: " ", repeat: true, bubbles: true, cancelable: true }))
    brake(transport).dispatchEvent(new KeyboardEvent("keyup", { key: " ", bubbles: true, cancelable: true }))
    assert.deepEqual(acts, ["hold true"])
    brake(transport).dispatchEvent(new MouseEvent("click", { detail: 0, bubbles: true })) // a screen reader's
    assert.ok(!state.held)
})

test("time runs, pauses, steps, is slowed down and begins anew", () => {
    const { transport, acts, state } = opened()
    found(transport.element, "button", "run.runrun.pause").click()
    assert.ok(!state.running)
    for (const name of ["run.step", "run.reset"]) found(transport.element, "button", name).click()
    const rate = found(transport.element, "combobox", "run.rate") as HTMLSelectElement
    rate.selectedIndex = 2
    rate.dispatchEvent(new Event("change"))
    assert.deepEqual(acts, ["run false", "step", "reset", "rate 0.25"])
})

test("in the past, one goes on or back; where one cannot go on, only back", () => {
    const { transport, acts, show } = opened()
    const past = transport.element.querySelector<HTMLElement>(".past")!
    const goes = found(transport.element, "button", "past.go_on")
    assert.ok(past.hidden)
    show({ past: 1, branches: true })
    assert.ok(!past.hidden && !goes.hidden)
    show({ branches: false })
    assert.ok(goes.hidden)
    found(transport.element, "button", "transport.back").click()
    assert.deepEqual(acts, ["seek"])
})

test("while the robots take no commands, every button says why, and then what it does", () => {
    const { transport, show } = opened()
    const buttons = [...transport.element.querySelectorAll("button")], hints = buttons.map(each => each.title)
    show({ frozen: "look to the front" })
    assert.ok(buttons.every(each => each.title === "look to the front" && each.ariaDisabled === "true"))
    assert.ok(transport.element.querySelector("select")!.disabled)
    show({ frozen: "" })
    assert.deepEqual(buttons.map(each => each.title), hints)
    assert.ok(buttons.every(each => each.ariaDisabled === null) && !transport.element.querySelector("select")!.disabled)
})

test("a button shows one of its labels, and keeps the room of all", () => {
    const { transport, show } = opened()
    const shown = () => [...brake(transport).children].map(each => each.classList.contains("off"))
    assert.deepEqual(shown(), [false, true])
    show({ held: true })
    assert.deepEqual(shown(), [true, false])
})
