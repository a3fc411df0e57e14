"""A page comes back by itself, and until then says in words what is going on.

The page's own script runs in Chromium against a network and a server that are simulated there, with
a simulated clock. The messages are those of a real lab.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

pytest.importorskip("playwright")

from playwright.sync_api import Browser

from onpath.app.classroom.classroom import Classroom
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.app.server.own_part import own_part
from onpath.app.server.server_options import ServerOptions
from onpath.app.viser_adapter.addresses import class_address
from onpath.app.viser_adapter.page_scripts import our_scripts
from tests.support.own_socket import OwnSocket
from tests.support.waiting import wait_for

SITE = "http://lab.example/"
LONGEST = 30.0  # [s] of a first message
LAST = 120.0  # [s]; later, nothing disturbs
BACK = 30.0  # [s] until a page that stood still is back, and has been for some time
ENOUGH = 12 * LONGEST  # [s] for all first messages one after another, and pauses in between

# What the page finds instead of viser, network and server. `wrong` lists the moments without
# a sentence, and those with one although all is there.
NETWORK = """plan => {
    const OPENS = 40 // [s] that viser's worker lets a websocket take; see connection.ts
    const NOTICED = 5 // [s] until a page may have noticed that nothing comes any more
    const FORGETS = 40 // [s] until a server has noticed that a page does not answer any more
    const now = () => Date.now() / 1000, later = (act, after) => setTimeout(act, 1000 * after)
    const drawn = (() => { let n = 0; return () => plan.delays[n++ % plan.delays.length] })()
    const lab = { up: true, visits: new Map(), tabs: [], datas: [] }
    Object.assign(lab, { wrong: [], whole: 0, same: 0, calm: 0 })
    window.lab = lab
    window.requestAnimationFrame = act => later(() => act(performance.now()), 1)
    Object.defineProperty(navigator, "onLine", { get: () => !lab.offline })
    const seen = () => lab.hidden ? "hidden" : "visible"
    Object.defineProperty(document, "visibilityState", { get: seen })
    lab.hide = hidden => {
        lab.hidden = hidden
        lab.calm = now() + NOTICED
        document.dispatchEvent(new Event("visibilitychange"))
    }
    const reachable = () => lab.up && !lab.offline && !plan.forbidden

    // What the server knows of a page, as long as it has one of its websockets.
    class Visit {
        constructor(page) { Object.assign(this, { page, data: null, tab: null, isOpen: false }) }
        get scene() { return this.tab?.isDrawn ? this.tab.asked : 0 }
        tellScene() { this.data?.tell(JSON.stringify({ is: "state", scene: this.scene })) }
        lose(part, held) {
            if (this[part] !== held) return
            this[part] = null
            if (part === "tab") this.tellScene()
            const isLast = !this.data && !this.tab && lab.visits.get(this.page) === this
            if (isLast) lab.visits.delete(this.page)
        }
    }

    class FakeWorker extends EventTarget {
        constructor() { super(); this.generation = 0 }
        say(data) {
            const event = new MessageEvent("message", { data })
            this.dispatchEvent(event)
        }
        postMessage({ type }) {
            if (type !== "set_server" && type !== "retry") return
            this.leave?.()
            const tab = { at: now(), alive: true, opens: true, mute: false }
            Object.assign(tab, { asked: 0, isDrawn: false, visit: null })
            const generation = ++this.generation, isLast = () => generation === this.generation
            const current = () => tab.alive && isLast()
            const end = () => {
                tab.alive = false
                tab.visit?.lose("tab", tab)
                if (this.current === tab) this.current = null
            }
            tab.drop = () => {
                const tell = current()
                tab.opens = false
                end()
                if (tell) this.say({ type: "closed" })
            }
            tab.die = () => { // and the page does not notice
                tab.alive = false
                tab.visit?.lose("tab", tab)
            }
            tab.fallMute = () => { // and nobody notices: a router has forgotten the connection
                tab.mute = true
                tab.alive = false
                later(() => tab.visit?.lose("tab", tab), FORGETS)
            }
            later(() => {
                if (!isLast() || !tab.opens) return
                tab.alive = true // to be told
                tab.drop()
            }, OPENS)
            this.leave = end
            lab.tabs.push(tab)
            later(() => {
                if (!current()) return
                if (!reachable()) return tab.drop()
                this.current = tab
                tab.opens = false
                this.say({ type: "connected" })
                later(() => current() && this.belong(tab), drawn()) // asked, and answered
            }, reachable() ? drawn() : 0.01)
        }
        belong(tab) {
            const [page, asked] = (localStorage.getItem("viser-user:page") ?? "").split(".")
            const visit = lab.visits.get(page)
            if (!visit) return tab.drop()
            visit.tab?.drop()
            Object.assign(tab, { visit, asked: Number(asked) })
            visit.tab = tab
            later(() => {
                if (!tab.alive || this.current !== tab) return
                this.say({ type: "message_batch" })
                tab.isDrawn = true
                visit.tellScene()
            }, drawn())
        }
        get isWhole() {
            const shown = this.current?.isDrawn ? this.current.asked : 0
            return Boolean(shown && lab.datas.some(data => data.hears && data.scene === shown))
        }
    }
    window.Worker = FakeWorker
    window.fetch = async () => {
        if (!lab.up || lab.offline) throw new TypeError("no network")
        return { status: plan.forbidden ? 403 : 200 }
    }
    window.WebSocket = class extends EventTarget {
        static OPEN = 1
        constructor() {
            super()
            Object.assign(this, { readyState: 0, at: now(), visit: null, scene: -1 })
            lab.datas.push(this)
            later(() => {
                if (this.readyState > 1) return
                if (!reachable()) return this.end(1006)
                this.readyState = 1
                this.dispatchEvent(new Event("open"))
            }, reachable() ? drawn() : 0.01)
        }
        send(text) {
            const { is, page } = JSON.parse(text)
            if (is !== "hello") return
            later(() => {
                if (this.mute || this.readyState !== 1) return
                let visit = lab.visits.get(page)
                if (!visit) lab.visits.set(page, visit = new Visit(page))
                visit.data?.end(1001)
                visit.data = this
                if (plan.waits && !visit.isOpen) this.hear('{"is":"wait","text":"full"}')
                later(() => {
                    if (visit.data !== this || this.mute || this.readyState !== 1) return
                    visit.isOpen = true
                    this.visit = visit
                    for (const message of plan.messages) this.hear(message)
                    visit.tellScene()
                    this.beat()
                }, plan.waits ?? drawn())
            }, drawn())
        }
        beat() {
            if (this.readyState !== 1 || this.mute) return
            this.hear('{"is":"alive"}')
            later(() => this.beat(), 1)
        }
        tell(text) {
            if (this.hears) this.hear(text)
        }
        hear(data) {
            const message = JSON.parse(data)
            if (message.is === "state" && "scene" in message) this.scene = message.scene
            this.dispatchEvent(new MessageEvent("message", { data }))
        }
        fallMute() {
            this.mute = true
            later(() => this.forget(), FORGETS)
        }
        forget() { for (const visit of lab.visits.values()) visit.lose("data", this) }
        get hears() { return this.visit && !this.mute && this.readyState === 1 }
        end(code) {
            if (this.readyState > 1) return
            this.readyState = 3
            lab.same = 0
            this.forget()
            const event = new Event("close")
            event.code = code
            this.dispatchEvent(event)
        }
        close() { later(() => this.end(1000), 0.01) }
    }

    const faults = {
        viser: () => lab.tabs.forEach(tab => tab.drop()),
        silently: () => lab.tabs.forEach(tab => tab.die()),
        mute: () => {
            for (const tab of lab.tabs) if (tab.alive) tab.fallMute()
            for (const data of lab.datas) data.fallMute()
            lab.calm = now() + NOTICED
        },
        data: code => lab.datas.forEach(data => data.end(code)),
        restart: (_, lasts) => {
            lab.up = false
            faults.viser()
            faults.data(1006)
            lab.visits.clear()
            later(() => (lab.up = true), lasts)
        },
        offline: (_, lasts) => {
            lab.offline = true
            faults.viser()
            faults.data(1006)
            later(() => { lab.offline = false; dispatchEvent(new Event("online")) }, lasts)
        },
    }
    for (const { kind, at, code, lasts } of plan.faults) later(() => faults[kind](code, lasts), at)
    addEventListener("DOMContentLoaded", () => {
        lab.worker = new Worker("blob:viser", { type: "module" })
        lab.worker.postMessage({ type: "set_server" })
        let was = false
        setInterval(() => {
            const said = document.querySelector(".op-notice")?.textContent ?? ""
            const isWhole = lab.worker.isWhole
            lab.same = isWhole === was ? lab.same + 1 : 0
            was = isWhole
            lab.whole = isWhole && !lab.worker.current.mute ? lab.same : 0
            const matters = lab.same > 3 && !lab.hidden && now() > lab.calm && !plan.waits
            if (matters && isWhole === Boolean(said)) lab.wrong.push([now(), isWhole, said])
        }, 200)
    })
}"""
PARTS = """() => {
    const seen = name => [...document.querySelectorAll(name)]
    return {
        strip: seen("#op-strip").length,
        titles: seen("#op-stage .title").map(each => each.innerText.trim() !== ""),
        lenses: seen(".lens canvas").length,
        hold: seen("#op-strip button").some(each => each.textContent.startsWith("Hold")),
        notice: document.querySelector(".op-notice")?.dataset.cause ?? "",
        root: document.documentElement.className,
    }
}"""


@dataclass(frozen=True)
class Fault:
    """What ends connections, when [s], with which code, and for how long [s] nothing answers."""

    kind: str
    at: float
    code: int = 1006
    lasts: float = 1.0


@dataclass(frozen=True)
class Away:
    """When [s] a page stands still, and how long [s]; its timers come once in each `step` [s].

    One step is a phone that is asleep, several are a tab behind another one.
    """

    at: float
    step: float
    steps: int = 1
    hidden: bool = True


seconds = st.floats(0.01, LONGEST)
faults = st.builds(
    Fault,
    st.sampled_from(["viser", "data", "restart", "offline", "silently", "mute"]),
    st.floats(0.0, LAST - LONGEST),
    st.sampled_from([1000, 1001, 1006, 1008, 1011, 1012, 1013, 1015]),
    seconds,
)
aways = st.builds(
    Away,
    at=st.floats(0.0, LAST),
    step=st.sampled_from([1.0, 10.0, 60.0, 600.0]),
    steps=st.integers(1, 10),
    hidden=st.booleans(),
)


class Told(dict[str, Any]):
    """What a lab tells; too long to be shown where a test fails."""

    def __repr__(self) -> str:
        return "Told"


@pytest.fixture(scope="module")
def told(server: LabServer) -> Told:
    """What a real lab tells a page at first."""
    return told_by(server, "/", {"words", "state", "path", "frame"})


def told_by(server: LabServer, path: str, kinds: set[str]) -> Told:
    """What a server tells a page at first, with messages of some kinds."""
    with OwnSocket(f"ws://127.0.0.1:{server.server.get_port()}{path}") as own:
        wait_for(lambda: own.kinds() >= kinds, LONGEST)
        messages = list[str]()
        for message in own.told:
            if "achieved" in message:  # this machine may be busy just now
                message["achieved"] = message.get("rate", 1.0)
            if message["is"] != "alive":
                messages.append(json.dumps(message))
        return Told(messages=messages)


def document() -> str:
    head = (our_scripts() + own_part()).decode()
    head = f"<meta charset=utf-8>PLAN{head}"
    return f"<!doctype html><html><head>{head}</head><body><div id=root></div></body></html>"


class Visit:
    """A page in such a network: between two times [s], until it has been whole for some seconds."""

    def __init__(
        self,
        browser: Browser,
        plan: dict[str, Any],
        least: float,
        most: float,
        away: Away | None = None,
    ) -> None:
        context = browser.new_context(viewport=plan.get("size"))
        self.page, self.errors = context.new_page(), list[str]()
        self.page.on("pageerror", lambda error: self.errors.append(str(error)))
        self.page.clock.install(time=0)
        text = document().replace("PLAN", f"<script>({NETWORK})({json.dumps(plan)})</script>")
        self.page.route("**/*", lambda route: route.fulfill(body=text, content_type="text/html"))
        self.page.goto(SITE)
        if away is not None:
            self.page.clock.run_for(round(1e3 * away.at))
            self._stand_still(away)
        while (now := self._now) < most and not (now > least and self._is_whole):
            self.page.clock.run_for(5000)
        self.parts: dict[str, Any] = self.page.evaluate(PARTS)
        self.wrong: list[Any] = self.page.evaluate("lab.wrong")
        self.last_try: float = self.page.evaluate("lab.datas.at(-1).at")
        context.close()

    def _stand_still(self, away: Away) -> None:
        self.page.evaluate("hidden => lab.hide(hidden)", away.hidden)
        for _ in range(away.steps):
            self.page.clock.fast_forward(round(1e3 * away.step))
        self.page.evaluate("lab.hide(false)")

    @property
    def _now(self) -> float:
        return self.page.evaluate("Date.now() / 1000")

    @property
    def _is_whole(self) -> bool:
        return self.page.evaluate("lab.whole > 50")


def becomes_whole(
    browser: Browser,
    told: Told,
    delays: list[float],
    faults: list[Fault],
    away: Away | None = None,
    within: float = ENOUGH,
) -> None:
    """Assert that a page is whole in the end, and has said until then what was missing."""
    plan = {**told, "delays": delays, "faults": [asdict(each) for each in faults]}
    last = max((each.at + each.lasts for each in faults), default=0.0)
    if away is not None:
        last = max(last, away.at + away.step * away.steps)
    visit = Visit(browser, plan, last, last + within, away)
    assert visit.errors == []
    assert visit.parts == {
        "strip": 1,
        "titles": [True, True],
        "lenses": 2,
        "hold": True,
        "notice": "",
        "root": "",
    }
    assert visit.wrong == []


def test_a_page_becomes_whole_by_itself(browser: Browser, told: Told) -> None:
    for delay, fault in (
        (LONGEST, None),
        (0.01, Fault("restart", 5.0, lasts=15.0)),
        (0.01, Fault("silently", 5.0)),
        (0.5, Fault("mute", 1.0)),  # before it is there
        (0.01, Fault("data", 5.0, 1008)),
    ):
        becomes_whole(browser, told, [delay], [fault] if fault else [])


@pytest.mark.thorough
def test_a_student_who_joins_on_a_phone_gets_the_whole_page_however_late_it_is(
    browser: Browser,
) -> None:
    room = Classroom()
    server = LabServer("127.0.0.1", 0, LoopCache(), ServerOptions(classrooms=[room]))
    told = told_by(server, class_address(room.code), {"words", "state", "path", "frame", "class"})
    server.stop()
    told["size"] = {"width": 390, "height": 844}
    becomes_whole(browser, told, [LONGEST], [])
    assert any('"is": "class"' in message for message in told["messages"])


PHONE, LAPTOP, TAB = Away(10.0, 600.0), Away(10.0, 600.0, hidden=False), Away(10.0, 60.0, 10)


def test_a_page_that_stood_still_for_minutes_soon_becomes_whole(
    browser: Browser, told: Told
) -> None:
    for away, fault in (
        (PHONE, None),
        (PHONE, Fault("mute", 20.0)),
        (LAPTOP, Fault("mute", 20.0)),
        (TAB, Fault("restart", 20.0)),
        (TAB, Fault("viser", 20.0)),
    ):
        becomes_whole(browser, told, [0.01], [fault] if fault else [], away, within=BACK)


@pytest.mark.thorough
@settings(suppress_health_check=[HealthCheck.too_slow], max_examples=15)
@given(st.lists(seconds, min_size=1, max_size=12), st.lists(faults, max_size=4), st.none() | aways)
def test_whatever_is_late_or_ends_a_page_becomes_whole_and_says_so(
    browser: Browser, told: Told, delays: list[float], faults: list[Fault], away: Away | None
) -> None:
    becomes_whole(browser, told, delays, faults, away)


def test_only_a_page_that_is_forbidden_stays_away(browser: Browser, told: Told) -> None:
    plan = {**told, "delays": [0.01], "faults": [], "forbidden": True}
    visit = Visit(browser, plan, 60.0, 60.0)
    assert visit.parts["notice"] == "forbidden" and visit.last_try < 15.0
    assert visit.wrong == []


def test_a_page_that_waits_for_a_place_keeps_its_place_in_the_queue(
    browser: Browser, told: Told
) -> None:
    plan = {**told, "delays": [0.01], "faults": [], "waits": 600.0}
    visit = Visit(browser, plan, 620.0, 660.0)
    assert visit.parts["hold"] and visit.last_try < 1.0
