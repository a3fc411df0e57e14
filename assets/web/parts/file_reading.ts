// What all sheets have that read a file: a button that chooses it, how far it has come, and why it cannot be used.

import type { Answer, Files } from "../channel/files"
import type { LogFile, PathFile } from "../channel/messages"
import { made, refuse, tell } from "../core/dom"
import { phrase, type Texts } from "../core/words"
import { pressed, type SheetDialog } from "./sheet"

export class FileReading {
    readonly choose: HTMLButtonElement
    readonly chooser = Object.assign(made("input", ""), { type: "file", hidden: true })
    readonly bar = Object.assign(made("progress", ""), { max: 1, hidden: true })
    readonly state = made("p", "state")
    readonly refusal = made("p", "refusal")
    isBusy = false
    private isStale = false

    /** `label`: of the button; `kinds`: of files, as an input has them; `take` is given a file that is chosen or dropped. */
    constructor(
        private readonly texts: Texts,
        private readonly files: Files,
        sheet: SheetDialog,
        label: string,
        kinds: string,
        private readonly take: (file: File) => void,
    ) {
        const { chooser, bar, state, refusal } = this
        this.choose = pressed("main", label, () => chooser.click())
        chooser.accept = kinds
        bar.ariaLabel = phrase(texts, "design.reading")
        state.role = "status"
        refusal.role = "alert"
        chooser.addEventListener("change", () => {
            this.give(chooser.files?.[0])
            chooser.value = "" // the same file may be chosen again
        })
        sheet.element.addEventListener("dragover", event => event.preventDefault())
        sheet.element.addEventListener("drop", event => {
            event.preventDefault()
            this.give(event.dataTransfer?.files[0])
        })
    }

    /** Take a file, if there is one and none is being read. */
    give(file: File | undefined): void {
        if (file && !this.isBusy) this.take(file)
    }

    /** Have a file read, again if that is asked for meanwhile; `use`: how it is read, asked each time. */
    async read(file: File | null, use: () => PathFile | LogFile, signal: AbortSignal): Promise<Answer | null> {
        const { texts, choose, bar, state, refusal } = this
        this.isStale = true
        if (!file || this.isBusy) return null
        this.isBusy = choose.disabled = true
        bar.hidden = false
        refuse(refusal, "")
        tell(state, phrase(texts, "design.reading"))
        let answer: Answer | null = null
        while (this.isStale && !signal.aborted) {
            this.isStale = false
            answer = await this.files.send(file, use(), share => (bar.value = share), signal)
        }
        this.isBusy = choose.disabled = false
        bar.hidden = true
        return answer
    }
}
