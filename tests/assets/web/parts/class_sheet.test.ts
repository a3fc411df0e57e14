import { found, TEXTS } from "../page"
import assert from "node:assert/strict"
import { test } from "node:test"
import type { ClassMessage, PageMessage } from "../../../../assets/web/channel/messages"
import { ClassSheet } from "../../../../assets/web/parts/class_sheet"

const NONE = { code: "", name: "", longest: 0, stored: "", privacy: "", away: "", asked: false, asks: "", identification: "", linked: "" } as const
const GUEST: ClassMessage = { ...NONE, is: "class", membership: "guest", code: "ABC234", longest: 5, stored: "all of it", privacy: "https://x.example/p" }
const MEMBER: ClassMessage = { ...GUEST, membership: "member", name: "<img src=x>" }
const ELSEWHERE: ClassMessage = { ...NONE, is: "class", membership: "elsewhere" }

function opened(seat: ClassMessage, teaches = false, isGone = false) {
    for (const each of document.querySelectorAll("dialog")) each.remove()
    const sent: PageMessage[] = []
    let closed = 0, asked = 0
    const card = new ClassSheet(TEXTS, teaches, { send: message => sent.push(message), closed: () => closed++, teach: () => asked++ })
    const { body, element } = card.open(seat, isGone)
    const field = () => body.querySelector<HTMLInputElement>("form input")!
    const submit = (typed: string) => {
        field().value = typed
        field().dispatchEvent(new Event("input", { bubbles: true }))
        body.querySelector("form")!.dispatchEvent(new Event("submit", { cancelable: true }))
    }
    const refusal = () => body.querySelector("[role=alert]")!.textContent
    return { card, body, element, field, submit, refusal, sent, isClosed: () => closed > 0, isAsked: () => asked > 0 }
}

test("a nickname is asked for with its bound, what is stored can be opened, and one request is sent at a time", () => {
    const { card, body, element, submit, field, refusal, sent } = opened(GUEST)
    assert.match(element.querySelector("h2")!.textContent, /ABC234/)
    assert.equal(document.activeElement, field())
    assert.equal(field().getAttribute("aria-required"), "true")
    assert.match(body.querySelector("details")!.textContent, /class\.what_stored.*all of it/)
    assert.equal(body.querySelector<HTMLAnchorElement>("details a")!.href, GUEST.privacy)
    submit("123456")
    assert.deepEqual([sent.length, refusal()], [0, "class.too_long"])
    submit(" Zoë👩‍🔬 ") // four characters, as readers see them
    submit("again")
    assert.deepEqual(sent, [{ is: "join", code: "", name: "Zoë👩‍🔬" }])
    card.hear({ is: "seat", of: "join", why: "<b>this class is full</b>", address: "" })
    assert.deepEqual([refusal(), field().ariaInvalid, body.querySelector("b")], ["<b>this class is full</b>", "true", null])
    submit("")
    assert.deepEqual(sent[1], { is: "join", code: "", name: "" }) // the lab says that it needs a name
    card.show(GUEST) // the connection was lost, and with it the answer
    submit("Mia")
    assert.equal(sent.length, 3)
})

test("half a nickname stays in another language, and in a page that is loaded anew, until it is taken", () => {
    const { card, field, body } = opened(GUEST)
    field().value = "Mi"
    field().dispatchEvent(new Event("input", { bubbles: true }))
    card.show({ ...GUEST, stored: "alles" })
    assert.deepEqual([field().value, document.activeElement === field()], ["Mi", true])
    assert.match(body.textContent, /alles/)
    assert.equal(opened(GUEST).field().value, "Mi")
    opened(MEMBER)
    assert.equal(opened(GUEST).field().value, "")
})

test("a member sees the own name as text, what comes next, and the way out", () => {
    const { body, sent } = opened(MEMBER)
    assert.equal(body.querySelector("bdi")!.textContent, MEMBER.name)
    assert.equal(body.querySelector("img"), null)
    assert.match(body.textContent, /class\.then/)
    found(body, "button", "class.leave").click()
    assert.deepEqual(sent, [{ is: "leave" }])
    assert.ok((found(body, "button", "class.leave") as HTMLButtonElement).disabled)
})

test("elsewhere a class's code leads to its address, once", () => {
    const { card, body, submit, sent } = opened(ELSEWHERE)
    submit("abc234")
    assert.deepEqual(sent, [{ is: "join", code: "abc234", name: "" }])
    for (let k = 0; k < 2; k++) card.hear({ is: "seat", of: "join", why: "", address: "../c/abc234/" })
    const links = [...body.querySelectorAll("a")]
    assert.deepEqual(links.map(each => each.textContent), ["class.elsewhere"])
    assert.equal(document.activeElement, links[0])
    assert.match(links[0]!.href, /\/c\/abc234\/$/)
})

