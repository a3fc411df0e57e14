// One robot under a law: its state, the forces on it, and its drawing.

import type { SideSample, Vector } from "../core/engine"
import type { EffortData, SideData, FigureData, LawData, Place, Point } from "../core/figure_data"
import type { Kernels } from "./kernels"
import type { Path } from "./path"

const MOST_POINTS = 400 // of a drawing
export const MOST_TICKS = 128 // in one call of a loop

/** What is kept of an instant: the row of the log that is drawn, and the state from which to go on. */
export interface Kept {
    row: Float64Array
    state: Float64Array
    law: number
    ticks: number
}

export class Side {
    held = false
    /** How far its tip is pulled in the picture, from where it was when the pull began; null if it is not. */
    pulledBy: Point | null = null
    /** The reason why it has stopped, counted from 1 in `stops` of its law. */
    stopped = 0
    /** The first motor that gave more than the robot's file states, and how much. */
    beyond: { effort: EffortData; gave: number } | null = null
    ticks = 0
    distance = 0
    most = 0 // largest distance from what is drawn since it was held back
    law = this.data.law
    /** Which variant of its loop runs, and numbers in its settings; see changes.ts. */
    private variant = 0
    private numbers: readonly (readonly [number, number])[] = []
    private readonly sizes = this.figure.sizes
    private readonly longest = Math.max(...this.path.data.states.map(each => each.length))
    private readonly state = this.kernels.room(this.longest)
    private readonly begun = this.kernels.room(this.longest) // the state at the start
    private readonly settings = this.kernels.room(this.path.data.settings.length)
    private readonly log = this.kernels.room((1 + MOST_TICKS) * this.sizes.log) // the last row, then new ones
    private readonly result = this.kernels.room(2 * this.sizes.p + 4 + this.sizes.n)
    private readonly points = this.kernels.room(4 * this.sizes.bars + 2 * this.sizes.joints)
    private readonly nearest = this.kernels.room(1 + this.sizes.p) // the distance, and the closest point
    private readonly straight = this.kernels.room(this.sizes.n + this.sizes.p) // a configuration, and its tip
    private readonly moved = this.kernels.room(2 * this.sizes.n) // a configuration, and its velocity
    private readonly y = this.kernels.room(this.sizes.p)
    private drawing: number | null = null // address of the points of a drawing
    private readonly grabbed = this.kernels.room(this.sizes.p) // where the tip was when a pull began
    private row = this.log // the last one
    private readonly past = this.kernels.room(this.sizes.log)
    private isPast = false // whether the row of a past instant is shown

    constructor(
        readonly data: SideData,
        private readonly figure: FigureData,
        private readonly kernels: Kernels,
        private path: Path,
    ) {
        this.begin(path)
    }

    get pulled(): boolean { return this.pulledBy !== null }
    readonly does = (): LawData => this.figure.laws[this.law]!
    /** Start again on a path, at rest, with the path's settings. */
    begin(path: Path): void {
        const { kernels, state } = this
        this.path = path
        kernels.numbers.set(path.data.states[this.law]!, state)
        kernels.numbers.set(path.data.settings, this.settings)
        this.configure(this.variant, this.numbers)
        if (path.edited) this.call(`begin${this.law}`, path.begin, path.valuesAt(path.data.begin), state, state)
        this.tune()
        this.held = this.isPast = false
        this.pulledBy = this.beyond = null
        this.stopped = this.ticks = this.most = 0
        this.seeStart()
    }

    /** Go on from the present state under another law, whose memory is empty. */
    change(law: number): void {
        if (law !== this.law) this.call(`change${this.law}to${law}`, this.state, this.state)
        this.law = law
        this.kernels.copy(this.state + this.figure.state.theta_ref[0], this.field("theta_ref"), 1)
    }

    /** Take a variant of the loop, and numbers at indices of the settings. */
    configure(variant: number, numbers: readonly (readonly [number, number])[]): void {
        Object.assign(this, { variant, numbers })
        for (const [index, value] of numbers) this.set(index, value)
    }

    /** A number of the settings. */
    readonly setting = (index: number): number => this.kernels.numbers[this.settings + index]!
    private readonly set = (index: number, value: number) => (this.kernels.numbers[this.settings + index] = value)
    /** Advance by some ticks; a robot that stops stays as it was one tick before, as in the lab. */
    advance(ticks: number): void {
        if (this.stopped) return
        const { kernels, state, settings, log, sizes } = this
        this.tune()
        kernels.copy(this.row, log, sizes.log)
        kernels.loop(this.loop, [state, settings, this.path.table, log + sizes.log], ticks)
        for (let i = 1; i <= ticks && !this.stopped; i++, this.ticks++) {
            this.row = log + i * sizes.log
            this.call("fault", this.field("q"), this.field("v"), this.field("theta_ref"), this.result)
            if ((this.stopped = kernels.numbers[this.result]!)) this.row -= sizes.log
            this.beyond ??= this.excess()
            if (i % 4 === 0 || i === ticks || this.stopped) this.measure()
        }
    }

