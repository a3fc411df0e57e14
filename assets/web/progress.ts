// Keeps a student's progress in the browser; for a learning platform see scorm.ts.

import type { Grade } from "./grade"

/** Shows a message about what is kept, in the page's texts. */
export type Tell = (key: string, values?: Record<string, string>) => void

/** Texts by key, and reports on a lesson. */
export interface Progress {
    get(key: string): string | null
    set(key: string, value: string): void
    grade(grade: Grade): void
}

const PREFIX = "onpath."

/** In the browser's local storage, for all pages of the site; in memory where there is none, or no room. */
export class LocalProgress implements Progress {
    private readonly memory = new Map<string, string>()
    lost = false // whether nothing could be kept

    constructor(private readonly tell: Tell) {}

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
            this.tell("site.not_kept")
        }
    }

    grade(): void {}
}
