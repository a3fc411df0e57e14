// The start page: the free lab, and the student's progress.

import { save } from "../core/dom"
import type { PageData } from "../core/lesson_data"
import { refused } from "../core/refusal"
import { phrase } from "../core/words"
import { Simulation } from "../simulation/simulation"
import { exported, forget, imported, notesOf } from "../lessons/notes"
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
        for (const element of document.querySelectorAll<HTMLElement>("[data-lesson]")) {
            const { steps, required, tasks } = this.page.lessons[element.dataset["lesson"]!]!
            const notes = notesOf(this.progress, element.dataset["lesson"]!)
            const passed = Object.keys(notes.tasks).length
            const counts = { done: String(notes.seen), all: String(steps), tasks: String(passed) }
            const finished = notes.seen >= required && tasks.every(id => id in notes.tasks)
            element.textContent = notes.seen ? `· ${finished ? "✓ " : ""}${phrase(this.page, "site.done", counts)}` : ""
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
