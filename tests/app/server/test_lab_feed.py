"""When a page is told of its lab: what moves at every turn, everything else more rarely."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from threading import Event
from types import SimpleNamespace
from typing import Any, cast

import msgspec
import numpy as np
import pytest

from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.lab.snapshots.page_snapshot import LawPlaces, PageSnapshot
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.server.built_in_course import built_in_course
from onpath.app.server.lab_feed import AT_EASE, LabFeed
from onpath.app.server.page_context import PageContext
from onpath.app.server.page_data import PageData
from onpath.app.server.page_text import PageText
from onpath.app.simulation.display_rate import STRIDES, is_turn
from onpath.app.simulation.scheduled_lab import ScheduledLab
from onpath.app.simulation.slow_updates import SlowUpdates
from onpath.models.control.settable import changed
from onpath.models.systems.catalogue import ROBOTS
from tests.support.lab import FOLLOWER, FRAME, do, loop_cache, new_lab, y

FRAMES = 240


class Paper:
    """Stands in for a page; notes when it is shown what moves, and when everything."""

    is_ready, is_outdated = True, False
    client = SimpleNamespace(client_id=1)

    def __init__(self) -> None:
        self.now = 0
        self.moved, self.whole = list[int](), list[int]()
        self.places = list[LawPlaces]()

    def show(self, snapshot: object) -> None:
        (self.whole if isinstance(snapshot, PageSnapshot) else self.moved).append(self.now)
        if isinstance(snapshot, PageSnapshot):
            self.places.append(snapshot.places)


class Untold:
    """Stands in for our own part of a page, which is told nothing."""

    def follow(self, lab: object, drawn: object, is_turn: bool, settle: object) -> None: ...

    def tell(self, *what: object) -> None: ...

    def waits(self, lab: object) -> bool:
        return False


class Stream:
    """Stands in for the connection of a page; notes in which frames it is told of which step."""

    is_open, is_busy, opened = True, False, 1

    def __init__(self) -> None:
        self.now, self.steps = 0, dict[int, int]()

    def hand_over(self, *messages: Callable[[], bytes]) -> None:
        for told in (msgspec.json.decode(message()) for message in messages):
            if told["is"] == "lesson" and told["lesson"]:
                self.steps.setdefault(told["version"], self.now)


def feed_of(data: Any, offset: int, followed: Any = None) -> LabFeed:
    """What shows a lab on a page of which viser's part is a `Paper`."""
    make = cast(Any, None)
    return LabFeed(data, make=make, send=lambda: None, offset=offset, followed=followed)


def shown(stride: float, offset: int, *commands: c.Command, every: int = 6) -> Paper:
    """What a page is shown of a lab with this user.

    Args:
        every: frames between slow updates.
    """
    lab, paper = new_lab(FRAME), Paper()
    page: Any = paper
    feed = feed_of(cast(Any, Untold()), offset)
    feed.furnish(page)
    do(lab, *commands)
    for paper.now in range(FRAMES):
        lab.advance(FRAME)
        if paper.now % every == 0:
            feed.refresh(lab, 1.0)
        feed.show(lab, paper.now, stride)
    return paper


@pytest.mark.parametrize("stride", STRIDES)
@pytest.mark.parametrize("offset", [0, 7])
@pytest.mark.parametrize("every", [6, 15, 60])
def test_what_moves_is_shown_at_its_turns_and_once_a_frame(
    stride: float, offset: int, every: int
) -> None:
    """However rarely everything else is."""
    paper = shown(stride, offset, every=every)
    turns = {frame for frame in range(FRAMES) if is_turn(frame + offset, stride)}
    assert paper.whole == list(range(0, FRAMES, every))
    assert set(paper.moved) == turns - set(paper.whole)
    assert len(paper.moved) == len(set(paper.moved))


@pytest.mark.parametrize(("law", "anew"), [("path_following", 1), ("virtual_constraint", 5)])
def test_what_moves_does_not_make_the_places_of_poles_anew(law: str, anew: int) -> None:
    """A panel that is shown other places works out the poles and draws them."""
    paper = shown(AT_EASE, 0, c.ChooseLaw(FOLLOWER, law))
    assert len(paper.moved) > len(paper.whole) > 4 * anew
    assert len(set(map(id, paper.places))) <= anew  # in four seconds


