// The live figure of a step, whose kernels are in a script that pages share.

import type { Action, Script, SiteFigure, StepData } from "../core/lesson_data"
import { Kernels } from "../simulation/kernels"
import { Recorded } from "../lessons/recorded"
import { Figure } from "./figure"

declare global {
    interface Window {
        onpathKernels: Record<string, string>
    }
}

/** The kernels in a script of the site. */
export async function kernelsOf(name: string): Promise<Kernels> {
    if (!window.onpathKernels[name]) {
        const script = document.createElement("script")
        script.src = `site/kernels/${name}.js`
        await new Promise((done, failed) => {
            script.addEventListener("load", done)
            script.addEventListener("error", () => failed(new Error(`${script.src} was not loaded`)))
            document.head.append(script)
        })
    }
    return Kernels.from(window.onpathKernels[name]!)
}

export class Stage {
    private constructor(
        readonly figure: Figure,
        readonly simulation: Recorded,
        private readonly into: HTMLElement,
        private readonly ended: AbortController,
    ) {}

    /** Put a figure into the page. */
    static async open(data: SiteFigure, { values, remade }: StepData, into: HTMLElement): Promise<Stage> {
        const simulation = new Recorded(data, await kernelsOf(data.module), values, Object.keys(remade))
        const ended = new AbortController()
        return new Stage(new Figure(simulation, into, ended.signal, true), simulation, into, ended)
    }

    close(): void {
        this.ended.abort()
        for (const { element } of [this.figure.form, this.figure.strip]) element.remove()
        this.into.replaceChildren()
    }

    /** Show on the robots what a symbol means; nothing if it is empty. */
    light(symbol: string): void {
        this.figure.light(symbol)
    }

    run(on: boolean): void {
        this.figure.engine.act({ do: "run", on })
    }

    /** Perform a link's actions; the form follows. */
    act(actions: Action[]): void {
        for (const action of actions) {
            if (action.run !== undefined) this.run(action.run)
            else this.simulation.act(action)
        }
        this.figure.changed()
    }

    /** Play a script from the step's beginning; `ended` gets whether all of it was played, or a reset came. */
    play(script: Script, ended: (whole: boolean) => void): void {
        const { simulation, figure } = this
        const go = (rate: number) => figure.engine.act({ do: "rate", rate })
        const told = (action: Action) => {
            if (action.rate) go(action.rate)
            figure.form.update()
        }
        simulation.play(script, told, whole => {
            go(1)
            if (whole) this.run(false)
            ended(whole)
        })
        figure.changed()
        this.run(true)
    }
}
