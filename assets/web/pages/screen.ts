// Opens a page of a class that has no lab of its own: its wall or its remote control.

import type { ServerEngine } from "../channel/channel"
import { Connection } from "../channel/connection"

const CHECKED = 250 // [ms] between checks of the connection

/** Show a page as soon as the server has told what it needs. */
export function openScreen(engine: ServerEngine, make: () => HTMLElement): void {
    const connection = new Connection(engine, null)
    let shown = false
    const follow = () => {
        if (engine.ready && !shown) {
            shown = true
            document.documentElement.classList.remove("op-loading")
            document.body.prepend(make())
        }
        connection.check(shown)
    }
    setInterval(follow, CHECKED)
    engine.on(() => { if (!shown) follow() })
    follow()
    Object.assign(window, { onpathLab: engine }) // for tests
}
