// Keeps progress in a learning platform, through the run-time of SCORM 1.2 or SCORM 2004.

import type { Given } from "../core/shared_data"
import type { BlockData, Package } from "../core/lesson_data"
import { packed, unpacked } from "../core/packed"
import { parsed } from "./notes"
import type { Grade, Progress, Tell } from "./progress"

type Api = Record<string, ((...values: string[]) => unknown) | undefined>
const DATA = "cmi.suspend_data"
const NAMES = {
    "1.2": {
        api: "API", verb: "LMS", end: "Finish", core: "cmi.core.", mode: "cmi.core.lesson_mode", room: 4096,
        status: "cmi.core.lesson_status", scaled: "", progress: "",
        time: "time", response: "student_response", wrong: "wrong", longest: 255, text: "fill-in", task: "performance",
    },
    "2004": {
        api: "API_1484_11", verb: "", end: "Terminate", core: "cmi.", mode: "cmi.mode", room: 64000,
        status: "cmi.completion_status", scaled: "cmi.score.scaled", progress: "cmi.progress_measure",
        time: "timestamp", response: "learner_response", wrong: "incorrect", longest: 4000, text: "long-fill-in", task: "other",
    },
}
export class ScormProgress implements Progress {
    private kept: Record<string, unknown> = {}
    private open = false // whether there is a session
    private records = false // false in a review
    private credit = false // whether a score is wanted

    private constructor(
        private readonly names: (typeof NAMES)[Package["version"]],
        private readonly api: Api,
        private readonly scoresParts: boolean,
        private readonly say: Tell,
    ) {
        this.begin()
        this.kept = { ...(unpacked(this.value(DATA)) as object | undefined) }
        addEventListener("pagehide", () => this.end())
        addEventListener("pageshow", event => {
            if (!event.persisted) return // it comes back from the browser's cache, after its session has ended
            this.begin()
            this.keep()
        })
    }

    /** Null if there is no platform around this page. */
    static found({ version, partial }: Package, tell: Tell): ScormProgress | null {
        const { api } = NAMES[version]
        const found = apiOf(window, api) ?? apiOf(window.opener as Window | null, api)
        if (!found) tell("site.no_platform")
        return found && new ScormProgress(NAMES[version], found, partial, tell)
    }

    get(key: string): string | null {
        const value = this.kept[key] ?? null
        return value === null || typeof value === "string" ? value : JSON.stringify(value)
    }

    set(key: string, value: string): void {
        this.kept[key] = parsed(value) ?? value
        this.keep()
    }

    /** A score never decreases, and what is passed or completed remains so. An unfinished lesson gets none, unless the
     * teacher wants that. */
    grade({ progress, score }: Grade): void {
        const { names } = this
        if (this.credit) {
            const points = Math.round(100 * (score ?? NaN))
            if ((progress === 1 || this.scoresParts) && this.raises(`${names.core}score.raw`, points)) {
                this.ask("SetValue", `${names.core}score.min`, "0") // a platform need not take these two
                this.ask("SetValue", `${names.core}score.max`, "100")
                this.put(`${names.core}score.raw`, String(points))
                if (names.scaled) this.put(names.scaled, (points / 100).toFixed(2))
            }
            if (names.progress && this.raises(names.progress, progress)) this.put(names.progress, progress.toFixed(4))
            if (progress === 1) this.status("completed", ["passed", "completed"])
        }
        this.checked("Commit", "")
    }

    /** The platform gets each answer when it is given, as an interaction; it need not take any. */
    tell(lesson: string, given: Given, block?: BlockData): void {
        const { names } = this, count = this.value("cmi.interactions._count")
        if (!this.credit || !/^\d+$/.test(count)) return
        const { item, attempt = 1, time = 0, answer, number, text, right, hints, lesson: version, product } = given
        const drawn = answer?.times?.map((at, i) => `${Number(at.toFixed(2))} ${Number(answer.values![i]!.toFixed(2))}`).join(", ")
        const { option } = answer ?? {}, counts = block?.kind !== "choice" && !(block && "uncounted" in block && block.uncounted)
        const response = typeof option === "number" ? String(option) : drawn ?? text ?? (typeof number === "number" ? String(number) : "")
        const at = new Date(1000 * time), type = typeof option === "number" ? "choice" : !block ? names.task : block.kind === "number" ? "numeric" : names.text
        const put = (name: string, value: string) => this.ask("SetValue", `cmi.interactions.${count}.${name}`, value)
        put("id", `${lesson}.${item}.${attempt}`)
        put("type", type)
        put(names.time, names.scaled ? `${at.toISOString().slice(0, 19)}Z` : at.toTimeString().slice(0, 8))
        if (response) put(names.response, Array.from(response).slice(0, names.longest).join(""))
        put("result", !counts || typeof right !== "boolean" ? "neutral" : right ? "correct" : names.wrong)
        if (names.scaled) put("description", JSON.stringify({ hints: hints ?? 0, sure: answer?.sure ?? "", lesson: version, product }))
    }

    private begin(): void {
        this.open = true
        this.open = this.checked("Initialize", "")
        this.records = this.open && !["review", "browse"].includes(this.value(this.names.mode))
        this.credit = this.records && this.value(`${this.names.core}credit`) !== "no-credit"
        if (this.open && !this.records) this.say("site.review")
        if (this.records) this.put(`${this.names.core}exit`, "suspend") // a lesson may be left and resumed
        if (this.credit) this.status("incomplete", ["passed", "completed", "failed"])
    }

    private end(): void {
        this.ask(this.names.end, "")
        this.open = this.records = this.credit = false
    }

    private keep(): void {
        if (!this.records) return
        const found = packed(this.kept, this.names.room)
        if (!found) return this.say("site.no_room")
        if (found.cut) this.say("site.cut", { most: String(this.names.room) })
        this.put(DATA, found.text)
    }

    private status(status: string, unless: string[]): void {
        if (!unless.includes(this.value(this.names.status))) this.put(this.names.status, status)
    }

    private readonly value = (name: string): string => this.ask("GetValue", name)
    private readonly put = (name: string, value: string): boolean => this.checked("SetValue", name, value)
    private readonly raises = (name: string, value: number): boolean => value >= Number(this.value(name))
    /** Whether it succeeded; if the platform refuses, the page says why. */
    private checked(verb: string, ...values: string[]): boolean {
        if (!this.open) return false
        if (this.ask(verb, ...values) !== "false") return true
        const code = this.ask("GetLastError")
        this.say("site.refused", { reason: `${this.ask("GetErrorString", code)} (${code})` })
        return false
    }

    /** The platform's answer; empty without a session, "false" if it fails. */
    private ask(verb: string, ...values: string[]): string {
        try {
            return this.open ? String(this.api[this.names.verb + verb]!(...values)) : ""
        } catch (error) {
            console.error(error)
            return "false"
        }
    }
}

/** The platform's object in a window or in one that encloses it; null if that is another site's. */
function apiOf(page: Window | null, name: string, deep = 10): Api | null {
    try {
        if (!page || !deep) return null
        const found = (page as unknown as Record<string, Api | undefined>)[name]
        return found ?? (page.parent === page ? null : apiOf(page.parent, name, deep - 1))
    } catch { return null }
}
