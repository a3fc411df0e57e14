// The lessons in their order, how far one is, and the routes.

import type { Command, LessonCard, LessonSheet, RouteCard } from "../channel/messages"
import { made } from "../core/dom"
import { nextLesson } from "../core/next_lesson"
import { phrase, type Texts } from "../core/words"
import { icon } from "./icons"
import { pressed, SheetDialog } from "./sheet"

type Send = (command: Command) => void

export function chooseLesson(texts: Texts, { lessons, routes, open }: LessonSheet, send: Send): SheetDialog {
    const sheet = new SheetDialog(texts, "lessons", phrase(texts, "lesson.choose"))
    const go: Send = command => {
        sheet.close()
        send(command)
    }
    const next = lessons.find(each => each.name === open && !each.finished) ?? nextLesson(lessons)
    const cards = lessons.map(lesson => [lesson, cardOf(texts, lesson, lesson === next, () => go({ do: "OpenLesson", name: lesson.name }))] as const)
    const list = made("ol", "lessons", ...cards.map(([, card]) => made("li", "", card)))
    sheet.body.append(list)
    if (routes.length) sheet.body.append(made("h3", "", phrase(texts, "route.routes")), ...routes.map(route => routeOf(texts, route, go)))
    sheet.open(cards.find(([lesson]) => lesson === next)?.[1])
    return sheet
}

/** A lesson as one button, with its picture; below that, how much is done of one that is begun. */
function cardOf(texts: Texts, lesson: LessonCard, isNext: boolean, act: () => void): HTMLElement {
    const name = lesson.number ? `${lesson.number}. ${lesson.title}` : lesson.title
    const state = lesson.finished ? "lesson.done" : lesson.begun ? "lesson.begun" : ""
    const done = lesson.begun && !lesson.finished ? [`${Math.round(100 * lesson.done)} %`] : [] // the bar says it only to the eye
    const facts = [...(state ? [phrase(texts, state)] : []), ...done, ...lesson.facts].flatMap(each => [" · ", made("span", "", each)]).slice(1)
    const card = pressed(`card${isNext ? " next" : ""}`, "", act)
    card.append(made("b", "", name), made("span", "summary", lesson.summary), made("span", "facts", lesson.finished ? icon("done") : "", ...facts))
    if (lesson.picture) card.prepend(Object.assign(made("img", "about"), { src: lesson.picture, alt: "" })) // its title stands beside it
    if (lesson.begun && !lesson.finished) card.append(Object.assign(made("progress", ""), { value: lesson.done, ariaHidden: "true" }))
    if (isNext) card.append(made("b", "here", phrase(texts, lesson.begun ? "lesson.go_on_here" : "lesson.begin_here")))
    return card
}

function routeOf(texts: Texts, { name, title, summary, minutes, stops }: RouteCard, go: Send): HTMLElement {
    const follow = pressed("", phrase(texts, "route.follow"), () => go({ do: "FollowRoute", name }))
    follow.setAttribute("aria-label", `${phrase(texts, "route.follow")}: ${title}`)
    const heading = made("summary", "", made("b", "", title), " ", made("span", "facts", minutes))
    return made("details", "route", heading, made("p", "", summary), made("ul", "", ...stops.map(stop => made("li", "", stop))), follow)
}
