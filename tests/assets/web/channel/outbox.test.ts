import "../page"
import assert from "node:assert/strict"
import { mock, test } from "node:test"
import { Outbox } from "../../../../assets/web/channel/outbox"
import type { Command } from "../../../../assets/web/channel/messages"

/** A page, whose storage is that of the page before it. */
function page(): { outbox: Outbox; sent: Command[]; told: () => number } {
    const sent: Command[] = []
    let told = 0
    return { sent, outbox: new Outbox(command => sent.push(command), () => void told++), told: () => told }
}

const keyOf = (command: Command | undefined) => (command as { key: string }).key

test("an answer is sent again, under the same key, by each page and connection until it is stored", () => {
    localStorage.clear()
    mock.timers.enable({ apis: ["setTimeout"] })
    const first = page()
    first.outbox.reach("lab")
    first.outbox.post({ do: "Predict", option: 1 }, "a", 3)
    first.outbox.post({ do: "AnswerQuiz", block: 2, option: 0 }, "a", 4)
    const keys = first.sent.map(keyOf)
    assert.equal(new Set(keys).size, 2)
    assert.ok(first.outbox.has("a", "3") && first.outbox.has("a", "4.2") && !first.outbox.has("a", "4") && !first.outbox.has("b", "3"))
    first.outbox.reach("lab") // another connection
    assert.deepEqual(first.sent.slice(2).map(keyOf), keys)
    const second = page() // the page was loaded anew
    second.outbox.reach("lab")
    assert.deepEqual(second.sent, first.sent.slice(0, 2))
    second.outbox.settle([keys[0]!, "another"])
    assert.equal(second.told(), 1)
    assert.ok(!second.outbox.has("a", "3") && second.outbox.has("a", "4.2"))
    const third = page()
    third.outbox.reach("lab")
    assert.deepEqual(third.sent.map(keyOf), [keys[1]])
    third.outbox.settle(keys)
    const last = page()
    last.outbox.reach("lab")
    assert.deepEqual(last.sent, [])
    mock.timers.reset()
})

test("another lab of the browser does not get it, and broken storage is no answer", () => {
    localStorage.clear()
    const one = page()
    one.outbox.reach("lab")
    one.outbox.post({ do: "AnswerNumber", block: 0, given: 2.5 }, "a", 1)
    one.outbox.settle([])
    const other = page()
    other.outbox.reach("other")
    assert.deepEqual(other.sent, [])
    for (const broken of ["[1, null, {}]", "{}", "x", '[{"do": 3}]']) {
        localStorage.setItem("onpath-sending lab", broken)
        const after = page()
        after.outbox.reach("lab")
        assert.deepEqual(after.sent, [])
    }
    one.outbox.settle(one.sent.map(keyOf))
})

test("an answer that gets no reply is sent again by itself, and not once it is stored", () => {
    localStorage.clear()
    mock.timers.enable({ apis: ["setTimeout"] })
    const { outbox, sent } = page()
    outbox.reach("lab")
    outbox.post({ do: "AnswerInWords", block: 1, typed: "b" }, "a", 2)
    mock.timers.tick(4000)
    mock.timers.tick(4000)
    assert.equal(sent.length, 3)
    outbox.settle([keyOf(sent[0])])
    mock.timers.tick(20_000)
    assert.equal(sent.length, 3)
    mock.timers.reset()
})
