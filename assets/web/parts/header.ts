// The head of the lab's page: where one can go.

import type { ClassMessage } from "../channel/messages"
import { made } from "../core/dom"
import { phrase, type Texts } from "../core/words"
import { icon } from "./icons"
import { Menu } from "./menu"
import { pressed } from "./sheet"

/** Places of the head, and of its menu; with their names. */
const PLACES = { controls: "lesson.controls", lessons: "lesson.lessons", search: "search.title" } as const
const MORE = { compare: "compare.title", keep: "keep.title", help: "controls.help", display: "display.title" } as const
type Place = keyof typeof PLACES
type Destination = Place | keyof typeof MORE | "class"

export class Header {
    readonly element = made("header", "")
    /** Opens the controls, where they are not in sight. */
    readonly controls: HTMLButtonElement
    private readonly brand = made("span", "brand", "OnPath")
    /** Opens the card of the class. */
    readonly seat: HTMLButtonElement
    private readonly lessons: HTMLButtonElement
    private readonly ofLab: HTMLButtonElement[] // in the menu

    constructor(private readonly texts: Texts, go: (place: Destination) => void) {
        this.element.id = "op-head"
        const button = (place: Place) => {
            const named = pressed(place, icon(place), () => go(place))
            return entitled(named, phrase(texts, PLACES[place]))
        }
        const more = phrase(texts, "head.more"), menu = new Menu(more)
        menu.button.append(icon("more"))
        const item = (place: keyof typeof MORE) => pressed("", phrase(texts, MORE[place]), () => menu.leave(() => go(place)))
        this.ofLab = [item("compare"), item("keep")]
        menu.list.append(...this.ofLab, item("help"), item("display"))
        this.controls = button("controls")
        this.controls.ariaExpanded = "false"
        this.lessons = button("lessons")
        const places = made("nav", "", this.controls, this.lessons, button("search"), entitled(menu.button, more), menu.list)
        places.ariaLabel = "OnPath"
        this.seat = pressed("seat", "", () => go("class"))
        this.seat.hidden = true
        this.element.append(this.brand, this.seat, places)
    }

    /** Whether there are lessons. */
    set teaches(teaches: boolean) {
        this.lessons.hidden = !teaches
    }

    /** Whether the lab is one's own. */
    set own(own: boolean) {
        for (const each of this.ofLab) each.hidden = !own
    }

    /** Show who one is in the class, or how to join it. */
    sit({ membership, code, name, asks, identification }: ClassMessage): void {
        const { seat, brand, texts } = this
        seat.hidden = membership === "none"
        brand.hidden = !seat.hidden
        const isAsked = asks !== "" && !identification, room = phrase(texts, isAsked ? "class.sign" : "class.of", { code })
        seat.classList.toggle("asked", isAsked)
        if (membership === "member") seat.replaceChildren(made("b", "", made("bdi", "", name)), made("small", "", room))
        else seat.replaceChildren(phrase(texts, "class.join"))
        seat.ariaLabel = seat.title = membership === "member" ? `${name} · ${room}` : phrase(texts, "class.join")
    }
}

/** Give a button with a picture its name. */
function entitled(button: HTMLButtonElement, name: string): HTMLButtonElement {
    button.append(made("span", "", name))
    return Object.assign(button, { title: name, ariaLabel: name })
}
