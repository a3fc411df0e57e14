// The pages of the static site: see app/exports/site.

import { made } from "../standalone/controls"
import { judge } from "./checks"
import { said, type PageData } from "./data"
import { gradeOf } from "./grade"
import { LessonPage } from "./lesson"
import { packed, unpacked } from "./packed"
import { LocalProgress, type Tell } from "./progress"
import { ScormProgress } from "./scorm"
import { StartPage } from "./start"

const page = JSON.parse(document.getElementById("data")!.textContent!) as PageData
const told = new Set<string>()
const tell: Tell = (key, values) => {
    if (told.has(key)) return
    told.add(key)
    document.querySelector("#notice")!.append(made("p", "op-box", said(page, key, values)))
}
const local = new LocalProgress(tell)
const progress = (page.scorm && ScormProgress.found(page.scorm, tell)) || local
const site = page.lesson ? new LessonPage(page, progress) : new StartPage(page, local)
Object.assign(window, { site, judge, gradeOf, packed, unpacked }) // for tests
