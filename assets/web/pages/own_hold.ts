// A hold that a figure plays by itself, again and again, until somebody else does something: a reader sees what the robots are
// about before having found the button.

import type { LocalEngine } from "../simulation/local"

const [FIRST, REST, LONGEST] = [2.5, 6, 1.5] // [s] of simulated time: until the first hold, between two, and of one
const RETURNS = 0.95 // share of the largest distance below which the farthest robot has begun to come back

export class OwnHold {
    /** Whether nobody else has done anything yet. */
    plays = true
    private next = FIRST // [s], when it holds or, at the latest, lets go
    private acts = false
    private holds = false // whether the last hold is its own

    constructor(private readonly engine: LocalEngine, ended: AbortSignal) {
        engine.on(change => change !== "samples" && !this.acts && this.end(), ended)
    }

    /** Somebody else has done something: robots that nobody else holds are let go. */
    private end(): void {
        const { holds, engine: { simulation } } = this
        this.plays = this.holds = false
        if (holds) simulation.hold(false)
    }

    /** Hold the robots, or let them go, if it is time. */
    follow(): void {
        const { plays, next, engine: { simulation } } = this, { time, held, sides } = simulation
        if (!plays) return
        if (held && sides.some(side => side.stopped)) return simulation.reset() // and that is all
        const most = Math.max(...sides.map(side => side.most)), now = Math.max(...sides.map(side => side.distance))
        const returns = held && most > simulation.data.off && now < RETURNS * most
        if (time < next && !returns) return
        this.next = time + (held ? REST : LONGEST)
        this.acts = true
        simulation.hold(this.holds = !held)
        this.acts = false
    }
}
