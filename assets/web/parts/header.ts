// The head of the lab's page: where one can go.

import { made } from "../core/dom"
import { said, type Texts } from "../core/words"
import { icon, type Icon } from "./icons"
import { pressed } from "./sheet"

export type Place = "controls" | "search" | "lessons" | "help" | "display"
const ICONS: Record<Place, Icon> = { controls: "controls", search: "search", lessons: "lessons", help: "help", display: "gear" }
const KEYS: Record<Place, string> = {
    controls: "lesson.controls", search: "search.title", lessons: "lesson.lessons", help: "controls.help", display: "display.title",
}

export class Header {
    readonly element = made("header", "")
    /** Opens the controls, where they are not in sight. */
    readonly controls: HTMLButtonElement
    /** Whose place this is in which class. */
    readonly member = made("span", "member")

    constructor(texts: Texts, go: (place: Place) => void) {
        this.element.id = "op-head"
        const button = (place: Place) => {
            const name = said(texts, KEYS[place])
            const named = pressed(place, icon(ICONS[place]), () => go(place))
            named.append(made("span", "", name))
            return Object.assign(named, { title: name, ariaLabel: name })
        }
        this.controls = button("controls")
        this.controls.ariaExpanded = "false"
        const places = made("nav", "", this.controls, button("lessons"), button("search"), button("help"), button("display"))
        places.ariaLabel = "OnPath"
        this.element.append(made("span", "brand", "OnPath"), this.member, places)
    }
}
