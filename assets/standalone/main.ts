// The page of a figure: see app/exports/standalone/figure_page.py.

import { refused } from "./controls"
import type { FigureData } from "./data"
import { Figure } from "./figure"
import { Kernels } from "./kernels"
import { Simulation } from "./simulation"

async function begin(): Promise<void> {
    const data = JSON.parse(document.getElementById("data")!.textContent!) as FigureData
    const place = document.getElementById("figure")!
    place.replaceChildren() // the text for browsers without scripts
    try {
        const simulation = new Simulation(data, await Kernels.from(data.module))
        // For an enclosing page, and for tests: advance(ticks), simulation.hold(true) and so on.
        Object.assign(window, { onpath: new Figure(simulation, place) })
    } catch (error) {
        place.replaceChildren(refused(data, error))
    }
}

void begin()
