// The rows of a form: a setting each, or a button, or a note. While a hand is on a row, it shows what the hand wants.

import { elementsOf, made, refuse, svg, switchInput, tell } from "../core/dom"
import { draftOf, keepDraft } from "../core/drafts"
import type { FormField, FormOption } from "../core/form_data"
import { Scale, typedNumber } from "../core/scales"
import { phrase, WARNS, written, type Texts } from "../core/words"
import { icon } from "./icons"
import { PolePlane } from "./pole_plane"

const RESTS = 300 // [ms] after the last touch for which the hand's value stays
const TOLD = 5000 // [ms] for which a row says that the lab has another value than the hand wanted
const PAGE = 10 // steps of Page Up and Page Down

export type Value = FormOption["value"]

/** What a form shows, and where its changes go. */
export interface FormHost {
    readonly texts: Texts
    /** The value of a setting; undefined if it is not known. */
    value(name: string): Value | undefined
    set(name: string, value: Value): void
    /** Do what a button is for: its `act`, or what its name means to the page. */
    act(button: FormField): void
    /** Why the last value of a setting was refused; empty if it was not. */
    refused(name: string): string
    /** Whether the last value that was set is still on its way, so that `value` is older. */
    waits?(name: string): boolean
}

/** What a row needs of its form. */
export interface RowForm {
    readonly host: FormHost
    /** A value was set: what depends on it may have changed. */
    changed(): void
}

let rows = 0

/** Whether two values mean the same. */
export function same(one: Value | undefined | null, other: Value | undefined | null): boolean {
    if (typeof one !== "number" || typeof other !== "number") return one === other
    return Math.abs(one - other) <= 1e-9 * Math.max(1, Math.abs(one))
}

/** A row of a form. */
export abstract class FieldRow {
    readonly element: HTMLElement
    protected readonly id = `op-field-${rows++}`
    /** What the hand wants, while that counts or differs. */
    private wanted: Value | null = null
    private down = false
    private last = -Infinity // touch
    private readonly refusal = made("p", "refusal")
    private readonly back = made("button", "back")
    private resting: ReturnType<typeof setTimeout> | undefined
    private telling: ReturnType<typeof setTimeout> | undefined

    constructor(public field: FormField, protected readonly form: RowForm, protected readonly signal: AbortSignal) {
        this.element = made("div", "field")
        Object.assign(this.element.dataset, { name: field.name, kind: field.kind })
        this.refusal.id = `${this.id}-refusal`
        this.refusal.setAttribute("role", "alert")
        this.back.type = "button"
        this.back.textContent = "\u21ba"
        this.back.addEventListener("click", () => this.restore(), { signal })
    }

    /** Whether it may go on with other data. */
    fits(field: FormField): boolean {
        return looks(field) === looks(this.field)
    }

    /** Take other data; the elements stay. */
    take(field: FormField): void {
        const before = JSON.stringify(this.field)
        this.field = field
        if (JSON.stringify(field) !== before) this.name()
        this.update()
    }

    /** The value that the row shows. */
    get value(): Value | undefined {
        return this.wanted !== null && this.holds ? this.wanted : this.form.host.value(this.field.name)
    }

    /** The value to which one goes back: a lesson's, or the default; null: there is none. */
    get base(): Value | null { return this.field.mark ?? this.field.default ?? null }
    get isChanged(): boolean {
        const { value, base } = this
        return base !== null && value !== undefined && !same(value, base)
    }

    restore(): void {
        if (this.base !== null) this.choose(this.base)
    }

    /** Show the present value. */
    update(): void {
        const { field, form, value, isChanged, wanted } = this
        const { host } = form
        if (value !== undefined) this.show(value)
        this.back.style.visibility = isChanged ? "visible" : "hidden" // its room stays
        if (isChanged) {
            const name = phrase(host.texts, field.mark == null ? "form.back" : "form.back_lesson", { value: this.words(this.base!) })
            if (this.back.title !== name) this.back.title = this.back.ariaLabel = name
        }
        const refused = this.refused || host.refused(field.name)
        if (wanted !== null && !this.holds && same(wanted, value)) this.wanted = null
        const differs = !refused && this.wanted !== null && !this.holds
        if (differs) this.telling ??= setTimeout(() => this.forget(), TOLD)
        this.element.classList.toggle("differs", differs)
        refuse(this.refusal, differs ? phrase(host.texts, "form.differs", { value: this.words(wanted!) }) : refused)
        for (const input of this.inputs) {
            if (refused) input.setAttribute("aria-describedby", this.refusal.id)
            else input.removeAttribute("aria-describedby")
            input.ariaInvalid = refused ? "true" : null
        }
    }

