// Language, look, and what is heard: settings of this browser.

import type { Command, DisplaySheet, PageMessage } from "../channel/messages"
import { made, switchInput } from "../core/dom"
import { phrase, type Texts } from "../core/words"
import { LOOKS, type Look } from "./look"
import { pressed, SheetDialog } from "./sheet"

/** What the sheet shows and changes. */
interface Display {
    language: string
    large: boolean
    look: Look
    send(message: Command | PageMessage): void
    setLook(look: Look): void
    /** Opens what asks for a teacher's key; null where there is no class. */
    teach: (() => void) | null
}

export function display(texts: Texts, { languages, speaks, sounds }: DisplaySheet, host: Display): SheetDialog {
    const sheet = new SheetDialog(texts, "display", phrase(texts, "display.title"))
    const language = chosen("language", languages.map(({ code, name }) => [code, name] as const), host.language, code => host.send({ do: "SetLanguage", language: code }))
    const look = chosen("look", LOOKS.map(each => [each, phrase(texts, `look.${each}`)] as const), host.look, each => host.setLook(each as Look))
    const toggle = (key: string, on: boolean, set: (on: boolean) => void) => {
        const box = switchInput({ checked: on })
        box.addEventListener("change", () => set(box.checked))
        return made("label", "row", made("span", "", phrase(texts, key)), box)
    }
    sheet.body.append(
        made("label", "row", made("span", "", phrase(texts, "lesson.language")), language),
        made("label", "row", made("span", "", phrase(texts, "look.title")), look),
        toggle("lesson.presenting", host.large, on => host.send({ do: "Set", name: "presenting", value: on })),
        toggle("display.speaks", speaks, on => host.send({ is: "prefer", name: "speaks", on })),
        toggle("display.sounds", sounds, on => host.send({ is: "prefer", name: "sounds", on })),
    )
    if (host.teach) sheet.body.append(made("p", "row", pressed("", phrase(texts, "class.teacher"), host.teach)))
    sheet.open(language)
    return sheet
}

function chosen(name: string, options: readonly (readonly [string, string])[], now: string, set: (value: string) => void): HTMLSelectElement {
    const select = made("select", "", ...options.map(([value, label]) => Object.assign(made("option", "", label), { value })))
    select.name = name
    select.value = now
    select.addEventListener("change", () => set(select.value))
    return select
}