def test_pages_do_not_all_take_the_same_turn() -> None:
    at = [frame for offset in range(2) for frame in shown(AT_EASE, offset, every=FRAMES).moved]
    assert sorted(at) == list(range(1, FRAMES))


def test_a_hand_is_followed_in_every_frame_of_a_thread_at_ease() -> None:
    target = y(new_lab(FRAME).simulation, FOLLOWER) + 0.01
    paper = shown(AT_EASE, 0, c.Grab(FOLLOWER, target))
    assert sorted(paper.moved + paper.whole) == list(range(FRAMES))


def test_of_a_lab_at_rest_only_slow_updates_are_shown() -> None:
    paper = shown(AT_EASE, 0, c.SetRunning(False))
    assert len(paper.moved) <= 1 and paper.whole


def test_the_data_channel_waits_until_a_lab_that_is_followed_anew_has_been_shown() -> None:
    """In a frame of a busy thread in which nothing that moves is shown."""
    own, other, paper, told = new_lab(FRAME), new_lab(FRAME), Paper(), list[object]()

    class Data(Untold):
        def follow(self, lab: object, drawn: object, is_turn: bool, settle: object) -> None:
            told.append(lab)

    class Followed:
        found: Any = None

        def find(self) -> Any:
            return self.found

    page, data, followed = cast(Any, paper), cast(Any, Data()), cast(Any, Followed())
    feed = feed_of(data, 0, followed)
    feed.furnish(page)
    stride = STRIDES[-1]
    frame = next(i for i in range(9) if not is_turn(i, stride))
    feed.refresh(own, 1.0)
    feed.show(own, frame, stride)
    followed.found = ScheduledLab(other), 1
    feed.show(own, frame, stride)
    assert told == [own]
    feed.refresh(own, 1.0)
    feed.show(own, frame, stride)
    assert told == [own, other]


def test_another_step_is_told_as_soon_as_its_message_is_made() -> None:
    """However long ago the last slow update was."""
    rng, stream = np.random.default_rng(), Stream()
    course = built_in_course()
    lab = Lab(loop_cache(), course=course)
    text = PageText(course, "")
    nothing: Any = lambda *_: None  # noqa: E731
    context = PageContext("", course, 0, nothing, text, nothing, nothing)
    data = PageData(cast(Any, stream), lab, context, cast(Any, None))
    scheduled, updates = ScheduledLab(lab), SlowUpdates(lambda: 0.0)
    scheduled.display = feed_of(data, 0)
    asked = dict[int, int]()
    begins = {20: c.OpenLesson(next(iter(course.lessons)))}
    turns = 20 + np.cumsum(rng.integers(3, 20, 6))
    commands = begins | {
        int(turn): c.GoToStep(by=1 if i % 2 else -1) for i, turn in enumerate(turns, 1)
    }
    for stream.now in range(max(turns) + 9):
        if command := commands.get(stream.now):
            do(lab, command)
            asked[lab.lessons.version] = stream.now
        updates.run([scheduled], stream.now, 1.0, AT_EASE)
        scheduled.show(stream.now, AT_EASE)
        made = Event()
        text.submit(made.set)
        assert made.wait(30.0)
    assert set(asked) <= set(stream.steps)
    assert all(stream.steps[version] <= asked[version] + 1 for version in asked)
    data.close()


@pytest.mark.parametrize("name", ["flexible", "five_bar"])
def test_a_page_can_be_built_while_a_robot_is_made(name: str) -> None:
    """That takes long, and another thread reads the lab."""
    lab, seen = new_lab(FRAME), list[PageSnapshot]()
    simulation, entry = lab.simulation, ROBOTS[name]

    def slowly(parameters: Any) -> Any:
        seen.append(take_page_snapshot(lab, 1.0))
        return entry.make(parameters)

    before = take_page_snapshot(lab, 1.0)
    simulation.choose_robot(replace(entry, make=slowly))
    first = len(seen)
    assert first and all(each.key == before.key for each in seen)
    assert all(each.parameters == before.parameters for each in seen)
    chosen = take_page_snapshot(lab, 1.0)
    simulation.set_parameters(changed(simulation.parameters, "payload", 0.05))
    assert seen[first].key == chosen.key and seen[first].parameters == chosen.parameters
