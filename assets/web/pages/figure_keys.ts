// The keys of a figure: those of the lab, unless the focused control uses them.

import { isTyped, keyOf } from "../core/dom"
import type { Point } from "../core/figure_data"
import type { Transport } from "../parts/transport"
import type { LocalEngine } from "../simulation/local"
import type { Simulation } from "../simulation/simulation"

const PULL = 0.03 // [m], length of a pull by keys
const FURTHER = 0.005 // [m] by which a key pulls further in a lesson, as in the lab
const PULLS: Record<string, Point> = { a: [-1, 0], d: [1, 0], w: [0, 1], s: [0, -1] }
const DIRECTIONS: Record<string, Point> = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }

/** What keys act on. */
interface Page {
    readonly simulation: Simulation
    readonly engine: LocalEngine
    readonly transport: Transport
    /** Have it drawn again. */
    changed(): void
}

/** Hear the keys of a figure's page until `signal` ends it. */
export function hearKeys(figure: Page, inLesson: boolean, signal: AbortSignal): void {
    document.addEventListener("keydown", event => act(figure, event), { signal })
    if (figure.simulation.data.controls.includes("pull")) pulls(figure, inLesson, signal)
}

function act(page: Page, event: KeyboardEvent): void {
    const target = event.target as HTMLElement
    if (isTyped(event) || target.closest("input, [role=slider], summary")) return
    if (event.key === " " && target.closest("button")) return
    const { simulation, transport } = page
    const { selected, followed, data: { edit: { nudge } } } = simulation
    const acts: Record<string, [string, () => void]> = {
        h: ["hold", () => transport.toggleHold()],
        " ": ["run", () => transport.toggleRun()],
        ArrowRight: ["step", () => page.engine.act({ do: "step" })],
        r: ["reset", () => page.engine.act({ do: "reset" })],
        g: ["run", () => page.engine.act({ do: "goOn" })],
        n: ["drag", () => simulation.select(((selected ?? -1) + 1) % followed.data.points.length)],
    }
    const direction = DIRECTIONS[event.key]
    if (selected !== null && direction) acts[event.key] = ["drag", () => simulation.bend(selected, nudge * direction[0], nudge * direction[1])]
    if (selected !== null) acts["Escape"] = ["drag", () => simulation.select(null)]
    const [name, does] = acts[event.key] ?? acts[keyOf(event)] ?? []
    if (!name || !does || !simulation.data.controls.includes(name) || (event.repeat && !direction)) return
    event.preventDefault()
    does()
    page.changed()
}

/** Keys pull: while one is pressed, or in a lesson a little further each time, until X lets go. */
function pulls({ simulation }: Page, inLesson: boolean, signal: AbortSignal): void {
    let pulling = "" // the key that pulls
    addEventListener("keydown", event => {
        const key = keyOf(event), direction = PULLS[key]
        if (isTyped(event) || (event.repeat && !inLesson)) return
        if (inLesson && key === "x") simulation.pull(null)
        if (!direction) return
        pulling = key
        const [x, y] = (inLesson && simulation.sides.find(side => side.pulledBy)?.pulledBy) || [0, 0]
        const step = inLesson ? FURTHER : PULL
        simulation.pull([x + step * direction[0], y + step * direction[1]])
    }, { capture: true, signal }) // also while a slider has the focus
    addEventListener("keyup", event => !inLesson && keyOf(event) === pulling && simulation.pull(null), { capture: true, signal })
    addEventListener("blur", () => simulation.pull(null), { signal })
}
