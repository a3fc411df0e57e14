// A simulation that records what the lessons need: events, and all quantities 60 times a second.

import { ROBOTS, type Action, type Robot, type Script, type SiteFigure, type StepData, type Curves } from "../core/lesson_data"
import type { Kernels } from "../simulation/kernels"
import { Simulation } from "../simulation/simulation"
import type { Happening, RunRecord } from "./checks"

const FRAME = 1 / 60 // [s]
const MOST = 3600 // samples: the lab keeps one minute, too

export class Recorded extends Simulation {
    happenings: Happening[] = []
    /** Called before every frame of a 60th of a second; a script acts then. False: wait here. */
    private before: (time: number) => boolean = () => true
    /** Number of the run; each reset begins another one. */
    run = 0
    private frame = 0
    private written = new Map<number, number>()
    private settings: Record<string, number | string> = {}
    private times: number[] = []
    private samples: Record<Robot, Record<string, number[]>>

    constructor(override readonly data: SiteFigure, kernels: Kernels, private readonly begun: StepData["values"]) {
        super(data, kernels)
        this.samples = this.nothing()
        this.setUp()
    }

    /** As when the step began. */
    setUp(): void {
        const { lengths, paths, ...settings } = this.begun
        this.settings = { ...settings, length: lengths[0]!, path: paths[0]! }
        this.written.clear()
        this.data.sliders.forEach((slider, i) => (this.values[i] = slider.value))
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

    override set(slider: number, value: number): void {
        super.set(slider, value)
        const name = this.data.names[slider]
        if (!name) return
        this.settings[name] = value
        this.note("set", name)
    }

    override reset(): void {
        this.note("reset")
        this.restart()
    }

    override choose(path: number): void {
        const { lengths, paths } = this.begun
        this.path = path
        Object.assign(this.settings, { path: paths[path], length: lengths[path] })
        this.note("path", paths[path])
        this.restart()
    }

    /** Perform an action of a script or a link. */
    act(action: Action): void {
        const only = action.side ?? undefined
        if (action.hold !== undefined) this.hold(action.hold, only)
        else if (action.pull) this.pull(action.pull, only)
        else if (action.release) this.pull(null)
        else if (action.path !== undefined) this.choose(action.path)
        else if (action.reset) this.reset()
        else if (action.set) this.write(action.set, action.write ?? [])
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

    record(): RunRecord {
        const { times, happenings, run, settings } = this
        return { times, end: this.time, values: this.samples, happenings, run, settings, changed: this.different() }
    }

    private different(): string[] {
        const given = { ...this.begun, path: this.begun.paths[0]! } as Record<string, unknown>
        const compared = Object.keys(this.settings).filter(name => name !== "length")
        return compared.filter(name => this.settings[name] !== given[name])
    }

    /** A quantity of both robots up to now. */
    curve(quantity: string): Curves {
        const now = this.now()
        const of = (robot: Robot) => [...(this.samples[robot][quantity] ?? []), now[robot][quantity] ?? 0]
        return { times: [...this.times, this.time], tracker: of("tracker"), follower: of("follower") }
    }

    private write(values: Record<string, number | string>, places: [number, number][]): void {
        for (const [place, value] of places) {
            this.written.set(place, value)
            for (const side of this.sides) side.set(place, value)
        }
        for (const [name, value] of Object.entries(values)) {
            this.settings[name] = value
            const slider = this.data.names.indexOf(name)
            if (slider >= 0) this.values[slider] = Number(value)
            this.note("set", name)
        }
    }

    /** Begin anew, with the settings as they are. */
    private restart(): void {
        this.run++
        this.frame = 0
        this.times = []
        this.samples = this.nothing()
        const kept = [...this.happenings]
        super.reset() // this sets all sliders
        this.happenings = kept
        for (const [place, value] of this.written) for (const side of this.sides) side.set(place, value)
        this.data.sliders.forEach(({ place }, i) => {
            if (place >= 0) for (const side of this.sides) side.set(place, this.values[i]!)
        })
    }

    private readonly at = (frame: number): number => Math.floor((frame * FRAME) / this.data.dt + 1e-9)
    private note(name: string, detail = "", robots: Robot[] = ROBOTS): void {
        this.happenings.push({ run: this.run, time: this.time, name, detail, robots })
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
