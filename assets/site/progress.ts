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

/** In the browser's local storage, for all pages of the site. */
export class LocalProgress implements Progress {
    get(key: string): string | null {
        return localStorage.getItem(PREFIX + key)
    }

    set(key: string, value: string): void {
        localStorage.setItem(PREFIX + key, value)
    }

    score(): void {}

    completed(): void {}
}
