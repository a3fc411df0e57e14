// The phase plane: how fast each robot moves away from its path, over how far it is off.

import { made } from "../core/dom"
import { shown, type Engine, type RowData } from "../core/engine"
import { disc, letters, Sheet, stroke, tones, type Pixel } from "../core/ink"
import { phrase, significant, type Texts } from "../core/words"
import { axisFor, type Range } from "./axis"

const SECONDS = 3 // [s] of each robot's past that are drawn
const EDGE = 16 // [px] around the plane
const FONT = "12px system-ui, sans-serif"
const BOLD = "600 13px system-ui, sans-serif"

export class PhasePlane {
    readonly sheet: Sheet
    readonly element: HTMLElement
    private readonly ranges: [Range, Range]

    constructor(private readonly texts: Texts, private readonly engine: Engine, private readonly rows: readonly [RowData, RowData], changed: () => void) {
        this.sheet = new Sheet(changed, true)
        const { canvas } = this.sheet
        Object.assign(canvas, { role: "img", ariaLabel: phrase(texts, "plot.phase_name") })
        this.element = made("div", "phase", canvas)
        this.ranges = rows.map(({ least: [bottom, top] }) => ({ bottom, top })) as [Range, Range]
    }

    draw(): void {
        const { sheet, rows, ranges, texts, engine } = this
        const ink = sheet.cleared()
        if (!ink) return
        const { time } = shown(engine)
        const samples = [...engine.since(time - SECONDS), engine.present].filter(sample => sample.time <= time && sample.time > 0) // at 0 nothing is measured yet
        const ways = engine.texts.map((_, i) => samples.flatMap((sample): Pixel[] => {
            const [x, y] = rows.map(({ lines, scale }) => (engine.field(sample, i, lines[0]!.field)?.[0] ?? NaN) * scale)
            return Number.isFinite(x! + y!) ? [[x!, y!]] : []
        }))
        ranges.forEach((range, k) => {
            const most = Math.max(0, ...ways.flat().map(point => Math.abs(point[k]!)))
            ranges[k] = axisFor(range, -most, most, rows[k]!.least)
        })
        const [right, up] = ranges.map(({ top }) => top) as [number, number]
        const [middle, half] = [[sheet.width / 2, sheet.height / 2], [sheet.width / 2 - EDGE, sheet.height / 2 - EDGE]] as const
        const place = ([x, y]: Pixel): Pixel => [middle[0] + (x / right) * half[0], middle[1] - (y / up) * half[1]]
        const { soft, ink: dark, paper } = tones()
        stroke(ink, [place([-right, 0]), place([right, 0])], soft, 1)
        stroke(ink, [place([0, -up]), place([0, up])], soft, 1)
        ways.forEach((way, i) => {
            if (!way.length) return
            const tone = tones()[`side${engine.texts[i]!.side}`]
            ink.setLineDash(engine.texts[i]!.side === 1 ? [7, 4] : [])
            stroke(ink, way.map(place), tone, 2)
            ink.setLineDash([])
            disc(ink, place(way[way.length - 1]!), 6, paper)
            disc(ink, place(way[way.length - 1]!), 4.5, tone)
        })
        ink.font = FONT
        ink.textBaseline = "middle"
        const named = (k: 0 | 1) => `${rows[k].lines[0]!.name || rows[k].label} [${rows[k].unit}]`
        const number = (value: number) => significant(texts, value, 3)
        const write = (text: string, x: number, y: number, align: CanvasTextAlign) => {
            ink.textAlign = align
            letters(ink, text, x, y, dark, paper)
        }
        write(`${named(0)} ${number(right)}`, sheet.width - 4, middle[1] - 9, "right")
        write(number(-right), 4, middle[1] - 9, "left")
        write(`${named(1)} ${number(up)}`, middle[0] + 6, 8, "left")
        write(number(-up), middle[0] + 6, sheet.height - 8, "left")
        ink.font = BOLD
        engine.texts.forEach(({ name, side }, i) => {
            ink.textAlign = "left"
            letters(ink, name, 4, sheet.height - 8 - 16 * (engine.texts.length - 1 - i), tones()[`side${side}`], paper)
        })
    }
}
