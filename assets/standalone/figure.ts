// Builds a figure in a page, and lets time run.

import { caption, spoken } from "./captions"
import { Controls, made, type Running } from "./controls"
import { said, type FigureData } from "./data"
import { Plot } from "./plot"
import type { Simulation } from "./simulation"
import { View } from "./view"

const FRAME = 1 / 60 // [s], of a step
const LONGEST = 0.1 // [s], that a picture may be late before simulated time falls behind
const SILENCE = 3000 // [ms], at least, between two lines of the same kind
const PULL = 0.03 // [m], by which a key pulls

export class Figure implements Running {
    running = !matchMedia("(prefers-reduced-motion: reduce)").matches
    readonly controls: Controls
    private readonly data: FigureData
    private readonly views: View[]
    private readonly captions: HTMLElement[]
    private readonly plot: Plot
    private readonly live = made("p", "live")
    private last = performance.now()
    private due = 0
    private stale = true
    private kind = ""
    private said = 0

    /** `ended` stops the figure, for a page that puts another one in its place. */
    constructor(
        readonly simulation: Simulation,
        into: HTMLElement,
        private readonly ended: AbortSignal = new AbortController().signal,
    ) {
        const data = (this.data = simulation.data)
        this.views = this.simulation.benches.map(bench => new View(bench, data))
        this.captions = this.views.map(() => made("span", "caption"))
        this.plot = new Plot(this.simulation, data)
        this.live.setAttribute("role", "status")
        this.controls = new Controls(simulation, this, ended)
        into.replaceChildren(...this.parts())
        if (data.controls.includes("pull")) {
            for (const view of this.views) this.grabs(view)
            this.keys()
        }
        addEventListener("resize", () => (this.stale = true), { signal: ended })
        this.forget()
        requestAnimationFrame(() => this.frame())
    }

    step(): void {
        this.advance(Math.round(FRAME / this.data.dt))
    }

    forget(): void {
        this.plot.clear()
        for (const view of this.views) view.clear()
        this.follow()
    }

    /** Advance by so many ticks, apart from the clock. */
    advance(ticks: number): void {
        this.simulation.advance(ticks)
        this.follow()
    }

    private parts(): HTMLElement[] {
        const { data } = this
        const robots = this.views.map((view, i) => {
            const { title, text } = data.benches[i]!
            const heading = made("h2", `title bench${i}`, title, " ", this.captions[i]!)
            heading.title = text
            view.canvas.setAttribute("role", "img")
            view.canvas.setAttribute("aria-label", said(data, "standalone.scene", { law: title }))
            return made("section", "robot", heading, view.canvas)
        })
        this.plot.canvas.setAttribute("role", "img")
        this.plot.canvas.setAttribute("aria-label", this.plot.label())
        return [
            ...(data.title ? [made("h1", "", data.title)] : []),
            made("div", "robots", ...robots),
            this.controls.element,
            ...(data.controls.includes("plot") ? this.plotted() : []),
            this.live,
        ]
    }

    private plotted(): HTMLElement[] {
        return [
            made("p", "axis", said(this.data, "standalone.plot")),
            made("div", "plot", this.plot.canvas),
        ]
    }

    private frame(): void {
        if (this.ended.aborted) return
        const now = performance.now()
        this.due += Math.min((now - this.last) / 1e3, LONGEST)
        this.last = now
        const ticks = Math.floor(this.due / this.data.dt)
        this.due -= ticks * this.data.dt
        if (this.running && ticks > 0) this.advance(ticks)
        if (this.stale) this.draw()
        requestAnimationFrame(() => this.frame())
    }

    private follow(): void {
        this.stale = true
        for (const view of this.views) view.follow()
        this.plot.follow()
    }

    private draw(): void {
        const { simulation, data } = this
        this.stale = false
        for (const view of this.views) view.draw(data.paths[simulation.path]!.outline)
        this.plot.draw()
        const captions = simulation.benches.map(bench => caption(bench, data))
        this.captions.forEach((element, i) => {
            if (element.textContent !== captions[i]) element.textContent = captions[i]!
        })
        this.say(captions)
    }

    /** Say what robots do when it changes, and from time to time each millimetre of it. */
    private say(captions: string[]): void {
        const line = spoken(this.simulation.benches, captions, this.data)
        const kind = line.replace(/[0-9]+/g, "")
        const now = performance.now()
        if (line === this.live.textContent) return
        if (kind === this.kind && now < this.said + SILENCE) return
        this.kind = kind
        this.said = now
        this.live.textContent = line
    }

    /** Pull all tips while the mouse or a finger drags one of them, or a key is down. */
    private grabs(view: View): void {
        const { canvas } = view
        let from: PointerEvent | null = null
        canvas.addEventListener(
            "touchstart",
            event => {
                const touch = event.touches[0]
                if (touch && view.holds(touch.clientX, touch.clientY)) event.preventDefault()
            },
            { passive: false },
        )
        canvas.addEventListener("pointerdown", event => {
            if (!view.holds(event.clientX, event.clientY)) return
            from = event
            canvas.setPointerCapture(event.pointerId)
            this.simulation.pull([0, 0])
        })
        canvas.addEventListener("pointermove", event => {
            canvas.classList.toggle("near", from !== null || view.holds(event.clientX, event.clientY))
            if (!from || event.pointerId !== from.pointerId) return
            this.simulation.pull(view.metres(event.clientX - from.clientX, event.clientY - from.clientY))
        })
        for (const end of ["pointerup", "pointercancel"] as const)
            canvas.addEventListener(end, () => {
                if (from) this.simulation.pull(null)
                from = null
            })
    }

    private keys(): void {
        const ways: Record<string, [number, number]> = {
            a: [-PULL, 0], d: [PULL, 0], w: [0, PULL], s: [0, -PULL],
        }
        const way = (event: KeyboardEvent) =>
            event.ctrlKey || event.metaKey || event.altKey ? undefined : ways[event.key.toLowerCase()]
        const { ended: signal } = this
        addEventListener(
            "keydown",
            event => {
                const by = way(event)
                if (by && !event.repeat) this.simulation.pull(by)
            },
            { signal },
        )
        addEventListener("keyup", event => way(event) && this.simulation.pull(null), { signal })
        addEventListener("blur", () => this.simulation.pull(null), { signal })
    }
}
