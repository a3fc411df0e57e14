// What the parts of a page know of the robots, independently of how they are simulated; see local.ts.
// Lengths are in metres, forces in newtons, times in seconds of the simulation.

import type { RowData } from "./shared_data"

export type { RowData }

/** A point or a vector in the space of the end-points: two numbers, or three. */
export type Vector = readonly number[]

/** One robot at an instant. */
export interface SideSample {
    /** From the end-point to the path. */
    distance: number
    tip: Vector
    /** The point of the path that is closest to the end-point. */
    closest: Vector
    /** The point at which the law aims by its clock; null if the law has no clock. */
    reference: Vector | null
    /** The force on the end-point. */
    force: Vector
    /** Where the end-point would be if the link did not bend; null if no link can. */
    straight: Vector | null
    held: boolean
    pulled: boolean
}

export interface Sample {
    time: number
    sides: readonly SideSample[]
}

/** The texts about a robot: the name and meaning of its law, and a caption of what it is doing, which may be empty. */
export interface SideText {
    /** Its colours: 0 is the left robot's, 1 the right one's. */
    side: 0 | 1
    title: string
    /** A shorter title, for the lines of a chart. */
    name: string
    text: string
    caption: string
}

/** What a real arm has logged: curves over time from the beginning of a run on; see LogMessage. */
export interface LogCurves {
    /** Of its file. */
    name: string
    times: readonly number[]
    /** The numbers of each field at these times, in SI units; NaN where it is not known. */
    fields: ReadonlyMap<string, readonly (readonly number[])[]>
}

/** Numbers as they are told, in units of which an SI unit has some. */
export type ToldField = readonly [name: string, unit: number, columns: readonly (readonly (number | null)[])[]]

export function logCurves(name: string, times: readonly number[], told: readonly ToldField[]): LogCurves {
    const fields = new Map(told.map(([field, unit, columns]) => [field, columns.map(column => column.map(each => (each === null ? NaN : each / unit)))]))
    return { name, times, fields }
}

/** The path, as lines through its points. */
export interface PathShape {
    lines: readonly (readonly Vector[])[]
    /** Of a drawing of several strokes: the strokes, and the links between them, along which the pen is up. */
    strokes?: readonly (readonly Vector[])[]
    links?: readonly (readonly Vector[])[]
    closed: boolean
    /** Two directions at right angles and of length 1, in which the path is seen from in front. */
    right: Vector
    up: Vector
}

export interface State {
    running: boolean
    /** Of time; 1 is as fast as reality. */
    rate: number
    held: boolean
    pulled: boolean
    /** The past instant that is shown, or null: the present. */
    past: number | null
    /** Whether one may go on from a past instant. */
    branches: boolean
    /** Why the robots take no commands now; empty if they do. */
    frozen: string
}

/** Something that a reader does with both robots. */
export type Act =
    | { do: "hold" | "run"; on: boolean }
    | { do: "step" | "reset" }
    | { do: "rate"; rate: number }
    | { do: "seek"; at: number | null }
    | { do: "goOn" } // from the past instant that is shown; what came after it is discarded

/** What has changed: there are new samples; earlier ones are no longer valid; the step of a lesson, or what is
 * measured in it; or anything else. */
export type Change = "samples" | "history" | "path" | "lesson" | "measured" | "state" | "words" | "form" | "values" | "class" | "log"

export interface Engine {
    readonly state: State
    readonly path: PathShape
    readonly texts: readonly SideText[]
    readonly present: Sample
    /** The recorded samples after an instant, the oldest first: 60 a second, at most a minute; without the present. */
    since(time: number): readonly Sample[]
    /** What can be plotted of these robots. */
    readonly rows: readonly RowData[]
    /** Be told these fields, too, also of the past. */
    plot(fields: readonly string[]): void
    /** The numbers of a field of a robot in one of the samples, in SI units; null if they are not known. */
    field(sample: Sample, side: number, name: string): ArrayLike<number> | null
    /** What a real arm has logged, to be drawn over the plots; null: nothing. */
    readonly log: LogCurves | null
    act(act: Act): void
    /** What a symbol of joints means on a robot: points of a line, one for a joint, or none. */
    lit(symbol: string, side: number): readonly Vector[]
    on(listener: (change: Change) => void, ended?: AbortSignal): void
}

/** The recorded sample at an instant: the last one that is not later, or the first. */
export function sampleAt(samples: readonly Sample[], time: number): Sample | undefined {
    let [low, high] = [0, samples.length]
    while (low < high) {
        const middle = (low + high) >> 1
        if (samples[middle]!.time <= time + 1e-9) low = middle + 1
        else high = middle
    }
    return samples[Math.max(low - 1, 0)]
}

/** What is shown: the present, or the past instant that is looked at. */
export function shown(engine: Engine): Sample {
    const { past } = engine.state
    return (past !== null && sampleAt(engine.since(-Infinity), past)) || engine.present
}
