// A task of a step, which shows how far it is done.

import { made } from "../core/dom"
import type { PageData, TaskData } from "../core/lesson_data"
import { general } from "../core/numbers"
import { localized, phrase } from "../core/words"
import type { Verdict } from "../core/shared_data"
import { passedTasks } from "../lessons/notes"
import type { Student } from "../lessons/student"

export class Task {
    private passedIn = -1 // number of the run
    private shown = ""

    constructor(
        private readonly page: PageData,
        private readonly element: HTMLElement,
        private readonly data: TaskData,
        private readonly student: Student,
        private readonly passed: () => void,
    ) {
        for (const hint of element.querySelectorAll<HTMLDetailsElement>("[data-hint]"))
            hint.addEventListener("toggle", () => {
                if (hint.open) student.reads(data.id, Number(hint.dataset["hint"]))
            })
        this.show([])
    }

    follow(): void {
        const before = passedTasks(this.student.notes)[this.data.id]
        const result = this.student.result(this.data)
        if (!result) return
        const passed = result.verdicts.every(verdict => verdict.passed)
        if (passed || this.passedIn !== result.run) this.show(result.verdicts)
        if (passed) this.passedIn = result.run
        if (passed && before === undefined) this.passed()
    }

    private show(verdicts: Verdict[]): void {
        const { page, element, data } = this
        const { best, way } = passedTasks(this.student.notes)[data.id] ?? { way: 0 }
        const passed = best === undefined ? "" : data.best ? `: ${localized(general(best, 3), page)}` : " "
        const text = JSON.stringify([verdicts, passed, way])
        if (text === this.shown) return
        this.shown = text
        const done = verdicts.every(verdict => verdict.passed)
        const lines = verdicts.map(verdict => lineOf(verdict, done))
        if (passed) lines.push(made("li", "right", `✓ ${phrase(page, "lesson.passed")}${passed.trim()}`))
        element.querySelector(".verdicts")!.replaceChildren(...lines)
        const whys = [...element.querySelectorAll<HTMLDetailsElement>(".after")]
        const told = passed ? whys.find(each => Number(each.dataset["way"]) === way) ?? whys[0] : undefined
        for (const each of whys) each.hidden = each !== told // closed: its title asks why
    }
}

/** A condition: open, met, or missed for good; nothing is met before anything was done. A bar fills while it must last. */
function lineOf({ passed, words, share, begun, broken }: Verdict, done: boolean): HTMLElement {
    const met = passed && (begun || done)
    const line = made("li", broken !== null ? "wrong" : met ? "right" : "", `${broken !== null ? "✗" : met ? "✓" : "○"} ${words}`)
    if (share === null || share === 1 || !begun) return line
    const filled = made("span", "")
    filled.style.width = `${100 * share}%`
    const bar = made("span", "share", filled)
    bar.ariaHidden = "true" // the words tell it
    line.append(bar)
    return line
}
