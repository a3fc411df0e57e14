// A question before something that cannot be undone.

import { made } from "../core/dom"
import { phrase, type Texts } from "../core/words"
import { pressed, SheetDialog } from "./sheet"

/** Do something once the user has said yes. */
export function ask(texts: Texts, title: string, question: string, act: () => void): void {
    const sheet = new SheetDialog(texts, "question", title)
    const no = pressed("", phrase(texts, "question.no"), () => sheet.close())
    const yes = pressed("warning", phrase(texts, "question.yes"), () => {
        sheet.close()
        act()
    })
    sheet.body.append(made("p", "", question), made("div", "row", no, yes))
    sheet.open(no)
}
