import { press, TEXTS } from "../page"
import assert from "node:assert/strict"
import { test } from "node:test"
import type { RobotSheet } from "../../../../assets/web/channel/messages"
import { chooseRobot } from "../../../../assets/web/parts/robot_sheet"

const ROBOTS = ["a", "b", "c"].map(name => ({ name, label: name.toUpperCase(), text: "", differs: "", picture: "data:,", tip: "", is_built: true, send: { do: "ChooseRobot", name } }))
const TIP = { ...ROBOTS[1]!, tip: "tool0", is_built: false, send: { is: "choose_tip", robot: "b", tip: "tool0" } }

/** The robots to choose from, opened by a button; returns what is chosen. */
function opened(): { button: HTMLButtonElement; chosen: unknown[]; card: () => HTMLElement } {
    const button = document.createElement("button"), chosen: unknown[] = []
    document.body.replaceChildren(button)
    button.focus()
    chooseRobot(TEXTS, { robots: [...ROBOTS, TIP] } as unknown as RobotSheet, "b", message => chosen.push(message))
    return { button, chosen, card: () => document.activeElement as HTMLElement }
}

test("the present robot has the focus, keys go to another one, and the focus comes back with the choice", () => {
    const { button, chosen, card } = opened()
    assert.equal(card().getAttribute("aria-current"), "true")
    press(card(), "ArrowRight")
    card().click()
    assert.deepEqual(chosen, [{ do: "ChooseRobot", name: "c" }])
    assert.ok(document.activeElement === button && !document.querySelector("dialog"))
})

test("the robot that is there is not begun anew", () => {
    const { chosen, card } = opened()
    card().click()
    assert.deepEqual(chosen, [])
})

test("a tip that is not built is asked of the server, although the name is that of the present robot", () => {
    const { chosen, card } = opened()
    press(card(), "End")
    card().click()
    assert.deepEqual(chosen, [{ is: "choose_tip", robot: "b", tip: "tool0" }])
})
