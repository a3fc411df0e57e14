// The settings of a lab: what it has told of them, and what is on its way to it.

import type { ValuesMessage } from "../core/form_data"
import type { SetField } from "./messages"

const PERIOD = 110 // [ms], least time between two messages of a setting: a drag of 5 s sends at most 50
const AGAIN = 1000 // [ms] after which a message that was not answered is sent again

type Value = ValuesMessage["values"][string]

export class RemoteSettings {
    private values: Record<string, Value> = {}
    private refusals: Record<string, string> = {}
    private readonly next = new Map<string, Value>() // to be sent
    private readonly last = new Map<string, number>() // when a setting was sent
    private readonly sent = new Map<string, SetField>() // and not answered
    private number = 0
    private timer: ReturnType<typeof setTimeout> | undefined

    constructor(private readonly send: (message: SetField) => void) {}

    readonly value = (name: string): Value | undefined => this.values[name]
    readonly refused = (name: string): string => this.refusals[name] ?? ""
    /** Whether the last value that was set may be newer than what the lab has told. */
    readonly waits = (name: string): boolean => this.next.has(name) || this.sent.has(name)

    /** Set a value: at once, or as soon as the last message of this setting is old enough. */
    set(name: string, value: Value): void {
        this.next.set(name, value)
        this.flush()
    }

    /** What the lab has told. */
    hear({ values, refused = {}, heard = {} }: ValuesMessage): void {
        Object.assign(this.values, values)
        for (const [name, why] of Object.entries(refused)) {
            if (why) this.refusals[name] = why
            else delete this.refusals[name]
        }
        for (const [name, number] of Object.entries(heard)) if (number >= (this.sent.get(name)?.number ?? Infinity)) this.sent.delete(name)
    }

    /** A new connection: nobody knows what came through the last one. */
    connected(): void {
        for (const [name, { value }] of this.sent) this.again(name, value)
        this.last.clear()
        this.flush()
    }

    private again(name: string, value: Value): void {
        if (!this.next.has(name)) this.next.set(name, value)
    }

    private flush(): void {
        clearTimeout(this.timer)
        const now = performance.now()
        const due = (name: string, wait: number) => (this.last.get(name) ?? -Infinity) + wait - now
        for (const [name, { value }] of this.sent) if (due(name, AGAIN) <= 0) this.again(name, value)
        for (const [name, value] of this.next) {
            if (due(name, PERIOD) > 0) continue
            this.next.delete(name)
            this.last.set(name, now)
            const message: SetField = { is: "set", name, value, number: ++this.number }
            this.sent.set(name, message)
            this.send(message)
        }
        const waits = [...[...this.next.keys()].map(name => due(name, PERIOD)), ...[...this.sent.keys()].map(name => due(name, AGAIN))]
        if (waits.length) this.timer = setTimeout(() => this.flush(), Math.max(1, Math.min(...waits)))
    }
}
