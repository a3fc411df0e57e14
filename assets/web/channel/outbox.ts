// Answers on their way: the browser keeps them until the lab has stored them, and sends them again after any loss of the
// connection, the process or the page. Each has a key, by which it counts once.

import { recalled, remember } from "../core/memory"
import { SECOND_TRY } from "../lessons/notes"
import type { Command } from "./messages"

/** An answer, with the step that asked for it. */
export type AnswerCommand = Extract<Command, { lesson?: string; key?: string }>
type Kept = AnswerCommand & { lesson: string; step: number; key: string }

const MOST = 50 // answers that are kept; further ones take the place of the first
const AGAIN = 4000 // [ms] after which an answer that is not stored is sent again

export class Outbox {
    private lab = ""
    private kept: Kept[] = []
    private timer = 0

    constructor(private readonly send: (command: Command) => void, private readonly changed: () => void) {}

    /** The answers are those of a lab, which has just been reached. */
    reach(lab: string): void {
        const entry = entryOf(lab), before = recalled(entry)
        const others = Array.isArray(before) ? (before as unknown[]).filter(isKept) : []
        const own = this.lab === lab ? this.kept : []
        this.lab = lab
        this.kept = [...others.filter(({ key }) => own.every(each => each.key !== key)), ...own]
        this.sendAll()
    }

    /** Send an answer, and keep it until it is stored. */
    post(answer: AnswerCommand, lesson: string, step: number): void {
        const key = Array.from(crypto.getRandomValues(new Uint8Array(12)), each => each.toString(16).padStart(2, "0")).join("")
        const kept = { ...answer, lesson, step, key }
        this.kept = [...this.kept, kept].slice(-MOST)
        this.keep()
        this.send(kept)
        this.wait()
    }

    /** These are stored. */
    settle(keys: readonly string[]): void {
        const left = this.kept.filter(({ key }) => !keys.includes(key))
        if (left.length === this.kept.length) return
        this.kept = left
        this.keep()
        this.changed()
    }

    /** Whether an answer to a prediction (by its step) or to a question (by step and block) is on its way. */
    has(lesson: string, item: string): boolean {
        return this.kept.some(each => each.lesson === lesson && itemOf(each) === item)
    }

    private sendAll(): void {
        for (const each of this.kept) this.send(each)
        this.wait()
    }

    private wait(): void {
        clearTimeout(this.timer)
        if (this.kept.length) this.timer = window.setTimeout(() => this.sendAll(), AGAIN)
    }

    private keep(): void {
        remember(entryOf(this.lab), this.kept.length ? this.kept : null)
    }
}

function itemOf(answer: Kept): string {
    const second = "second" in answer && answer.second ? SECOND_TRY : ""
    return "block" in answer ? `${answer.step}.${answer.block}${second}` : String(answer.step)
}

function entryOf(lab: string): string {
    return `onpath-sending ${lab}`
}

/** A browser's storage is not trusted; the lab judges what it is sent. */
function isKept(each: unknown): each is Kept {
    if (typeof each !== "object" || each === null) return false
    const { do: name, lesson, step, key } = each as Record<string, unknown>
    return typeof name === "string" && typeof lesson === "string" && typeof step === "number" && typeof key === "string"
}
