// Progress in a learning platform, by the run-time of SCORM 1.2 or of SCORM 2004.

import { parsed } from "./notes"
import type { Progress } from "./progress"
type Api = Record<string, (...values: string[]) => string>
const DATA = "cmi.suspend_data"
const MEASURES = ["cmi.score.scaled", "cmi.progress_measure"]
const NAMES = {
    "1.2": { api: "API", verb: "LMS", end: "Finish", core: "cmi.core.", status: "cmi.core.lesson_status", most: 4096, measures: [] as string[] },
    "2004": { api: "API_1484_11", verb: "", end: "Terminate", core: "cmi.", status: "cmi.completion_status", most: 64000, measures: MEASURES },
}
/** What is left out where there is no room for it: a run can be seen again, a curve drawn again. */
const LEFT_OUT = [[], ["truths"], ["truths", "times", "values"], ["truths", "times", "values", "why", "written"]]

export class ScormProgress implements Progress {
    private kept: Record<string, unknown>
    private readonly call = (verb: string, ...values: string[]): string => this.api[this.names.verb + verb]!(...values)
    private constructor(private readonly names: (typeof NAMES)[keyof typeof NAMES], private readonly api: Api) {
        this.call("Initialize", "")
        this.kept = { ...(parsed(this.call("GetValue", DATA)) as object | null) }
        this.call("SetValue", `${this.names.core}exit`, "suspend") // a lesson may be left, and gone on with
        if (this.call("GetValue", this.names.status) !== "completed") this.call("SetValue", this.names.status, "incomplete")
        addEventListener("pagehide", () => this.call(names.end, ""), { once: true })
    }

    static found(version: keyof typeof NAMES): ScormProgress | null {
        const found = apiOf(window, NAMES[version].api) ?? apiOf(window.opener as Window | null, NAMES[version].api)
        return found && new ScormProgress(NAMES[version], found)
    }

    get(key: string): string | null {
        const value = this.kept[key] ?? null
        return value === null || typeof value === "string" ? value : JSON.stringify(value)
    }

    set(key: string, value: string): void {
        this.kept[key] = parsed(value) ?? value
        const texts = LEFT_OUT.map(names => JSON.stringify(this.kept, (name, own) => (names.includes(name) ? undefined : own)))
        const text = texts.find(each => each.length <= this.names.most)
        if (text) this.call("SetValue", DATA, text)
        this.call("Commit", "")
    }

    score(part: number, whole: number): void {
        const share = whole ? part / whole : 0
        const points = Object.entries({ min: 0, max: 100, raw: Math.round(100 * share) })
        for (const [name, value] of points) this.call("SetValue", `${this.names.core}score.${name}`, String(value))
        for (const name of this.names.measures) this.call("SetValue", name, share.toFixed(4))
        this.call("Commit", "")
    }

    completed(): void {
        this.call("SetValue", this.names.status, "completed")
        this.call("Commit", "")
    }
}

/** The platform's object, in a page or in one around it; null in another site's page. */
function apiOf(page: Window | null, name: string, deep = 10): Api | null {
    try {
        if (!page || !deep) return null
        const found = (page as unknown as Record<string, Api | undefined>)[name]
        return found ?? (page.parent === page ? null : apiOf(page.parent, name, deep - 1))
    } catch { return null }
}
