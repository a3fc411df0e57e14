// The place of a lab in a class: a student joins it, sees who one is in it, or leaves it; with the key, a teacher opens the
// teacher's page.

import type { ClassMessage, PageMessage, SeatAnswer } from "../channel/messages"
import { made, refuse, tell } from "../core/dom"
import { draftOf, keepDraft } from "../core/drafts"
import { phrase, type Texts } from "../core/words"
import { ask as confirm } from "./question"
import { pressed, SheetDialog } from "./sheet"

const DRAFT = "nickname"
const LONGEST = 200 // characters of a code or a name, as `Typed` of app/channel/sheet_messages.py
const PLAIN = { type: "text", autocomplete: "off", autocapitalize: "off", spellcheck: false, maxLength: LONGEST } as const

export interface SeatHost {
    send(message: PageMessage): void
    /** The card has been closed. */
    closed(): void
    /** Open what asks for the teacher's key. */
    teach(): void
}

export class ClassSheet {
    private readonly sheet: SheetDialog
    private readonly refusal = made("p", "refusal")
    private acts: HTMLButtonElement | null = null // sends a request, one at a time
    private field: HTMLInputElement | null = null
    private shown = ""

    /** `teaches`: whether it is for the teacher's key. */
    constructor(private readonly texts: Texts, private readonly teaches: boolean, private readonly host: SeatHost) {
        this.sheet = new SheetDialog(texts, teaches ? "teach" : "class", "", () => host.closed())
        this.refusal.role = "alert"
        this.refusal.id = "op-seat-refusal"
    }

    open(seat: ClassMessage, isGone = false): SheetDialog {
        this.show(seat)
        if (isGone) {
            const gone = made("p", "gone", phrase(this.texts, "class.gone"))
            gone.role = "status"
            this.sheet.body.prepend(gone)
        }
        this.sheet.open(this.field)
        return this.sheet
    }

    close(): void { this.sheet.close() }

    /** Follow the lab's place; what is half typed stays. */
    show(seat: ClassMessage): void {
        const { texts, teaches, sheet, refusal } = this
        if (this.acts) this.acts.disabled = false // it is sent again with each connection
        const shown = JSON.stringify([seat, teaches])
        if (shown === this.shown) return
        this.shown = shown
        const hadFocus = sheet.body.contains(document.activeElement)
        this.acts = this.field = null
        tell(refusal, "")
        sheet.title = phrase(texts, teaches ? "class.teach" : "class.title") + (seat.code && ` ${seat.code}`)
        sheet.body.replaceChildren(...teaches ? this.key() : seat.membership === "member" ? this.member(seat) : this.joining(seat))
        if (hadFocus) sheet.body.querySelector<HTMLElement>("form input")?.focus()
    }

    /** What has come of the last request. */
    hear({ why, address }: SeatAnswer): void {
        const { texts, field, acts, refusal } = this
        if (acts) acts.disabled = false
        refuse(refusal, why)
        if (field) field.ariaInvalid = why ? "true" : null
        if (why) field?.focus()
        if (!address) return
        const link = made("a", "main", phrase(texts, "class.elsewhere"))
        link.href = address
        this.sheet.body.querySelector("a.main")?.remove()
        refusal.after(link)
        link.focus()
    }

    private joining(seat: ClassMessage): HTMLElement[] {
        const { code, longest } = seat
        if (!code) return [this.asks("class.code", "class.code_hint", "class.join", typed => { this.host.send({ is: "join", code: typed, name: "" }) }), this.teacher()]
        const form = this.asks("class.nickname", "class.nickname_hint", "class.join", typed => {
            if (lengthOf(typed) > longest) return phrase(this.texts, "class.too_long", { most: String(longest) })
            this.host.send({ is: "join", code: "", name: typed })
            return ""
        })
        const draft = draftOf<{ typed: string }>(DRAFT)
        if (typeof draft?.typed === "string") this.field!.value = draft.typed
        this.field!.addEventListener("input", () => keepDraft(DRAFT, this.field && { typed: this.field.value }))
        return [form, this.stored(seat), this.teacher()]
    }

    /** Who has come to teach is not asked for a nickname. */
    private teacher(): HTMLElement { return made("p", "row", pressed("", phrase(this.texts, "class.teacher"), () => this.host.teach())) }