    private forget(): void {
        this.telling = undefined
        if (this.holds) return
        this.wanted = null
        this.update()
    }

    /** Where buttons that follow stand, if in this row: small, without words if they have a picture. */
    readonly beside: HTMLElement | null = null
    /** Why what was typed is no value; empty if it is one. */
    protected refused = ""
    /** The elements that change the value. */
    protected abstract readonly inputs: readonly HTMLElement[]
    /** Put names and ranges into the elements. */
    protected abstract name(): void
    protected abstract show(value: Value): void
    /** A value as it is written. */
    abstract words(value: Value): string
    /** Name and value in the line of a closed group. */
    brief(value: Value): string { return this.words(value) }

    /** Whether the hand's value counts. */
    private get holds(): boolean {
        return this.down || performance.now() < this.last + RESTS || Boolean(this.form.host.waits?.(this.field.name))
    }

    /** Set a value by hand. */
    protected choose(value: Value): void {
        this.refused = ""
        this.wanted = value
        this.touched()
        this.form.host.set(this.field.name, value)
        this.form.changed()
    }

    /** The hand is, or was, at the row. */
    protected touched(down = this.down): void {
        this.down = down
        this.last = performance.now()
        clearTimeout(this.resting)
        if (!down && this.wanted !== null) this.resting = setTimeout(() => this.form.changed(), RESTS + 1)
    }

    /** The name with its unit, as a screen reader says it. */
    protected get label(): string {
        const { label, unit } = this.field
        return unit ? `${label} [${unit}]` : label
    }

    protected title(of: HTMLElement): void {
        const { symbol = "", unit, help = "" } = this.field
        const typed = plain(symbol), all = this.field.label
        const label = symbol && (all === typed || all.startsWith(`${typed} `)) ? all.slice(typed.length + 1) : all
        of.replaceChildren(...(symbol ? [made("i", "symbol", symbol), label && " "] : []), label, ...(unit ? [" ", made("span", "unit", unit)] : []))
        this.element.title = help
    }

    /** Put the parts of the row together, with its way back and its refusal. */
    protected fill(...parts: Node[]): void {
        this.element.append(...parts, this.back, this.refusal)
    }

    /** Backspace and Delete go back. */
    protected goesBack(element: HTMLElement): void {
        element.addEventListener("keydown", event => {
            if (event.key !== "Backspace" && event.key !== "Delete") return
            event.preventDefault()
            event.stopPropagation()
            this.restore()
        }, { signal: this.signal })
    }
}

/** A slider and a box for its number; a switch before them if 0 is off. */
class NumberRow extends FieldRow {
    private scale = scaleOf(this.field)
    private readonly slider = made("input", "")
    private readonly box = made("input", "typed")
    private readonly heading = made("label", "name")
    private readonly toggle: HTMLInputElement | null = null
    private readonly marks = [made("i", "default"), made("i", "lesson")]
    private readonly track = made("span", "track", ...this.marks, this.slider)
    private readonly draft = `field ${this.field.name}`
    private typing = false
    protected readonly inputs: HTMLElement[]

    constructor(field: FormField, form: RowForm, signal: AbortSignal) {
        super(field, form, signal)
        const { slider, box, track } = this
        slider.type = "range"
        slider.id = this.id
        this.heading.htmlFor = this.id
        box.type = "text"
        box.inputMode = "decimal"
        box.autocomplete = "off"
        box.spellcheck = false
        this.inputs = [slider, box]
        const parts: Node[] = [this.heading, track, box]
        if (field.on != null) {
            this.toggle = switchInput({ id: `${this.id}-on` })
            this.heading.htmlFor = this.toggle.id
            this.toggle.addEventListener("change", () => this.choose(this.toggle!.checked ? this.field.on! : 0), { signal })
            this.goesBack(this.toggle)
            this.inputs.unshift(this.toggle)
            parts.splice(1, 0, this.toggle)
        }
        this.fill(...parts)
        this.listen()
        this.name()
        queueMicrotask(() => this.resume()) // once it is on the page
    }

