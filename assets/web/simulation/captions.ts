// Captions of what each robot is doing, as in app/view/captions.py.

import type { FigureData } from "../core/figure_data"
import { phrase, significant, written } from "../core/words"
import type { Side } from "./side"
import type { Simulation } from "./simulation"

function kind(side: Side, off: boolean, data: FigureData): string {
    if (side.stopped) return "stopped"
    const { byClock } = side.does()
    if (side.held) return byClock ? (off ? "torn_off" : "held") : off ? "off" : "waits"
    const returns = side.share("far") > data.returns, bounded = side.share("integral_used") > data.full
    if (side.pulled) return returns ? "pulled_far" : bounded ? "pulled_bounded" : "pulled"
    if (!off) return ""
    if (returns) return "returns"
    return byClock ? "chases" : bounded ? "off_bounded" : "off"
}

/** A robot's caption; empty if it simply does what its law's title says. */
export function caption(side: Side, data: FigureData): string {
    const distance = side.held ? side.most : side.distance
    const which = kind(side, distance >= data.off, data), mm = 1e3 * distance
    return which && phrase(data, `caption.${which}`, { mm: written(data, mm, mm >= 0.05 && mm < 1 ? 1 : 0) })
}

/** One line with the captions of all robots that have one. */
export function spoken(simulation: Simulation, captions: string[]): string {
    const { data } = simulation
    const line = (text: string, i: number) => phrase(data, "caption.spoken", { robot: simulation.title(i), caption: text })
    return captions.map((text, i) => text && line(text, i)).filter(Boolean).join(" ")
}

/** Why robots have stopped, why the path goes no further, or which point the keys move. */
export function notes(simulation: Simulation): string {
    const { sides, followed, selected, data } = simulation
    const lines = sides.map((side, i) => {
        const reason = side.does().stops[side.stopped - 1]
        const time = written(data, side.ticks * data.dt, 1)
        return reason ? phrase(data, "say.stopped", { robot: simulation.title(i), time, reason }) : ""
    })
    for (const { beyond } of sides) {
        if (!beyond) continue
        const { effort: { joint, unit, most }, gave } = beyond
        const [given, limit] = [gave, most].map(each => `${significant(data, each, 4)} ${unit}`)
        lines.push(phrase(data, "efforts.exceeded", { joint, gave: given!, limit: limit! }))
    }
    if (followed.doubts.length) {
        const reasons = followed.doubts.map(key => phrase(data, key)).join("; ")
        lines.push(phrase(data, "say.ambiguous", { reasons }))
    }
    if (followed.fault) {
        const length = written(data, followed.fault.length ?? 0, 0)
        const reasons = followed.fault.reasons.map(key => phrase(data, key, { length })).join("; ")
        lines.push(phrase(data, "say.no_further", { reasons }))
    } else if (selected !== null) {
        const all = String(followed.data.points.length)
        lines.push(phrase(data, "standalone.selected", { number: String(selected + 1), all }))
    }
    return lines.filter(Boolean).join(" ")
}
