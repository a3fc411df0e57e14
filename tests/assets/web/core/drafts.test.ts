import "../page"
import assert from "node:assert/strict"
import { test } from "node:test"
import { draftOf, keepDraft, keepDraftsOf } from "../../../../assets/web/core/drafts"

test("a draft is there for the lab in which it was made, and for no other", () => {
    for (const lab of ["a", "b"]) {
        keepDraftsOf(lab)
        assert.equal(draftOf("law"), null)
        keepDraft("law", { text: lab })
    }
    keepDraftsOf("a")
    assert.deepEqual(draftOf("law"), { text: "a" })
    keepDraft("law", null)
    assert.equal(draftOf("law"), null)
    keepDraftsOf("b")
    assert.deepEqual(draftOf("law"), { text: "b" })
})

test("what somebody else has put into the storage is no draft", () => {
    keepDraftsOf("c")
    keepDraft("law", { text: "x" })
    for (const text of ["", "{", "null", "5", '"x"']) {
        sessionStorage.setItem(Object.keys(sessionStorage).find(name => name.includes(" c "))!, text)
        assert.equal(draftOf("law"), null)
    }
})
