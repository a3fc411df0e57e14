// The pages of the static site: see app/exports/site.

import { judge } from "./checks"
import type { PageData } from "./data"
import { LessonPage } from "./lesson"
import { LocalProgress } from "./progress"
import { StartPage } from "./start"

const page = JSON.parse(document.getElementById("data")!.textContent!) as PageData
const progress = new LocalProgress()
const site = page.lesson ? new LessonPage(page, progress) : new StartPage(page, progress)
Object.assign(window, { site, judge }) // for tests
