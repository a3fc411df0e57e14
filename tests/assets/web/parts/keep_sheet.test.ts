import { found, TEXTS } from "../page"
import assert from "node:assert/strict"
import { test } from "node:test"
import type { Command, PageMessage } from "../../../../assets/web/channel/messages"
import { Keep, shareAddress, takenShareCode } from "../../../../assets/web/parts/keep_sheet"

const CODE = "ONPATH1-ABCDEFG234-ABCDEFG"

test("a share code is in the address that is told, is taken from there once, and waits to be used", () => {
    const sent: (Command | PageMessage)[] = []
    for (const path of ["/", "/lab/", "/lab/l/abcdefghjkmn/", "/c/abc/"]) {
        history.replaceState(null, "", path)
        const address = shareAddress(CODE)
        assert.equal(address, `http://localhost${path.startsWith("/lab") ? "/lab" : ""}/#${CODE}`)
        history.replaceState(null, "", `${path}?x=1#${CODE}`)
        const given = takenShareCode()
        assert.equal(given, CODE)
        assert.equal(location.href, `http://localhost${path}?x=1`)
        assert.equal(takenShareCode(), "")
        const { body } = new Keep(TEXTS, { is: "sheet", sheet: "keep", code: "", until: "" } as never, message => sent.push(message), () => {}, given).open()
        assert.equal(sent.length, 0) // nothing is changed before one agrees
        found(body, "button", "keep.use").click()
        assert.deepEqual(sent.splice(0), [{ do: "UseShared", text: CODE }])
    }
})
