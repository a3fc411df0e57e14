import "../page"
import assert from "node:assert/strict"
import { test } from "node:test"
import { made, tell } from "../../../../assets/web/core/dom"

test("an element says its last text, with the node of the one before it, and without elements", () => {
    const element = made("p", "", made("b", "", "at first"))
    for (const text of ["0.1 mm", "0.2 mm", "<b>0.3</b> mm"]) {
        const before = element.firstElementChild ? null : element.firstChild
        tell(element, text)
        assert.equal(element.textContent, text)
        assert.equal(element.children.length, 0)
        if (before) assert.equal(element.firstChild, before)
    }
    tell(element, "")
    assert.equal(element.childNodes.length, 0)
    tell(element, "again")
    assert.equal(element.textContent, "again")
})