test("a teacher's key is not shown, not kept, and nobody is asked for it with the nickname", () => {
    const { card, field, submit, sent, refusal } = opened(GUEST, true)
    assert.equal(field().type, "password")
    submit("K7MF-2XQA-9TZR")
    assert.deepEqual(sent, [{ is: "teach", key: "K7MF-2XQA-9TZR" }])
    card.hear({ is: "seat", of: "teach", why: "this is not the teacher's key", address: "" })
    assert.equal(refusal(), "this is not the teacher's key")
    for (const storage of [localStorage, sessionStorage])
        for (let k = 0; k < storage.length; k++) assert.doesNotMatch(storage.getItem(storage.key(k)!)!, /K7MF/)
    assert.equal(opened(GUEST).body.querySelector("input[type=password]"), null)
})

test("who is no member any more is told so, and may join again", () => {
    const { body, field } = opened(GUEST, false, true)
    assert.equal(body.querySelector("[role=status]")!.textContent, "class.gone")
    assert.ok(field())
})

test("somebody of the same name who is away is offered once, and asked about", () => {
    const { body, sent, card } = opened({ ...MEMBER, away: "Ada" })
    assert.match(body.textContent, /class.is_it_you/)
    body.querySelectorAll("button").forEach(each => each.textContent === "class.ask_place" && each.click())
    assert.deepEqual(sent, [{ is: "ask_place" }])
    card.show({ ...MEMBER, away: "Ada", asked: true })
    assert.match(body.textContent, /class.place_asked/)
    assert.ok([...body.querySelectorAll("button")].every(each => each.textContent !== "class.ask_place"))
    card.show(MEMBER)
    assert.doesNotMatch(body.textContent, /class.is_it_you|class.place_asked/)
})

test("a member is asked only for what the teacher asks for, and a word may be given and taken back", () => {
    const silent = opened(MEMBER)
    assert.deepEqual([...silent.body.querySelectorAll("form")].map(each => each.querySelector("label")!.textContent), ["class.word"])
    const { card, body, sent, refusal } = opened({ ...MEMBER, asks: "ID number (your teacher sees this)", identification: "<b>12" })
    const [told, word] = [...body.querySelectorAll("form")]
    const field = told!.querySelector("input")!
    assert.deepEqual([told!.querySelector("label")!.textContent, field.value], ["ID number (your teacher sees this)", "<b>12"])
    const submit = (form: HTMLFormElement, typed: string) => {
        form.querySelector("input")!.value = typed
        form.dispatchEvent(new Event("submit", { cancelable: true }))
    }
    submit(told!, " 34 ")
    submit(told!, "56") // one at a time
    card.hear({ is: "seat", of: "identify", why: "", address: "" })
    submit(told!, "")
    submit(word!, "cactus")
    assert.deepEqual(sent, [{ is: "identify", typed: "34" }, { is: "identify", typed: "" }, { is: "link", word: "cactus" }])
    card.hear({ is: "seat", of: "link", why: "too short", address: "" })
    assert.deepEqual([refusal(), word!.querySelector("input")!.ariaInvalid, field.ariaInvalid], ["too short", "true", null])
    assert.match(told!.textContent, /class\.id_known/)
    assert.doesNotMatch(opened({ ...MEMBER, asks: "ID number" }).body.textContent, /class\.id_known/)
    card.show({ ...MEMBER, linked: "own" })
    assert.match(body.textContent, /class\.word_own/)
    card.show({ ...MEMBER, linked: "shared" })
    assert.match(body.querySelector<HTMLDetailsElement>("details.word")!.textContent, /class\.word_shared/)
    assert.equal(body.querySelector<HTMLDetailsElement>("details.word")!.open, true)
})

test("who has come to teach finds the key's card where a nickname or a code is asked for, and nowhere else", () => {
    const button = (body: HTMLElement) => [...body.querySelectorAll("button")].find(each => each.textContent === "class.teacher")
    for (const seat of [GUEST, ELSEWHERE]) {
        const { body, isAsked } = opened(seat)
        button(body)!.click()
        assert.ok(isAsked())
    }
    assert.equal(button(opened(MEMBER).body), undefined)
    assert.equal(button(opened(GUEST, true).body), undefined)
})
