// Keep, share and export: the lab's code, a code of its set-up, files of the last minute, and the record of the lessons.

import type { Command, KeepSheet, MakeFile, PageMessage } from "../channel/messages"
import { made, refuse, switchInput, tell } from "../core/dom"
import { phrase, type Texts } from "../core/words"
import { pressed, SheetDialog } from "./sheet"

const FILES: Record<MakeFile["file"], string> = { table: "export.table", picture: "export.picture", lines: "export.lines", film: "export.film", report: "keep.report" }

type Send = (message: Command | PageMessage) => void

export class Keep {
    private readonly sheet: SheetDialog
    private readonly shared = made("div", "told")
    private readonly refusal = made("p", "refusal")
    private code = ""
    private readonly first: HTMLElement // to be pressed when it opens

    /** `given`: a share code that the page's address has brought. */
    constructor(private readonly texts: Texts, { code, until }: KeepSheet, private readonly send: Send, closed: () => void, given = "") {
        const sheet = (this.sheet = new SheetDialog(texts, "keep", phrase(texts, "keep.title"), closed))
        this.refusal.role = "alert"
        const share = pressed("main", phrase(texts, "keep.share"), () => send({ do: "Share" }))
        const using = this.typed("keep.paste", "keep.paste_hint", "keep.use", text => {
            sheet.close()
            send({ do: "UseShared", text })
        }, given)
        const sharing = made("section", "", made("h3", "", phrase(texts, "keep.sharing")), share, this.shared, using)
        this.first = given ? using.querySelector("button")! : share
        const files = made("section", "", made("h3", "", phrase(texts, "export.title")), made("div", "row", ...(["table", "picture", "lines", "film"] as const).map(file => this.file(file))))
        const withCode = switchInput()
        const record = made("section", "", made("h3", "", phrase(texts, "keep.record")), this.file("report", () => withCode.checked))
        sheet.body.append(sharing, files, record)
        if (code) {
            record.append(made("label", "row", made("span", "", phrase(texts, "keep.with_code")), withCode), made("p", "note", phrase(texts, "keep.with_code_means")))
            sheet.body.prepend(made("section", "", made("h3", "", phrase(texts, "keep.coming_back")), made("p", "", phrase(texts, "keep.yours")),
                this.codeBox(code), made("p", "note", until),
                this.typed("keep.other", "keep.other_hint", "keep.go", typed => send({ is: "enter", code: typed }))))
        }
        sheet.body.append(this.refusal)
    }

    open(): SheetDialog {
        this.sheet.open(this.first)
        return this.sheet
    }

    /** Show the share code that was asked for. */
    show(shared: string): void {
        if (!shared || shared === this.code) return
        this.code = shared
        this.shared.replaceChildren(made("p", "", phrase(this.texts, "keep.shared")), this.codeBox(shareAddress(shared)), this.codeBox(shared))
    }

    /** Say how it stands with a file, or why a code was refused. */
    tell(text: string): void { refuse(this.refusal, text) }

    /** A button for a file, of whose making the page tells then. */
    private file(file: MakeFile["file"], withCode = () => false): HTMLElement {
        return pressed("", phrase(this.texts, FILES[file]), () => {
            this.sheet.close()
            this.send({ is: "make", file, with_code: withCode() })
        })
    }

    private codeBox(code: string): HTMLElement {
        const { texts } = this
        const shown = made("code", "", code)
        shown.translate = false
        const copy = pressed("copy", phrase(texts, "code.copy"), () => void copied(shown).then(() => tell(copy, phrase(texts, "code.copied"))))
        return made("div", "code", shown, copy)
    }

    /** A field for a code, and the button that uses it. */
    private typed(label: string, hint: string, act: string, use: (text: string) => void, value = ""): HTMLElement {
        const { texts } = this
        const field = Object.assign(made("input", ""), { type: "text", autocomplete: "off", autocapitalize: "off", spellcheck: false, title: phrase(texts, hint), value })
        const name = made("label", "", made("span", "", phrase(texts, label)), field)
        const form = made("form", "typed", name, Object.assign(made("button", "", phrase(texts, act)), { type: "submit" }))
        form.addEventListener("submit", event => {
            event.preventDefault()
            tell(this.refusal, "")
            if (field.value.trim()) use(field.value.trim())
            else field.focus()
        })
        return form
    }
}

/** The address at which a lab opens with a share code; what is behind # reaches no server. */
export const shareAddress = (code: string): string => `${location.origin}${location.pathname.replace(/\/[cl]\/[a-z0-9]+\/?$/i, "/")}#${code}`

/** The share code in the page's address, which is removed from there; empty if there is none. */
export function takenShareCode(): string {
    const [code = ""] = /ONPATH\d+-[\w-]+/i.exec(location.hash) ?? []
    if (code) history.replaceState(history.state, "", `${location.pathname}${location.search}`)
    return code
}

/** Copy what an element shows; where that is not allowed, it is at least selected. */
async function copied(element: HTMLElement): Promise<void> {
    try {
        await navigator.clipboard.writeText(element.textContent)
    } catch {
        getSelection()?.selectAllChildren(element)
        document.execCommand("copy")
    }
}
