// One robot under a law: its state, what acts on it, and what is seen of it.

import type { BenchData, FigureData, PathData, Place } from "./data"
import type { Kernels } from "./kernels"

export const MOST_TICKS = 128 // in one call of a loop

export interface PathPlaces {
    data: PathData
    table: number
    grid: number
}

export class Bench {
    held = false
    pulled = false
    stopped = false
    distance = 0
    /** Largest distance since it has been held back. */
    most = 0
    private readonly state: number
    private readonly settings: number
    private readonly log: number
    private readonly result: number
    private readonly points: number
    private readonly y: number
    /** Where the tip was when a pull began. */
    private readonly grabbed: number
    /** The last row of the log. */
    private row: number

    constructor(
        readonly data: BenchData,
        private readonly number: number,
        private readonly figure: FigureData,
        private readonly kernels: Kernels,
        private path: PathPlaces,
    ) {
        const { log, p, bars, joints } = figure.sizes
        const longest = Math.max(...figure.paths.map(each => each.states[number]!.length))
        this.state = kernels.room(longest)
        this.settings = kernels.room(path.data.settings[number]!.length)
        this.log = kernels.room(MOST_TICKS * log)
        this.result = kernels.room(2 * p + 4)
        this.points = kernels.room(4 * bars + 2 * joints)
        this.y = kernels.room(p)
        this.grabbed = kernels.room(p)
        this.row = this.log
        this.begin(path)
    }

    /** Begin anew on a path, at rest, with the settings that it comes with. */
    begin(path: PathPlaces): void {
        this.path = path
        this.kernels.numbers.set(path.data.states[this.number]!, this.state)
        this.kernels.numbers.set(path.data.settings[this.number]!, this.settings)
        this.held = this.pulled = this.stopped = false
        this.most = 0
        this.seeStart()
    }

    set(place: number, value: number): void {
        this.kernels.numbers[this.settings + place] = value
    }

    /** Advance by some ticks; a robot that has stopped stays where it is. */
    advance(ticks: number): void {
        if (this.stopped) return
        const { kernels, state, settings, log, figure } = this
        kernels.loop(this.name(`loop${this.number}`), [state, settings, this.path.table, log], ticks)
        for (let i = 0; i < ticks && !this.stopped; i++) {
            this.row = log + i * figure.sizes.log
            this.call("fault", this.field("q"), this.field("v"), this.result)
            this.stopped = kernels.numbers[this.result] !== 0
            if (i % 4 === 3 || i === ticks - 1) this.measure()
        }
    }

    /** Hold it back along the path where it is, or let it go. */
    hold(on: boolean): void {
        const { settings: places, state } = this.figure
        if (on) {
            const tangent = this.settings + places.hold_tangent[0]
            this.call("tip", this.state + state.q[0], this.y)
            this.copy(this.y, this.settings + places.hold_anchor[0], this.figure.sizes.p)
            this.call("brake", this.path.table, this.y, this.state + state.theta[0], tangent)
            this.most = this.distance
        }
        this.held = on
        this.set(places.hold_active[0], on ? 1 : 0)
    }

    /** Pull the tip by so much in the picture, from where it was when the pull began; null: let go. */
    pull(by: [number, number] | null): void {
        const { settings: places, sizes } = this.figure
        if (by && !this.pulled) this.copy(this.field("y"), this.grabbed, sizes.p)
        this.pulled = by !== null
        this.set(places.hand_active[0], by ? 1 : 0)
        if (!by) return
        const { kernels, result } = this
        kernels.numbers.set([0, 0, ...by], result)
        this.call("hand", this.grabbed, result, result + 2, this.settings + places.hand_target[0])
    }

    /** Ends of bars, begin and end of each, then joints, as x and y in the picture. */
    picture(): Float64Array {
        const { bars, joints } = this.figure.sizes
        this.call("picture", this.field("q"), this.points, this.points + 4 * bars)
        return this.kernels.numbers.subarray(this.points, this.points + 4 * bars + 2 * joints)
    }

    tip(): [number, number] {
        return this.point("place", this.field("y"))
    }

    /** The point that the law aims at. */
    aim(): [number, number] {
        return this.point("aim", this.path.table, this.field(this.data.aim))
    }

    /** The reference point, whatever the law aims at. */
    reference(): [number, number] {
        return this.point("aim", this.path.table, this.field("theta_ref"))
    }

    /** Of a flexible link: the deflection of its tip, [m], and the energy in it, [J]. */
    measured(): [number, number] {
        return this.point("measured", this.field("q"), this.field("v"))
    }

    /** The end of the arrow of the force. */
    arrow(): [number, number] {
        return this.point("arrow", this.field("y"), this.field("force"))
    }

    /** The last row of the log. */
    logged(): Float64Array {
        return this.kernels.numbers.slice(this.row, this.row + this.figure.sizes.log)
    }

    /** Before the first tick there is no log: what is seen of it is made from the state. */
    private seeStart(): void {
        const { log, state, sizes } = this.figure
        this.row = this.log
        this.kernels.numbers.fill(0, this.log, this.log + sizes.log)
        this.copy(this.state + state.q[0], this.field("q"), sizes.n)
        this.call("tip", this.state + state.q[0], this.field("y"))
        for (const place of [log.theta, log.theta_ref])
            this.copy(this.state + state.theta[0], this.row + place[0], 1)
        this.measure()
    }

    private measure(): void {
        const { table, grid } = this.path
        this.call("distance", table, grid, this.field("y"), this.field("theta"), this.result)
        this.distance = this.kernels.numbers[this.result]!
        if (this.held) this.most = Math.max(this.most, this.distance)
    }

    private point(name: string, ...places: number[]): [number, number] {
        this.call(name, ...places, this.result)
        return [this.kernels.numbers[this.result]!, this.kernels.numbers[this.result + 1]!]
    }

    private field(name: keyof FigureData["log"]): number {
        const place: Place = this.figure.log[name]
        return this.row + place[0]
    }

    private copy(from: number, to: number, count: number): void {
        this.kernels.numbers.copyWithin(to, from, from + count)
    }

    private call(name: string, ...places: number[]): void {
        this.kernels.call(this.name(name), ...places)
    }

    private name(name: string): string {
        return `${name}.${this.path.data.kind}`
    }
}
