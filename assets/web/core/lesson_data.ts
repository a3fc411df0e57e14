// The data that Python puts into the pages: see app/exports/site.

import type { FigureData, Setting } from "./figure_data"
import type { Answer, Curves } from "./shared_data"

export type Robot = "tracker" | "follower"
export const ROBOTS: Robot[] = ["tracker", "follower"]
export type { Answer, Curves, Setting }

/** One action of a script or a link of a page without a server; it has one of these fields besides `side`. */
export interface Action {
    hold?: boolean
    pull?: [number, number]
    release?: boolean
    set?: Record<string, Setting>
    path?: number
    /** A control point, and how far it moves to the right and up in the plane of the path, [m]. */
    move?: [number, number, number]
    /** Of each side; null: as it is. */
    laws?: (number | null)[]
    reset?: boolean
    run?: boolean
    rate?: number
    side?: number | null
}

export interface Script {
    until: number
    do: [number, Action][]
}

export interface SiteFigure extends FigureData {
    quantities: string[]
}

export interface TimeWindow {
    during: "always" | "held" | "pulled" | "free" | "released"
    last: number
    least: number
}

export type Phrases = Record<string, string>

export interface Bound extends TimeWindow {
    kind: "bound"
    quantity: string
    robot: Robot
    stat: string
    below: number | null
    above: number | null
    phrases: Phrases
}

export interface Compare extends TimeWindow {
    kind: "compare"
    quantity: string
    larger: Robot
    smaller: Robot
    stat: string
    ratio: number
    phrases: Phrases
}

export interface Better extends TimeWindow {
    kind: "better"
    quantity: string
    robot: Robot
    stat: string
    share: number
    phrases: Phrases
}

export interface Once extends TimeWindow {
    kind: "once"
    quantity: string
    robot: Robot
    stat: string
    below: number | null
    above: number | null
    since: { event: string; name: string }[]
    /** With which it counts. */
    setting: SettingCheck
    phrases: Phrases
}

export interface EventCheck {
    kind: "event"
    event: string
    name: string
    times: number
    since: { event: string; name: string }[]
    phrases: Phrases
}

export interface Order {
    kind: "order"
    events: { event: string; name: string; phrase: string }[]
}

export interface SettingCheck {
    kind: "setting"
    name: string
    equals: Setting | null
    below: number | null
    above: number | null
    whole: boolean
    phrases: Phrases
    labels: Record<string, string>
}

export interface Only {
    kind: "only"
    names: string[]
    labels: Record<string, string>
}

export type Check = Bound | Compare | Better | Once | EventCheck | Order | SettingCheck | Only

/** What a task wants of a quantity that is plotted. */
export interface LimitData {
    plot: string
    below: number | null
    above: number | null
    side: 0 | 1
    label: string
}

export interface TaskData {
    kind: "task"
    limits: LimitData[]
    id: string
    best: string
    checks?: Check[]
    /** Number of its hints, the last of which is the recipe. */
    hints?: number
    /** Conditions of the ways in which it may be passed; see lessons/task_schema.py. */
    ways?: Check[]
    /** Whether it counts nothing in a grade. */
    exploratory?: boolean
}

/** Something that can be seen in a curve, see `SketchShape` in lessons/schema.py. */
export interface SketchFeature {
    name: string
    peaks: [number, number] | null
    highest: [number, number] | null
    lowest: [number, number] | null
    at: [number, number, number][]
    level: [number, number, number, number][]
}

export interface SketchData {
    kind: "sketch"
    quantity: string
    label: string
    unit: string
    robots: string[]
    seconds: number
    top: number
    bottom: number
    /** The robot that is predicted. */
    robot?: Robot
    /** What its author looks for in a curve; from a lab, once the run is over. */
    features?: SketchFeature[]
    /** Of the circle that is followed, [m]; null for another path. */
    radius?: number | null
    /** What the student drew before a discussion, after which the class is asked again. */
    before?: Answer
}

/** A sketch at the end of a lesson, with what happened. */
export interface ChartData { data: SketchData; script: Script | null; answer: Answer; truth: Curves | null }

/** A line of a derivation, see lessons/schema.py. */
export interface LineData { name: string; formula: string; tolerance: number; wrong: string[] }

/** What has become of a line, see lessons/derivation/judged.py. */
export interface LineState {
    tries: { typed: string; verdict: "right" | "carried" | "wrong"; known: number | null }[]
    closed: boolean
}

export interface DerivationData {
    kind: "derivation"
    /** How names and functions may be typed. */
    known: Record<string, string>
    /** On a page without a server. */
    lines?: LineData[]
    /** Of the names, at random points. */
    values?: Record<string, number[]>
    /** From a lab, which judges itself. */
    states?: LineState[]
}

export interface ChoiceData {
    kind: "choice" | "quiz"
    right?: number
    voted?: boolean
    uncounted?: boolean
    /** Whether something else is asked after a wrong answer. */
    followed?: boolean
    /** What that is; from a lab, once it is asked. */
    second?: ChoiceData | NumberData
}

export interface NumberData {
    kind: "number"
    number?: number
    tolerance?: number
    wrong?: number[]
    voted?: boolean
    uncounted?: boolean
}

export type BlockData =
    // Links have actions: those above on a page without a server, those of channel/messages.ts in the lab.
    | { kind: "text"; links: (unknown[] | null)[]; when?: [string, number[]] }
    // A lab keeps what is right to itself until there is an answer, and while the class votes.
    | ChoiceData
    | NumberData
    | { kind: "open" }
    | DerivationData
    | SketchData
    | TaskData

export interface StepData {
    kind: "play" | "predict" | "run" | "explain" | "task" | "quiz"
    optional: boolean
    running: boolean
    script: Script | null
    truth?: Curves // of a run that only the lab can play
    values: Record<string, Setting> & { lengths: number[]; paths: string[] }
    blocks: BlockData[]
    figure: number
    /** A parameter that makes another robot -> its value -> the figure with it. */
    remade: Record<string, Record<string, number>>
    /** What is plotted besides the distance. */
    plots: string[]
}

export interface PageData {
    words: Record<string, string>
    lesson: string
    /** Of the lesson, and of OnPath; a lab knows them itself. */
    version?: string
    product?: string
    /** What each symbol of the lesson means. */
    symbols: Record<string, string>
    /** Whether this is the concept test, which tells nothing. */
    test?: boolean
    scorm?: Package | null
    figures: SiteFigure[]
    steps: StepData[]
    lessons: Record<string, { number: string; steps: number; required: number; tasks: string[] }>
}

/** What kind of package this is. */
export interface Package {
    version: "1.2" | "2004"
    /** Whether an unfinished lesson gets a score, too. */
    partial: boolean
}
