// A simulation that records what the lessons need: events, and all quantities 60 times a second.

import type { Point } from "../core/figure_data"
import type { Action, Check, Curves, Robot, Script, Setting, SiteFigure, StepData } from "../core/lesson_data"
import { ROBOTS } from "../core/lesson_data"
import type { Kernels } from "../simulation/kernels"
import type { Side } from "../simulation/side"
import { Simulation } from "../simulation/simulation"
import type { Happening, RunRecord } from "./checks"

const SIDES = ["left", "right"] // in the order of ROBOTS
const EDITED = "own" // name of a path that is no preset
const FRAME = 1 / 60 // [s] between samples
const MOST = 3600 // samples that are kept: one minute, as in the lab

export class Recorded extends Simulation {
    happenings: Happening[] = []
    /** Called before every frame of a 60th of a second; a script acts then. False: wait here. */
    private before: (time: number) => boolean = () => true
    /** Number of the run; each reset begins another one. */
    run = 0
    protected override readonly likeLab = true
    private frame = 0
    private settings: Record<string, Setting> = {}
    private times: number[] = []
    private samples: Record<Robot, Record<string, number[]>>

    /** Called before the record of a run is lost, by a reset or another path. */
    ending: () => void = () => {}
    /** Called if a parameter gets a value that makes another robot. */
    remake: (name: string, value: Setting) => void = () => {}

    /** `remade`: the parameters that make another robot. */
    constructor(
        override readonly data: SiteFigure, kernels: Kernels, private readonly begun: StepData["values"],
        private readonly remade: readonly string[] = [],
    ) {
        super(data, kernels)
        this.samples = this.nothing()
        this.setUp()
    }

    /** Start over as another robot, with the other settings as they are. */
    goOnFrom(before: Recorded, name: string, value: Setting): void {
        this.settings = { ...before.settings, [name]: value }
        this.changes.values = { ...before.values, [name]: value }
        this.configure()
        this.run = before.run
        this.restart()
        this.happenings = [...before.happenings]
        this.note("set", name)
    }

    /** As when the step began. */
    setUp(): void {
        const { lengths, paths, ...settings } = this.begun
        this.settings = { ...settings, length: lengths[0]!, path: paths[0]! }
        this.changes.begin()
        this.configure()
        this.sides.forEach(side => (side.law = side.data.law))
        for (const path of this.paths) path.restore()
        this.path = 0
        this.restart()
        this.happenings = []
    }

    override advance(ticks: number): void {
        for (let left = ticks; left > 0; ) {
            if (this.ticks >= this.at(this.frame)) {
                if (!this.before(this.time)) return
                this.sample()
                this.frame++
            }
            const part = Math.min(left, this.at(this.frame) - this.ticks)
            super.advance(part)
            left -= part
            this.sides.forEach((side, i) => {
                if (side.stopped && !this.isStopped(ROBOTS[i]!)) this.note("diverged", "", [ROBOTS[i]!])
            })
        }
    }

    override hold(on: boolean, only?: number): void {
        if (only !== undefined) this.note(on ? "hold" : "let_go", "", [ROBOTS[only]!])
        else if (on !== this.held) this.note(on ? "hold" : "let_go")
        super.hold(on, only)
    }

    override pull(by: [number, number] | null, only?: number): void {
        const pulled = this.sides.some(side => side.pulled)
        if (only !== undefined) this.note(by ? "pull" : "release", "", [ROBOTS[only]!])
        else if (pulled !== (by !== null)) this.note(by ? "pull" : "release")
        super.pull(by, only)
    }

    override set(values: Record<string, Setting>): void {
        const makes = Object.entries(values).find(([name, value]) => this.remade.includes(name) && value !== this.values[name])
        if (makes) {
            this.remake(...makes)
            return
        }
        super.set(values)
        for (const [name, value] of Object.entries(values)) {
            if (!(name in this.begun)) continue // how something is drawn
            this.settings[name] = value
            this.note("set", name)
        }
    }

    /** Change the law of a side. */
    chooseLaw(side: number, law: number): void {
        if (law === this.sides[side]!.law) return
        this.sides[side]!.change(law)
        const { key } = this.data.laws[law]!
        this.settings[SIDES[side]!] = key
        this.note("law", key, [ROBOTS[side]!])
    }

    /** Keep the result of an edit of the path. */
    protected override edited(): void {
        Object.assign(this.settings, { path: EDITED, length: 1e3 * this.followed.length() })
        this.note("path", EDITED)
    }

    override reset(): void {
        this.ending()
        this.note("reset")
        this.restart()
    }

    override choose(path: number): void {
        this.ending()
        const { lengths, paths } = this.begun
        this.path = path
        this.paths[path]!.restore()
        Object.assign(this.settings, { path: paths[path], length: lengths[path] })
        this.note("path", paths[path])
        this.restart()
    }

    /** Perform an action of a script or a link. */
    act(action: Action): void {
        const only = action.side ?? undefined
        if (action.hold !== undefined) this.hold(action.hold, only)
        else if (action.pull) this.pullOn(action.pull, only)
        else if (action.release) this.pull(null)
        else if (action.path !== undefined) this.choose(action.path)
        else if (action.reset) this.reset()
        else if (action.set) this.set(action.set)
        else if (action.move) this.bend(...action.move)
        else action.laws?.forEach((law, side) => law !== null && this.chooseLaw(side, law))
    }

