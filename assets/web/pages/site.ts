// The script of all pages of the course (app/exports/site).

import { made } from "../core/dom"
import type { PageData } from "../core/lesson_data"
import { packed, unpacked } from "../core/packed"
import { shapesOf } from "../core/symbols"
import { phrase } from "../core/words"
import { judge, wayOf } from "../lessons/checks"
import { gradeOf } from "../lessons/grade"
import { LocalProgress, type Tell } from "../lessons/progress"
import { ScormProgress } from "../lessons/scorm"
import { LocalStudent } from "../lessons/student"
import { hearNotes } from "./lecture"
import { Player } from "./player"
import { StartPage } from "./start"

function showPage(page: PageData): void {
    const told = new Set<string>()
    const tell: Tell = (key, values) => {
        if (told.has(key)) return
        told.add(key)
        document.querySelector("#notice")!.append(made("p", "op-box", phrase(page, key, values)))
    }
    const local = new LocalProgress(tell)
    const progress = (page.scorm && ScormProgress.found(page.scorm, tell)) || local
    const site = page.lesson ? new Player(page, progress) : new StartPage(page, local)
    hearNotes()
    Object.assign(window, { LocalStudent, ScormProgress, site, judge, wayOf, gradeOf, packed, unpacked, shapesOf }) // for tests
}

showPage(JSON.parse(document.getElementById("data")!.textContent) as PageData)
