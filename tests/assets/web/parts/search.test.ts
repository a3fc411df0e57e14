import assert from "node:assert/strict"
import { test } from "node:test"
import { plain, ranked, type Entry } from "../../../../assets/web/parts/search"

const entry = (label: string, text = "", kind = "Setting"): Entry => ({ kind, label, text, go: () => {} })
const labels = (found: Entry[]) => found.map(each => each.label)

test("accents, subscripts and signs do not matter", () => {
    assert.equal(plain("Größe K₁: √(x)"), "große k1 x")
    assert.deepEqual(labels(ranked([entry("K₃ across"), entry("Wall")], "k3")), ["K₃ across"])
})

test("a name counts more than a sentence, its beginning more than its middle", () => {
    const all = [entry("Brake", "a wall is not one"), entry("Firewall"), entry("The wall"), entry("Wall angle"), entry("Wall")]
    assert.deepEqual(labels(ranked(all, "wall")), ["Wall", "Wall angle", "The wall", "Firewall", "Brake"])
})

test("every word must be found, in any order; without a word everything is", () => {
    const all = [entry("Path following: left", "", "Law"), entry("Path following: right", "", "Law"), entry("Path")]
    assert.deepEqual(labels(ranked(all, "right law path")), ["Path following: right"])
    assert.deepEqual(ranked(all, "  "), all)
    assert.deepEqual(ranked(all, "xyz"), [])
})
