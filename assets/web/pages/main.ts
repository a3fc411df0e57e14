// One script for all pages: an exported figure (app/exports/standalone), a page of the course (app/exports/site), or
// the page of the lab, which has no data of its own.

import { made } from "../core/dom"
import type { FigureData } from "../core/figure_data"
import type { PageData } from "../core/lesson_data"
import { packed, unpacked } from "../core/packed"
import { refused } from "../core/refusal"
import { shapesOf } from "../core/symbols"
import { said } from "../core/words"
import { Kernels } from "../simulation/kernels"
import { Simulation } from "../simulation/simulation"
import { judge, wayOf } from "../lessons/checks"
import { gradeOf } from "../lessons/grade"
import { LocalProgress, type Tell } from "../lessons/progress"
import { ScormProgress } from "../lessons/scorm"
import { Figure } from "./figure"
import { showLab } from "./lab"
import { Player } from "./player"
import { StartPage } from "./start"

async function showFigure(data: FigureData, place: HTMLElement): Promise<void> {
    const still = [...place.querySelectorAll("img")]
    place.replaceChildren() // also the text for browsers without scripts
    try {
        const simulation = new Simulation(data, await Kernels.from(data.module))
        // For an enclosing page, and for tests: advance(ticks), simulation.hold(true) and so on.
        Object.assign(window, { onpath: new Figure(simulation, place) })
        if (parent !== window) tellHeight()
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

function showPage(page: PageData): void {
    const told = new Set<string>()
    const tell: Tell = (key, values) => {
        if (told.has(key)) return
        told.add(key)
        document.querySelector("#notice")!.append(made("p", "op-box", said(page, key, values)))
    }
    const local = new LocalProgress(tell)
    const progress = (page.scorm && ScormProgress.found(page.scorm, tell)) || local
    const site = page.lesson ? new Player(page, progress) : new StartPage(page, local)
    Object.assign(window, { site, judge, wayOf, gradeOf, packed, unpacked, shapesOf }) // for tests
}

const source = document.getElementById("data")
const data: unknown = source && JSON.parse(source.textContent)
const figure = document.getElementById("figure")
if (!source) showLab()
else if (figure) void showFigure(data as FigureData, figure)
else showPage(data as PageData)
