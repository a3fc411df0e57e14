// The engine of a page without a server: a simulation in WebAssembly, and its clock.

import { sampleAt, type Act, type Change, type Engine, type LogCurves, type PathShape, type RowData, type SideText, type State, type Vector } from "../core/engine"
import { caption } from "./captions"
import type { Moment, Simulation } from "./simulation"

const FRAME = 1 / 60 // [s] of simulated time per frame
const LONGEST = 0.1 // [s] that a picture may be late before simulated time falls behind

export class LocalEngine implements Engine {
    running = !matchMedia("(prefers-reduced-motion: reduce)").matches
    rate = 1
    /** Simulated time lost lately, [s], because pictures were late. */
    lost = 0
    private past: number | null = null
    private resumes = false // whether the present goes on after a look at the past
    private now: Moment | null = null // the present, if it is known
    private due = 0
    private last = performance.now()
    private readonly listeners = new Set<(change: Change) => void>()
    private shape: PathShape | null = null

    constructor(readonly simulation: Simulation, private readonly branches = true) {
        simulation.changed = change => {
            if (change === "path") this.shape = null
            if (change === "history") this.show(null)
            this.now = null
            this.tell(change)
        }
    }

    get state(): State {
        const { running, rate, past, branches, simulation } = this
        const held = simulation.sides.some(side => side.held), pulled = simulation.sides.some(side => side.pulled)
        return { running, rate, held, pulled, past, branches, frozen: "" }
    }

    get path(): PathShape {
        const { followed, data } = this.simulation
        const [right, up] = data.front
        return (this.shape ??= { ...followed.shape(), closed: followed.data.closed, right, up })
    }

    get texts(): SideText[] {
        const { sides, data } = this.simulation
        return sides.map((each, i) => {
            const title = this.simulation.title(i)
            return { side: each.data.side, title, name: each.does().name ?? title, text: each.does().text, caption: caption(each, data) }
        })
    }

    get present(): Moment { return (this.now ??= this.simulation.moment()) }

    since(time: number): Moment[] {
        const { recent } = this.simulation
        return recent.slice(recent.findLastIndex(moment => moment.time <= time) + 1)
    }

    get rows(): readonly RowData[] { return this.simulation.data.rows }

    get log(): LogCurves | null { return this.simulation.log }

    plot(): void {} // all fields are known

    field({ robots, sides }: Moment, side: number, name: string): ArrayLike<number> | null {
        return name === "distance" ? [sides[side]!.distance] : this.simulation.sides[side]!.kept(robots[side]!, name)
    }

    on(listener: (change: Change) => void, ended?: AbortSignal): void {
        this.listeners.add(listener)
        ended?.addEventListener("abort", () => this.listeners.delete(listener))
    }

    act(act: Act): void {
        const { simulation } = this
        if (act.do === "seek") this.show(act.at)
        else if (act.do === "goOn") this.goOn()
        else {
            this.show(null)
            if (act.do === "hold") this.hold(act.on)
            else if (act.do === "run") this.running = act.on
            else if (act.do === "rate") this.rate = act.rate
            else if (act.do === "reset") simulation.reset()
            else {
                this.running = false
                simulation.advance(Math.round(FRAME / simulation.data.dt))
            }
        }
        this.tell("state")
    }

    /** Let the time of the page's clock pass; returns whether anything moves. */
    pass(now: number): boolean {
        const { simulation } = this
        const passed = (now - this.last) / 1e3
        this.last = now
        const runs = this.running && this.past === null
        if (runs && passed < 1) // otherwise the page was hidden
            this.lost = 0.98 * this.lost + Math.max(0, passed - LONGEST)
        this.due += this.rate * Math.min(passed, LONGEST)
        const ticks = Math.floor(this.due / simulation.data.dt)
        this.due -= ticks * simulation.data.dt
        if (runs && ticks > 0) simulation.advance(ticks)
        if (runs && ticks > 0) return true
        const moves = simulation.followed.advance(passed)
        if (moves) simulation.changed("path")
        return moves
    }

    /** Show the past instant, or the present. */
    private show(time: number | null): void {
        const { simulation } = this
        const moment = time === null ? undefined : sampleAt(simulation.recent, time) as Moment | undefined
        const before = this.past
        this.past = moment?.time ?? null
        simulation.sides.forEach((side, i) => side.show(moment?.robots[i] ?? null))
        if (moment && before === null) this.resumes = this.running
        if (moment) this.running = false
        else if (before !== null) this.running = this.resumes
    }

    /** Hold both robots or let them go, and let time run: somebody wants to see what happens. */
    private hold(on: boolean): void {
        this.simulation.hold(on)
        this.running = true
    }

    private goOn(): void {
        const { past, simulation, branches } = this
        if (past === null || !branches) return
        const moment = sampleAt(simulation.recent, past) as Moment
        this.show(null)
        simulation.goOn(moment)
        this.running = true
    }

    /** Joints are shown on the robots only; see view.ts. */
    lit(): Vector[] { return [] }

    private tell(change: Change): void {
        for (const listener of this.listeners) listener(change)
    }
}
