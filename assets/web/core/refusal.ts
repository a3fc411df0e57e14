// Why a figure does not run.

import { made } from "./dom"
import type { FigureData } from "./figure_data"
import { phrase } from "./words"

/** Show why a figure does not run, in its place. */
export function refused(data: FigureData, error: unknown): HTMLElement {
    console.error(error)
    const line = made("p", "note", phrase(data, "standalone.refused", { reason: String(error) }))
    line.setAttribute("role", "alert")
    return line
}
