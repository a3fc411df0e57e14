// What the browser remembers for a page, as JSON; without storage, as in a sandboxed frame, that is nothing.

/** `sessionStorage` is this tab's alone, and ends with it. */
type StorageName = "localStorage" | "sessionStorage"

/** What is remembered under a name, whoever has put it there; null: nothing. */
export function recalled(name: string, storage: StorageName = "localStorage"): unknown {
    try {
        return JSON.parse(window[storage].getItem(name) ?? "null") as unknown
    } catch {
        return null // without storage, or not ours
    }
}

/** Remember a value; null forgets it. */
export function remember(name: string, value: object | null, storage: StorageName = "localStorage"): void {
    try {
        if (value === null) window[storage].removeItem(name)
        else window[storage].setItem(name, JSON.stringify(value))
    } catch {} // without storage it lasts as long as the page
}
