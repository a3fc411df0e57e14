// The page of a figure: see app/exports/standalone/figure_page.py.

import type { FigureData } from "./data"
import { Figure } from "./figure"
import { Kernels } from "./kernels"
import { Simulation } from "./simulation"

async function begin(): Promise<void> {
    const data = JSON.parse(document.getElementById("data")!.textContent!) as FigureData
    const simulation = new Simulation(data, await Kernels.from(data.module))
    // For a page around it, and for tests: advance(ticks), simulation.hold(true) and so on.
    Object.assign(window, { onpath: new Figure(simulation, document.getElementById("figure")!) })
}

void begin()
