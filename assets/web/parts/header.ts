// The head of the lab's page: where one can go.

import { made } from "../core/dom"
import { said, type Texts } from "../core/words"
import { icon, type Icon } from "./icons"
import { pressed } from "./sheet"

type Destination = "controls" | "search" | "lessons" | "help" | "display"
const ICONS: Record<Destination, Icon> = { controls: "controls", search: "search", lessons: "lessons", help: "help", display: "gear" }
const KEYS: Record<Destination, string> = {
    controls: "lesson.controls", search: "search.title", lessons: "lesson.lessons", help: "controls.help", display: "display.title",
}

export class Header {
    readonly element = made("header", "")
    /** Opens the controls, where they are not in sight. */
    readonly controls: HTMLButtonElement

    constructor(texts: Texts, go: (place: Destination) => void) {
        this.element.id = "op-head"
        const button = (place: Destination) => {
            const name = said(texts, KEYS[place])
            const named = pressed(place, icon(ICONS[place]), () => go(place))
            named.append(made("span", "", name))
            return Object.assign(named, { title: name, ariaLabel: name })
        }
        this.controls = button("controls")
        this.controls.ariaExpanded = "false"
        const places = made("nav", "", this.controls, button("lessons"), button("search"), button("help"), button("display"))
        places.ariaLabel = "OnPath"
        this.element.append(made("span", "brand", "OnPath"), places)
    }
}
