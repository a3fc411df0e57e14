// What the server of a lab says of a lesson; see app/viser_adapter/README.md.

import type { Answer, Curves, Script, SketchData, StepData } from "../core/lesson_data"
import type { Verdict } from "../lessons/checks"
import type { Notes } from "../lessons/notes"

export interface LabMessage { is: string }

/** The open step of a lesson, or its end; without a lesson, `lesson` is empty. */
export interface LessonMessage extends LabMessage {
    is: "lesson"
    lesson: string
    version: number
    index: number
    ended: boolean
    test: boolean
    playing: boolean
    symbols: Record<string, string>
    /** HTML of what stands above and below the text, and of the steps by index. */
    head: string
    pager: string
    sections: Record<string, string>
    steps: StepData[]
    notes?: Notes
    charts?: { data: SketchData; script: Script | null; answer: Answer; truth: Curves | null }[]
}

/** What is measured in the open step. */
export interface MeasuredMessage extends LabMessage {
    is: "measured"
    verdicts: Record<string, Verdict[]>
    truth: Curves | null
}
