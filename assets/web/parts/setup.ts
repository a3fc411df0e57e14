// What is chosen first: the robot, the path, and the laws of the two sides.

import type { RemoteEngine } from "../channel/channel"
import type { Choices, LawChoice, PathOutline } from "../channel/messages"
import { made, tell } from "../core/dom"
import { said, type Texts } from "../core/words"
import { icon } from "./icons"
import { pictureOf } from "./robot_sheet"
import { pressed } from "./sheet"

const SVG = "http://www.w3.org/2000/svg"
const OWN = "own" // the entry with which one types a law
const SIDES = ["left", "right"] as const

/** What the setup opens. */
export interface SetupHost {
    open(what: "robots" | "compare" | "laws"): void
    /** Open a file with a path. */
    file(): void
    /** Type a law for a side. */
    type(side: 0 | 1): void
}

export class Setup {
    readonly element = made("section", "form setup")
    private readonly robot: HTMLButtonElement
    private readonly tiles = made("div", "tiles")
    private readonly path = made("span", "value")
    private readonly laws: { select: HTMLSelectElement; says: HTMLElement; refusal: HTMLElement; edit: HTMLButtonElement }[]
    private choices: Choices | null = null
    private shown = ""

    constructor(private readonly texts: Texts, private readonly engine: RemoteEngine, private readonly host: SetupHost) {
        const words = (key: string) => said(texts, key)
        this.robot = pressed("robot", "", () => host.open("robots"))
        this.tiles.role = "radiogroup"
        this.tiles.ariaLabel = words("design.path")
        const acts = made("div", "acts",
            Object.assign(pressed("", words("setup.draw"), () => engine.send({ is: "freehand" })), { title: words("design.draw_hint") }),
            Object.assign(pressed("", words("setup.file"), () => host.file()), { title: words("setup.file_hint") }),
            pressed("", words("design.undo"), () => engine.send({ do: "Undo" })), pressed("", words("design.redo"), () => engine.send({ do: "Redo" })))
        this.laws = SIDES.map((side, i) => {
            const select = made("select", ""), says = made("p", `says side${i}`), refusal = made("p", "refusal")
            select.id = `op-law-${side}`
            select.ariaLabel = words(`laws.${side}`)
            select.addEventListener("change", () => this.choose(i as 0 | 1, select.value))
            refusal.setAttribute("role", "alert")
            const edit = pressed("edit", words("setup.edit_law"), () => host.type(i as 0 | 1))
            edit.ariaLabel = `${words("setup.edit_law")}: ${words(`laws.own_${side}`)}`
            return { select, says, refusal, edit }
        })
        const rows = this.laws.map(({ select, says, refusal, edit }, i) => {
            const name = Object.assign(made("label", "name", words(`setup.${SIDES[i]!}`)), { htmlFor: select.id })
            return made("div", "law", made("div", "field", name, select), says, edit, refusal)
        })
        this.element.append(
            made("div", "group", made("div", "field", made("span", "name", words("search.kind_robot")), this.robot),
                made("div", "field", made("span", "name", words("design.path")), this.path), this.tiles, acts),
            made("div", "group", ...rows, made("div", "acts", pressed("", words("setup.compare"), () => host.open("compare")), pressed("", words("laws.about"), () => host.open("laws")))),
        )
    }

    /** Offer what this robot can do. */
    offer(choices: Choices): void {
        const { texts, robot, tiles, laws } = this
        this.choices = choices
        this.shown = ""
        robot.replaceChildren(pictureOf(choices.robot), made("b", "", choices.robot.label), icon("right"))
        robot.title = choices.robot.text
        tiles.replaceChildren(...choices.paths.map(path => this.tile(path)))
        const options = (list: readonly LawChoice[]) => list.map(law => Object.assign(made("option", "", law.label), { value: law.name }))
        for (const { select } of laws) select.replaceChildren(...options(choices.laws), Object.assign(made("option", "", said(texts, "laws.own")), { value: OWN }))
        this.follow()
    }

    /** Show what is chosen now. */
    follow(): void {
        const { choices, engine, texts } = this, lab = engine.lab!
        if (!choices) return
        const shown = JSON.stringify([lab.laws, lab.path, lab.refusals, lab.texts])
        if (shown === this.shown) return
        this.shown = shown
        for (const input of this.tiles.querySelectorAll("input")) input.checked = input.value === lab.path
        tell(this.path, choices.paths.find(path => path.name === lab.path)?.label ?? said(texts, "design.own"))
        this.laws.forEach(({ select, says, refusal, edit }, i) => {
            const law = lab.laws[i]!, isKnown = choices.laws.some(each => each.name === law)
            if (select !== document.activeElement || select.value !== law) select.value = isKnown ? law : OWN
            tell(says, lab.texts[i]!)
            says.classList.toggle("typed", !isKnown)
            edit.hidden = isKnown
            tell(refusal, lab.refusals[i] ?? "")
        })
    }

    private choose(side: 0 | 1, law: string): void {
        if (law === OWN) return this.host.type(side)
        this.engine.send({ do: "ChooseLaw", side: SIDES[side], law })
    }

    /** After a typed law was given up, the menu shows again what acts. */
    restore(): void {
        this.shown = ""
        this.follow()
    }

    private tile({ name, label, outline }: PathOutline): HTMLElement {
        const input = Object.assign(made("input", ""), { type: "radio", name: "op-path", value: name, ariaLabel: label })
        input.addEventListener("change", () => this.engine.send({ do: "ChoosePath", name }))
        const picture = document.createElementNS(SVG, "svg"), line = document.createElementNS(SVG, "path")
        picture.setAttribute("viewBox", "-60 -60 120 120")
        picture.setAttribute("aria-hidden", "true")
        line.setAttribute("d", outline)
        picture.append(line)
        return Object.assign(made("label", "tile", input, picture), { title: label })
    }
}
