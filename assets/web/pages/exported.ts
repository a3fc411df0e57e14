// The script of an exported figure (app/exports/standalone), which is alone in its page.

import type { FigureData } from "../core/figure_data"
import { refused } from "../core/refusal"
import { Kernels } from "../simulation/kernels"
import { Simulation } from "../simulation/simulation"
import { keepInAddress } from "./address"
import { Figure } from "./figure"

async function showFigure(data: FigureData, place: HTMLElement): Promise<void> {
    const still = [...place.querySelectorAll("img")]
    place.replaceChildren() // also the text for browsers without scripts
    try {
        const simulation = new Simulation(data, await Kernels.from(data.module))
        // For an enclosing page, and for tests: advance(ticks), simulation.hold(true) and so on.
        const figure = new Figure(simulation, place)
        place.append(...still) // for paper
        Object.assign(window, { onpath: figure })
        if (parent === window) keepInAddress(figure)
        else tellHeight()
    } catch (error) {
        place.replaceChildren(refused(data, error), ...still)
    }
}

/** Tell the page around this one, whenever it changes, how high a frame must be. */
function tellHeight(): void {
    const observer = new ResizeObserver(entries => {
        const height = Math.ceil(entries[entries.length - 1]!.borderBoxSize[0]!.blockSize)
        parent.postMessage({ onpath: "height", height }, "*")
        if (frameElement?.hasAttribute("srcdoc")) (frameElement as HTMLElement).style.height = `${height}px` // a notebook's
    })
    observer.observe(document.documentElement)
}

void showFigure(JSON.parse(document.getElementById("data")!.textContent) as FigureData, document.getElementById("figure")!)
