// The simulated figure: sides on a path, time, and the reader's actions. It does not depend on a page.

import { Side, MOST_TICKS } from "./side"
import { said, type FigureData, type Point } from "./data"
import type { Kernels } from "./kernels"
import { Path } from "./path"
import { Poles } from "./poles"

export const SECONDS = 8 // kept in memory
const PERIOD = 1 / 60 // [s], between two moments, however seldom a picture is drawn

/** A moment: the tips in the picture, and their distances to the path. */
export interface Moment {
    time: number
    held: boolean
    tips: Point[]
    millimetres: number[]
}

export class Simulation {
    ticks = 0
    held = false
    path = 0
    /** The control point that keys move. */
    selected: number | null = null
    readonly paths = this.data.paths.map(path => new Path(path, this.data, this.kernels))
    readonly sides = this.data.sides.map(each => new Side(each, this.data, this.kernels, this.paths[0]!))
    readonly values = this.data.sliders.map(slider => slider.value)
    private readonly poles = new Poles(this.data, this.kernels)
    private readonly period = Math.min(Math.max(Math.round(PERIOD / this.data.dt), 1), MOST_TICKS) // in ticks
    /** The last seconds of this run. */
    recent: Moment[] = [this.moment()]

    constructor(readonly data: FigureData, private readonly kernels: Kernels) {}

    /** Simulated time, [s]. */
    get time(): number { return this.ticks * this.data.dt }
    get followed(): Path { return this.paths[this.path]! }

    /** The name of a robot: its law, and its side if both have the same law. */
    title(side: number): string {
        const law = this.sides[side]!.does().title
        const alike = this.sides.filter(each => each.does().title === law).length > 1
        return alike ? said(this.data, "side.title", { law, side: this.sideName(side) }) : law
    }

    readonly sideName = (side: number): string => said(this.data, side ? "side.right" : "side.left")
    /** The lines about the poles, if a law has them. */
    lines(): string[] {
        const side = this.data.controls.includes("poles") && this.sides.find(each => each.does().linear)
        return side ? this.poles.lines(side.settings) : []
    }

    /** The present moment. */
    moment(): Moment {
        const { time, held, sides } = this
        return { time, held, tips: sides.map(side => side.tip()), millimetres: sides.map(side => 1e3 * side.distance) }
    }

    advance(ticks: number): void {
        const { period } = this
        this.followed.advance(ticks * this.data.dt)
        for (let left = ticks; left > 0; ) {
            const part = Math.min(left, period - (this.ticks % period))
            for (const side of this.sides) side.advance(part)
            this.ticks += part
            left -= part
            if (this.ticks % period === 0) this.remember()
        }
    }

    private remember(): void {
        this.recent.push(this.moment())
        while (this.recent[0]!.time < this.time - SECONDS) this.recent.shift()
    }

    hold(on: boolean): void {
        if (on === this.held) return
        this.held = on
        for (const side of this.sides) side.hold(on)
    }

    /** Pull all tips by a vector in the picture; null: let go. */
    pull(by: Point | null): void {
        for (const side of this.sides) side.pull(by)
    }

    /** Begin anew, with the values of the sliders. */
    reset(): void {
        this.ticks = 0
        this.held = false
        this.followed.settle()
        for (const side of this.sides) side.begin(this.followed)
        this.values.forEach((value, i) => this.set(i, value))
        this.recent = [this.moment()]
    }

    /** Begin anew on another path. */
    choose(path: number): void {
        this.select(null)
        this.path = path
        this.reset()
    }

    select(point: number | null): void {
        this.selected = point
        this.followed.fault = null
    }

    /** Set a slider's value in the loops. */
    set(slider: number, value: number): void {
        this.values[slider] = value
        const { place } = this.data.sliders[slider]!
        if (place >= 0) for (const side of this.sides) side.set(place, value)
    }
}
