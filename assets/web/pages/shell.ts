// What stands around the stage of the lab's page: the head, the controls, the search, the keys, and all that opens.

import type { News, ServerEngine } from "../channel/channel"
import type { Command, Index, PageMessage } from "../channel/messages"
import { phrase, type Texts } from "../core/words"
import { ClassSheet } from "../parts/class_sheet"
import { LawComparison } from "../parts/compare_sheet"
import { display } from "../parts/display_sheet"
import { noFile, pastedFile, pathFromFile } from "../parts/file_sheet"
import type { Form } from "../parts/form"
import { Header } from "../parts/header"
import { help } from "../parts/help_sheet"
import { Keep, takenShareCode } from "../parts/keep_sheet"
import { Keys } from "../parts/keys"
import { isLog, logFromFile, noLog } from "../parts/log_sheet"
import { aboutLaws } from "../parts/law_sheet"
import { chooseLesson } from "../parts/lesson_sheet"
import { keepLook, keptLook } from "../parts/look"
import { Panel } from "../parts/panel"
import { pointAtStage } from "../parts/pointing"
import { chooseRobot } from "../parts/robot_sheet"
import { Search, type Entry } from "../parts/search"
import { isSheetOpen, type SheetDialog } from "../parts/sheet"

/** What can be opened, with the title under which the search finds it. */
const TITLES = {
    robots: "robots.choose", laws: "laws.about", compare: "compare.title", keep: "keep.title", lessons: "lesson.choose",
    help: "help.title", display: "display.title", file: "design.files", log: "log.title",
    class: "class.title", teach: "class.teach",
} as const
type Opens = keyof typeof TITLES
/** What can be opened beside a plant. */
const BESIDE_PLANT = ["laws", "help", "display", "file", "log"]

type Message = Command | PageMessage

export class Shell {
    readonly header: Header
    readonly panel: Panel
    /** The form in the panel; null until the lab has told it. */
    form: Form | null = null
    private readonly search: Search
    private readonly keys: Keys
    private index: Index | null = null
    private known = "" // language and robot of the index
    private opened: { name: Opens; dialog: SheetDialog } | null = null
    private keep: Keep | null = null
    private brought = "" // share code of the page's address
    private compare: LawComparison | null = null
    private seat: ClassSheet | null = null
    private membership = "" // of the lab in the class, as it was told last
    private asked = false // whether the teacher has been asked for a former place
    private readonly chosen = noFile()
    private readonly chosenLog = noLog()
    private dropped: File | undefined // for the sheet that is opened next
    private leaves = false // whether it leaves the class by itself

    /** `reopen`: what was open before the page got its present words. */
    constructor(private readonly engine: ServerEngine, private readonly texts: Texts, signal: AbortSignal, reopen: string) {
        this.header = new Header(texts, place => this.go(place))
        this.panel = new Panel(texts, this.header.controls, signal)
        this.search = new Search(texts, () => this.entries())
        this.keys = new Keys(message => engine.send(message), () => this.search.open(), signal)
        engine.on(change => {
            if (change === "state") this.follow()
            else if (change === "class") this.sit()
        }, signal)
        engine.onNews(news => this.hear(news), signal)
        addEventListener("dragover", event => hasFile(event) && event.preventDefault(), { signal }) // or it takes the page's place
        addEventListener("drop", event => this.drop(event), { signal })
        addEventListener("paste", event => this.paste(event), { signal })
        this.follow()
        this.sit()
        if (reopen in TITLES && !this.opened) void this.open(reopen as Opens)
        addEventListener("hashchange", () => this.takeShareCode(), { signal })
        this.takeShareCode()
    }

    get elements(): HTMLElement[] { return [this.header.element, this.panel.element] }

    /** Remove everything; returns the name of what was open, or an empty text. */
    end(): string {
        const name = this.opened?.dialog.isOpen ? this.opened.name : ""
        this.opened?.dialog.close()
        for (const element of this.elements) element.remove()
        return name
    }

    /** Open one of the sheets with what the lab says now. */
    async open(name: Opens): Promise<void> {
        const { engine, texts } = this, lab = engine.lab!
        const send = (message: Message) => engine.send(message)
        const opens: Record<Opens, () => Promise<SheetDialog>> = {
            robots: async () => chooseRobot(texts, await engine.ask("robots"), lab.robot, send),
            laws: async () => aboutLaws(texts, await engine.ask("laws"), lab.laws),
            lessons: async () => chooseLesson(texts, await engine.ask("lessons"), send),
            help: async () => help(texts, await engine.ask("help"), this.keys.known, lab.plant ? null : () => pointAtStage(texts, engine)),
            display: async () => display(texts, await engine.ask("display"), {
                language: lab.language, large: lab.presenting, look: keptLook(), send, setLook: keepLook,
                teach: this.isClassroom ? () => void this.open("teach") : null,
            }),
            keep: async () => (this.keep = new Keep(texts, await engine.ask("keep"), send, () => (this.keep = null), this.brought)).open(),
            file: () => Promise.resolve(pathFromFile(texts, engine.files, this.chosen, file => this.take(file, "log"), this.dropped)),
            log: () => Promise.resolve(logFromFile(texts, engine.files, this.chosenLog, () => engine.log?.name ?? "", () => send({ do: "RemoveLog" }), this.dropped)),
            compare: async () => {
                const data = await engine.ask("compare")
                return (this.compare ??= new LawComparison(texts, {
                    send, about: () => void this.open("laws"), get laws() { return engine.lab!.laws },
                })).open(data)
            },
            class: () => Promise.resolve(this.takeSeat("class")),
            teach: () => Promise.resolve(this.takeSeat("teach")),
        }
        this.opened?.dialog.close()
        this.opened = { name, dialog: await opens[name]() }
    }

