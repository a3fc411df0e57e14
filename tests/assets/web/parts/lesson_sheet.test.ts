import { TEXTS } from "../page"
import assert from "node:assert/strict"
import { test } from "node:test"
import type { LessonSheet } from "../../../../assets/web/channel/messages"
import { chooseLesson } from "../../../../assets/web/parts/lesson_sheet"
import { chance } from "../random"

test("one card says where to go on: the open lesson, or else the first that is neither finished nor to be skipped", () => {
    const random = chance(1)
    for (let round = 0; round < 100; round++) {
        const lessons = ["", "1", "1b", "2", "3", "3b", ""].map((number, i) => {
            const finished = random() < 0.5
            const begun = finished || random() < 0.5
            return { name: `l${i}`, number, picture: number && "data:,", title: "", summary: "", facts: [], done: finished ? 1 : begun ? 0.4 : 0, begun, finished }
        })
        const open = lessons[Math.floor(random() * 14)]
        const sheet = chooseLesson(TEXTS, { open: open?.name ?? "", lessons, routes: [] } as unknown as LessonSheet, () => undefined)
        const cards = [...document.querySelectorAll(".card")]
        const told = lessons.filter((_, i) => cards[i]!.querySelector(".here"))
        const left = lessons.filter(each => ["1", "2", "3"].includes(each.number) && !each.finished)
        assert.deepEqual(told, open && !open.finished ? [open] : left.slice(0, 1))
        assert.deepEqual(cards.map(card => card.querySelector("progress")?.value), lessons.map(each => (each.begun && !each.finished ? each.done : undefined)))
        assert.deepEqual(cards.map(card => card.textContent.includes("40 %")), lessons.map(each => each.begun && !each.finished))
        assert.deepEqual(cards.map(card => Boolean(card.querySelector("img"))), lessons.map(each => Boolean(each.number)))
        sheet.close()
    }
})
