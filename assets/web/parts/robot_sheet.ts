// The robots to choose from: a grid of pictures, with the arrow keys and Enter.

import type { Command, PageMessage, RobotSheet } from "../channel/messages"
import { made } from "../core/dom"
import { phrase, type Texts } from "../core/words"
import { pressed, SheetDialog } from "./sheet"

/** Open the robots; the present one has the focus. */
export function chooseRobot(texts: Texts, { robots }: RobotSheet, present: string, send: (message: Command | PageMessage) => void): SheetDialog {
    const sheet = new SheetDialog(texts, "robots", phrase(texts, "robots.choose"))
    const cards = robots.map(robot => {
        const isPresent = robot.is_built && robot.name === present
        const card = pressed("card", "", () => {
            sheet.close()
            if (!isPresent) send(robot.send)
        })
        const picture = Object.assign(made("img", "robot"), { src: robot.picture, alt: "" }) // its name stands beside it
        card.append(picture, made("b", "", robot.label), made("span", "differs", robot.differs))
        card.title = robot.text
        card.tabIndex = isPresent ? 0 : -1
        if (isPresent) card.setAttribute("aria-current", "true")
        return card
    })
    const grid = made("div", "grid", ...cards)
    grid.role = "group"
    grid.ariaLabel = phrase(texts, "robots.choose")
    grid.addEventListener("keydown", event => {
        const at = cards.indexOf(document.activeElement as HTMLButtonElement)
        const across = cards.filter(card => card.offsetTop === cards[0]!.offsetTop).length
        const to = { ArrowRight: at + 1, ArrowLeft: at - 1, ArrowDown: at + across, ArrowUp: at - across, Home: 0, End: cards.length - 1 }[event.key]
        if (to === undefined || at < 0) return
        event.preventDefault()
        const next = cards[to]
        if (!next) return
        for (const card of cards) card.tabIndex = card === next ? 0 : -1
        next.focus()
    })
    sheet.body.append(grid, made("p", "note", phrase(texts, "robots.illustrative")))
    sheet.open(cards.find(card => card.tabIndex === 0) ?? cards[0])
    return sheet
}