    /** Go on typing what was half typed when the page was reloaded. */
    private resume(): void {
        const { box } = this, { text } = draftOf<{ text: string }>(this.draft) ?? {}
        if (typeof text !== "string" || document.activeElement !== document.body) return
        box.focus({ preventScroll: true })
        if (document.activeElement !== box) return // it is hidden
        box.value = text
        this.typing = true
    }

    /** From now on the box shows what is typed, or the value again. */
    private type(on: boolean): void {
        if (on || this.typing) keepDraft(this.draft, on ? { text: this.box.value } : null)
        this.typing = on
    }

    /** The value as a number of what is shown, and back. */
    private readonly inUnits = (value: Value): number => Number(value) * (this.field.factor ?? 1)
    private readonly ofUnits = (shown: number): number => shown / (this.field.factor ?? 1)
    private pick(shown: number): void { this.choose(this.ofUnits(shown)) }

    words(value: Value): string {
        const { unit, on } = this.field
        if (on != null && value === 0) return phrase(this.form.host.texts, "form.off")
        return `${this.digits(value)} ${unit ?? ""}`.trim()
    }

    override brief(value: Value): string {
        const { symbol, label } = this.field
        return symbol ? `${symbol} ${this.digits(value)}` : `${label} ${this.words(value)}`
    }

    private readonly digits = (value: Value): string => written(this.form.host.texts, this.scale.shown(this.inUnits(value)))

    protected name(): void {
        const { slider, box, field, label, marks } = this
        this.scale = scaleOf(field)
        const { low, high, isLog } = this.scale
        Object.assign(slider, isLog ? { min: "0", max: "1", step: "any" } : { min: String(low), max: String(high), step: "any" })
        this.title(this.heading)
        slider.ariaLabel = box.ariaLabel = label
        if (this.toggle) this.toggle.ariaLabel = field.label
        for (const element of this.inputs) describe(element, field.help)
        for (const [mark, value] of [[marks[0]!, field.default], [marks[1]!, field.mark]] as const) {
            mark.hidden = typeof value !== "number" || (this.toggle !== null && value === 0)
            if (!mark.hidden) mark.style.setProperty("--at", this.scale.place(this.inUnits(value!)).toFixed(4))
        }
    }

    protected show(value: Value): void {
        const number = this.inUnits(value), { slider, scale, box } = this
        const shown = String(scale.isLog ? scale.place(number) : scale.clamped(number))
        if (slider.value !== shown) slider.value = shown
        slider.style.setProperty("--at", scale.place(number).toFixed(4))
        const limit = this.field.limit ? this.form.host.value(this.field.limit) : undefined
        this.track.classList.toggle("limited", limit !== undefined)
        if (limit !== undefined) this.track.style.setProperty("--limit", scale.place(this.inUnits(limit)).toFixed(4))
        const text = `${this.digits(value)} ${this.field.unit ?? ""}`.trim()
        if (slider.ariaValueText !== text) slider.ariaValueText = text
        if (!this.typing && box.value !== this.digits(value)) box.value = this.digits(value)
        if (!this.toggle) return
        this.toggle.checked = number !== 0
        this.track.hidden = box.hidden = number === 0
    }

    private listen(): void {
        const { slider, box, signal } = this
        slider.addEventListener("pointerdown", () => {
            this.touched(true)
            const up = new AbortController()
            signal.addEventListener("abort", () => up.abort(), { signal: up.signal })
            for (const event of ["pointerup", "pointercancel", "blur"])
                addEventListener(event, () => (up.abort(), this.touched(false)), { capture: true, signal: up.signal })
        }, { signal })
        slider.addEventListener("input", () => {
            const { valueAsNumber: at } = slider, { scale } = this
            const meant = [this.base, this.field.default, 0].filter(each => typeof each === "number").map(each => this.inUnits(each))
            this.pick(scale.settled(scale.isLog ? scale.at(at) : scale.rounded(at), meant.filter(each => each === scale.clamped(each))))
        }, { signal })
        this.goesBack(slider)
        slider.addEventListener("keydown", event => this.key(event), { signal })
        box.addEventListener("keydown", event => this.typed(event), { signal })
        box.addEventListener("input", () => (this.type(true), this.touched()), { signal })
        box.addEventListener("focus", () => box.select(), { signal })
        box.addEventListener("blur", () => this.typing && !this.commit() && this.undo(), { signal })
    }

