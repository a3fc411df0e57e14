// What has been typed or drawn but not committed: kept in this tab of the browser, so that it survives a reload.

import { recalled, remember } from "./memory"

let owner = "" // code of the lab whose drafts these are; empty on a page without a server

/** From now on, drafts are those of a lab: whoever uses the tab next has another one. */
export function keepDraftsOf(lab: string): void {
    owner = lab
}

/** The draft of a name, or null. A browser's storage is not trusted: what is not an object is no draft. */
export function draftOf<T extends object>(name: string): Partial<T> | null {
    const kept = recalled(entryOf(name), "sessionStorage")
    return kept !== null && typeof kept === "object" ? kept : null
}

/** Keep a draft; null forgets it. */
export function keepDraft(name: string, draft: object | null): void {
    remember(entryOf(name), draft, "sessionStorage")
}

/** Begin where a new element was scrolled to, also by a page before this one, and keep where it is from now on.
 * @param of what it shows: elsewhere it begins at the top */
export function keepScroll(element: HTMLElement, name: string, of = ""): void {
    const draft = draftOf<{ of: string; top: number }>(name)
    const keep = (top: number) => keepDraft(name, { of, top })
    const top = draft?.of === of ? Number(draft.top) || 0 : 0
    if (top) element.scrollTop = top // which lays the page out
    keep(top) // what was read before this begins at its top again
    element.addEventListener("scroll", () => keep(element.scrollTop), { passive: true })
}

function entryOf(name: string): string {
    return `onpath-draft ${owner} ${name}`
}
