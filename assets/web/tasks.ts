// The tasks of a step, checked against its record twice a second.

import { made } from "./controls"
import { judge, statistic, type Verdict } from "./checks"
import type { PageData, TaskData } from "./lesson_data"
import { said } from "./words"
import type { Notes } from "./notes"
import { general } from "./numbers"
import type { Recorded } from "./recorded"

export class Task {
    private passedIn = -1 // number of the run
    private shown = ""

    constructor(
        private readonly page: PageData,
        private readonly element: HTMLElement,
        private readonly data: TaskData,
        private readonly notes: Notes,
        private readonly changed: (line: string) => void,
    ) {
        this.show([])
    }

    follow(simulation: Recorded): void {
        if (!this.data.checks) return
        const record = simulation.record()
        const verdicts = judge(this.data.checks, record, this.page.words)
        const passed = verdicts.every(verdict => verdict.passed)
        if (passed) this.pass(simulation)
        if (passed || this.passedIn !== record.run) this.show(verdicts)
        if (passed) this.passedIn = record.run
    }

    private pass(simulation: Recorded): void {
        const { tasks } = this.notes
        const { best, id } = this.data
        const record = simulation.record()
        const value = best ? (statistic(record, "follower", best, "max", record.times.map(() => true)) ?? 0) : 0
        const first = tasks[id] === undefined
        if (!first && value >= tasks[id]!) return
        tasks[id] = Math.round(1e3 * value) / 1e3
        this.changed(first ? said(this.page, "lesson.passed") : "")
    }

    private show(verdicts: Verdict[]): void {
        const { page, element, data, notes } = this
        const best = notes.tasks[data.id]
        const passed = best === undefined ? "" : data.best ? `: ${general(best, 3).replace(".", page.words["point"]!)}` : " "
        const text = JSON.stringify([verdicts, passed])
        if (text === this.shown) return
        this.shown = text
        const lines = verdicts.map(verdict => made("li", verdict.passed ? "right" : "", `${verdict.passed ? "✓" : "○"} ${verdict.words}`))
        if (passed) lines.push(made("li", "right", `✓ ${said(page, "lesson.passed")}${passed.trim()}`))
        element.querySelector(".verdicts")!.replaceChildren(...lines)
        const why = element.querySelector<HTMLDetailsElement>(".after")
        if (why) why.hidden = !passed
        if (why && passed) why.open = true
    }
}
