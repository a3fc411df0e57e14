// The start page: the free lab, and the student's progress.

import { save } from "../core/dom"
import type { PageData } from "../core/lesson_data"
import { nextLesson } from "../core/next_lesson"
import { refused } from "../core/refusal"
import { phrase } from "../core/words"
import { Simulation } from "../simulation/simulation"
import { exported, forget, imported, notesOf, passedTasks } from "../lessons/notes"
import type { LocalProgress } from "../lessons/progress"
import { Figure } from "./figure"
import { kernelsOf } from "./stage"

const LARGEST = 5_000_000 // [B] of a progress file

export class StartPage {
    figure: Figure | null = null

    constructor(private readonly page: PageData, private readonly progress: LocalProgress) {
        void this.begin()
        this.show()
        this.button("save", () => this.save())
        this.button("forget", () => {
            if (!confirm(phrase(page, "site.forget_sure"))) return
            forget(progress, page)
            this.told("site.forgotten")
        })
        document.querySelector<HTMLInputElement>("#read")!.addEventListener("change", event => {
            void this.read(event.target as HTMLInputElement)
        })
    }

    private async begin(): Promise<void> {
        const data = this.page.figures[0]!
        const place = document.querySelector<HTMLElement>(".stage")!
        try {
            const simulation = new Simulation(data, await kernelsOf(data.module))
            this.figure = new Figure(simulation, place)
        } catch (error) {
            place.replaceChildren(refused(data, error))
        }
    }

    private readonly button = (name: string, act: () => void) => document.getElementById(name)!.addEventListener("click", act)
    private show(): void {
        const lessons = Object.entries(this.page.lessons).map(([name, { number, steps, required, tasks }]) => {
            const notes = notesOf(this.progress, name), best = passedTasks(notes)
            const done = Math.min(notes.seen, required) + tasks.filter(id => id in best).length
            const all = required + tasks.length, count = Object.keys(best).length
            return { name, number, seen: notes.seen, steps, count, done: done / all, finished: done === all }
        })
        const next = nextLesson(lessons)
        for (const lesson of lessons) {
            const { name, seen, steps, count, done, finished } = lesson
            const counts = phrase(this.page, "site.done", { done: String(seen), all: String(steps), tasks: String(count) })
            const told = (kind: string) => document.querySelector<HTMLElement>(`[data-${kind}="${name}"]`)!
            told("lesson").textContent = seen ? `· ${finished ? "✓ " : ""}${counts}` : ""
            const bar = told("done") as HTMLProgressElement
            bar.hidden = !seen
            bar.value = done
            told("here").textContent = lesson === next ? phrase(this.page, seen ? "lesson.go_on_here" : "lesson.begin_here") : ""
        }
    }

    private save(): void {
        save("onpath-progress.json", new Blob([exported(this.progress, this.page)], { type: "application/json" }))
    }

    private async read(input: HTMLInputElement): Promise<void> {
        const file = input.files?.[0]
        if (!file) return
        const good = file.size <= LARGEST && imported(this.progress, this.page, await file.text())
        input.value = ""
        this.told(good ? "site.read_done" : "site.no_progress")
    }

    private told(key: string): void {
        document.querySelector("#told")!.textContent = phrase(this.page, this.progress.lost ? "site.not_kept" : key)
        this.show()
    }
}
