// What has been typed or drawn but not committed: kept in this tab of the browser, so that it survives a reload.

const PREFIX = "onpath-draft "

/** The draft of a name, or null. A browser's storage is not trusted: what is not an object is no draft. */
export function draftOf<T extends object>(name: string): Partial<T> | null {
    try {
        const kept: unknown = JSON.parse(sessionStorage.getItem(PREFIX + name) ?? "null")
        return kept !== null && typeof kept === "object" ? kept : null
    } catch {
        return null // without storage, or not ours
    }
}

/** Keep a draft; null forgets it. */
export function keepDraft(name: string, draft: object | null): void {
    try {
        if (draft === null) sessionStorage.removeItem(PREFIX + name)
        else sessionStorage.setItem(PREFIX + name, JSON.stringify(draft))
    } catch {} // without storage a reload loses it
}
