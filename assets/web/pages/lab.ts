// The page of the lab: viser's canvas is the stage; around it stand the head, the controls, a lesson's column, the strip
// with plots, numbers and buttons for time, a lens for each robot, and the robots' titles.

import { made, tell } from "../core/dom"
import { shown } from "../core/engine"
import type { FormMessage } from "../core/form_data"
import { enlarge, retone } from "../core/ink"
import { phrase, significant, written, type Texts } from "../core/words"
import { ServerEngine } from "../channel/channel"
import type { Command, PageMessage } from "../channel/messages"
import { Connection, PictureLink } from "../channel/connection"
import { ClassPanel } from "../parts/class_panel"
import { Column } from "../parts/column"
import { Downloads } from "../parts/downloads"
import type { FormHost } from "../parts/fields"
import { Form } from "../parts/form"
import { Lens } from "../parts/lens"
import { keptLook } from "../parts/look"
import { OverStage } from "../parts/over_stage"
import { Plant } from "../parts/plant"
import { ask } from "../parts/question"
import { significantly } from "../parts/row"
import { Strip } from "../parts/strip"
import { Sketch } from "../parts/sketch"
import { SymbolOverlay } from "../parts/symbol_overlay"
import { Transport } from "../parts/transport"
import { Voice } from "../parts/voice"
import { Shell } from "./shell"

const CHECKED = 250 // [ms] between checks of what viser has put into the page
const RATES = [0.125, 0.25, 0.5, 1, 2, 4]
const RESTS = 300 // [ms] for which the canvas keeps its size, until the lab is told of it
const NUMBERS = 100 // [ms] between changes of the large numbers
const INVITES = ["hold", "let_go"] // invitations to press the main button
const LARGER = 1.7 // scale of charts and lenses for a projector
const UPRIGHT = matchMedia("(width <= 36em), (aspect-ratio <= 4/5)")
const PHONE = matchMedia("(width <= 36em)")

/** Our part of the page, in one language. */
class Face {
    private readonly ended = new AbortController()
    private readonly strip: Strip
    private readonly lenses: Lens[]
    private readonly overlay: SymbolOverlay
    private readonly sketch: Sketch
    private readonly numbers: HTMLElement[]
    private readonly readings: HTMLElement[]
    private readonly stage: OverStage
    private readonly room = made("div", "op-room") // that the robots' picture has, or will have
    private readonly element: HTMLElement
    private readonly undo = made("button", "undo")
    private readonly transport: Transport
    private readonly clock = made("span", "clock")
    private readonly column: Column
    private readonly voice: Voice
    private readonly shell: Shell
    private klass: ClassPanel | null = null
    private canvas: HTMLElement | null = null
    private width = 0 // of the canvas, [px]
    private height = 0
    private readonly forms = new Map<FormMessage["place"], Form>()
    private resizing = 0
    private read = 0

    /** `reopen`: what was open before the page got these texts. */
    constructor(private readonly engine: ServerEngine, private readonly texts: Texts, reopen = "") {
        const { signal } = this.ended
        const indices = engine.texts.map((_, i) => i)
        this.strip = new Strip(texts, engine, signal, "onpath-rows", {
            choose: () => void this.shell.open("log"), remove: () => engine.send({ do: "RemoveLog" }),
        })
        this.lenses = indices.map(i => new Lens(texts, engine, i, signal))
        this.overlay = new SymbolOverlay(engine)
        this.sketch = new Sketch(engine, signal)
        this.numbers = indices.map(() => made("b", "number"))
        this.transport = new Transport(texts, engine, ["hold", "run", "step", "reset"], signal, RATES)
        this.readings = indices.map(i => made("div", `reading side${i}`, made("span", "value", this.numbers[i]!, " mm"), made("span", "whose")))
        for (const reading of this.readings) reading.role = "group"
        this.stage = new OverStage(engine, texts, this.overlay.element, this.sketch.element)
        Object.assign(this.undo, { type: "button", textContent: phrase(texts, "past.undo"), title: phrase(texts, "past.undo_hint") })
        this.undo.addEventListener("click", () => engine.send({ do: "UndoGoOn" }))
        const time = made("label", "", phrase(texts, "run.rate"), this.transport.rate)
        this.strip.menu.begin(time, phrase(texts, "plots.time"), phrase(texts, "plots.time_hint"))
        this.transport.add(this.undo, this.strip.menu.element)
        const head = made("div", "head", this.transport.element, this.clock)
        this.column = new Column(texts, engine, () => true, symbol => this.light(symbol), signal)
        this.element = made("section", "", head, made("div", "numbers", ...this.readings), this.strip.element, this.column.beneath)
        this.element.id = "op-strip"
        this.element.ariaLabel = phrase(texts, "chart.title")
        this.voice = new Voice(engine, texts, () => UPRIGHT.matches, signal)
        this.shell = new Shell(engine, texts, signal, reopen)
        document.body.prepend(this.room, this.stage.element, this.voice.element, this.column.element, this.element, ...this.shell.elements,
            new Downloads(engine.files, texts, signal).element)
        if (engine.lab!.plant) new Plant(texts, engine, signal)
        engine.askForm()
        engine.on(change => {
            if (change === "form") this.showForms()
            else if (change === "values") for (const form of this.forms.values()) form.update()
        }, signal)
        this.showForms()
        engine.on(change => {
            if (change === "lesson") this.hear()
            else if (change === "measured") this.column.measure(engine.measured!)
            else if (change !== "samples") this.show()
        }, signal)
        PHONE.addEventListener("change", () => this.arrange(), { signal })
        UPRIGHT.addEventListener("change", () => this.column.arrange(), { signal })
        this.arrange()
        this.show()
        if (engine.lesson) this.hear()
        if (engine.measured) this.column.measure(engine.measured)
        requestAnimationFrame(now => this.frame(now))
    }