    /** A file that is dropped on the page is a path, or can only be the log of an arm. */
    private drop(event: DragEvent): void {
        if (!hasFile(event) || event.defaultPrevented) return
        event.preventDefault()
        this.take(event.dataTransfer!.files[0])
    }

    /** So is a drawing that is pasted where nothing is typed. */
    private paste(event: ClipboardEvent): void {
        const isTyped = (event.target as Partial<HTMLElement>).closest?.("input, textarea, [contenteditable]")
        const file = isTyped ? undefined : pastedFile(event)
        if (!file) return
        event.preventDefault()
        this.take(file)
    }

    /** A share code in the page's address waits in its field to be used. */
    private takeShareCode(): void {
        this.brought = takenShareCode()
        if (this.brought && this.engine.lab!.own) void this.open("keep")
    }

    private take(file: File | undefined, as?: "log"): void {
        const { own, frozen } = this.engine.lab!
        if (!file || !own || frozen || (!as && isSheetOpen())) return
        this.dropped = file
        void this.open(as ?? (isLog(file) ? "log" : "file"))
        this.dropped = undefined
    }

    /** Go to what a button names. */
    go(place: string): void {
        if (place === "robot") return void this.open("robots")
        if (place === "controls") this.panel.show(!this.panel.isOpen)
        else if (place === "search") this.search.open()
        else void this.open(place as Opens)
    }

    private follow(): void {
        const { engine } = this, lab = engine.lab!
        this.keep?.show(lab.shared)
        this.compare?.follow()
        this.panel.freeze(lab.frozen)
        this.header.own = lab.own && !lab.plant
        this.header.teaches = !lab.plant
        const known = `${lab.language} ${lab.robot}`
        if (known === this.known) return
        this.known = known
        void engine.ask("index").then(index => {
            this.index = index
            this.keys.known = index.keys
            this.search.renew()
        })
    }

    private get isClassroom(): boolean { return (this.engine.seat?.membership ?? "none") !== "none" }

    /** Open the card of the class, or what asks for a teacher's key. */
    private takeSeat(name: "class" | "teach", isGone = false): SheetDialog {
        const { engine, texts } = this
        const send = (message: PageMessage) => {
            this.leaves = message.is === "leave" || message.is === "forget_me"
            engine.send(message)
        }
        const seat = (this.seat = new ClassSheet(texts, name === "teach", { send, closed: () => (this.seat = null), teach: () => void this.open("teach") }))
        return seat.open(engine.seat!, isGone)
    }

    /** Show the lab's place in a class. A page at the address of a class begins with its card. */
    private sit(): void {
        const { engine, header, membership, leaves, asked } = this, { seat } = engine
        if (!seat) return
        this.membership = seat.membership
        this.asked = seat.asked
        header.sit(seat)
        this.seat?.show(seat)
        const isDone = !seat.away && (!seat.asks || seat.identification)
        if ((membership && seat.membership !== membership && isDone) || (asked && !seat.asked)) {
            this.seat?.close() // what was asked for is done
            if (document.activeElement === document.body) header.seat.focus()
        }
        if (seat.membership !== "guest" || this.seat) return
        const isGone = membership === "member"
        if (isGone ? leaves : engine.hasGreeted) return
        engine.hasGreeted = true
        this.opened?.dialog.close()
        this.opened = { name: "class", dialog: this.takeSeat("class", isGone) }
    }

    private hear(told: News): void {
        if (told.is === "seat") this.seat?.hear(told)
        else if (told.is === "compared") this.compare?.show(told)
        else if (told.of === "compare") this.compare?.refuse(told.text)
        else this.keep?.tell(told.text)
    }

    /** Everything that the search finds. */
    private entries(): Entry[] {
        const { texts, index, form } = this
        const settings = (form?.settings ?? []).map(({ name, label, group, ...field }) => ({
            kind: group, label, text: field.help ?? "", go: () => {
                this.panel.bring()
                form!.reveal(name)
            },
        }))
        const { plant } = this.engine.lab!
        const opens = Object.entries(TITLES).filter(([name]) => (plant ? BESIDE_PLANT.includes(name) : this.isClassroom || (name !== "class" && name !== "teach")))
        const sheets = opens.map(([name, key]) => ({
            kind: phrase(texts, "search.kind_open"), label: phrase(texts, key), text: phrase(texts, `search.of_${name}`), go: () => void this.open(name as Opens),
        }))
        const found = (index?.found ?? []).map(({ kind, label, text, send }) => ({
            kind: phrase(texts, `search.kind_${kind}`), label, text, go: () => send.forEach(message => this.engine.send(message)),
        }))
        return [...settings, ...sheets, ...found]
    }
}

function hasFile({ dataTransfer }: DragEvent): boolean {
    return dataTransfer?.types.includes("Files") ?? false
}
