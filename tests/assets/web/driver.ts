// A page without layout, driven by tests in Python (tests/support/node_page.py): each line of the input is a request.

import { createInterface } from "node:readline"
import { runInThisContext } from "node:vm"
import { has as hasFeature } from "../../../assets/web/lessons/features"
import { lengthOf, products } from "../../../assets/web/simulation/fit"
import { motions } from "../../../assets/web/simulation/poles"
import { inkOf, resize, window } from "./page"

interface Request { open?: string; url?: string; evaluate?: string; argument?: unknown }

/** Numbers that JSON does not have, as objects. */
function packed(value: unknown): unknown {
    if (typeof value === "number" && (!Number.isFinite(value) || Object.is(value, -0))) return { number: Object.is(value, -0) ? "-0.0" : String(value) }
    if (ArrayBuffer.isView(value)) return Array.from(value as unknown as number[], packed)
    if (Array.isArray(value)) return value.map(packed)
    if (typeof value === "object" && value) return Object.fromEntries(Object.entries(value).map(([key, each]) => [key, packed(each)]))
    return value
}

async function answer({ open, url, evaluate, argument }: Request): Promise<unknown> {
    if (url) window.happyDOM.setURL(url)
    if (open !== undefined) {
        const scripts = [...open.matchAll(/<script(?![^>]*application\/json)[^>]*>([\s\S]*?)<\/script>/g)].map(found => found[1]!)
        window.document.write(open.replaceAll(/<script(?![^>]*application\/json)[^>]*>[\s\S]*?<\/script>/g, ""))
        for (const script of scripts) runInThisContext(script)
        return null
    }
    const value: unknown = runInThisContext(`(${evaluate})`)
    return packed(await (typeof value === "function" ? (value as (given: unknown) => unknown)(argument) : value))
}

// A page goes on after an error of its script.
const complaints: string[] = []
for (const event of ["uncaughtException", "unhandledRejection"]) process.on(event, error => complaints.push(String(error)))
Object.assign(globalThis, { complaints, hasFeature, inkOf, lengthOf, motions, products, resize })

let turn: Promise<void> = Promise.resolve()
createInterface({ input: process.stdin }).on("line", line => {
    turn = turn.then(async () => {
        try {
            process.stdout.write(`${JSON.stringify({ value: await answer(JSON.parse(line) as Request) })}\n`)
        } catch (error) {
            process.stdout.write(`${JSON.stringify({ error: String(error instanceof Error ? error.stack : error) })}\n`)
        }
    })
}).on("close", () => process.exit())
