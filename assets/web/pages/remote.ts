// The remote control of a class: the teacher's form on a phone, held in one hand. Until the phone is let in, it shows a number.

import { made, tell } from "../core/dom"
import type { FormMessage } from "../core/form_data"
import { phrase, type Texts } from "../core/words"
import { ServerEngine } from "../channel/channel"
import type { Command, PageMessage } from "../channel/messages"
import { Awake } from "../parts/awake"
import { ClassPanel } from "../parts/class_panel"
import type { FormHost } from "../parts/fields"
import { Form } from "../parts/form"
import { ask } from "../parts/question"
import { openScreen } from "./screen"

class Remote {
    readonly element = made("main", "")
    private readonly text = made("p", "ask")
    private readonly number = made("p", "number")
    private panel: ClassPanel | null = null
    private form: Form | null = null
    private readonly host: FormHost
    private readonly awake = new Awake()

    constructor(private readonly engine: ServerEngine, private readonly texts: Texts) {
        const { settings } = engine
        this.host = {
            texts, value: settings.value, refused: settings.refused, waits: settings.waits,
            set: (name, value) => settings.set(name, value),
            act: ({ label, act, asks }) => {
                const send = () => engine.send(act as Command | PageMessage)
                if (asks) ask(texts, label, asks, send)
                else send()
            },
        }
        this.number.role = "status"
        this.element.append(made("h1", "", phrase(texts, "remote.title")), this.text, this.number)
        if (!isSecureContext) this.element.append(made("p", "plain", phrase(texts, "remote.plain")))
        engine.on(() => this.show())
        document.addEventListener("visibilitychange", () => { void this.wake() })
        this.show()
    }

    private show(): void {
        const { engine } = this, told = engine.remote
        if (!told) return
        tell(this.text, told.text)
        tell(this.number, told.number)
        this.text.hidden = this.number.hidden = !told.number
        const data = engine.forms.get("class")
        if (this.panel) this.panel.element.hidden = Boolean(told.number)
        if (data?.groups.length && !told.number) this.showForm(data)
        void this.wake()
    }

    private showForm(data: FormMessage): void {
        if (!this.form) {
            this.form = new Form(data, this.host, new AbortController().signal)
            this.panel = new ClassPanel(this.texts, this.form)
            this.number.after(this.panel.element)
        }
        this.form.show(data)
        this.form.update()
        this.panel!.show(data, false)
    }

    /** Keep the phone awake while a vote is open. */
    private readonly wake = () => this.awake.keep(Boolean(this.engine.remote?.votes) && document.visibilityState === "visible")
}

const engine = new ServerEngine(() => ({ dark: false, plain: true, upright: true }), "remote")
openScreen(engine, () => new Remote(engine, engine.words!).element)