    private key(event: KeyboardEvent): void {
        if (event.ctrlKey || event.metaKey || event.altKey) return
        const steps: Record<string, number> = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1, PageUp: PAGE, PageDown: -PAGE }
        const { scale } = this, by = steps[event.key], value = this.inUnits(this.value ?? 0)
        if (by) this.pick(scale.moved(value, event.shiftKey ? PAGE * by : by))
        else if (event.key === "Home") this.pick(scale.low)
        else if (event.key === "End") this.pick(scale.high)
        else return
        event.preventDefault()
        event.stopPropagation()
    }

    private typed(event: KeyboardEvent): void {
        const by = { ArrowUp: 1, ArrowDown: -1 }[event.key]
        if (event.key === "Enter") this.commit()
        else if (event.key === "Escape" && (this.typing || this.refused)) this.undo()
        else if (by) {
            this.type(false)
            this.pick(this.scale.moved(this.inUnits(this.value ?? 0), by))
        } else return
        event.preventDefault()
        event.stopPropagation()
    }

    /** Set what was typed; returns whether it is a value. */
    private commit(): boolean {
        const { texts } = this.form.host
        const { low = 0, high = 0 } = this.field
        const typed = typedNumber(this.box.value, texts.words["point"] ?? "."), value = typed === null ? null : this.ofUnits(typed)
        if (typed === null || value === null || value < low || value > high) {
            const range = { low: this.digits(low), high: this.digits(high) }
            this.refused = phrase(texts, value === null ? "form.no_number" : "form.range", range)
            this.form.changed()
            return false
        }
        this.type(false)
        if (typed === this.scale.shown(this.inUnits(this.value ?? 0))) this.undo() // nothing else was typed than what stood there
        else this.choose(value)
        return true
    }

    private undo(): void {
        this.type(false)
        this.refused = ""
        this.form.changed()
        this.update()
    }
}

/** One of several values. */
abstract class OptionRow extends FieldRow {
    private offered = ""

    words(value: Value): string {
        return this.options.find(each => same(each.value, value))?.label ?? String(value)
    }

    protected get options(): FormOption[] { return this.field.options ?? [] }
    /** Name what is chosen from, and offer the options if they are other ones: a menu stays open. */
    protected offer(heading: HTMLElement, from: HTMLElement): void {
        const { field, options } = this, offered = JSON.stringify(options)
        this.title(heading)
        from.ariaLabel = field.label
        describe(from, field.help)
        if (offered === this.offered) return
        this.offered = offered
        this.put(options)
    }

    protected abstract put(options: readonly FormOption[]): void
}

class ChoiceRow extends OptionRow {
    private readonly select = made("select", "")
    private readonly heading = made("label", "name")
    protected readonly inputs = [this.select]

    constructor(field: FormField, form: RowForm, signal: AbortSignal) {
        super(field, form, signal)
        this.select.id = this.heading.htmlFor = this.id
        this.select.addEventListener("change", () => {
            const option = this.options[this.select.selectedIndex]
            if (option) this.choose(option.value)
        }, { signal })
        this.goesBack(this.select)
        this.fill(this.heading, this.select)
        this.name()
    }

    protected name(): void { this.offer(this.heading, this.select) }

    protected put(options: readonly FormOption[]): void {
        const { select } = this
        select.replaceChildren(...options.map(({ label, help = "" }) => Object.assign(made("option", "", label), { title: help })))
        select.selectedIndex = -1
    }

    protected show(value: Value): void {
        const index = this.options.findIndex(each => same(each.value, value))
        if (this.select.selectedIndex !== index) this.select.selectedIndex = index
    }
}

/** One of few values, each with its picture. */
class PictureRow extends OptionRow {
    private readonly heading = made("span", "name")
    private readonly tiles = made("span", "tiles")
    override readonly beside = made("span", "pictures", this.tiles)
    protected inputs: HTMLInputElement[] = []

    constructor(field: FormField, form: RowForm, signal: AbortSignal) {
        super(field, form, signal)
        this.tiles.setAttribute("role", "radiogroup")
        this.fill(this.heading, this.beside)
        this.goesBack(this.tiles)
        this.name()
    }

    protected name(): void { this.offer(this.heading, this.tiles) }

