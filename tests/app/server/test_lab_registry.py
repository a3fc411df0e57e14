"""A reload comes back to its own lab; abandoned labs wait a while and are gone."""

from __future__ import annotations

import re

import pytest

from onpath.app.lab.commands import SetLanguage, SetRunning
from onpath.app.lab.lab import Lab
from onpath.app.lab.looking_back import look_back
from onpath.app.server.lab_registry import (
    CODE,
    HISTORY_KEPT,
    KEPT,
    MOST_ABANDONED,
    LabRegistry,
    RegisteredLab,
)
from onpath.app.simulation.simulation_thread import SimulationThread
from onpath.app.storage.lab_state import LabState
from onpath.app.storage.records import NotKept
from onpath.assets.messages import languages
from onpath.lessons.words import Words
from tests.support.lab import do, new_lab
from tests.support.student import MOST_CODES, remembered


class Desk:
    """Labs under a clock that stands still, and browsers that keep their codes."""

    def __init__(self) -> None:
        self.now = 1000.0
        self.thread = SimulationThread()
        self.registry = LabRegistry(self.thread, new_lab, lambda: self.now)
        self.storage: dict[str, str | None] = {}
        self._clients = 0

    def open(self, browser: str) -> tuple[int, RegisteredLab]:
        """A tab: (client, its entry)."""
        self._clients += 1
        known = self.storage.get(browser)
        entry = self.registry.join(self._clients, known)
        entry.scheduled.display = _View()
        self.storage[browser] = remembered(entry.code, known or "")
        return self._clients, entry


class _View:
    is_outdated = False

    def refresh(self, lab: object, achieved: float) -> None:
        pass

    def is_turn(self, lab: object, frame: int, stride: float) -> bool:
        return True

    def show(self, lab: object, frame: int, stride: float) -> None:
        pass

    def send(self) -> None:
        pass


@pytest.fixture
def desk() -> Desk:
    return Desk()


@pytest.mark.parametrize("language", languages())
def test_a_lab_that_cannot_be_opened_is_told_of_in_the_language_of_the_new_one(
    desk: Desk, language: str
) -> None:
    def make() -> Lab:
        lab = new_lab()
        do(lab, SetLanguage(language))
        return lab

    def load(_: str) -> LabState | None:
        raise NotKept("error.lab_newer")

    desk.registry.make, desk.registry.load = make, load
    desk.storage["a"] = "abcdefghijkm"
    lab = desk.open("a")[1].scheduled.lab
    words = Words(language)
    assert lab.message == words("say.lab_kept", reason=words("error.lab_newer"))
    assert lab.message_level == "warning"
    assert ("gespeichert" in lab.message) == (language == "de")


def test_reload_comes_back_to_the_same_lab(desk: Desk) -> None:
    client, entry = desk.open("a")
    for _ in range(5):
        left = desk.registry.leave(client)
        assert left is entry and entry.client is None
        assert entry.scheduled.display is None  # time waits
        client, again = desk.open("a")
        assert again is entry and entry.client == client and entry.scheduled.display is not None
    assert len(desk.registry) == 1 and desk.thread.labs == [entry.scheduled]


def test_two_tabs_are_two_labs_and_each_reload_finds_its_own(desk: Desk) -> None:
    first, one = desk.open("a")
    second, two = desk.open("a")
    assert one is not two and one.scheduled.lab is not two.scheduled.lab and one.code != two.code
    desk.registry.leave(first)
    assert desk.open("a")[1] is one
    desk.registry.leave(second)
    assert desk.open("a")[1] is two


def test_the_lab_left_last_comes_back_first(desk: Desk) -> None:
    tabs = [desk.open("a") for _ in range(3)]
    for client, _ in (tabs[1], tabs[2], tabs[0]):
        desk.now += 1
        desk.registry.leave(client)
    assert [desk.open("a")[1] for _ in range(3)] == [tabs[0][1], tabs[2][1], tabs[1][1]]


def test_another_browser_gets_another_lab(desk: Desk) -> None:
    client, entry = desk.open("a")
    desk.registry.leave(client)
    assert desk.open("b")[1] is not entry


@pytest.mark.parametrize("known", [None, "", "x", "0" * 12, "," * 500, "<script>", "é" * 300])
def test_codes_that_nobody_gave_open_nothing(desk: Desk, known: str | None) -> None:
    client, entry = desk.open("a")
    desk.registry.leave(client)
    desk.storage["b"] = known
    assert desk.open("b")[1] is not entry
    assert re.fullmatch(r"[a-z0-9]{12}(,[a-z0-9]{12})*", str(desk.storage["b"]))


