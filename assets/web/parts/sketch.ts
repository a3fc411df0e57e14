// The robots as lines, while there is no picture of them.

import { shown, type Vector } from "../core/engine"
import { dashed, disc, Sheet, stroke, tones, type Pixel } from "../core/ink"
import { projected } from "../core/placing"
import type { ServerEngine } from "../channel/channel"

export class Sketch {
    private stale = true
    private readonly sheet = new Sheet(() => (this.stale = true))

    constructor(private readonly engine: ServerEngine, ended: AbortSignal) {
        this.sheet.canvas.className = "sketch"
        this.sheet.canvas.setAttribute("aria-hidden", "true")
        engine.on(() => (this.stale = true), ended)
    }

    get element(): HTMLCanvasElement { return this.sheet.canvas }

    draw(): void {
        const { engine, sheet, element } = this, { drawn } = engine.lab!
        if (element.hidden !== drawn) element.hidden = drawn
        if (drawn || !this.stale) return
        this.stale = false
        const ink = sheet.cleared()
        if (!ink) return
        shown(engine).sides.forEach((sample, i) => {
            const colours = tones(), camera = engine.cameras[i]!
            const pixel = (point: Vector): Pixel => {
                const [x, y] = projected(camera, point)
                return [sheet.width / 2 + x * sheet.height, sheet.height / 2 + y * sheet.height]
            }
            const { path } = engine
            for (const line of path.strokes ?? path.lines) stroke(ink, line.map(pixel), colours.path, 2.5)
            for (const link of path.links ?? []) dashed(ink, link.map(pixel), colours.path, 2.5)
            const ends = engine.lit("bars", i).map(pixel)
            for (let k = 0; k + 1 < ends.length; k += 2) stroke(ink, [ends[k]!, ends[k + 1]!], colours[`side${i as 0 | 1}`], 8)
            for (const end of ends) disc(ink, end, 5, colours.steel)
            disc(ink, pixel(sample.reference ?? sample.closest), 6, colours[`dark${i as 0 | 1}`])
            disc(ink, pixel(sample.tip), 5, colours.ink)
        })
    }
}