    /** Another step of a lesson is open, or none. */
    private hear(): void {
        const lesson = this.engine.lesson!
        this.column.hear(lesson)
        const step = lesson.lesson ? lesson.steps[lesson.index] : undefined
        this.strip.follows(step)
        this.showForms()
        this.transport.subdued = this.column.leads
        this.clock.hidden = this.column.leads && !this.column.playing // its instants are those of the run to come
    }

    /** Show the settings: those of the lab in the panel, those of a step in its card. */
    private showForms(): void {
        const { engine, texts, shell, forms, column } = this, { settings } = engine
        const host: FormHost = {
            texts, value: settings.value, refused: settings.refused, waits: settings.waits,
            set: (name, value) => settings.set(name, value),
            act: ({ name, label, act, asks }) => {
                const send = () => (act ? engine.send(act as Command | PageMessage) : shell.go(name))
                if (asks) ask(texts, label, asks, send)
                else send()
            },
        }
        for (const [place, data] of engine.forms) {
            const form = forms.get(place)
            if (form) form.show(data)
            else forms.set(place, new Form(data, host, this.ended.signal))
        }
        const lab = forms.get("lab"), step = forms.get("step")
        if (lab && !shell.form) {
            shell.form = lab
            shell.panel.fill(lab.element)
        }
        this.showClass()
        if (!step) return
        if (!engine.forms.get("step")!.groups.length) step.element.remove()
        else if (!step.element.isConnected) column.offer(step.element) // once: what is moved loses the focus
    }

    /** Show a teacher the class in the place of lessons. */
    private showClass(): void {
        const { engine, texts, forms, column } = this, data = engine.forms.get("class")
        if (!data?.groups.length) return column.lend(null)
        this.klass ??= new ClassPanel(texts, forms.get("class")!)
        this.klass.show(data, engine.lab!.presenting)
        column.lend(this.klass.element)
    }

    /** Remove it; returns what was open. */
    end(): string {
        this.ended.abort() // first: a box that is removed while somebody types in it is not left
        const open = this.shell.end()
        for (const element of [this.column.element, this.room, this.stage.element, this.element]) element.remove()
        document.documentElement.classList.remove("op-large", "op-lesson", "op-waits", "op-plays")
        return open
    }

    /** Follow viser's canvas, which changes its size, or is replaced. Not to be called by a ResizeObserver, or a lens misses its own new size. */
    place(): void {
        const canvas = webgl.works ? document.querySelector<HTMLElement>("canvas[data-engine]") : null
        const { left, top, width, height } = (canvas ?? this.room).getBoundingClientRect()
        if (height > 0) this.engine.shape = width / height
        if (canvas && (width !== this.width || height !== this.height)) {
            clearTimeout(this.resizing)
            this.resizing = window.setTimeout(() => this.engine.send({ is: "resized", upright: UPRIGHT.matches }), RESTS)
        }
        Object.assign(this, { width, height })
        if (canvas !== this.canvas && canvas) {
            this.canvas = canvas
            Object.assign(canvas, { role: "img", ariaLabel: phrase(this.texts, "page.scene") })
            const observer = new ResizeObserver(() => requestAnimationFrame(() => this.ended.signal.aborted || this.place()))
            observer.observe(canvas)
            this.ended.signal.addEventListener("abort", () => observer.disconnect())
        }
        this.voice.place(left, top, width, height)
        this.stage.place(left, top, width, height)
    }

