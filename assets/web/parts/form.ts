// A form: the settings that a lab, a step of a lesson or a figure shows, drawn from their declarations. See fields.ts for
// its rows, and app/view/forms.py for what it is told.

import { made, tell } from "../core/dom"
import type { FormField, FormGroup, FormMessage, FormNeed } from "../core/form_data"
import { recalled, remember } from "../core/memory"
import { phrase } from "../core/words"
import { rowOf, same, type FormHost, type FieldRow, type RowForm } from "./fields"

const OPENED = "onpath-groups" // which groups are open, in the browser's memory
const LOW = 900 // [px] of the window's height, below which one group is open at a time
const FOUND = 2000 // [ms] for which a row that was looked for is marked

export class Form implements RowForm {
    readonly element = made("div", "form")
    private readonly main = made("div", "column")
    private readonly more = made("div", "column")
    private readonly groups = new Map<string, GroupView>()
    private readonly rows = new Map<string, FieldRow>()
    private data: FormMessage | null = null
    private shown = ""

    constructor(data: FormMessage, readonly host: FormHost, private readonly signal: AbortSignal) {
        this.element.append(made("div", "columns", this.main, this.more))
        this.show(data)
    }

    /** Show other fields. What is the same stays, with its focus and what is half typed. */
    show(data: FormMessage): void {
        const shown = JSON.stringify(data)
        if (shown === this.shown) return
        this.shown = shown
        this.data = data
        const focused = document.activeElement
        const fields = data.groups.flatMap(group => group.fields)
        for (const field of fields) {
            const row = this.rows.get(field.name)
            if (row?.fits(field)) continue
            row?.element.remove()
            this.rows.set(field.name, rowOf(field, this, this.signal))
        }
        const names = new Set(fields.map(field => field.name))
        for (const [name, row] of this.rows)
            if (!names.has(name)) {
                row.element.remove()
                this.rows.delete(name)
            }
        for (const group of data.groups)
            if (!this.groups.has(group.name)) this.groups.set(group.name, new GroupView(group, this, this.signal))
        for (const [name, view] of this.groups) {
            const group = data.groups.find(each => each.name === name)
            if (group) view.take(group)
            else {
                view.element.remove()
                this.groups.delete(name)
            }
        }
        const isFirst = (group: FormGroup) => group.level !== "deeper"
        const placed = (wanted: (group: FormGroup) => boolean) =>
            data.groups.filter(wanted).map(group => this.groups.get(group.name)!.element)
        arrange(this.main, placed(isFirst))
        arrange(this.more, placed(group => !isFirst(group)))
        this.more.hidden = !this.more.firstChild
        this.element.dataset["place"] = data.place
        for (const field of fields) this.rows.get(field.name)!.take(field)
        this.update()
        // An element that is moved loses the focus.
        if (focused instanceof HTMLElement && focused !== document.activeElement && this.element.contains(focused))
            focused.focus({ preventScroll: true })
    }

    /** Show the present values. */
    update(): void {
        for (const row of this.rows.values()) {
            row.update()
            const acts = this.acts(row.field.needs)
            if (row.element.classList.contains("idle") === acts) row.element.classList.toggle("idle", !acts)
        }
        for (const group of this.groups.values()) group.update()
    }

    /** A hand has changed a value. */
    readonly changed = (): void => this.update()

    /** The element of a group. */
    part(name: string): HTMLElement | undefined { return this.groups.get(name)?.element }

    /** The row of a field. */
    readonly row = (name: string): FieldRow | undefined => this.rows.get(name)

    /** Whether a field with these conditions acts. */
    acts(needs: FormField["needs"] = []): boolean {
        const value = (name: string) => this.rows.get(name)?.value ?? this.host.value(name)
        const meets = ({ name, of }: FormNeed) => {
            const given = value(name)
            if (given === undefined) return false
            return of?.length ? of.some(each => same(each, given)) : Boolean(given) && given !== "off"
        }
        // What nobody knows here is as the author of the place wants it.
        return needs.every(each => each.some(meets) || each.every(({ name }) => value(name) === undefined))
    }

    /** Bring a field into view, with the focus on it; returns whether the form has it. */
    reveal(name: string): boolean {
        const row = this.rows.get(name)
        if (!row) return false
        for (const group of this.groups.values()) if (group.element.contains(row.element)) group.open()
        row.element.scrollIntoView({ block: "nearest" })
        row.element.querySelector<HTMLElement>("input:not([hidden]), select, textarea, button.do")?.focus({ preventScroll: true })
        row.element.classList.add("found")
        setTimeout(() => row.element.classList.remove("found"), FOUND)
        return true
    }

    /** What can be set or done here now, with the title of its group; what opens elsewhere is not among it. */
    get settings(): (FormField & { group: string })[] {
        const all = (this.data?.groups ?? []).flatMap(({ title, fields }) => fields.map(field => ({ ...field, group: title })))
        return all.filter(({ kind, act, needs }) => kind !== "note" && kind !== "poles" && (kind !== "button" || act) && this.acts(needs))
    }

    /** Mark the row of a setting that is pointed at elsewhere; empty: none. */
    light(name: string): void {
        for (const [each, { element }] of this.rows) element.classList.toggle("lit", each === name)
    }

