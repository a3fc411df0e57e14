// What pages with and without a server have: a student's answers, how tasks are judged, curves and
// what can be plotted; made by app/channel/typescript.py from lessons/given.py, lessons/checks.py,
// app/steps/block_data.py and app/lab/plot_rows.py: change them there.

/** The answer to a prediction: an option, a sketched curve, or neither if it was skipped. */
export interface Answer {
    /** index of the option, or None. */
    option?: number | null
    /** points of a sketch, [s] and in the quantity's unit. */
    times?: number[]
    /** points of a sketch, [s] and in the quantity's unit. */
    values?: number[]
    /** how sure the student is. */
    sure?: "" | "certain" | "fairly" | "guessing"
    /** index of the chosen reason, or None. */
    reason?: number | null
    /** the reason in the student's own words. */
    why?: string
}

/** One answer, as it was given: what was answered later is another one beside it.
 *
 * A student's progress, the record of a class, the grade, and what a learning platform is told are all read from these. */
export interface Given {
    /** what was answered: a prediction, by step, a question, by step and block, a second try (see `lessons.second_try`), or a
     * task, by its id. */
    item: string
    /** number of the answer to the item, from 1, or 2 for a second try; one that only repeats the answer before it is none. */
    attempt?: number
    /** seconds since 1970; 0 if unknown. */
    time?: number
    /** how often the item had been asked again by then; 0: never. */
    round?: number
    /** to a prediction or a quiz. */
    answer?: Answer | null
    /** to a question whose answer is a number; the value of a task that was passed, or 0. */
    number?: number | null
    /** in the student's own words; of a derivation, all rows so far. */
    text?: string
    /** whether it is right; null where that is not judged. */
    right?: boolean | null
    /** number of hints that had been shown. */
    hints?: number
    /** the way in which a task was passed, see `lessons.checks.way_of`; null: it is none. */
    way?: number | null
    /** whether the choice cannot be identified, because the lesson has changed. */
    lost?: boolean
    /** keys of the chosen option and reason; see `lessons.kept`. */
    mark?: string
    /** keys of the chosen option and reason; see `lessons.kept`. */
    why_mark?: string
    /** a number by which the browser knows the answer; one that comes again counts once. */
    key?: string
    /** versions of the lesson and of OnPath. */
    lesson?: string
    /** versions of the lesson and of OnPath. */
    product?: string
}

/** The same quantity of both robots over time, [s]. */
export interface Curves {
    times: number[]
    tracker: number[]
    follower: number[]
}

/** A line of each robot in a row: a number of a field. */
export interface RowLine {
    field: string
    /** index in the field. */
    at: number
    /** if that of the robot is not enough, else empty. */
    name: string
}

/** A quantity that can be plotted over time, for a page. */
export interface RowData {
    name: string
    /** what it is called where one chooses it. */
    menu: string
    /** what it is called at its axis. */
    label: string
    unit: string
    /** factor from SI to the unit. */
    scale: number
    /** the range that its axis has at least; if it `floats`, the size of this range, wherever. */
    least: [number, number]
    floats: boolean
    lines: RowLine[]
}

/** Whether a check is satisfied, and a sentence with the measured and the required value. */
export interface Verdict {
    passed: boolean
    words: string
    /** of the time that it must last, from 0 to 1; None if it has no duration. */
    share: number | null
    /** whether anything has been done in this run that it could judge. */
    begun: boolean
    /** when it was missed for good in this run, [s]; None if it was not. */
    broken: number | null
}
