// What lies over the robots' picture: each robot's title, what it does now, and its lens; and what one waits for.

import { made, tell } from "../core/dom"
import { shown } from "../core/engine"
import { projected, shares } from "../core/placing"
import { phrase, written, type Texts } from "../core/words"
import type { ServerEngine } from "../channel/channel"

export class OverStage {
    readonly element: HTMLElement
    /** One for each robot, as wide as its part of the picture. */
    readonly sides: HTMLElement[]
    private readonly titles: HTMLElement[]
    private readonly captions: HTMLElement[]
    private readonly still = made("p", "still")
    private width = 0 // of the picture, [px]
    private height = 0
    private placed = "" // for which places of the robots

    constructor(private readonly engine: ServerEngine, private readonly texts: Texts, ...drawn: HTMLElement[]) {
        this.titles = engine.texts.map(() => made("h2", "title", made("span", "", made("b", ""), made("small", ""))))
        this.captions = engine.texts.map(() => made("p", "caption", made("span", "")))
        this.sides = engine.texts.map((_, i) => made("div", `side side${i}`, this.titles[i]!, this.captions[i]!))
        this.still.setAttribute("role", "status")
        this.element = made("div", "", made("h1", "op-unseen", "OnPath"), ...drawn, ...this.sides, this.still)
        this.element.id = "op-stage"
    }

    /** Cover the picture. */
    place(left: number, top: number, width: number, height: number): void {
        Object.assign(this.element.style, { left: `${left}px`, top: `${top}px`, width: `${width}px`, height: `${height}px` })
        Object.assign(this, { width, height })
        this.arrange()
    }

    show(): void {
        const { engine, texts } = this
        const { past, running } = engine.state
        engine.texts.forEach(({ title, name, text, caption }, i) => {
            tell(this.titles[i]!.querySelector("b")!, name)
            tell(this.titles[i]!.querySelector("small")!, name === title ? "" : title) // its law
            this.titles[i]!.title = text
            tell(this.captions[i]!.firstElementChild as HTMLElement, past === null ? caption : "")
        })
        const time = written(texts, shown(engine).time, 1)
        const { drawn, machine, waits } = engine.lab!
        const building = drawn || !webgl.works ? "" : phrase(texts, "stage.building", { robot: machine })
        tell(this.still, building || waits || (past !== null ? phrase(texts, "stage.past", { time }) : running ? "" : phrase(texts, "stage.paused")))
        this.element.classList.toggle("undrawn", !drawn)
        this.arrange()
    }

    /** Put the titles over the robots, where the camera shows them. */
    arrange(): void {
        const { width, height } = this
        const { cameras } = this.engine, { above } = this.engine.lab!
        const middles = cameras.map(camera => width / 2 + height * projected(camera, above)[0])
        const key = JSON.stringify([width, middles.map(Math.round)])
        if (key === this.placed) return
        this.placed = key
        const given = shares(middles, width)
        this.element.style.setProperty("--op-share", `${Math.min(...given.map(share => share.width))}px`)
        given.forEach((share, i) => {
            const { style } = this.sides[i]!
            Object.assign(style, { left: `${share.left}px`, width: `${share.width}px` })
            style.setProperty("--op-before", `${share.middle}fr`)
            style.setProperty("--op-after", `${share.width - share.middle}fr`)
        })
    }
}
