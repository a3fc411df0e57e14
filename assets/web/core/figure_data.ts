// The data that Python puts into the page: see app/exports/standalone/figure_data.py.

import type { RowData } from "./engine"

/** Index of the first number in a flat vector, and how many there are. */
export type Place = [number, number]

/** To the right and up, [m]. */
export type Point = [number, number]

type Numbers<Name extends string> = Record<Name, number>
type Texts<Name extends string> = Record<Name, string>

export interface SideData { law: number; side: 0 | 1 }

export interface LawData extends Texts<"title" | "text"> {
    /** Of the robot under this law in a lesson's texts. */
    name?: string
    aim: "theta" | "theta_ref"
    byClock: boolean
    linear: boolean
    stops: string[]
}

export interface PathData extends Texts<"label" | "kind" | "fit"> {
    closed: boolean
    doubts: string[]
    points: Point[]
    table: number[]
    grid: number[]
    outline: number[]
    states: number[][]
    settings: number[]
}

export type SliderData = Texts<"label" | "unit" | "help"> & Numbers<"low" | "high" | "step" | "value" | "place">

export type EffortData = Texts<"joint" | "unit"> & Numbers<"motor" | "most">

export interface FigureData extends Texts<"language" | "module"> {
    words: Record<string, string>
    dt: number
    sizes: Numbers<"p" | "n" | "rigid" | "log" | "bars" | "joints">
    state: Record<"q" | "theta" | "theta_ref", Place>
    settings: Record<"hold_active" | "hold_anchor" | "hold_tangent" | "hand_active" | "hand_target", Place>
    log: Record<
        "q" | "v" | "y" | "theta" | "theta_ref" | "u" | "force" | "far" | "integral_used" | "theta_rate" | "speed" | "xi" | "xi_rate", Place
    >
    rows: RowData[]
    sides: SideData[]
    laws: LawData[]
    /** Laws from which readers may choose. */
    choices: number[]
    paths: PathData[]
    sliders: SliderData[]
    controls: string[]
    /** Directions to the right and up in the plane of the path, as in `front_of` in models. */
    front: [number[], number[]]
    box: [number, number, number, number]
    off: number
    /** Shares above which a law counts as returning from far away, and its integral as bounded. */
    returns: number
    full: number
    strip: number
    /** The torque limits that the robot's file states. */
    efforts: EffortData[]
    poles: Numbers<"interval" | "size" | "steps" | "slow"> & { behaviours: string[] }
    edit: Numbers<"piece" | "fine" | "sums" | "row" | "samples" | "outline" | "grid"> &
        Numbers<"halvings" | "blend" | "nudge"> & { checks: string[] }
}
