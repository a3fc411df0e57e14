// The wall of a class, for a projector: what the class is asked and has answered, how to join, and the robots of its step.
// It has no controls.

import { elementsOf, made, tell } from "../core/dom"
import { projected } from "../core/placing"
import { ServerEngine } from "../channel/channel"
import type { WallMessage } from "../channel/messages"
import { Sketch } from "../parts/sketch"
import { openScreen } from "./screen"

const MOST = 0.45 // share of the height that a text above the robots may take

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
        const sizes = new ResizeObserver(() => { this.fit(); this.place() })
        for (const each of [this.element, this.stage]) sizes.observe(each)
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
        this.fit()
    }

    private fill(element: HTMLElement, html: string): void {
        if (this.shown.get(element) === html) return
        this.shown.set(element, html)
        element.replaceChildren(elementsOf(html))
    }

    /** Put the robots under a short text, and beside a longer one, which may be smaller; without them, a still longer one has two columns. */
    private fit(): void {
        const { element, asked } = this
        const fits = (shape: string, ...zooms: number[]) => {
            element.className = shape
            return zooms.some(zoom => {
                asked.style.setProperty("zoom", String(zoom))
                return asked.scrollHeight <= asked.clientHeight && asked.scrollWidth <= asked.clientWidth
            })
        }
        const isShort = () => asked.offsetHeight <= MOST * element.clientHeight
        if (!(fits("", 1) && isShort()) && !fits("beside", 1, 0.9, 0.8, 0.7)) fits("long", 1, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4)
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
