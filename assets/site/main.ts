// The pages of the static site: see app/exports/site.

import type { PageData } from "./data"
import { LessonPage } from "./lesson"
import { LocalProgress } from "./progress"
import { StartPage } from "./start"

const page = JSON.parse(document.getElementById("data")!.textContent!) as PageData
const progress = new LocalProgress()
// For tests: the open page.
Object.assign(window, { site: page.lesson ? new LessonPage(page, progress) : new StartPage(page, progress) })
