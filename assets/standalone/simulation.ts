// The simulated figure: benches on a path, time, and what its reader does. It knows no page.

import { Bench, MOST_TICKS, type PathPlaces } from "./bench"
import type { FigureData } from "./data"
import type { Kernels } from "./kernels"

export class Simulation {
    ticks = 0
    held = false
    path = 0
    readonly benches: Bench[]
    readonly values: number[]
    private readonly paths: PathPlaces[]

    constructor(readonly data: FigureData, kernels: Kernels) {
        this.paths = data.paths.map(path => ({
            data: path,
            table: kernels.put(path.table),
            grid: kernels.put(path.grid),
        }))
        this.values = data.sliders.map(slider => slider.value)
        this.benches = data.benches.map(
            (bench, i) => new Bench(bench, i, data, kernels, this.paths[0]!),
        )
    }

    /** Simulated time, [s]. */
    get time(): number {
        return this.ticks * this.data.dt
    }

    advance(ticks: number): void {
        for (let left = ticks; left > 0; left -= MOST_TICKS)
            for (const bench of this.benches) bench.advance(Math.min(left, MOST_TICKS))
        this.ticks += ticks
    }

    hold(on: boolean): void {
        if (on === this.held) return
        this.held = on
        for (const bench of this.benches) bench.hold(on)
    }

    /** Pull all tips by so much in the picture; null: let go. */
    pull(by: [number, number] | null): void {
        for (const bench of this.benches) bench.pull(by)
    }

    /** Begin anew, with the values of the sliders. */
    reset(): void {
        this.ticks = 0
        this.held = false
        for (const bench of this.benches) bench.begin(this.paths[this.path]!)
        this.values.forEach((value, i) => this.set(i, value))
    }

    /** Begin anew on another path. */
    choose(path: number): void {
        this.path = path
        this.reset()
    }

    /** Give a slider's value to the loops. */
    set(slider: number, value: number): void {
        this.values[slider] = value
        const { place } = this.data.sliders[slider]!
        if (place >= 0) for (const bench of this.benches) bench.set(place, value)
    }
}