    /** Begin a script, from the step's beginning; time must then advance. `told` gets each action, and `ended` whether all of
     * it was played, or a reset came. */
    play(script: Script, told: (action: Action) => void, ended: (whole: boolean) => void): void {
        const waiting = [...script.do].sort((a, b) => a[0] - b[0])
        let before = 0 // simulated time before the last reset, [s]
        this.setUp()
        let { run } = this
        const end = (whole: boolean) => {
            this.before = () => true
            ended(whole)
            return !whole
        }
        this.before = time => {
            if (this.run !== run) return end(false)
            while (waiting.length && waiting[0]![0] <= before + time + 1e-9) {
                const [, action] = waiting.shift()!
                told(action)
                this.act(action)
                if (this.run === run) continue
                run = this.run
                before += time
                time = 0
            }
            return before + time < script.until - 1e-9 || end(true)
        }
    }

    /** Play all of a script at once; returns what a quantity did. */
    played(script: Script, quantity: string): Curves {
        let playing = true
        this.play(script, () => {}, () => (playing = false))
        while (playing) this.advance(Math.round(1 / this.data.dt))
        return this.curve(quantity)
    }

    /** `before`: what was measured in earlier runs. */
    record(before: ReadonlyMap<Check, number> = new Map()): RunRecord {
        const { times, happenings, run, settings } = this
        return { times, end: this.time, values: this.samples, happenings, run, settings, changed: this.different(), before }
    }

    /** Pull from where the tip is now, even during a pull; both robots by what the follower is pulled. */
    private pullOn(by: Point, only?: number): void {
        const [tracker, follower] = this.sides as [Side, Side], side = this.sides[only ?? 1]!
        const moved = side.pulled ? side.grabAnew() : null
        if (moved && side === follower && tracker.pulled) tracker.moveGrab(moved)
        this.pull(by, only)
    }

    private different(): string[] {
        const given = { ...this.begun, path: this.begun.paths[0]! } as Record<string, unknown>
        const compared = Object.keys(this.settings).filter(name => name !== "length" && !SIDES.includes(name))
        const laws = SIDES.filter((_, i) => this.sides[i]!.law !== this.data.sides[i]!.law)
        return [...compared.filter(name => this.settings[name] !== given[name]), ...laws]
    }

    /** A quantity of both robots up to now. */
    curve(quantity: string): Curves {
        const now = this.now()
        const of = (robot: Robot) => [...(this.samples[robot][quantity] ?? []), now[robot][quantity] ?? 0]
        return { times: [...this.times, this.time], tracker: of("tracker"), follower: of("follower") }
    }

    /** Start over, with the settings as they are. */
    private restart(): void {
        this.run++
        this.frame = 0
        this.times = []
        this.samples = this.nothing()
        const kept = [...this.happenings]
        super.reset()
        this.happenings = kept
    }

    private readonly at = (frame: number): number => Math.floor((frame * FRAME) / this.data.dt + 1e-9)
    /** Record an event; what a drag of a slider repeats within a second is recorded once. */
    private note(name: string, detail = "", robots: Robot[] = ROBOTS): void {
        const { run, time } = this, last = this.happenings[this.happenings.length - 1]
        const repeats = name === "set" && last?.name === "set" && last.run === run && last.detail === detail
        if (!repeats || time - last.time >= 1) this.happenings.push({ run, time, name, detail, robots })
    }

    private isStopped(robot: Robot): boolean {
        return this.happenings.some(each => each.name === "diverged" && each.run === this.run && each.robots.includes(robot))
    }

    private nothing(): Record<Robot, Record<string, number[]>> {
        const empty = () => Object.fromEntries(this.data.quantities.map(name => [name, [] as number[]]))
        return { tracker: empty(), follower: empty() }
    }

    private sample(): void {
        const now = this.now()
        this.times.push(this.time)
        for (const robot of ROBOTS)
            for (const name of this.data.quantities) this.samples[robot][name]!.push(now[robot][name]!)
        if (this.times.length <= MOST) return
        this.times.shift()
        for (const robot of ROBOTS) for (const name of this.data.quantities) this.samples[robot][name]!.shift()
    }

    /** All quantities of both robots, in their units. */
    private now(): Record<Robot, Record<string, number>> {
        const reference = this.sides[0]!.reference()
        const own = this.sides.map(side => {
            const row = side.logged()
            const of = (name: keyof SiteFigure["log"]) => row.subarray(this.data.log[name][0], this.data.log[name][0] + this.data.log[name][1])
            const tip = side.tip()
            const [deflection, energy] = this.data.quantities.includes("energy") ? side.measured() : [0, 0]
            return {
                distance: 1e3 * side.distance,
                lag: 1e3 * Math.hypot(tip[0] - reference[0], tip[1] - reference[1]),
                speed: 1e3 * of("speed")[0]!,
                rate: of("theta_rate")[0]!,
                place: of("theta")[0]!,
                across: 1e3 * of("xi")[0]!,
                across_rate: 1e3 * of("xi_rate")[0]!,
                torque: Math.max(...of("u").map(Math.abs)),
                force: Math.hypot(...of("force")),
                deflection: 1e3 * deflection,
                energy: 1e3 * energy,
            }
        })
        return { tracker: own[0]!, follower: own[1]! }
    }
}
