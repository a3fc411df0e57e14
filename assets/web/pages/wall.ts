// The wall of a class, for a projector: what the class is asked and has answered, how to join, and the robots of its step.
// It has no controls.

import { elementsOf, made, tell } from "../core/dom"
import { projected } from "../core/placing"
import { ServerEngine } from "../channel/channel"
import type { WallMessage } from "../channel/messages"
import { Sketch } from "../parts/sketch"
import { openScreen } from "./screen"

class Wall {
    readonly element: HTMLElement
    private readonly sketch: Sketch
    private readonly names: HTMLElement[]
    private readonly stage: HTMLElement
    private readonly asked = made("section", "asked")
    private readonly join = made("aside", "join")
    private readonly closing = made("p", "closing")
    private readonly shown = new Map<HTMLElement, string>()

    constructor(private readonly engine: ServerEngine) {
        this.sketch = new Sketch(engine, new AbortController().signal)
        this.names = engine.texts.map((_, i) => made("h2", `name side${i}`))
        this.stage = made("section", "robots", this.sketch.element, ...this.names)
        this.closing.role = "timer"
        this.asked.role = "status"
        this.element = made("main", "", this.asked, this.closing, this.stage, this.join)
        new ResizeObserver(() => this.place()).observe(this.stage)
        engine.on(change => {
            if (change === "class") this.hear(engine.wall!)
            else if (change !== "samples") this.place()
        })
        if (engine.wall) this.hear(engine.wall)
        this.draw()
    }

    private hear({ join, asked, closing, note }: WallMessage): void {
        this.fill(this.join, join)
        this.fill(this.asked, asked)
        tell(this.closing, closing === null ? note : String(closing))
        this.closing.classList.toggle("runs", closing !== null)
    }

    private fill(element: HTMLElement, html: string): void {
        if (this.shown.get(element) === html) return
        this.shown.set(element, html)
        element.replaceChildren(elementsOf(html))
    }

    /** Put the names over the robots. */
    private place(): void {
        const { width, height } = this.stage.getBoundingClientRect(), { engine } = this
        if (!height) return
        engine.shape = width / height
        engine.texts.forEach(({ name }, i) => {
            tell(this.names[i]!, name)
            this.names[i]!.style.left = `${width / 2 + height * projected(engine.cameras[i]!, engine.lab!.above)[0]}px`
        })
    }

    private draw(): void {
        this.sketch.draw()
        requestAnimationFrame(() => this.draw())
    }
}

const engine = new ServerEngine(() => ({ dark: false, plain: true, upright: false }), "wall")
openScreen(engine, () => new Wall(engine).element)
