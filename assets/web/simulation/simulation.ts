// The simulated figure: sides on a path, time, and the reader's actions. It does not depend on a page.

import { logCurves, type Change, type LogCurves, type Sample } from "../core/engine"
import type { FigureData, Point, Setting } from "../core/figure_data"
import { phrase } from "../core/words"
import type { Kernels } from "./kernels"
import { Changes } from "./changes"
import { Path } from "./path"
import { channels, type Channel } from "./poles"
import { Side, MOST_TICKS, type Kept } from "./side"

const MINUTE = 60 // [s], kept in memory
const PERIOD = 1 / 60 // [s], between two moments, however seldom a picture is drawn

/** A sample, with what is needed to draw it, and to go on from it. */
export interface Moment extends Sample {
    ticks: number
    tips: Point[] // in the picture
    robots: Kept[]
}

export class Simulation {
    ticks = 0
    held = false
    path = 0
    /** Whether the brake catches the robots where the lab does, at the row of the last tick, and not as in `onpath.simulate`. */
    protected readonly likeLab: boolean = false
    /** The control point that keys move. */
    selected: number | null = null
    readonly paths = this.data.paths.map(path => new Path(path, this.data, this.kernels))
    readonly sides = this.data.sides.map(each => new Side(each, this.data, this.kernels, this.paths[0]!))
    readonly changes = new Changes(this.data.changes, this.data.loops)
    private readonly period = Math.min(Math.max(Math.round(PERIOD / this.data.dt), 1), MOST_TICKS) // in ticks
    /** Called at each change. */
    changed: (change: Change) => void = () => {}
    private logged: { path: number; edited: boolean; curves: LogCurves } | null = null
    /** The last minute of this run. */
    recent: Moment[] = [this.moment()]

    constructor(readonly data: FigureData, private readonly kernels: Kernels) {}

    /** Simulated time, [s]. */
    get time(): number { return this.ticks * this.data.dt }
    get followed(): Path { return this.paths[this.path]! }

    /** The name of a robot: its law, and its side if both have the same law. */
    title(side: number): string {
        const law = this.sides[side]!.does().title
        const alike = this.sides.filter(each => each.does().title === law).length > 1
        return alike ? phrase(this.data, "side.title", { law, side: this.sideName(side) }) : law
    }

    readonly sideName = (side: number): string => phrase(this.data, side ? "side.right" : "side.left")
    /** What a real arm has logged; where it is on a path whose points have been moved is not known. */
    get log(): LogCurves | null {
        const { data: { logged: log }, path } = this, { edited } = this.followed
        if (!log) return null
        const known = this.logged
        if (known?.path === path && known.edited === edited) return known.curves
        const curves = logCurves(log.name, log.times, [...log.fields, ...(edited ? [] : log.paths[path]!)])
        this.logged = { path, edited, curves }
        return curves
    }

    /** The poles, if a law has them. */
    get poles(): Channel[] {
        const side = this.data.controls.includes("poles") && this.sides.find(each => each.does().linear)
        return side ? channels(this.data, this.data.poles.gains.map(gain => side.setting(gain))) : []
    }

    /** The present moment. */
    moment(): Moment {
        const { time, ticks, sides } = this
        return {
            time,
            ticks,
            sides: sides.map(side => side.sample()),
            tips: sides.map(side => side.tip()),
            robots: sides.map(side => side.keep()),
        }
    }

    advance(ticks: number): void {
        const { period } = this
        if (this.followed.advance(ticks * this.data.dt)) this.changed("path")
        for (let left = ticks; left > 0; ) {
            const part = Math.min(left, period - (this.ticks % period))
            for (const side of this.sides) side.advance(part)
            this.ticks += part
            left -= part
            if (this.ticks % period === 0) this.remember()
        }
        this.changed("samples")
    }

    private remember(): void {
        this.recent.push(this.moment())
        while (this.recent[0]!.time < this.time - MINUTE) this.recent.shift()
    }

    /** Go on from a moment; what came after it is forgotten. */
    goOn(moment: Moment): void {
        this.ticks = moment.ticks
        this.held = false
        this.sides.forEach((side, i) => side.goOn(moment.robots[i]!))
        this.recent.splice(this.recent.indexOf(moment) + 1)
        this.changed("history")
    }

    /** Hold back one robot, or all. */
    hold(on: boolean, only?: number): void {
        if (only === undefined) {
            if (on === this.held) return
            this.held = on
        }
        for (const side of this.meant(only)) side.hold(on, this.likeLab)
        this.changed("state")
    }

    /** Pull the tip of one robot, or all tips, by a vector in the picture; null: let go. */
    pull(by: Point | null, only?: number): void {
        for (const side of this.meant(only)) side.pull(by)
        this.changed("state")
    }

    private readonly meant = (only?: number): Side[] => (only === undefined ? this.sides : [this.sides[only]!])

    /** Restart the run, with the parameters as they are. */
    reset(): void {
        this.ticks = 0
        this.held = false
        this.followed.settle()
        for (const side of this.sides) side.begin(this.followed)
        this.recent = [this.moment()]
        this.changed("path")
        this.changed("history")
    }

    /** Restart on another path. */
    choose(path: number): void {
        this.select(null)
        this.path = path
        this.reset()
    }

    /** Move a control point in the plane of the path, [m]. */
    bend(point: number, right: number, up: number): void {
        if (this.followed.shift(point, right, up)) this.edited()
    }

    /** Keep the result of a drag of a control point. */
    drop(): void {
        if (this.followed.finish()) this.edited()
    }

    /** The path is another one now. */
    protected edited(): void {}

    select(point: number | null): void {
        this.selected = point
        this.followed.fault = null
    }

    get values(): Record<string, Setting> { return this.changes.values }

    /** Give parameters other values. */
    set(values: Record<string, Setting>): void {
        Object.assign(this.values, values)
        this.configure()
    }

    /** Let the values of the parameters act in the loops. */
    protected configure(): void {
        const { variant } = this.changes, numbers = [...this.changes.numbers()]
        for (const side of this.sides) side.configure(variant, numbers)
    }
}
