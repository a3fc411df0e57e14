// Where a student's progress is kept. A page in a learning platform has another place for it.

/** Texts by key, and what is told of the whole. */
export interface Progress {
    get(key: string): string | null
    set(key: string, value: string): void
    /** So much of the whole is done. */
    score(part: number, whole: number): void
    /** All is done that is not optional. */
    completed(): void
}

const PREFIX = "onpath."

/** In the browser's local storage, for all pages of the site; in memory where there is none. */
export class LocalProgress implements Progress {
    private readonly memory = new Map<string, string>()
    lost = false // whether nothing could be kept

    get(key: string): string | null {
        try {
            return localStorage.getItem(PREFIX + key) ?? this.memory.get(key) ?? null
        } catch {
            return this.memory.get(key) ?? null
        }
    }

    set(key: string, value: string): void {
        try {
            localStorage.setItem(PREFIX + key, value)
        } catch {
            this.lost = true
            this.memory.set(key, value)
        }
    }

    score(): void {}

    completed(): void {}
}
