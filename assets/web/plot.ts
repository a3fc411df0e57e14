// The distance of all robots to the path over time.

import { written, type Point } from "./figure_data"
import type { Moment, Simulation } from "./simulation"
import { inkOf, stroke } from "./view"

const SECONDS = 8
const MARGIN = { left: 44, right: 10, top: 10, bottom: 24 }
const DASHES = [[], [7, 4]] // colour is not the only sign
const STEPS = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000] // [mm]

type Scale = (value: number) => number

export class Plot {
    readonly canvas = document.createElement("canvas")

    constructor(private readonly simulation: Simulation) {}

    draw(moments: Moment[]): void {
        const { canvas, simulation } = this
        const { clientWidth: width, clientHeight: height } = canvas
        const ink = inkOf(canvas)
        if (!ink) return
        moments = moments.filter(moment => moment.time >= simulation.time - SECONDS)
        const top = 1.1 * Math.max(4, ...moments.flatMap(moment => moment.sides.map(side => 1e3 * side.distance)))
        const begin = Math.max(0, simulation.time - SECONDS)
        const x = (time: number) => MARGIN.left + ((time - begin) / SECONDS) * (width - MARGIN.left - MARGIN.right)
        const y = (value: number) => height - MARGIN.bottom - (value / top) * (height - MARGIN.top - MARGIN.bottom)
        ink.fillStyle = simulation.data.colours.held
        moments.forEach(({ time, sides }, i) => {
            const next = x(moments[i + 1]?.time ?? time)
            if (sides.some(side => side.held)) ink.fillRect(x(time), y(top), next - x(time) + 0.5, y(0) - y(top))
        })
        this.axes(ink, x, y, top, begin)
        simulation.sides.forEach((side, i) => {
            ink.setLineDash(DASHES[i % DASHES.length]!)
            const way = moments.map(({ time, sides }): Point => [x(time), y(1e3 * sides[i]!.distance)])
            stroke(ink, way, side.data.colour, 2)
        })
        ink.setLineDash([])
    }

    private axes(ink: CanvasRenderingContext2D, x: Scale, y: Scale, top: number, begin: number): void {
        const { data } = this.simulation
        const step = STEPS.find(each => top / each <= 4.4) ?? STEPS[STEPS.length - 1]!
        ink.fillStyle = data.colours.ink
        ink.font = "12px system-ui, sans-serif"
        ink.textAlign = "right"
        ink.textBaseline = "middle"
        for (let value = 0; value <= top; value += step) {
            stroke(ink, [[x(begin), y(value)], [x(begin + SECONDS), y(value)]], data.colours.grid, 1)
            ink.fillText(written(data, value, 0), MARGIN.left - 6, y(value))
        }
        ink.textAlign = "center"
        for (let time = Math.ceil(begin); time <= begin + SECONDS; time++)
            ink.fillText(written(data, time, 0), x(time), y(0) + 13)
    }
}