    /** Put the lenses on the stage, or into the strip on a telephone. */
    private arrange(): void {
        this.lenses.forEach((lens, i) => {
            if (PHONE.matches) this.readings[i]!.prepend(lens.element)
            else this.stage.sides[i]!.append(lens.element)
        })
        this.column.arrange()
        this.place()
    }

    private show(): void {
        const { engine, transport } = this
        this.stage.show()
        engine.texts.forEach(({ name }, i) => {
            this.readings[i]!.ariaLabel = name
            tell(this.readings[i]!.querySelector<HTMLElement>(".whose")!, name)
        })
        this.undo.hidden = !engine.lab!.undo
        transport.element.classList.toggle("looks", !engine.lab!.own || engine.lab!.plant !== null)
        transport.invited = INVITES.includes(engine.lab!.said.invitation)
        this.enlarge(engine.lab!.presenting)
        if (this.klass) this.showClass()
        this.read = 0
    }

    /** Show on the robots and in the lenses what a symbol means. */
    private light(symbol: string): void {
        this.engine.light(symbol)
        for (const picture of [this.overlay, ...this.lenses]) picture.lit = symbol
        const gain = symbol.startsWith("K_") ? symbol.replace("_", "") : ""
        for (const form of this.forms.values()) form.light(gain)
    }

    /** Draw for a projector, or for a screen. */
    private enlarge(large: boolean): void {
        document.documentElement.classList.toggle("op-large", large)
        enlarge(large ? LARGER : 1)
    }

    private frame(now: number): void {
        if (this.ended.signal.aborted) return
        const { engine, strip, lenses, texts } = this
        strip.draw(now)
        this.overlay.draw()
        this.sketch.draw()
        for (const lens of lenses) {
            lens.scale = this.height / engine.lab!.height / lens.sheet.zoom || lens.scale
            lens.draw(now)
        }
        if (now > this.read + NUMBERS) {
            this.read = now
            const { time, sides } = shown(engine), { running } = engine.state
            sides.forEach((side, i) => tell(this.numbers[i]!, significantly(texts, 1e3 * side.distance, strip.chart.axes)))
            const clock = { time: written(texts, time, running ? 1 : 2), speed: significant(texts, engine.lab!.achieved, 2) }
            tell(this.clock, phrase(texts, running ? "readout.running" : "readout.paused", clock))
        }
        requestAnimationFrame(next => this.frame(next))
    }
}

/** Show our part of the page as soon as the lab has told of itself, whether or not viser's has come. */
function showLab(): void {
    const root = document.documentElement
    const scheme = new Scheme()
    const engine = new ServerEngine(() => ({ dark: scheme.dark, plain: webgl.plain, upright: UPRIGHT.matches })), connection = new Connection(engine, new PictureLink())
    let face: Face | null = null
    let words: Texts | null = null, reopen = "", calmed = !matchMedia("(prefers-reduced-motion: reduce)").matches
    root.classList.add("op-loading")
    const follow = () => {
        scheme.check(engine)
        if (engine.ready && document.body) {
            if (engine.words !== words) {
                reopen = face?.end() ?? ""
                words = engine.words!
                root.lang = engine.words!.language
                face = new Face(engine, words, reopen)
                root.classList.remove("op-loading")
            }
            face!.place()
            if (!calmed) {
                calmed = true // users who ask for less motion begin with a lab at rest
                engine.act({ do: "run", on: false })
            }
        }
        connection.check(face !== null)
    }
    setInterval(follow, CHECKED)
    engine.on(change => { if (change === "words" || !face) follow() })
    follow()
    Object.assign(window, { onpathLab: engine }) // for tests
}

/** Whether the page is dark, as the system or its user wants. The page is at once; the lab is told for the robots'
 * picture, which is rebuilt, as soon as nothing is dragged there. */
class Scheme {
    dark = false
    private told = false
    private pressed = false
    private readonly asked = matchMedia("(prefers-color-scheme: dark)")

    constructor() {
        this.follow()
        this.told = this.dark
        this.asked.addEventListener("change", () => this.follow())
        addEventListener("op-look", () => this.follow())
        for (const [name, down] of [["pointerdown", true], ["pointerup", false], ["pointercancel", false]] as const)
            addEventListener(name, () => { this.pressed = down }, { capture: true })
    }

    private follow(): void {
        if (matchMedia("print").matches) return // paper is light
        const look = keptLook()
        this.dark = look === "system" ? this.asked.matches : look === "dark"
        document.documentElement.classList.toggle("op-dark", this.dark)
        retone()
    }

    check(engine: ServerEngine): void {
        if (this.dark === this.told || !engine.connected || this.pressed) return
        this.told = this.dark
        engine.send({ is: "dark", on: this.dark })
    }
}

showLab()
