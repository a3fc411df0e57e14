// A law of one's own: its lines, the button that uses them, and why they were refused. What is typed is kept until it is used.

import type { RemoteEngine } from "../channel/channel"
import { made, tell } from "../core/dom"
import { draftOf, keepDraft } from "../core/drafts"
import { said, type Texts } from "../core/words"
import { pressed, SheetDialog } from "./sheet"

const SIDES = ["left", "right"] as const

export class OwnLaw {
    private readonly sheet: SheetDialog
    private readonly box = made("textarea", "")
    private readonly refusal = made("p", "refusal")
    private asked = "" // what was used last, until the lab has it or has refused it
    private readonly draft: string

    /** `first`: a law to begin with. `about`: opens what can be typed. */
    constructor(texts: Texts, private readonly engine: RemoteEngine, private readonly side: 0 | 1, first: string, about: () => void, closed: () => void) {
        const { box, refusal } = this, name = said(texts, `laws.own_${SIDES[side]}`), law = this.present
        this.draft = `law ${SIDES[side]}`
        this.sheet = new SheetDialog(texts, "own-law", name, closed)
        Object.assign(box, { rows: 5, spellcheck: false, autocapitalize: "off", ariaLabel: name })
        box.value = draftOf<{ text: string }>(this.draft)?.text ?? linesOf(law.includes("=") ? law : first)
        box.addEventListener("input", () => keepDraft(this.draft, { text: box.value }))
        box.addEventListener("keydown", event => {
            if (event.key !== "Enter" || event.shiftKey || event.isComposing) return
            event.preventDefault()
            this.use()
        })
        refusal.setAttribute("role", "alert")
        tell(refusal, engine.lab!.refusals[side] ?? "")
        this.sheet.body.append(made("p", "note", said(texts, "laws.own_hint")), box, refusal,
            made("div", "row", pressed("main", said(texts, "laws.use"), () => this.use()), pressed("", said(texts, "laws.about"), about)))
        this.sheet.open(box)
    }

    get dialog(): SheetDialog { return this.sheet }

    /** Close it once the lab has the law; say why it was refused. */
    follow(): void {
        if (!this.sheet.isOpen) return
        const why = this.engine.lab!.refusals[this.side] ?? ""
        tell(this.refusal, why)
        if (!this.asked || why || plainly(this.present) !== this.asked) return
        keepDraft(this.draft, null)
        this.sheet.close()
    }

    private get present(): string { return this.engine.lab!.laws[this.side]! }

    private use(): void {
        const text = this.box.value
        this.asked = plainly(text)
        tell(this.refusal, "")
        this.engine.send({ do: "TypeLaw", side: SIDES[this.side], text })
        this.follow()
    }
}

/** A law with each formula on a line of its own. */
function linesOf(law: string): string {
    return law.replaceAll("; ", "\n")
}

/** A law without what does not matter in it. */
function plainly(law: string): string {
    return law.split(/[;\n]/).map(line => line.replaceAll(/\s/g, "")).filter(Boolean).join(";")
}
