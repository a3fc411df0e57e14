// The files that a page of the lab sends to its server, and those that it gets.

import { save } from "../core/dom"
import type { DownloadMessage, DownloadPart, FileMessage, PageMessage, SendFile } from "./messages"

const PART = 96_000 // [B] of a file per message to the server; the next one follows its answer

/** A file for the page: what is told of it, and the share of it that has come. */
export interface Download extends Pick<DownloadMessage, "number" | "name" | "text"> {
    state: DownloadMessage["state"] | "done"
    share: number
}

/** What became of a file that was sent; `state` is empty if it was given up. */
export interface Answer extends Pick<FileMessage, "why" | "lines" | "helps" | "columns" | "quantities"> {
    state: "used" | "refused" | ""
}

const GIVEN_UP: Answer = { state: "", why: "", lines: [], helps: [], columns: [], quantities: [] }

interface Upload {
    begin: SendFile
    content: File
    told: (share: number) => void
    done: (answer: Answer) => void
}

export class Files {
    private number = 0
    private upload: Upload | null = null
    private kept: { file: File; number: number } | null = null // that the server has read last
    private coming: { begin: DownloadMessage; parts: Uint8Array<ArrayBuffer>[]; received: number } | null = null
    private readonly listeners = new Set<(download: Download) => void>()

    constructor(private readonly tell: (message: PageMessage) => void) {}

    /** Send a file, or have the same one read again.
     * @param told is told the share that has arrived
     * @param stopped gives it up */
    send(file: File, use: SendFile["use"], told: (share: number) => void = () => {}, stopped?: AbortSignal): Promise<Answer> {
        this.give()
        return new Promise(done => {
            const again = this.kept?.file === file ? this.kept.number : 0
            const begin: SendFile = { is: "send", number: ++this.number, name: file.name.slice(0, 200), size: file.size, use, again }
            const upload = (this.upload = { begin, content: file, told, done })
            stopped?.addEventListener("abort", () => upload === this.upload && this.give())
            this.tell(begin)
        })
    }

    /** Be told of the making and coming of a file for the page, which is saved as soon as it is there. */
    on(listener: (download: Download) => void, ended?: AbortSignal): void {
        this.listeners.add(listener)
        ended?.addEventListener("abort", () => this.listeners.delete(listener))
    }

    /** The channel is open again: the server knows nothing of a part that was under way. */
    restart(): void {
        const { upload } = this
        if (!upload) return
        this.tell({ is: "drop", number: upload.begin.number })
        this.tell((upload.begin = { ...upload.begin, number: ++this.number }))
    }

    hear(message: FileMessage | DownloadMessage | DownloadPart): void {
        if (message.is === "file") void this.answered(message)
        else if (message.is === "part") this.take(message)
        else {
            this.coming = message.state === "coming" ? { begin: message, parts: [], received: 0 } : null
            this.say(message, message.state, 0)
        }
    }

    private async answered({ number, state, received, ...answer }: FileMessage): Promise<void> {
        const { upload } = this
        if (upload?.begin.number !== number) return
        const { begin, content, told, done } = upload
        told(begin.size ? received / begin.size : 1)
        if (state === "awaited") {
            const bytes = new Uint8Array(await content.slice(received, received + PART).arrayBuffer())
            if (this.upload === upload && upload.begin.number === number) this.tell({ is: "part", number, content: coded(bytes) })
        } else if (state !== "reading") {
            this.upload = null
            this.kept = { file: content, number }
            done({ state, ...answer })
        }
    }

    private take({ number, content }: DownloadPart): void {
        const { coming } = this
        if (coming?.begin.number !== number) return
        const part = Uint8Array.from(atob(content), letter => letter.charCodeAt(0))
        coming.parts.push(part)
        coming.received += part.length
        const { begin, parts, received } = coming
        const isWhole = received >= begin.size
        if (isWhole) {
            this.coming = null
            save(begin.name, new Blob(parts, { type: "application/octet-stream" }))
        }
        this.say(begin, isWhole ? "done" : "coming", begin.size ? received / begin.size : 1)
    }

    /** Give up the file that is under way. */
    private give(): void {
        const { upload } = this
        this.upload = null
        if (!upload) return
        this.tell({ is: "drop", number: upload.begin.number })
        upload.done(GIVEN_UP)
    }

    private say({ number, name, text }: DownloadMessage, state: Download["state"], share: number): void {
        for (const listener of this.listeners) listener({ number, name, text, state, share })
    }
}

function coded(bytes: Uint8Array): string {
    let text = ""
    for (const byte of bytes) text += String.fromCharCode(byte)
    return btoa(text)
}
