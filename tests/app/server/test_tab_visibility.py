"""Hidden tabs and tabs in which nothing moves cost almost nothing."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from onpath.app.lab import commands as c
from onpath.app.lab.advance_together import advance_together
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server import tab_visibility
from onpath.app.server.lab_server import LabServer
from onpath.app.server.tab_visibility import PATIENCE, TICK, TabVisibility
from onpath.app.simulation.scheduled_lab import ScheduledLab
from tests.bench.client_protocol import SEEN
from tests.support.frame_clock import FrameClock
from tests.support.lab import new_lab
from tests.support.student import Student

EACH = 2.0  # [s] between messages of a page that it draws
QUIET = PATIENCE + 2 * TICK  # [s] after which nothing more is sent
HIDDEN, PAUSED = 150.0, 1000.0  # [B/s]


class Page:
    """A page that is shown a lab, and a clock that a test sets."""

    def __init__(self) -> None:
        self.now, self.updates = 100.0, 0
        self.sight = TabVisibility(lambda: self.now)
        self.scheduled = ScheduledLab(new_lab())
        self.sight.watch(self.scheduled, self)

    is_outdated = False

    def refresh(self, lab: object, achieved: float) -> None:
        pass

    def is_turn(self, lab: object, frame: int, stride: float) -> bool:
        return True

    def show(self, lab: object, frame: int, stride: float) -> None:
        self.updates += 1

    def send(self) -> None:
        pass

    def wait(self, seconds: float, draws: bool = False) -> None:
        """Let time pass; the lab is shown as long as somebody looks."""
        for tick in range(round(seconds / TICK)):
            self.now += TICK
            if self.scheduled.display is not None:
                self.scheduled.drain()
                advance_together([self.scheduled.frame(TICK)])
                self.scheduled.show(0, 1)
            if draws and tick % round(EACH / TICK) == 0:
                self.sight.hear()
            self.sight.check()


def test_a_page_that_stalls_for_a_while_is_not_taken_for_gone() -> None:
    page = Page()
    page.wait(60.0, draws=True)
    page.wait(PATIENCE - EACH)
    assert page.scheduled.display is page


def test_a_lab_waits_for_a_page_that_is_not_drawn_and_continues() -> None:
    page = Page()
    lab = page.scheduled.lab
    page.wait(QUIET)
    assert page.scheduled.display is None
    told, simulated = page.updates, lab.simulation.time
    page.wait(100.0)
    assert (page.updates, lab.simulation.time) == (told, simulated) and simulated > 0
    page.sight.hear()
    assert page.scheduled.display is page
    page.wait(10.0, draws=True)
    assert page.updates > told and lab.simulation.time > simulated


def test_a_late_message_does_not_bring_back_a_page_that_has_left() -> None:
    page = Page()
    page.wait(QUIET)
    page.sight.leave()
    page.sight.hear()
    assert page.scheduled.display is None
    other = Page()
    other.wait(QUIET)
    other.scheduled.display = page  # somebody else has the lab by now
    other.sight.hear()
    assert other.scheduled.display is page
    other.sight.leave()
    assert other.scheduled.display is page


class Tab(Student):
    """A simulated tab that can be hidden: it draws nothing."""

    def hide(self, hidden: bool) -> None:
        """Draw no more, or again."""
        self.draws = not hidden
        if self.draws:
            assert self._data is not None
            self._data.send(SEEN)

    def rate(self, clock: FrameClock, seconds: float) -> float:
        """What comes, [B/s], in as many frames of the lab as should pass in these seconds."""
        before = self.received
        self.read(clock.alarm(seconds))
        return (self.received - before) / seconds


SOON = {"PATIENCE": EACH + 1.0, "TICK": 0.1}
GONE = sum(SOON.values()) + 0.5  # [s]


@pytest.fixture
def server(monkeypatch: pytest.MonkeyPatch) -> Iterator[LabServer]:
    for name, seconds in SOON.items():
        monkeypatch.setattr(tab_visibility, name, seconds)
    server = LabServer("127.0.0.1", 0, LoopCache())
    yield server
    server.stop()


@pytest.fixture
def tab(server: LabServer) -> Iterator[Tab]:
    with Tab(f"ws://127.0.0.1:{server.server.get_port()}") as tab:
        tab.open()
        tab.read(lambda: tab.moving > 10)
        yield tab


@pytest.mark.thorough
def test_a_hidden_tab_gets_nothing_and_then_the_present_whole(server: LabServer, tab: Tab) -> None:
    (scheduled,), clock = server.thread.labs, FrameClock(server.thread)
    visible = tab.rate(clock, 2 * GONE)
    assert scheduled.display is not None
    tab.hide(True)
    tab.read(lambda: scheduled.display is None)
    tab.rate(clock, 0.5)  # what was on its way
    simulated, moving = scheduled.simulation.time, tab.moving
    hidden = tab.rate(clock, 2.0)
    assert hidden < min(HIDDEN, 0.01 * visible)
    assert scheduled.simulation.time == simulated and tab.moving == moving
    scheduled.lab.post(c.ChoosePath("clover"))  # a teacher does, say
    tab.hide(False)
    tab.read(lambda: tab.values["path"] == "clover" and tab.moving > moving + 10)
    assert scheduled.simulation.time > simulated


@pytest.mark.thorough
def test_a_paused_lab_sends_nothing(server: LabServer, tab: Tab) -> None:
    (scheduled,), clock = server.thread.labs, FrameClock(server.thread)
    running = tab.rate(clock, 2.0)
    scheduled.lab.post(c.SetRunning(False))
    tab.rate(clock, GONE)
    paused = tab.rate(clock, 2.0)
    assert paused < min(PAUSED, 0.05 * running)
    before = tab.moving
    tab.tell({"do": "StepOnce"})
    tab.read(lambda: tab.moving > before)
