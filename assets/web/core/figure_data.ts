// The data that Python puts into the page: see app/exports/standalone/figure_data.py.

import type { RowData, ToldField } from "./engine"
import type { FormMessage } from "./form_data"

/** Index of the first number in a flat vector, and how many there are. */
export type Place = [number, number]

/** To the right and up, [m]. */
export type Point = [number, number]

type Numbers<Name extends string> = Record<Name, number>
type Texts<Name extends string> = Record<Name, string>

/** What the poles of a linear law depend on besides its gains: the sampling interval and the look-ahead [s], the computing
 * delay in intervals, whether the position along the path is controlled, and where K1 to K5 are in the settings. */
export interface PoleNumbers { interval: number; ahead: number; delay: number; position: boolean; gains: number[] }

/** Of the fit of a series: samples, intervals between knots that are summed, harmonics, and least lengths [m]. */
export type FitNumbers = Numbers<"samples" | "fine" | "harmonics" | "closest" | "shortest">

export interface SideData { law: number; side: 0 | 1 }

export interface LawData extends Texts<"title" | "text"> {
    /** Its name, or "own" for one that somebody has typed. */
    key: string
    /** Of the robot under this law in a lesson's texts. */
    name?: string
    aim: "theta" | "theta_ref"
    byClock: boolean
    linear: boolean
    stops: string[]
}

export interface PathData extends Texts<"label" | "kind"> {
    closed: boolean
    dimension: number
    doubts: string[]
    points: Point[]
    /** θ at which a run begins. */
    begin: number
    /** Of a drawing; 0 for a series. */
    pieces: number
    /** Points from which the search for the closest one begins. */
    grid: number
    /** From which θ to which the pen is up. */
    raised: [number, number][]
    /** What moves with a control point of a drawing: θ of it, and a weight for each point of the table. */
    handles: { theta: number; weights: number[] }[]
    table: number[]
    /** Of a series, in the picture. */
    outline: number[]
    /** What a row of the checks is about, and how many rows there are. */
    checks: string[]
    samples: number
    /** The index of the largest turning in the settings of a drawing. */
    turning: number | null
    states: number[][]
    settings: number[]
}

/** The value of a parameter: a number, or one of some options; or whether something is shown. */
export type Setting = number | string | boolean

/** The parameters that may change: their first values, and where they act in the settings of the loops. */
export interface ChangesData {
    values: Record<string, Setting>
    /** Of those that are one number of the settings. */
    indices: Record<string, number>
    /** Rows of numbers at some indices, for the values of some parameters. */
    tables: { names: string[]; values: Setting[][]; indices: number[]; numbers: number[][] }[]
}

/** A picture in the plane of the path: its lower left corner, and the ways to its right and to its top. */
export interface PlaneImage extends Texts<"src"> { corner: Point; right: Point; up: Point; opacity?: number }

/** What is drawn besides the robots; see app/exports/standalone/drawings.py. */
export interface DrawingsData {
    switches: Texts<"name" | "label" | "help">[]
    /** What is drawn at first. */
    shown: string[]
    marks: { at: Point; from?: Point; text: string }[]
    labels?: { names: string[]; points: number; axes: [Point, Point][]; axisNames: { text: string; place: Point }[] }
    /** Of each path. */
    tubes?: { shown: number; across: number[]; along: number; lines: number }[]
    rank?: PlaneImage
    zone?: PlaneImage
}

/** Which variant of the loops runs: the classes of the values that decide it, joined by commas, are a key. A number is of class
 * 0 or 1, "off" or "on", one of some options its index among them. */
export interface LoopsData {
    classes: Record<string, Setting[]>
    keys: Record<string, number>
}

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
    /** What a real arm has logged: what does not depend on the path, and what does, for each path. */
    logged?: { name: string; times: number[]; fields: ToldField[]; paths: ToldField[][] } | null
    sides: SideData[]
    laws: LawData[]
    drawings: DrawingsData
    loops: LoopsData
    changes: ChangesData
    paths: PathData[]
    /** The settings that readers may change. */
    form: FormMessage
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
    /** For each path the least α on it from which on the zero dynamics are unstable, and what is said below and beyond. */
    critical: { limit: number; notes: [string, string] }[]
    poles: PoleNumbers
    fit: FitNumbers
    edit: Numbers<"row" | "refinements" | "turns" | "grain" | "halvings" | "blend" | "nudge">
}
