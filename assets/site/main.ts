// The pages of the static site: see app/exports/site.

import { judge } from "./checks"
import type { PageData } from "./data"
import { LessonPage } from "./lesson"
import { LocalProgress } from "./progress"
import { ScormProgress } from "./scorm"
import { StartPage } from "./start"

const page = JSON.parse(document.getElementById("data")!.textContent!) as PageData
const local = new LocalProgress()
const progress = (page.scorm && ScormProgress.found(page.scorm)) || local
const site = page.lesson ? new LessonPage(page, progress) : new StartPage(page, local)
Object.assign(window, { site, judge }) // for tests
