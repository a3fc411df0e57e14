// Keeps a student's progress in the browser; for a learning platform see scorm.ts.

import type { Given } from "../core/shared_data"
import type { BlockData } from "../core/lesson_data"

/** Shows a message about what is kept, in the page's texts. */
export type Tell = (key: string, values?: Record<string, string>) => void

/** Shares, from 0 to 1; optional steps and tasks to be found by trying do not count. */
export interface Grade {
    /** The share of parts that are done: steps opened, runs seen to their end, predictions
     * committed, questions answered, tasks passed. */
    progress: number
    /** The share of quizzes, numbers and tasks that are right; null before one of them was answered or passed. A right second
     * answer counts half; a task may be tried until it is passed, and counts nothing after its last hint, the recipe. */
    score: number | null
}

/** Texts by key, and reports on a lesson. */
export interface Progress {
    get(key: string): string | null
    set(key: string, value: string): void
    grade(grade: Grade): void
    /** An answer was given to a part of a lesson; of a task the part is not known. */
    tell(lesson: string, given: Given, block?: BlockData): void
}

const PREFIX = "onpath."

/** In the browser's local storage, for all pages of the site; in memory where there is none, or no room. */
export class LocalProgress implements Progress {
    private readonly memory = new Map<string, string>()
    lost = false // whether nothing could be kept

    constructor(private readonly say: Tell) {}

    get(key: string): string | null {
        try {
            return this.memory.get(key) ?? localStorage.getItem(PREFIX + key)
        } catch {
            return null
        }
    }

    set(key: string, value: string): void {
        try {
            localStorage.setItem(PREFIX + key, value)
            this.memory.delete(key)
        } catch {
            this.lost = true
            this.memory.set(key, value)
            this.say("site.not_kept")
        }
    }

    grade(): void {}
    tell(): void {}
}
