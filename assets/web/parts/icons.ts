// Small pictures on buttons, drawn with lines on a square of 24.

import { svg } from "../core/dom"

const LINES = {
    more: "M4 6.5h16M4 12h16M4 17.5h16",
    search: "M10.5 4a6.5 6.5 0 1 0 0 13 6.5 6.5 0 0 0 0-13M15.4 15.4 20.5 20.5",
    lessons: "M3 5.5c3-1.3 6-1.3 9 .7 3-2 6-2 9-.7v13c-3-1.3-6-1.3-9 .7-3-2-6-2-9-.7zM12 6.2v13",
    controls: "M4 7h9M17 7h3M4 17h3M11 17h9M15 4.5a2.5 2.5 0 1 0 0 5 2.5 2.5 0 0 0 0-5M9 14.5a2.5 2.5 0 1 0 0 5 2.5 2.5 0 0 0 0-5",
    close: "M6 6l12 12M18 6 6 18",
    right: "M9 5l7 7-7 7",
    done: "M4.5 12.5l5 5L19.5 7",
    draw: "M4 20l1-4L16.5 4.5l3 3L8 19zM14 7l3 3",
    undo: "M9 14 4 9l5-5M4 9h10a6 6 0 0 1 0 12h-3",
    redo: "M15 14l5-5-5-5M20 9H10a6 6 0 0 0 0 12h3",
} as const

export type Icon = keyof typeof LINES

/** What the laws aim at, as on the stage: discs from the largest to the smallest, each with its radius and what it is of. */
const SIGNS: Record<string, readonly (readonly [number, string])[]> = {
    "◯": [[12, "left"], [9, "dark-left"], [6.5, "white"]],
    "●": [[12, "right"], [6, "white"], [4.4, "dark-right"]],
}

/** A text with its signs drawn. */
export function withSigns(text: string): (Node | string)[] {
    return text.split(/([◯●])/).map(part => {
        const discs = SIGNS[part]?.map(([r, name]) => svg("circle", { cx: 12, cy: 12, r, class: name }))
        return discs ? svg("svg", { viewBox: "0 0 24 24", class: "op-sign", "aria-hidden": "true" }, ...discs) : part
    })
}

export function icon(name: Icon): SVGSVGElement {
    return svg("svg", { viewBox: "0 0 24 24", class: "op-icon", "aria-hidden": "true" }, svg("path", { d: LINES[name] }))
}
