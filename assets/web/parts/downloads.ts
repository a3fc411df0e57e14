// Says which file is being made or comes; a file is saved as soon as it has come.

import type { Download, Files } from "../channel/files"
import { made, tell } from "../core/dom"
import { phrase, type Texts } from "../core/words"

const STAYS = 4000 // [ms] that a notice stays after its file has come

export class Downloads {
    readonly element = made("div", "")
    private readonly text = made("span", "")
    private readonly bar = made("progress", "")
    private leaving = 0

    constructor(files: Files, texts: Texts, ended: AbortSignal) {
        this.element.id = "op-downloads"
        this.element.hidden = true
        this.text.setAttribute("role", "status")
        this.bar.max = 1
        const close = made("button", "op-cross", "×")
        close.type = "button"
        close.ariaLabel = phrase(texts, "help.close")
        close.addEventListener("click", () => (this.element.hidden = true))
        this.element.append(this.text, this.bar, close)
        files.on(download => this.show(download), ended)
        ended.addEventListener("abort", () => this.element.remove())
    }

    private show({ name, state, text, share }: Download): void {
        clearTimeout(this.leaving)
        this.element.hidden = false
        this.element.dataset["state"] = state
        if (state !== "coming") tell(this.text, text) // it is ready when it has come
        this.bar.hidden = state === "failed" || state === "done"
        this.bar.ariaLabel = name
        if (state === "coming") this.bar.value = share
        else this.bar.removeAttribute("value")
        if (state === "done") this.leaving = window.setTimeout(() => (this.element.hidden = true), STAYS)
    }
}