    private member(seat: ClassMessage): HTMLElement[] {
        const { texts } = this
        keepDraft(DRAFT, null)
        const known = seat.identification ? "class.id_known" : "class.id_hint"
        const asked = seat.asks ? [this.tells(seat.asks, known, "class.id_send", seat.identification, typed => ({ is: "identify", typed }))] : []
        const former = seat.away ? this.former(seat) : []
        const [before = "", after = ""] = phrase(texts, "class.member").split("{name}")
        const leave = (this.acts = pressed("", phrase(texts, "class.leave"), () => {
            leave.disabled = true
            this.host.send({ is: "leave" })
        }))
        const forget = pressed("warning", phrase(texts, "class.forget_me"), () => {
            confirm(texts, phrase(texts, "class.forget_me"), phrase(texts, "class.forget_me_sure"), () => { this.host.send({ is: "forget_me" }) })
        })
        return [made("p", "", before, made("b", "", made("bdi", "", seat.name)), after), ...asked, made("p", "", phrase(texts, "class.then")), ...former, this.word(seat), this.stored(seat), leave, forget, this.refusal]
    }

    /** A word that links two tests over months. */
    private word({ linked }: ClassMessage): HTMLElement {
        const { texts } = this, form = this.tells(phrase(texts, "class.word"), "class.word_hint", "class.word_send", "", word => ({ is: "link", word }))
        const fold = made("details", "word", made("summary", "", phrase(texts, "class.word")), form)
        fold.open = linked === "shared"
        if (linked) form.prepend(made("p", linked === "shared" ? "refusal" : "", phrase(texts, linked === "shared" ? "class.word_shared" : "class.word_own")))
        return fold
    }

    /** A field that may stay empty, and the button that sends it. */
    private tells(label: string, hint: string, act: string, value: string, message: (typed: string) => PageMessage): HTMLElement {
        const { texts } = this, field = Object.assign(made("input", ""), { ...PLAIN, value })
        const note = made("p", "note", phrase(texts, hint))
        note.id = `op-${act.replace(".", "-")}-hint`
        field.setAttribute("aria-describedby", `${note.id} ${this.refusal.id}`)
        const button = Object.assign(made("button", "", phrase(texts, act)), { type: "submit" })
        const form = made("form", "asks", made("div", "typed", made("label", "", made("span", "", label), field), button), note)
        form.noValidate = true
        form.addEventListener("submit", event => {
            event.preventDefault()
            if (button.disabled) return
            this.acts = button
            this.field = field
            button.disabled = true
            this.host.send(message(field.value.trim()))
        })
        return form
    }

    /** Somebody of the same name is away, whose place one can have back. */
    private former({ away, asked }: ClassMessage): HTMLElement[] {
        const { texts } = this
        const says = made("p", "former", phrase(texts, asked ? "class.place_asked" : "class.is_it_you", { name: away }))
        const ask = pressed("", phrase(texts, "class.ask_place"), () => {
            ask.disabled = true
            this.host.send({ is: "ask_place" })
        })
        return asked ? [says] : [says, ask]
    }

    private key(): HTMLElement[] {
        const form = this.asks("class.key", "class.key_hint", "class.teach", key => { this.host.send({ is: "teach", key }) })
        this.field!.type = "password"
        return [form]
    }

    private stored({ stored, privacy }: ClassMessage): HTMLElement {
        const { texts } = this, text = made("p", "note", stored)
        if (privacy) text.append(" ", Object.assign(made("a", "", phrase(texts, "class.privacy")), { href: privacy, target: "_blank", rel: "noopener noreferrer" }))
        return made("details", "stored", made("summary", "", phrase(texts, "class.what_stored")), text)
    }

    /** A field that must be filled in, and the button that uses it; `use` returns what is wrong with what was typed. */
    private asks(label: string, hint: string, act: string, use: (typed: string) => string | void): HTMLElement {
        const { texts, refusal } = this
        const field = (this.field = Object.assign(made("input", ""), PLAIN))
        const note = made("p", "note", phrase(texts, hint))
        note.id = "op-seat-hint"
        field.setAttribute("aria-required", "true")
        field.setAttribute("aria-describedby", `${note.id} ${refusal.id}`)
        const button = (this.acts = Object.assign(made("button", "main", phrase(texts, act)), { type: "submit" }))
        const form = made("form", "asks", made("div", "typed", made("label", "", made("span", "", phrase(texts, label)), field), button), refusal, note)
        form.noValidate = true // the lab says in the page's language what is missing
        form.addEventListener("submit", event => {
            event.preventDefault()
            if (button.disabled) return
            const why = use(field.value.trim()) ?? ""
            button.disabled = !why
            refuse(refusal, why)
        })
        return form
    }
}

/** How many characters readers see. */
function lengthOf(text: string): number {
    return [...new Intl.Segmenter().segment(text)].length
}