def test_codes_cannot_be_guessed_from_each_other() -> None:
    desk = Desk()
    codes = {desk.open(str(k))[1].code for k in range(50)}
    assert len(codes) == 50 and all(CODE.fullmatch(code) for code in codes)


def test_a_lab_in_use_is_given_to_nobody_else(desk: Desk) -> None:
    _, entry = desk.open("a")
    desk.storage["b"] = desk.storage["a"]
    assert desk.open("b")[1] is not entry


def test_browser_remembers_a_few_codes_the_newest_first(desk: Desk) -> None:
    codes = [desk.open("a")[1].code for _ in range(MOST_CODES + 3)]
    assert str(desk.storage["a"]).split(",") == codes[::-1][:MOST_CODES]


def test_abandoned_lab_is_kept_for_a_while_and_then_dropped(desk: Desk) -> None:
    client, entry = desk.open("a")
    _, used = desk.open("c")
    desk.registry.leave(client)
    desk.now += KEPT - 1
    desk.registry.leave(desk.open("b")[0])
    assert entry.scheduled in desk.thread.labs
    desk.now += 2
    desk.open("b")
    assert entry.scheduled not in desk.thread.labs
    assert desk.open("a")[1] is not entry
    assert used.scheduled in desk.thread.labs  # somebody looks at it, however long


def test_the_number_of_waiting_labs_is_limited(desk: Desk) -> None:
    tabs = [desk.open(str(k)) for k in range(MOST_ABANDONED + 5)]
    assert len(desk.registry) == MOST_ABANDONED + 5
    for client, entry in tabs:
        entry.scheduled.lab.advance(0.1)
        desk.now += 0.1
        desk.registry.leave(client)
    assert len(desk.registry) == len(desk.thread.labs) == MOST_ABANDONED
    kept = [len(entry.scheduled.simulation.history) > 0 for _, entry in tabs]
    assert kept == 5 * [False] + MOST_ABANDONED * [True]  # most of a lab's memory
    assert desk.open("0")[1] is not tabs[0][1]  # the oldest went
    assert desk.open(str(MOST_ABANDONED + 4))[1] is tabs[-1][1]


def test_leaving_twice_or_never_having_come_does_no_harm(desk: Desk) -> None:
    client, entry = desk.open("a")
    assert desk.registry.leave(99) is None
    assert desk.registry.leave(client) is entry and desk.registry.leave(client) is None
    assert len(desk.registry) == 1


def test_a_lab_in_which_nobody_did_anything_is_soon_dropped(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    desk = Desk()
    monkeypatch.setattr(desk.thread, "call", lambda function: function())
    (_, seen), (left, unused), (gone, used) = (desk.open(name) for name in "abc")
    for entry in (seen, unused, used):
        entry.scheduled.lab.advance(0.5)
    do(used.scheduled.lab, SetRunning(False))
    desk.registry.leave(left)
    desk.registry.leave(gone)
    labs = list[list[bool]]()
    for seconds in (HISTORY_KEPT - 1, 2, 10):
        desk.now += seconds
        desk.registry.free_memory()
        present = desk.thread.labs
        labs.append([entry.scheduled in present for entry in (seen, unused, used)])
    assert labs == [[True, True, True], [True, False, True], [True, False, True]]
    assert desk.open("c")[1] is used
    assert desk.open("b")[1].scheduled.simulation.time == 0.0


def test_a_lab_that_was_left_a_while_ago_keeps_no_history(monkeypatch: pytest.MonkeyPatch) -> None:
    desk = Desk()
    monkeypatch.setattr(desk.thread, "call", lambda function: function())
    (_, used), (left, gone), (paused, looking) = (desk.open(name) for name in "abc")
    for entry in (used, gone, looking):
        do(entry.scheduled.lab, SetRunning(True))
        entry.scheduled.lab.advance(0.5)
    look_back(looking.scheduled.simulation, 0.2)
    desk.registry.leave(left)
    desk.registry.leave(paused)
    lengths: list[list[bool]] = []
    for seconds in (0.0, HISTORY_KEPT + 1):
        desk.now += seconds
        desk.registry.free_memory()
        histories = [entry.scheduled.simulation.history for entry in (used, gone, looking)]
        lengths.append([len(history) > 0 for history in histories])
    assert lengths == [[True, True, True], [True, False, True]]
    _, back = desk.open("b")
    back.scheduled.lab.advance(0.5)
    assert back is gone and len(back.scheduled.simulation.history)