    protected put(options: readonly FormOption[]): void {
        this.inputs = options.map(option => {
            const input = Object.assign(made("input", ""), { type: "radio", name: this.id, ariaLabel: option.label })
            input.addEventListener("change", () => this.choose(option.value), { signal: this.signal })
            return input
        })
        this.tiles.replaceChildren(...options.map(({ label, picture, help }, i) =>
            Object.assign(made("label", "tile", this.inputs[i]!, picture ? outline(picture) : label), { title: help || label })))
    }

    protected show(value: Value): void {
        this.inputs.forEach((input, i) => (input.checked = same(this.options[i]!.value, value)))
    }
}

/** Something that is on or off. */
class SwitchRow extends FieldRow {
    private readonly toggle = switchInput({ id: this.id })
    private readonly heading = made("label", "name")
    protected readonly inputs = [this.toggle]

    constructor(field: FormField, form: RowForm, signal: AbortSignal) {
        super(field, form, signal)
        this.heading.htmlFor = this.id
        this.toggle.addEventListener("change", () => this.choose(this.toggle.checked), { signal })
        this.goesBack(this.toggle)
        this.fill(this.heading, this.toggle)
        this.name()
    }

    words(value: Value): string {
        return phrase(this.form.host.texts, value ? "form.is_on" : "form.off")
    }

    protected name(): void {
        this.title(this.heading)
        this.toggle.ariaLabel = this.field.label
        describe(this.toggle, this.field.help)
    }

    protected show(value: Value): void {
        this.toggle.checked = Boolean(value)
    }
}

/** Something to do. */
class ButtonRow extends FieldRow {
    private readonly button = made("button", "do")
    protected readonly inputs = [this.button]

    constructor(field: FormField, form: RowForm, signal: AbortSignal) {
        super(field, form, signal)
        this.button.type = "button"
        this.button.addEventListener("click", () => form.host.act(this.field), { signal })
        this.fill(this.button)
        this.name()
    }

    words(value: Value): string { return String(value) }

    protected name(): void {
        const { button, field } = this
        if (field.picture) button.replaceChildren(Object.assign(made("img", ""), { src: field.picture, alt: "" }), made("b", "", field.label), icon("right"))
        else if (field.icon) {
            button.replaceChildren(icon(field.icon), made("span", "", field.label))
            button.ariaLabel = field.label
        } else tell(button, field.label)
        this.element.title = button.ariaLabel ? [field.label, field.help].filter(Boolean).join(": ") : (field.help ?? "")
        for (const tone of ["main", "warning"]) button.classList.toggle(tone, field.tone === tone)
        button.classList.toggle("pictured", Boolean(field.picture))
        describe(button, field.help)
    }

    protected show(): void {}
}

/** A text of one or several lines. */
class TextRow extends FieldRow {
    private readonly area = made("textarea", "")
    private readonly use = made("button", "use")
    private readonly heading = made("label", "name")
    protected readonly inputs = [this.area]
    private readonly draft = `field ${this.field.name}`
    private typing = false
    private isKept = true // whether there may be a draft

    constructor(field: FormField, form: RowForm, signal: AbortSignal) {
        super(field, form, signal)
        const { area, use } = this
        const { text } = draftOf<{ text: string }>(this.draft) ?? {}
        if (typeof text === "string") {
            area.value = text
            this.typing = true
        }
        area.id = this.heading.htmlFor = this.id
        area.rows = 1
        area.spellcheck = false
        use.type = "button"
        use.textContent = phrase(form.host.texts, "form.use")
        use.addEventListener("click", () => this.commit(), { signal })
        area.addEventListener("input", () => {
            this.typing = this.isKept = true
            keepDraft(this.draft, { text: area.value })
            this.touched()
            this.update()
        }, { signal })
        area.addEventListener("keydown", event => {
            if (event.isComposing) return
            if (event.key === "Enter" && !event.shiftKey) this.commit()
            else if (event.key === "Escape" && this.typing) this.undo()
            else return
            event.preventDefault()
            event.stopPropagation()
        }, { signal })
        this.fill(this.heading, area, use)
        this.name()
    }

    words(value: Value): string { return String(value) }

    protected name(): void {
        this.title(this.heading)
        this.area.ariaLabel = this.field.label
        describe(this.area, this.field.help)
    }

