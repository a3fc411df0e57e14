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

function entryOf(name: string): string {
    return `onpath-draft ${owner} ${name}`
}
