// The distance of all robots to the path over time.

import { said, written, type FigureData } from "./data"
import type { Simulation } from "./simulation"

const SECONDS = 8
const MARGIN = { left: 44, right: 10, top: 10, bottom: 24 }
const DASHES = [[], [7, 4]] // colour is not the only sign
const GRID = "#dee2e8"
const STEPS = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000] // [mm]

interface Sample {
    time: number
    held: boolean
    millimetres: number[]
}

export class Plot {
    readonly canvas = document.createElement("canvas")
    private samples: Sample[] = []

    constructor(
        private readonly simulation: Simulation,
        private readonly data: FigureData,
    ) {}

    clear(): void {
        this.samples = []
    }

    follow(): void {
        const { time, held, benches } = this.simulation
        const millimetres = benches.map(bench => 1e3 * bench.distance)
        this.samples.push({ time, held, millimetres })
        while (this.samples[0]!.time < time - SECONDS) this.samples.shift()
    }

    draw(): void {
        const { canvas } = this
        const { clientWidth: width, clientHeight: height } = canvas
        const ratio = window.devicePixelRatio || 1
        canvas.width = Math.round(width * ratio)
        canvas.height = Math.round(height * ratio)
        const ink = canvas.getContext("2d")
        if (!ink) return
        ink.scale(ratio, ratio)
        const highest = Math.max(4, ...this.samples.flatMap(sample => sample.millimetres))
        const begin = Math.max(0, this.simulation.time - SECONDS)
        const x = (time: number) =>
            MARGIN.left + ((time - begin) / SECONDS) * (width - MARGIN.left - MARGIN.right)
        const y = (value: number) =>
            height - MARGIN.bottom - (value / (1.1 * highest)) * (height - MARGIN.top - MARGIN.bottom)
        this.held(ink, x, y(0), y(1.1 * highest))
        this.axes(ink, x, y, highest, begin)
        this.lines(ink, x, y)
    }

    private held(ink: CanvasRenderingContext2D, x: (time: number) => number, low: number, high: number): void {
        ink.fillStyle = "#eef1f5"
        let begin: number | null = null
        for (const { time, held } of this.samples) {
            if (held && begin === null) begin = time
            if (begin !== null && (!held || time === this.simulation.time)) {
                ink.fillRect(x(begin), high, x(time) - x(begin), low - high)
                begin = null
            }
        }
    }

    private axes(
        ink: CanvasRenderingContext2D,
        x: (time: number) => number,
        y: (value: number) => number,
        highest: number,
        begin: number,
    ): void {
        const { data } = this
        const step = STEPS.find(each => highest / each <= 4) ?? STEPS[STEPS.length - 1]!
        ink.fillStyle = data.colours.ink
        ink.strokeStyle = GRID
        ink.lineWidth = 1
        ink.font = "12px system-ui, sans-serif"
        ink.textAlign = "right"
        ink.textBaseline = "middle"
        for (let value = 0; value <= 1.1 * highest; value += step) {
            ink.beginPath()
            ink.moveTo(x(begin), y(value))
            ink.lineTo(x(begin + SECONDS), y(value))
            ink.stroke()
            ink.fillText(written(data, value, 0), MARGIN.left - 6, y(value))
        }
        ink.textAlign = "center"
        for (let time = Math.ceil(begin); time <= begin + SECONDS; time++)
            ink.fillText(written(data, time, 0), x(time), y(0) + 13)
    }

    private lines(
        ink: CanvasRenderingContext2D,
        x: (time: number) => number,
        y: (value: number) => number,
    ): void {
        this.simulation.benches.forEach((bench, i) => {
            ink.strokeStyle = bench.data.colour
            ink.lineWidth = 2
            ink.setLineDash(DASHES[i % DASHES.length]!)
            ink.beginPath()
            for (const sample of this.samples) ink.lineTo(x(sample.time), y(sample.millimetres[i]!))
            ink.stroke()
        })
        ink.setLineDash([])
    }

    /** What somebody hears who does not see it. */
    label(): string {
        return said(this.data, "standalone.plot")
    }
}
