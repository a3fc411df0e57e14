// Shows on the page what is what: a line from each name to its thing, until one presses anywhere.

import type { ServerEngine } from "../channel/channel"
import { made, svg } from "../core/dom"
import { shown, type Vector } from "../core/engine"
import type { Pixel } from "../core/ink"
import { projected } from "../core/placing"
import { phrase, type Texts } from "../core/words"
import { pressed } from "./sheet"

const GAP = 10, AWAY = 56 // [px] between labels, and from a label to its thing

/** Open the names over the page. */
export function pointAtStage(texts: Texts, engine: ServerEngine): void {
    const dialog = made("dialog", "op-pointing"), lines = svg("svg", { "aria-hidden": "true" })
    dialog.ariaLabel = phrase(texts, "help.point")
    const labels = Object.entries(places(engine)).flatMap(([name, place]) => {
        if (!place || !isInside(place)) return []
        const label = made("p", "", made("b", "", phrase(texts, `aid.${name}`)), " ", phrase(texts, `aid.${name}_means`))
        return [{ label, place }]
    })
    dialog.append(lines, ...labels.map(({ label }) => label), pressed("", phrase(texts, "help.close"), () => dialog.close()))
    dialog.addEventListener("click", () => dialog.close())
    dialog.addEventListener("close", () => dialog.remove())
    document.body.append(dialog)
    dialog.showModal()
    const taken: DOMRect[] = [dialog.querySelector("button")!.getBoundingClientRect()]
    for (const { label, place } of labels) {
        const at = free(place, label.getBoundingClientRect(), taken)
        label.style.left = `${at.x}px`
        label.style.top = `${at.y}px`
        taken.push(at)
        const from: Pixel = [clamp(place[0], at.left, at.right), clamp(place[1], at.top, at.bottom)]
        lines.append(svg("path", { d: `M${from.join(" ")} L${place.join(" ")} m-5 0 a5 5 0 1 0 10 0 a5 5 0 1 0 -10 0` }))
    }
}

/** Where the things are on the page; null if they are not there. */
function places(engine: ServerEngine): Record<string, Pixel | null> {
    const points = engine.path.lines[0] ?? [], sample = shown(engine), [left, right] = [sample.sides[0], sample.sides[1] ?? sample.sides[0]]
    return {
        pull: right ? onStage(engine, right.tip, 1) : null,
        aim: left ? onStage(engine, left.reference ?? left.closest, 0) : null,
        bend: left ? onStage(engine, points[Math.floor(points.length / 8)] ?? left.closest, 0) : null,
        lens: middleOf(".lens canvas"),
        hold: middleOf(".transport button.main"),
        chart: middleOf("#op-strip .plot"),
        search: middleOf("#op-head .search"),
    }
}

function middleOf(selector: string): Pixel | null {
    const element = [...document.querySelectorAll(selector)].find(each => each.checkVisibility())
    if (!element) return null
    const { left, top, width, height } = element.getBoundingClientRect()
    return [left + width / 2, top + height / 2]
}

/** A point of a robot's output space in the picture. */
function onStage({ cameras }: ServerEngine, point: Vector, side: number): Pixel | null {
    const stage = document.querySelector("#op-stage")?.getBoundingClientRect(), camera = cameras[side]
    if (!stage || !camera) return null
    const [x, y] = projected(camera, point)
    return [stage.left + stage.width / 2 + x * stage.height, stage.top + stage.height / 2 + y * stage.height]
}

/** A place for a label beside its thing where it lies over no other. */
function free([x, y]: Pixel, { width, height }: DOMRect, taken: readonly DOMRect[]): DOMRect {
    const candidates: DOMRect[] = []
    for (const away of [AWAY, 2 * AWAY, 3 * AWAY, 4.5 * AWAY])
        for (let turn = 0; turn < 12; turn++) {
            const angle = (turn * Math.PI) / 6
            const [cx, cy] = [x + Math.cos(angle) * (away + width / 2), y + Math.sin(angle) * (away + height / 2)]
            candidates.push(new DOMRect(clamp(cx - width / 2, GAP, innerWidth - width - GAP), clamp(cy - height / 2, GAP, innerHeight - height - GAP), width, height))
        }
    const own = new DOMRect(x - AWAY / 2, y - AWAY / 4, AWAY, AWAY / 2)
    const covers = (at: DOMRect) => [own, ...taken].some(other => at.left < other.right + GAP && other.left < at.right + GAP && at.top < other.bottom + GAP && other.top < at.bottom + GAP)
    return candidates.find(at => !covers(at)) ?? candidates[0]!
}

const clamp = (value: number, low: number, high: number): number => Math.min(Math.max(value, low), Math.max(high, low))
const isInside = ([x, y]: Pixel): boolean => x > 0 && y > 0 && x < innerWidth && y < innerHeight
