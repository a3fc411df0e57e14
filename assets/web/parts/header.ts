// The head of the lab's page: where one can go.

import type { ClassMessage } from "../channel/messages"
import { made } from "../core/dom"
import { phrase, type Texts } from "../core/words"
import { icon, type Icon } from "./icons"
import { pressed } from "./sheet"

type Destination = "controls" | "search" | "lessons" | "help" | "display" | "class"
const ICONS: Record<Exclude<Destination, "class">, Icon> = { controls: "controls", search: "search", lessons: "lessons", help: "help", display: "gear" }
const KEYS: Record<keyof typeof ICONS, string> = {
    controls: "lesson.controls", search: "search.title", lessons: "lesson.lessons", help: "controls.help", display: "display.title",
}

export class Header {
    readonly element = made("header", "")
    /** Opens the controls, where they are not in sight. */
    readonly controls: HTMLButtonElement
    private readonly brand = made("span", "brand", "OnPath")
    /** Opens the card of the class. */
    readonly seat: HTMLButtonElement

    constructor(private readonly texts: Texts, go: (place: Destination) => void) {
        this.element.id = "op-head"
        const button = (place: keyof typeof ICONS) => {
            const name = phrase(texts, KEYS[place])
            const named = pressed(place, icon(ICONS[place]), () => go(place))
            named.append(made("span", "", name))
            return Object.assign(named, { title: name, ariaLabel: name })
        }
        this.controls = button("controls")
        this.controls.ariaExpanded = "false"
        const places = made("nav", "", this.controls, button("lessons"), button("search"), button("help"), button("display"))
        places.ariaLabel = "OnPath"
        this.seat = pressed("seat", "", () => go("class"))
        this.seat.hidden = true
        this.element.append(this.brand, this.seat, places)
    }

    /** Show who one is in the class, or how to join it. */
    sit({ place, code, name }: ClassMessage): void {
        const { seat, brand, texts } = this
        seat.hidden = place === "none"
        brand.hidden = !seat.hidden
        const room = phrase(texts, "class.of", { code })
        if (place === "member") seat.replaceChildren(made("b", "", made("bdi", "", name)), made("small", "", room))
        else seat.replaceChildren(phrase(texts, "class.join"))
        seat.ariaLabel = seat.title = place === "member" ? `${name} · ${room}` : phrase(texts, "class.join")
    }
}
