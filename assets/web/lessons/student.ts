// What a student has done in a lesson, and whether it is right.

import type { PageData, TaskData, Answer, Curves } from "../core/lesson_data"
import type { Given, Verdict } from "../core/shared_data"
import { judge, statistic, wayOf } from "./checks"
import { EarlierRun } from "./earlier"
import { blockOf, gradeOf, isRight } from "./grade"
import { keep, noted, notesOf, passedTasks, lastSaid, type Notes } from "./notes"
import type { Progress } from "./progress"
import type { Recorded } from "./recorded"

export interface Student {
    readonly notes: Notes
    /** Decides the order of options, which is always the same for a student. */
    readonly name: string
    /** Called whenever the notes have changed. */
    changed: () => void
    /** A step is open; the number after the last step is the end. */
    goes(step: number): void
    predicts(step: number, answer: Answer): void
    chooses(question: string, option: number): void
    gives(question: string, number: number): void
    writes(question: string, text: string): void
    /** One more row of a derivation. */
    derives(question: string, row: string): void
    /** A hint of a task is read, the first of which is number 1. */
    reads(task: string, hint: number): void
    /** A run was seen to its end; `asked` is the step of the prediction that it shows. */
    sees(step: number, asked: number, truth: Curves): void
    /** What has become of the answer to a prediction, by its step, or to a question, by step and block; empty where none is
     * sent anywhere. */
    way(item: string): "" | "sending" | "sent"
    /** How far a task is done in the present run; null if that is unknown. */
    result(task: TaskData): Result | null
}

export interface Result {
    verdicts: Verdict[]
    /** Number of the run, from its beginning to a reset. */
    run: number
}

/** Notes in this browser or a learning platform, and the checks of this page. */
export class LocalStudent implements Student {
    readonly notes: Notes
    readonly name: string
    private about: Recorded | null = null
    private earlier = new EarlierRun()
    changed: () => void = () => {}

    constructor(private readonly page: PageData, private readonly progress: Progress) {
        this.notes = notesOf(progress, page.lesson)
        this.name = progress.get("student") ?? crypto.getRandomValues(new Uint32Array(2)).join("-")
        progress.set("student", this.name)
    }

    /** What the tasks are about. */
    set recorded(recorded: Recorded | null) {
        this.about = recorded
        this.earlier = new EarlierRun()
    }

    /** The tasks are about another robot now, and what was measured before counts on. */
    goesOn(recorded: Recorded): void {
        this.about = recorded
    }

    goes(step: number): void {
        const { notes, page } = this
        notes.step = step
        notes.seen = Math.max(notes.seen, Math.min(step + 1, page.steps.length))
        this.save()
    }

    predicts(step: number, answer: Answer): void {
        this.give(String(step), { answer })
    }

    chooses(question: string, option: number): void {
        this.give(question, { answer: { option } })
    }

    gives(question: string, number: number): void {
        this.give(question, { number })
    }

    writes(question: string, text: string): void {
        this.give(question, { text })
    }

    derives(question: string, row: string): void {
        const before = lastSaid(this.notes, question)
        this.writes(question, before ? `${before}\n${row}` : row)
    }

    reads(task: string, hint: number): void {
        const { hints } = this.notes
        if (hint <= (hints[task] ?? 0)) return
        hints[task] = hint
        this.save()
    }

    sees(step: number, asked: number, truth: Curves): void {
        this.notes.truths[String(asked)] = truth
        this.notes.played[String(step)] = true
        this.save()
    }

    way(): "" { return "" }

    result({ checks, ways, id, best }: TaskData): Result | null {
        if (!checks || !this.about) return null
        const record = this.about.record(this.earlier.values)
        this.earlier.follow(record, checks, this.page.words)
        const verdicts = judge(checks, record, this.page.words)
        if (verdicts.every(verdict => verdict.passed)) {
            const all = record.times.map(() => true)
            const value = best ? (statistic(record, "follower", best, "max", all) ?? 0) : 0
            this.pass(id, value, wayOf(ways ?? [], record, this.page.words))
        }
        return { verdicts, run: record.run }
    }

    /** One more answer; see `noted`. */
    private give(item: string, event: Partial<Given>): void {
        const { page, notes, progress } = this, block = blockOf(page.steps, item)
        const right = event.way === undefined ? block && isRight(block, { item, ...event }) : true
        const { version = "", product = "" } = page
        const given = noted(notes, {
            item, time: Math.round(Date.now()) / 1000, ...event, ...(right === null ? {} : { right }),
            ...(notes.hints[item] ? { hints: notes.hints[item] } : {}), lesson: version, product,
        })
        if (given) progress.tell(page.lesson, given, block)
        this.save()
    }

    save(): void {
        const { page, notes, progress } = this
        keep(progress, page.lesson, notes)
        progress.grade(gradeOf(page.steps, notes))
        this.changed()
    }

    /** A task is passed in a way, with a value of which the least is kept. */
    private pass(task: string, value: number, way: number): void {
        const before = passedTasks(this.notes)[task], best = before?.best ?? Infinity
        if (before && value >= best && way === before.way) return
        this.give(task, { number: Math.min(best, Math.round(1e3 * value) / 1e3), way })
    }
}
