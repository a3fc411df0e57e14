"""Hidden tabs and tabs in which nothing moves cost almost nothing."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from onpath.app.lab import commands as c
from onpath.app.lab.advance_together import advance_together
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server import tab_visibility as onlooker
from onpath.app.server.lab_server import LabServer
from onpath.app.server.tab_visibility import PATIENCE, QUESTION_INTERVAL, TICK, TabVisibility
from onpath.app.simulation.scheduled_lab import ScheduledLab
from tests.bench.client_protocol import answer
from tests.support.frame_clock import FrameClock
from tests.support.lab import new_lab
from tests.support.student import Student

QUIET = QUESTION_INTERVAL + PATIENCE + 2 * TICK  # [s] after which nothing more is sent
HIDDEN, PAUSED = 150.0, 1000.0  # [B/s]


class Browser:
    """A client and the view of it, and a clock that a test sets."""

    def __init__(self) -> None:
        self.now = 100.0
        self.updates, self.asked = 0, 0
        self._answer: Any = None
        self.camera = SimpleNamespace(
            up_direction=np.array([0.0, 0.0, 1.0]),
            on_update=lambda react: setattr(self, "_answer", react),
        )
        self._websock_connection = SimpleNamespace(queue_message=self._take)
        self.onlooker = TabVisibility(self, lambda: self.now)  # type: ignore[arg-type]
        self.scheduled = ScheduledLab(new_lab())
        self.onlooker.watch(self.scheduled, self)

    is_outdated = False

    def refresh(self, lab: object, achieved: float) -> None:
        pass

    def is_turn(self, lab: object, frame: int, stride: float) -> bool:
        return True

    def show(self, lab: object, frame: int, stride: float) -> None:
        self.updates += 1

    def send(self) -> None:
        pass

    def _take(self, message: Any) -> None:
        assert message.position == (0.0, 0.0, 1.0) and not message.initial
        self.asked += 1

    def answer(self) -> None:
        asyncio.run(self._answer(self.camera))

    def wait(self, seconds: float, answers: bool = False, tells: bool = True) -> None:
        """Let time pass; the lab is shown as long as somebody looks."""
        for _ in range(round(seconds / TICK)):
            self.now += TICK
            if tells and self.scheduled.display is not None:
                self.scheduled.drain()
                advance_together([self.scheduled.frame(TICK)])
                self.scheduled.show(0, 1)
            before = self.asked
            self.onlooker.look()
            if answers and self.asked > before:
                self.answer()


def test_a_browser_that_answers_late_is_not_taken_for_gone() -> None:
    browser = Browser()
    browser.wait(60.0, answers=True)
    assert 60 / (QUESTION_INTERVAL + TICK) - 1 <= browser.asked <= 60 / QUESTION_INTERVAL
    browser.wait(QUESTION_INTERVAL + PATIENCE - TICK)
    assert browser.scheduled.display is browser


def test_a_lab_waits_for_a_browser_that_does_not_answer_and_continues() -> None:
    browser = Browser()
    lab = browser.scheduled.lab
    browser.wait(QUIET)
    assert browser.scheduled.display is None
    told, asked, simulated = browser.updates, browser.asked, lab.simulation.time
    browser.wait(100.0)
    assert (browser.updates, lab.simulation.time) == (told, simulated) and simulated > 0
    assert browser.asked - asked <= 100 / QUESTION_INTERVAL
    browser.answer()
    assert browser.scheduled.display is browser
    browser.wait(10.0, answers=True)
    assert browser.updates > told and lab.simulation.time > simulated


def test_a_browser_that_is_sent_nothing_is_asked_nothing() -> None:
    browser = Browser()
    browser.wait(100.0, tells=False)
    assert browser.asked == 0 and browser.scheduled.display is browser


def test_a_late_answer_does_not_bring_back_a_browser_that_has_left() -> None:
    browser = Browser()
    browser.wait(QUIET)
    browser.onlooker.leave()
    browser.answer()
    assert browser.scheduled.display is None
    other = Browser()
    other.wait(QUIET)
    other.scheduled.display = browser  # somebody else has the lab by now
    other.answer()
    assert other.scheduled.display is browser
    other.onlooker.leave()
    assert other.scheduled.display is browser


class Tab(Student):
    """A simulated tab that can be hidden: it draws nothing, and answers all the rest."""

    hidden = False
    asked: dict[str, Any] | None = None

    def _take(self, message: dict[str, Any]) -> None:
        if self.hidden and message["type"] == "SetCameraUpDirectionMessage":
            self.asked = message
        else:
            super()._take(message)

    def show(self) -> None:
        """Resume drawing."""
        assert self.asked is not None and self._socket is not None
        self.hidden = False
        self._socket.send(answer(self.asked) or b"")

    def rate(self, clock: FrameClock, seconds: float) -> float:
        """What comes, [B/s], in as many frames of the lab as should pass in these seconds."""
        before = self.received
        self.read(clock.alarm(seconds))
        return (self.received - before) / seconds


SOON = {"QUESTION_INTERVAL": 0.5, "PATIENCE": 1.0, "TICK": 0.1}
GONE = sum(SOON.values()) + 0.5  # [s]


@pytest.fixture
def server(monkeypatch: pytest.MonkeyPatch) -> Iterator[LabServer]:
    for name, seconds in SOON.items():
        monkeypatch.setattr(onlooker, name, seconds)
    server = LabServer("127.0.0.1", 0, LoopCache())
    yield server
    server.stop()


@pytest.fixture
def tab(server: LabServer) -> Iterator[Tab]:
    with Tab(f"ws://127.0.0.1:{server.server.get_port()}", channel=True) as tab:
        tab.open()
        tab.read(lambda: tab.moving > 10)
        yield tab


@pytest.mark.thorough
def test_a_hidden_tab_gets_nothing_and_then_the_present_whole(server: LabServer, tab: Tab) -> None:
    (scheduled,), clock = server.thread.labs, FrameClock(server.thread)
    visible = tab.rate(clock, 2 * GONE)
    assert scheduled.display is not None
    tab.hidden = True
    tab.read(lambda: scheduled.display is None)
    tab.rate(clock, 0.5)  # what was on its way
    simulated, moving = scheduled.simulation.time, tab.moving
    hidden = tab.rate(clock, 2.0)
    assert hidden * SOON["QUESTION_INTERVAL"] / QUESTION_INTERVAL < min(HIDDEN, 0.01 * visible)
    assert scheduled.simulation.time == simulated and tab.moving == moving
    scheduled.lab.post(c.ChoosePath("clover"))  # a teacher does, say
    tab.show()
    tab.read(lambda: tab.find("Path")["value"] == "clover" and tab.moving > moving + 10)
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
