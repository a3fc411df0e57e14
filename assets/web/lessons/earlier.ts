// Values measured earlier: in the run before, and once in a step; see lessons/measures/earlier_run.py.

import type { Check, Once } from "../core/lesson_data"
import { happens, keeps, measured, type RunRecord } from "./checks"

export class EarlierRun {
    readonly values = new Map<Check, number>()
    private now = new Map<Check, number>()
    private run = -1
    private readonly undone = new Map<Once, number>()

    /** Measure the present run; to be called repeatedly until the run is reset. */
    follow(record: RunRecord, checks: readonly Check[], words: Record<string, string>): void {
        if (record.run !== this.run) {
            for (const [check, value] of this.now) this.values.set(check, value)
            this.run = record.run
            this.now = new Map()
        }
        for (const check of checks) {
            if (check.kind === "once") this.followOnce(check, record, words)
            if (check.kind !== "better") continue
            const value = measured(check, record)
            if (value !== null) this.now.set(check, value)
        }
    }

    private followOnce(check: Once, record: RunRecord, words: Record<string, string>): void {
        const counts = check.since.map(wanted => record.happenings.filter(each => happens(each, wanted)).length)
        const undone = counts.reduce((sum, each) => sum + each, 0)
        if (undone !== (this.undone.get(check) ?? 0)) {
            this.undone.set(check, undone)
            this.values.delete(check)
        }
        const value = keeps(check, record, words)
        if (value !== null) this.values.set(check, value)
    }
}
