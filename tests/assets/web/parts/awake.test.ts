import { chance } from "../random"
import assert from "node:assert/strict"
import { test } from "node:test"
import { Awake } from "../../../../assets/web/parts/awake"

// The screen of a phone is kept on while that is wanted, and never longer, however quickly it is wanted and not.

const turn = () => new Promise(resolve => void setTimeout(resolve, 0))

test("at most one lock is held, and none when none is wanted", async () => {
    for (let seed = 1; seed <= 60; seed++) {
        const draw = chance(seed), locks: { released: boolean }[] = []
        let refuses = false
        const held = () => locks.filter(each => !each.released).length
        const request = async () => {
            await turn()
            if (refuses) throw new Error("low battery")
            const lock = { released: false, release: async () => { await turn(); lock.released = true } }
            locks.push(lock)
            return lock
        }
        Object.defineProperty(navigator, "wakeLock", { value: { request }, configurable: true })
        const awake = new Awake()
        let wanted = false
        for (let i = 0; i < 12; i++) {
            const move = draw()
            if (move < 0.7) void awake.keep((wanted = draw() < 0.5))
            else if (move < 0.8) refuses = !refuses
            else if (move < 0.9) for (const lock of locks) lock.released = true // the page was hidden
            else await turn()
            assert.ok(held() <= 1)
        }
        refuses = false
        await awake.keep(wanted)
        assert.equal(held(), Number(wanted))
    }
})
