// What each robot is doing just now, as app/scene/captions.py says it.

import type { Bench } from "./bench"
import { said, written, type FigureData } from "./data"

function kind(bench: Bench, off: boolean): string {
    if (bench.stopped) return "stopped"
    const { byClock } = bench.data
    if (bench.held) return byClock ? (off ? "torn_off" : "held") : off ? "off" : "waits"
    if (bench.pulled) return "pulled"
    return off ? (byClock ? "chases" : "off") : ""
}

/** Empty for a robot that does what its law's title says. */
export function caption(bench: Bench, data: FigureData): string {
    const distance = bench.held ? bench.most : bench.distance
    const which = kind(bench, distance >= data.off)
    return which && said(data, `caption.${which}`, { mm: written(data, 1e3 * distance, 0) })
}

/** One line with the captions of all robots that have one. */
export function spoken(benches: Bench[], captions: string[], data: FigureData): string {
    const lines = benches.map((bench, i) =>
        captions[i]
            ? said(data, "caption.spoken", { robot: bench.data.title, caption: captions[i] })
            : "",
    )
    return lines.filter(Boolean).join(" ")
}
