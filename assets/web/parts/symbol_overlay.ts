// What a symbol of a lesson's text means, drawn over the robots on the stage of the lab.

import { shown, type SideSample, type Vector } from "../core/engine"
import type { Point } from "../core/figure_data"
import { Sheet, tones } from "../core/ink"
import { projected } from "../core/placing"
import { drawShapes, shapesOf } from "../core/symbols"
import type { ServerEngine } from "../channel/channel"

export class SymbolOverlay {
    /** The symbol that is shown; may be empty. */
    lit = ""
    private drawn = ""
    private readonly sheet: Sheet

    constructor(private readonly engine: ServerEngine) {
        this.sheet = new Sheet(() => {})
        this.sheet.canvas.className = "lit-up"
        this.sheet.canvas.setAttribute("aria-hidden", "true")
    }

    get element(): HTMLCanvasElement { return this.sheet.canvas }

    draw(): void {
        const { engine, sheet, lit } = this
        if (!lit && !this.drawn) return
        this.drawn = lit
        const ink = sheet.cleared()
        if (!ink || !lit) return
        shown(engine).sides.forEach((sample, i) => this.light(ink, sample, i))
    }

    /** In the plane of the path; of a robot in space, in that of the picture. */
    private light(ink: CanvasRenderingContext2D, sample: SideSample, side: number): void {
        const { engine: { path, lab, cameras }, sheet: { width, height } } = this
        const camera = cameras[side]!
        const project = (point: Vector): Point => {
            const [x, y] = projected(camera, point)
            return [width / 2 + x * height, height / 2 + y * height]
        }
        const metre = height / lab!.height // [px]
        const isFlat = sample.tip.length < 3
        const flat = (point: Vector): Point => {
            if (isFlat) return [dot(point, path.right), dot(point, path.up)]
            const [x, y] = project(point)
            return [x / metre, -y / metre]
        }
        const pixel = ([x, y]: Point): Point =>
            isFlat ? project(path.right.map((each, k) => x * each + y * path.up[k]!)) : [x * metre, -y * metre]
        const seen = {
            tip: flat(sample.tip), closest: flat(sample.closest), reference: sample.reference && flat(sample.reference),
            pushed: flat(sample.tip.map((each, k) => each + lab!.arrow * sample.force[k]!)),
            outline: (path.lines[0] ?? []).map(flat), closed: path.closed,
            joints: { [this.lit]: this.engine.lit(this.lit, side).map(flat) },
        }
        drawShapes(ink, shapesOf(this.lit, seen), pixel, tones().selected)
    }
}

const dot = (a: Vector, b: Vector): number => a.reduce((sum, each, k) => sum + each * b[k]!, 0)
