"""An endless stroke costs no more than a short one, and nothing on the shared event loop."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.app.common import palette
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.scene.stage_catalogue import stage_of
from onpath.app.scene.strokes.sketch_line import MOST, SketchLine
from onpath.app.server.lab_server import LabServer
from onpath.app.simulation.slow_updates import INTERVALS
from onpath.models.systems.five_bar_robot import RIGID_FIVE_BAR
from tests.support import waiting
from tests.support.drags import play
from tests.support.own_socket import feeds
from tests.support.student import Student

pytestmark = pytest.mark.thorough

FRAMES, MESSAGES, DISPLAY = 60, 400, 10  # per simulated second; so often a stroke is drawn at most
SECONDS = 6
wait_for = partial(waiting.wait_for, seconds=30.0)  # only ends a test that would hang


class Page:
    """One tab of a real lab whose frames are counted out here; notes what is told of the line."""

    def __init__(self, lab: LabServer) -> None:
        (self.number,) = wait_for(lambda: list(feeds(lab)))
        self.view: Any = feeds(lab)[self.number]
        self.client = lab.server.get_clients()[self.number]
        self.lab = next(iter(lab.registry._entries.values())).scheduled.lab
        lab.thread.stop()
        self.frame, self._showing = 0, False
        self.told: list[int] = []  # points of each drawing
        self.told_by_mouse = 0
        connection: Any = self.client._websock_connection
        self._queue = connection.queue_message
        connection.queue_message = self._note

    def _note(self, message: Any) -> None:
        if getattr(message, "name", "").endswith("/line"):
            drawn = getattr(message, "updates", None) or vars(getattr(message, "props", message))
            if "points" in drawn:
                self.told.append(len(drawn["points"]))
                self.told_by_mouse += not self._showing
        self._queue(message)

    def show(self, whole: bool = False) -> None:
        """A frame as in the simulation thread, with a slow update if it is due, or `whole`."""
        self._showing = True
        self.lab.drain()
        if whole or self.frame % min(INTERVALS.values()) == 0:
            self.view.refresh(self.lab, 1.0)
        self.view.show(self.lab, self.frame, 2.0)
        self.view.send()
        self._showing = False
        self.frame += 1

    def shown(self, node: str) -> bool:
        """Whether a node is there after another slow update."""
        self.show(whole=True)
        return self.client.scene.get_handle_by_name(node) is not None

    def scribble(self, node: str, place: Callable[[int], np.ndarray]) -> None:
        """A mouse that goes through places, at `MESSAGES` a second for `SECONDS`."""
        scene = SimpleNamespace(api=self.client.scene)
        for k in range(SECONDS * MESSAGES):
            play(scene, node, "update" if k else "start", 0, place(max(k - 1, 0)), place(k))
            if k * FRAMES // MESSAGES != (k - 1) * FRAMES // MESSAGES:
                self.show()
        self.end = partial(play, scene, node, "end", 0, place(k), place(k))

    def assert_bounded(self) -> None:
        """What has been told of the line since the beginning."""
        assert len(self.told) <= SECONDS * DISPLAY + 1
        assert max(self.told) <= MOST
        assert len(self.told) > SECONDS * DISPLAY / 2  # it is seen while it is drawn
        assert not self.told_by_mouse


@pytest.fixture
def page() -> Iterator[Page]:
    lab = LabServer("127.0.0.1", 0, LoopCache())
    with Student(f"ws://127.0.0.1:{lab.server.get_port()}") as student:
        student.open()
        student.read(lambda: student.moving)
        yield Page(lab)
    lab.stop()


def around(k: int) -> np.ndarray:
    """Steps of 3 mm along a circle, in the robot's frame, [m]."""
    turn = k * 0.03
    return np.array([0.2 + 0.1 * np.cos(turn), 0.0, 0.15 + 0.1 * np.sin(turn)])


def test_an_endless_freehand_stroke_is_drawn_ten_times_a_second_of_few_points(page: Page) -> None:
    strokes: list[np.ndarray] = []
    page.view.scene._scene.begin_freehand(strokes.append)
    base = next(iter(stage_of(RIGID_FIVE_BAR).bases.values()))
    page.scribble("/freehand/sheet", lambda k: base + around(k))
    page.assert_bounded()
    page.end()
    (stroke,) = strokes
    assert MOST / 2 <= len(stroke) <= MOST
    middle = np.array([0.2, 0.0, 0.15])
    assert np.linalg.norm(stroke - middle, axis=1) == pytest.approx(np.full(len(stroke), 0.1))
    assert stroke[0] == pytest.approx(around(0))
    assert not page.shown("/freehand/line") and not page.told_by_mouse


class Paper:
    """A scene on which lines are drawn."""

    def __init__(self) -> None:
        self.drawings: list[np.ndarray] = []

    def add_line_segments(self, _name: str, points: np.ndarray, *_: Any, **__: Any) -> Any:
        self.points = points
        return self

    def remove(self) -> None:
        self.drawings.append(np.zeros((0, 2, 3)))

    def __setattr__(self, name: str, value: Any) -> None:
        super().__setattr__(name, value)
        if name == "points":
            self.drawings.append(value)


@given(st.lists(st.floats(0.5, 1.5), max_size=40), st.integers(1, 4 * MOST))
def test_a_line_begins_where_it_began_and_ends_near_the_hand(
    steps: list[float], count: int
) -> None:
    paper = Paper()
    line = SketchLine(paper, "line", (palette.INK, 1.0), 1.0, lambda points: points)  # type: ignore[arg-type]
    way = np.cumsum([0.0, *(2.0 * np.resize(steps or [1.0], count))])
    for x in way:
        line.add(np.array([x, 0.0, 0.0]))
    points = line.points[:, 0]
    gaps = np.diff(points)
    assert len(points) <= MOST and points[0] == way[0] and set(points) <= set(way)
    if len(points) > 1:
        assert gaps.min() > 1.0 and way[-1] - points[-1] <= gaps.max()
    for _ in range(2):
        line.draw()
    assert len(paper.drawings) == (len(points) > 1)
    line.remove()
    line.add(np.array([-9.0, 0.0, 0.0]))
    line.draw()
    assert len(paper.drawings) == 2 * (len(points) > 1)
