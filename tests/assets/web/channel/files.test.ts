import "../page"
import assert from "node:assert/strict"
import { test } from "node:test"
import { Files, type Download } from "../../../../assets/web/channel/files"
import type { DownloadMessage, FileMessage, PageMessage, SendFile } from "../../../../assets/web/channel/messages"
import { chance } from "../random"

const PATH = { kind: "path" } as const

/** A server that takes files in parts. */
class Server {
    readonly heard: PageMessage[] = []
    content = ""
    private file: SendFile | null = null
    readonly files = new Files(message => {
        this.heard.push(message)
        queueMicrotask(() => this.take(message))
    })

    constructor(private readonly refuses = "", private readonly loses = -1) {}

    private answer(message: Omit<FileMessage, "is" | "lines" | "part" | "helps" | "columns" | "quantities">): void {
        this.files.hear({ is: "file", lines: [], helps: [], columns: [], quantities: [], ...message })
    }

    private take(message: PageMessage): void {
        if (message.is === "send") {
            this.file = message
            this.content = ""
            const state = this.refuses ? "refused" : message.size ? "awaited" : "used"
            this.answer({ number: message.number, state, received: 0, why: this.refuses })
        } else if (message.is === "part") {
            if (this.heard.length === this.loses) return this.files.restart() // the connection was lost
            assert.equal(message.number, this.file!.number)
            assert.ok(message.content.length <= 180_000)
            this.content += atob(message.content)
            const { length: received } = this.content
            if (received < this.file!.size) this.answer({ number: message.number, state: "awaited", received, why: "" })
            else for (const state of ["reading", "used"] as const) this.answer({ number: message.number, state, received, why: "" })
        }
    }
}

function random(size: number): Uint8Array<ArrayBuffer> {
    const draw = chance(size)
    return Uint8Array.from({ length: size }, () => Math.floor(256 * draw()))
}

function text(bytes: Uint8Array): string {
    return [...bytes].map(each => String.fromCharCode(each)).join("")
}

test("a file arrives as it is, part by part, with its progress", async () => {
    for (const size of [0, 1, 95_999, 96_000, 96_001, 400_000]) {
        const server = new Server(), content = random(size), shares: number[] = []
        const { why } = await server.files.send(new File([content], "a.csv"), PATH, share => shares.push(share))
        assert.equal(why, "")
        assert.equal(server.content, text(content))
        assert.deepEqual(shares, [...shares].sort((a, b) => a - b))
        assert.equal(shares.at(-1), 1)
    }
})

test("a refused file says why", async () => {
    assert.equal((await new Server("too large").files.send(new File(["abc"], "a"), PATH)).why, "too large")
})

test("a file whose connection is lost is sent anew", async () => {
    const server = new Server("", 3), content = random(200_000)
    assert.equal((await server.files.send(new File([content], "a"), PATH)).state, "used")
    assert.equal(server.content, text(content))
    assert.equal(server.heard.filter(each => each.is === "send").length, 2)
    assert.ok(server.heard.some(each => each.is === "drop"))
})

test("a second file takes the place of the first, and a file can be given up", async () => {
    const server = new Server(), [one, other] = [random(300_000), random(100_000)]
    const first = server.files.send(new File([one], "one"), PATH)
    const second = server.files.send(new File([other], "other"), PATH)
    assert.deepEqual((await Promise.all([first, second])).map(({ state }) => state), ["", "used"])
    assert.equal(server.content, text(other))
    const stopped = new AbortController()
    const third = server.files.send(new File([one], "one"), PATH, () => stopped.abort(), stopped.signal)
    assert.equal((await third).state, "")
    assert.notEqual(server.content.length, one.length)
})

test("a file for the page is saved once, whole, under its name", async () => {
    const saved: [string, Blob][] = []
    const made: Blob[] = []
    const create = document.createElement.bind(document)
    Object.assign(document, {
        createElement: (tag: string) => {
            const element = create(tag)
            if (tag === "a") element.click = () => saved.push([(element as HTMLAnchorElement).download, made.at(-1)!])
            return element
        },
    })
    URL.createObjectURL = blob => `blob:${made.push(blob as Blob)}`
    const { files } = new Server(), told: Download[] = []
    files.on(download => told.push(download))
    const content = random(150_000)
    const say = (state: DownloadMessage["state"], size = 0) => files.hear({ is: "download", number: 1, name: "a.png", state, text: state, size })
    const part = (from: number, until: number) =>
        files.hear({ is: "part", number: 1, content: btoa(text(content.slice(from, until))) })
    say("making")
    say("coming", content.length)
    part(0, 70_000)
    say("coming", content.length) // the page has connected again
    part(0, 65_536)
    part(65_536, 131_072)
    assert.equal(saved.length, 0)
    part(131_072, content.length)
    part(0, 10) // of none that is expected
    assert.deepEqual(saved.map(([name]) => name), ["a.png"])
    assert.equal(text(new Uint8Array(await saved[0]![1].arrayBuffer())), text(content))
    assert.deepEqual([told[0]!.state, told.at(-1)!.state, told.at(-1)!.share], ["making", "done", 1])
    say("failed")
    assert.equal(told.at(-1)!.text, "failed")
})
