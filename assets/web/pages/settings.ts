// The settings of a page without a server: what its form shows is the simulation's.

import type { FormField } from "../core/form_data"
import type { FigureData } from "../core/figure_data"
import { phrase, written } from "../core/words"
import type { FormHost, Value } from "../parts/fields"
import type { Side } from "../simulation/side"
import type { Simulation } from "../simulation/simulation"

const SIDES = ["left", "right"]

export class LocalSettings implements FormHost {
    readonly texts: FigureData = this.simulation.data

    /** `changed` is called after each change. */
    constructor(private readonly simulation: Simulation, private readonly changed: () => void) {}

    value(name: string): Value | undefined {
        const { simulation } = this, side = this.side(name)
        if (side) return side.law
        if (name === "path") return simulation.path
        if (name === "poles") return simulation.poles.map(({ line }) => line).join("\n")
        if (name === "pole_plane") return simulation.poles.flatMap(({ points }) => points).join("\n")
        if (name === "pace") return this.pace
        const critical = simulation.data.critical[simulation.path]
        if (critical && name === "critical_alpha") return critical.limit
        if (critical && name === "alpha_note") return critical.notes[Number(simulation.values["alpha"]) > critical.limit ? 1 : 0]
        return simulation.values[name]
    }

    /** How fast a drawing is drawn. */
    private get pace(): string {
        const { simulation: { followed, sides }, texts } = this
        return followed.data.pieces ? phrase(texts, "design.pace", { speed: written(texts, 1e3 * sides[0]!.pace, 0) }) : ""
    }

    set(name: string, value: Value): void {
        const { simulation } = this, side = this.side(name)
        if (side) side.change(Number(value))
        else if (name === "path") simulation.choose(Number(value))
        else simulation.set({ [name]: value })
        this.changed()
    }

    act(_: FormField): void {}

    refused(): string { return "" }

    private side(name: string): Side | undefined {
        return this.simulation.sides.find(each => SIDES[each.data.side] === name)
    }
}