    readonly keep = (): Kept => {
        const { law, ticks, kernels, state, longest } = this
        return { row: this.logged(), state: kernels.numbers.slice(state, state + longest), law, ticks }
    }

    /** The numbers of a field at an instant, in SI units; null if this robot has none. */
    kept({ row, law }: Kept, name: string): ArrayLike<number> | null {
        const { figure, sizes, kernels, moved, result } = this
        if (name === "theta_ref" && !figure.laws[law]!.byClock) return null
        const numbers = (place: Place) => row.subarray(place[0], place[0] + place[1])
        if (name in figure.log) return numbers(figure.log[name as keyof FigureData["log"]])
        const modes = sizes.n - sizes.rigid
        if (!modes) return null
        kernels.numbers.set(numbers(figure.log.q), moved)
        kernels.numbers.set(numbers(figure.log.v), moved + sizes.n)
        this.call("measured", moved, moved + sizes.n, result)
        const bent: Record<string, Place> = { deflection: [0, 1], internal_energy: [1, 1], modes: [2, modes] }
        const found = bent[name]
        return found ? kernels.numbers.slice(result + found[0], result + found[0] + found[1]) : null
    }

    /** Draw a past instant, or the present one. */
    show(kept: Kept | null): void {
        this.isPast = kept !== null
        if (kept) this.kernels.numbers.set(kept.row, this.past)
    }

    /** Go on from a past instant, free, with the settings as they are. */
    goOn({ row, state, law, ticks }: Kept): void {
        this.kernels.numbers.set(state, this.state)
        this.kernels.numbers.set(row, this.log)
        Object.assign(this, { law, ticks, row: this.log, stopped: 0, isPast: false })
        this.hold(false)
        this.pull(null)
        this.measure()
    }

    /** Hold it back along the path where it is, or let it go; `logged`: where it was in the last row of the log. */
    hold(on: boolean, logged = false): void {
        const { settings: spans, state } = this.figure
        if (on) {
            const tangent = this.settings + spans.hold_tangent[0], theta = logged ? this.field("theta") : this.state + state.theta[0]
            if (logged) this.kernels.copy(this.field("y"), this.y, this.sizes.p)
            else this.call("tip", this.state + state.q[0], this.y)
            this.kernels.copy(this.y, this.settings + spans.hold_anchor[0], this.sizes.p)
            this.call("brake", this.path.valuesAt(this.kernels.numbers[theta]!), tangent)
            this.most = this.path.draws(this.kernels.numbers[theta]!) ? this.distance : 0
        }
        this.held = on
        this.set(spans.hold_active[0], on ? 1 : 0)
    }

    /** Pull the tip by a vector in the picture from where it was when the pull began; null: let go. */
    pull(by: Point | null): void {
        const { settings: spans } = this.figure
        if (by && !this.pulled) this.kernels.copy(this.field("y"), this.grabbed, this.sizes.p)
        this.pulledBy = by
        this.set(spans.hand_active[0], by ? 1 : 0)
        if (!by) return
        this.kernels.numbers.set([0, 0, ...by], this.result)
        this.call("hand", this.grabbed, this.result, this.result + 2, this.settings + spans.hand_target[0])
    }

    /** Let a pull begin where the tip is now; returns by how much. */
    grabAnew(): number[] {
        const { kernels, sizes, grabbed } = this, y = this.field("y")
        const by = Array.from({ length: sizes.p }, (_, i) => kernels.numbers[y + i]! - kernels.numbers[grabbed + i]!)
        this.moveGrab(by)
        return by
    }

    /** Let a pull begin elsewhere. */
    moveGrab(by: readonly number[]): void {
        by.forEach((each, i) => (this.kernels.numbers[this.grabbed + i]! += each))
    }

    /** Both ends of each bar, then joints, as x and y in the picture; with the deflection so many times as large. */
    picture(larger = 1): Float64Array {
        const { bars, joints } = this.sizes, factor = this.result
        this.kernels.numbers[factor] = larger
        if (larger === 1) this.call("picture", this.seen("q"), this.points, this.points + 4 * bars)
        else this.call("enlarged", this.seen("q"), factor, this.points, this.points + 4 * bars)
        return this.kernels.numbers.subarray(this.points, this.points + 4 * bars + 2 * joints)
    }