    /** One group at a time where there is no room for more. */
    opened(group: GroupView): void {
        if (this.data?.place !== "lab" || innerHeight >= LOW) return
        for (const other of this.groups.values()) if (other !== group) other.close()
    }
}

/** A group of rows: always seen, or to be opened. */
class GroupView {
    readonly element: HTMLElement
    private readonly details: HTMLDetailsElement | null = null
    private readonly body = made("div", "fields")
    private readonly title = made("span", "heading")
    private readonly state = made("span", "state")
    private readonly dot = made("span", "dot")
    private readonly back = made("button", "back")
    private readonly sections = new Map<string, HTMLElement>()
    private readonly runs = new Map<string, HTMLElement>() // of buttons, by the name of the first one

    constructor(private group: FormGroup, private readonly form: Form, signal: AbortSignal) {
        const { name, level } = group
        const { texts } = form.host
        if (level === "deeper") {
            const details = (this.details = made("details", "", made("summary", "", this.title, this.state, this.dot), this.body))
            details.open = opened()[name] ?? false
            details.addEventListener("toggle", () => {
                remember(OPENED, { ...opened(), [name]: details.open })
                if (details.open) form.opened(this)
            }, { signal })
            this.dot.setAttribute("role", "img")
            this.dot.ariaLabel = phrase(texts, "form.changed")
            this.back.type = "button"
            this.back.textContent = "\u21ba"
            this.back.addEventListener("click", () => this.restore(), { signal })
            this.element = made("section", "group deeper", details, this.back)
        } else this.element = made("section", "group", this.body)
        this.element.dataset["name"] = name
        this.body.setAttribute("role", "group")
    }

    open(): void { if (this.details) this.details.open = true }
    close(): void { if (this.details) this.details.open = false }

    take(group: FormGroup): void {
        const { form, title, body, sections, runs, back } = this
        this.group = group
        tell(title, group.title)
        body.ariaLabel = group.title
        back.title = back.ariaLabel = phrase(form.host.texts, "form.back_group", { group: group.title })
        const rows = new Map<string, HTMLElement[]>(), buttons = new Map<HTMLElement, HTMLElement[]>()
        let run: HTMLElement | null = null // to which a further button belongs
        let areDrawn = false // the buttons of the run
        let last: FieldRow | null = null // of the section
        let at = ""
        for (const field of group.fields) {
            const section = field.section ?? "", row = form.row(field.name)!, { element } = row
            if (section !== at) last = run = null
            at = section
            element.classList.toggle("under", group.fields.some(each => field.needs?.flat().some(need => need.name === each.name)))
            const own = rows.get(section) ?? []
            rows.set(section, own)
            if (field.kind !== "button" || field.picture) {
                own.push(element)
                run = null
                last = row
                continue
            }
            const drawn = Boolean(field.icon)
            if (!run || drawn !== areDrawn) {
                run = runs.get(field.name) ?? made("div", "acts")
                runs.set(field.name, run)
                if (last?.beside && drawn) last.beside.append(run)
                else own.push(run)
            }
            areDrawn = drawn
            buttons.set(run, [...(buttons.get(run) ?? []), element])
        }
        for (const [box, elements] of buttons) arrange(box, elements)
        const parts = [...rows].flatMap(([section, elements]) => {
            if (!section) return elements
            const box = sections.get(section) ?? made("div", "section", made("h4", "", section))
            sections.set(section, box)
            box.setAttribute("role", "group")
            box.ariaLabel = section
            arrange(box, [box.firstElementChild as HTMLElement, ...elements])
            return [box]
        })
        arrange(body, parts)
    }

    update(): void {
        const { group, form, details } = this
        const changed = group.fields.some(({ name }) => form.row(name)!.isChanged)
        this.element.classList.toggle("changed", changed)
        if (!details) return
        this.dot.hidden = this.back.hidden = !changed
        tell(this.state, this.line())
    }

    /** What the group's values are, in one line. */
    private line(): string {
        const { group, form } = this
        const { texts } = form.host
        const parts: string[] = []
        let on = 0
        for (const name of group.states ?? []) {
            const row = form.row(name)
            if (!row || !form.acts(row.field.needs) || row.value === undefined) continue
            const { value } = row
            if (row.field.kind === "switch" || row.field.on != null) on += value ? 1 : 0
            else if (value !== "") parts.push(row.brief(value))
        }
        if (on) parts.push(phrase(texts, "form.count_on", { count: String(on) }))
        return parts.join(" · ")
    }

    private restore(): void {
        for (const { name } of this.group.fields) {
            const row: FieldRow = this.form.row(name)!
            if (row.isChanged) row.restore()
        }
    }
}

/** Give an element these children, in this order; what is in its place is not moved. */
function arrange(parent: HTMLElement, children: readonly HTMLElement[]): void {
    const wanted = new Set<Element>(children)
    for (const child of [...parent.children]) if (!wanted.has(child)) child.remove()
    let next = parent.firstElementChild
    for (const child of children) {
        if (child === next) next = next.nextElementSibling
        else parent.insertBefore(child, next)
    }
}

function opened(): Record<string, boolean> {
    return Object(recalled(OPENED) ?? {}) as Record<string, boolean>
}