    protected show(value: Value): void {
        this.use.hidden = !this.typing
        if (this.typing || this.form.host.refused(this.field.name)) return // what was refused stays, to be mended
        if (this.isKept) keepDraft(this.draft, null)
        this.isKept = false
        if (this.area.value !== value) this.area.value = String(value)
    }

    private commit(): void {
        this.typing = false
        this.choose(this.area.value)
    }

    private undo(): void {
        this.typing = false
        this.update()
    }
}

/** Lines of text, which are its value; a line may warn. */
class NoteRow extends FieldRow {
    private readonly note = made("p", "")
    protected readonly inputs: HTMLElement[] = []

    constructor(field: FormField, form: RowForm, signal: AbortSignal) {
        super(field, form, signal)
        this.element.append(this.note)
        this.name()
    }

    words(value: Value): string { return String(value).split("\n")[0]! }

    protected name(): void {
        this.show(this.value ?? this.field.label)
        this.note.className = this.field.tone ?? ""
    }

    protected show(value: Value): void {
        const text = String(value)
        this.element.hidden = text === ""
        if (this.note.textContent === text) return
        const lines = text.split("\n").map((line, i) => made("span", line.startsWith(WARNS) ? "warning" : "", i ? `\n${line}` : line))
        this.note.replaceChildren(...lines)
    }
}

/** The poles of the laws as a picture. */
class PoleRow extends FieldRow {
    private readonly plane = new PolePlane(this.form.host.texts)
    protected readonly inputs: HTMLElement[] = []

    constructor(field: FormField, form: RowForm, signal: AbortSignal) {
        super(field, form, signal)
        this.element.append(this.plane.element)
        this.name()
    }

    words(): string { return this.field.label }

    protected name(): void { this.plane.sheet.canvas.ariaLabel = this.field.label }

    protected show(value: Value): void {
        this.element.hidden = value === ""
        this.plane.show(String(value))
    }
}

/** What the server shows, such as a table; a button in it sets the setting that it names. */
class HtmlRow extends FieldRow {
    private shown = ""
    protected readonly inputs: HTMLElement[] = []

    constructor(field: FormField, form: RowForm, signal: AbortSignal) {
        super(field, form, signal)
        this.element.addEventListener("click", event => {
            const button = (event.target as Element).closest<HTMLButtonElement>("button[data-sets]")
            if (button) form.host.set(button.dataset.sets!, Number(button.value))
        }, { signal })
    }

    words(): string { return "" }

    protected name(): void {}

    protected show(value: Value): void {
        if (value === this.shown) return
        this.shown = String(value)
        const held = this.element.contains(document.activeElement) ? (document.activeElement as HTMLButtonElement).value : ""
        this.element.replaceChildren(elementsOf(this.shown))
        if (held) this.element.querySelector<HTMLElement>(`button[value="${CSS.escape(held)}"]`)?.focus()
    }
}

function scaleOf({ low = 0, high = 0, step = 1, factor = 1, scale }: FormField): Scale {
    return new Scale({ low: low * factor, high: high * factor, step: step * factor, scale })
}

const KINDS = {
    number: NumberRow,
    switched: NumberRow,
    choice: ChoiceRow,
    pictures: PictureRow,
    switch: SwitchRow,
    button: ButtonRow,
    text: TextRow,
    note: NoteRow,
    poles: PoleRow,
    html: HtmlRow,
}

/** Which row a field has. */
function looks({ kind, on, options }: FormField): keyof typeof KINDS {
    if (kind === "number" && on != null) return "switched"
    return kind === "choice" && options?.some(each => each.picture) ? "pictures" : kind
}

export function rowOf(field: FormField, form: RowForm, signal: AbortSignal): FieldRow {
    return new KINDS[looks(field)](field, form, signal)
}

/** A symbol as one types it: K1 for K₁. */
function plain(symbol: string): string {
    return symbol.replaceAll(/[₀-₉]/g, digit => String("₀₁₂₃₄₅₆₇₈₉".indexOf(digit)))
}

function describe(element: HTMLElement, text = ""): void {
    if (text) element.setAttribute("aria-description", text)
    else element.removeAttribute("aria-description")
}

function outline(picture: string): SVGElement {
    return svg("svg", { viewBox: "-60 -60 120 120", "aria-hidden": "true" }, svg("path", { d: picture }))
}