    /** Points of a drawing that a function of the configuration gives. */
    drawn(name: "labels" | "ellipse", count: number): Point[] {
        this.drawing ??= this.kernels.room(2 * MOST_POINTS)
        this.call(name, this.seen("q"), this.drawing)
        return Array.from({ length: count }, (_, i) => this.kernels.pair(this.drawing! + 2 * i))
    }

    /** The largest speed that is wanted along a drawing, [m/s]. */
    get pace(): number {
        this.tune()
        this.call("pace", this.settings, this.result)
        return Math.abs(this.kernels.numbers[this.result]!) * this.path.steepest
    }

    readonly tip = (): Point => this.point("place", this.seen("y"))
    /** The point that the law aims at. */
    readonly aim = (): Point => this.aimed(this.does().aim)
    /** The reference point, even if the law does not aim at it. */
    readonly reference = (): Point => this.aimed("theta_ref")
    /** The point of the path that is closest to the end-point. */
    readonly closest = (): Point => this.aimed("theta")
    /** The deflection of a flexible link's tip, [m], and the energy in the link, [J]. */
    readonly measured = (): Point => this.point("measured", this.field("q"), this.field("v"))
    /** The end of the arrow of the force. */
    readonly arrow = (): Point => this.point("arrow", this.seen("y"), this.seen("force"))
    /** How far a bound of the law is reached, from 0 to 1. */
    readonly share = (name: "far" | "integral_used"): number => this.kernels.numbers[this.field(name)]!
    /** What the page's parts know of the present instant. */
    sample(): SideSample {
        const { sizes, kernels, distance, held, pulled } = this
        const vector = (address: number): Vector => [...kernels.numbers.subarray(address, address + sizes.p)]
        const tip = vector(this.field("y")), force = vector(this.field("force")), closest = vector(this.nearest + 1)
        let reference: Vector | null = null, straight: Vector | null = null
        if (this.does().aim === "theta_ref") {
            this.path.at(kernels.numbers[this.field("theta_ref")]!, this.y)
            reference = vector(this.y)
        }
        if (sizes.rigid < sizes.n) {
            const end = this.straight + sizes.n
            kernels.copy(this.field("q"), this.straight, sizes.rigid)
            this.call("tip", this.straight, end) // whose modes are zero
            straight = vector(end)
        }
        return { distance, tip, closest, reference, force, straight, held, pulled }
    }

    /** The last row of the log. */
    readonly logged = (): Float64Array => this.kernels.numbers.slice(this.row, this.row + this.sizes.log)
    /** The row before the first tick: the row of a tick that is undone, without torque and force. */
    private seeStart(): void {
        const { kernels, figure, state, log } = this
        kernels.copy(state, this.begun, this.longest)
        kernels.loop(this.loop, [state, this.settings, this.path.table, log], 1)
        kernels.copy(this.begun, state, this.longest)
        this.row = log
        for (const [from, size] of [figure.log.u, figure.log.force]) kernels.numbers.fill(0, log + from, log + from + size)
        this.measure()
    }

    /** Let the loop know the bends of a drawing that is bent. */
    private tune(): void {
        const { path } = this
        if (path.edited && path.data.turning !== null) this.set(path.data.turning, path.turning)
    }

    private excess(): Side["beyond"] {
        const gave = ({ motor }: EffortData) => Math.abs(this.kernels.numbers[this.field("u") + motor]!)
        const effort = this.figure.efforts.find(each => gave(each) > each.most)
        return effort ? { effort, gave: gave(effort) } : null
    }

    private measure(): void {
        const at = (name: "theta" | "theta_ref") => this.kernels.numbers[this.field(name)]!
        this.path.nearest(this.field("y"), at("theta"), at(this.does().aim), this.nearest)
        this.distance = this.kernels.numbers[this.nearest]!
        if (this.held && this.path.draws(at("theta"))) this.most = Math.max(this.most, this.distance)
    }

    private aimed(at: "theta" | "theta_ref"): Point {
        this.path.at(this.kernels.numbers[this.seen(at)]!, this.y)
        return this.point("place", this.y)
    }

    private point(name: string, ...addresses: number[]): Point {
        this.call(name, ...addresses, this.result)
        return this.kernels.pair(this.result)
    }

    private readonly seen = (name: keyof FigureData["log"]): number =>
        (this.isPast ? this.past : this.row) + this.figure.log[name][0]
    private readonly field = (name: keyof FigureData["log"]): number => this.row + this.figure.log[name][0]
    private readonly call = (name: string, ...addresses: number[]) => this.kernels.call(this.name(name), ...addresses)
    private get loop(): string { return this.name(`loop${this.law}${this.variant ? `v${this.variant}` : ""}`) }
    private readonly name = (name: string): string => `${name}.${this.path.data.kind}`
}
