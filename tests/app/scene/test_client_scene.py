"""Drawing a lab needs only data: a snapshot that has been pickled is drawn identically."""

from __future__ import annotations

import pickle
import threading
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from functools import partial
from typing import Any

import numpy as np
import pytest
import viser
from viser.infra import Message

from onpath.app.common.work_thread import WorkThread
from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.lab.snapshots.snapshot import Motion
from onpath.app.lab.snapshots.take_snapshot import take_motion, take_page_snapshot
from onpath.app.scene.client_scene import ClientScene, Look
from onpath.app.server.lab_server import LabServer
from onpath.app.viser_adapter.frame_channel import FrameChannel
from onpath.app.viser_adapter.frame_packing import GroupUpdate
from onpath.lessons.course import Course
from onpath.lessons.schema import Sketch
from onpath.models.systems.catalogue import FIVE_BAR, ROBOTS
from tests.support import waiting
from tests.support.built_in import built_in_course
from tests.support.lab import FOLLOWER, FRAME, loop_cache
from tests.support.own_socket import feeds
from tests.support.student import Student

wait_for = partial(waiting.wait_for, seconds=30.0)  # only ends a test that would hang


@pytest.fixture(scope="module")
def client() -> Iterator[viser.ClientHandle]:
    """A browser's tab that nobody else draws in."""
    server = LabServer("127.0.0.1", 0, LoopCache())
    with Student(f"ws://127.0.0.1:{server.server.get_port()}") as student:
        student.open()
        student.read(lambda: student.moving)
        server.thread.stop()
        (number,) = wait_for(lambda: list(feeds(server)))
        yield server.server.get_clients()[number]
    server.stop()


@pytest.fixture(scope="module")
def course() -> Course:
    return built_in_course()[0]


class Drawing:
    """A scene whose work is done at once, and all that its browser is told of it."""

    def __init__(
        self, client: viser.ClientHandle, course: Course, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        self._client, self._course, self._patch = client, course, monkeypatch
        self.posted: list[c.Command] = []

    def of(self, snapshots: list[PageSnapshot | Motion]) -> list[tuple[str, object]]:
        """What is told while a scene is built from the first one, and shows the others.

        The camera is not of the lab: where it is now decides whether it must be moved.
        """
        told: list[tuple[str, object]] = []
        this = threading.get_ident()

        def take(_: FrameChannel, message: Message | GroupUpdate) -> None:
            if isinstance(message, GroupUpdate):
                for each in message.messages():
                    take(_, each)
                return
            kind = type(message).__name__
            if threading.get_ident() == this and not kind.startswith("SetCamera"):
                content = {k: v for k, v in vars(message).items() if k != "counter"}
                told.append((kind, plain(content)))

        self._client.scene.reset()
        with self._patch.context() as patch:
            patch.setattr(FrameChannel, "_take", take)
            patch.setattr(WorkThread, "submit", lambda _, work: work())
            first, *others = snapshots
            assert isinstance(first, PageSnapshot)
            post, look = self.posted.append, Look()
            scene = ClientScene(self._client, first, 1, look, self._course, post, print, set())
            for snapshot in others:
                assert scene.is_ready
                scene.show(snapshot)
            scene.close()
        return told.copy()


@pytest.fixture
def drawing(client: viser.ClientHandle, course: Course, monkeypatch: pytest.MonkeyPatch) -> Drawing:
    return Drawing(client, course, monkeypatch)


def plain(value: Any) -> object:
    """A message in a form that can be compared."""
    if isinstance(value, np.ndarray):
        return value.dtype.str, value.shape, value.tobytes()
    if isinstance(value, dict):
        return {key: plain(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [plain(each) for each in value]
    if is_dataclass(value):
        return {field.name: plain(getattr(value, field.name)) for field in fields(value)}
    return value if isinstance(value, bytes) else repr(value)


def filmed(lab: Lab, *commands: c.Command) -> Iterator[PageSnapshot | Motion]:
    """A lab that does something, and what is to be shown of it."""
    yield take_page_snapshot(lab, 1.0)
    for number, command in enumerate(commands):
        lab.post(command)
        for _ in range(15):
            lab.drain()
            lab.advance(lab.simulation.settings.rate * FRAME)
        yield take_motion(lab)
        yield take_page_snapshot(lab, 0.9, nickname="Ada <b>" if number else "")


def assert_draws_the_same(drawing: Drawing, snapshots: list[PageSnapshot | Motion]) -> None:
    copies = [pickle.loads(pickle.dumps(each)) for each in snapshots]
    told, again = drawing.of(snapshots), drawing.of(copies)
    assert len(told) > 30
    for one, other in zip(told, again, strict=True):
        assert one == other
    assert drawing.posted == []  # what draws asks for nothing


@pytest.mark.thorough
@pytest.mark.parametrize("robot", ["five_bar", "flexible", "seven_axes"])
def test_a_lab_is_drawn_from_data(robot: str, drawing: Drawing, course: Course) -> None:
    lab = Lab(loop_cache(), ROBOTS[robot], course)
    y = lab.simulation.runs[FOLLOWER].shown()["y"].copy()
    film = filmed(
        lab,
        *(c.Hold(True), c.Set("copy", False), c.Hold(False), c.Set("K1", 90.0)),
        *(c.Grab(FOLLOWER, y + 0.02), c.Release(), c.SelectPoint(1), c.NudgePoint(0.002, 0.001)),
        *(c.ChoosePath("figure of eight"), c.ChoosePath("ellipse"), c.Share()),
        *(c.Set("torque_limit", 0.5), c.LookAt(1.0), c.GoOn(), c.Set("rate", 0.5)),
        *(c.Set("larger", 3.0), c.SetRunning(False)),
    )
    assert_draws_the_same(drawing, list(film))


@pytest.mark.thorough
@pytest.mark.parametrize("robot", ["five_bar", "flexible", "seven_axes"])
def test_a_page_is_told_nothing_while_nothing_changes(
    robot: str, drawing: Drawing, course: Course
) -> None:
    lab = Lab(loop_cache(), ROBOTS[robot], course)
    lab.post(c.Hold(True))
    *_, last = filmed(lab, c.Set("larger", 2.0), c.SetRunning(False))
    told = drawing.of([last, last, take_motion(lab)])
    again = [last, take_page_snapshot(lab, 0.9, nickname="Ada <b>"), take_motion(lab)]
    assert drawing.of([last, last, take_motion(lab), *again]) == told


def test_a_lesson_is_drawn_from_data(drawing: Drawing, course: Course) -> None:
    name, step = next(
        (name, number)
        for name in course.lessons
        for number, step in enumerate(course.lesson(name, "en").steps)
        if any(isinstance(block, Sketch) for block in step.blocks)
    )
    lab = Lab(loop_cache(), FIVE_BAR, course)
    lab.post(c.OpenLesson(name))
    lab.drain()
    on = [c.GoToStep(1)] * step
    answer = c.Predict(times=(0.0, 4.0, 8.0), values=(0.0, 20.0, 5.0))
    film = filmed(lab, *on, answer, c.GoToStep(1), c.PlayStep(), *on, c.SetLanguage("en"))
    assert_draws_the_same(drawing, list(film))


def test_what_has_not_changed_is_shared_with_the_snapshot_before() -> None:
    lab = Lab(loop_cache())
    lab.drain()
    lab.advance(FRAME)
    one = take_page_snapshot(lab, 1.0)
    assert take_page_snapshot(lab, 1.0, one).path is one.path
    lab.advance(FRAME)
    two = take_page_snapshot(lab, 1.0, one)
    assert two.path is one.path and two.motion is not one.motion
    lab.post(c.SelectPoint(2))
    lab.drain()
    assert take_page_snapshot(lab, 1.0, two).path.selected == 2


class Shown:
    """The scene of a lab, and how often it has been built."""

    def __init__(self, lab: Lab, client: viser.ClientHandle, patch: pytest.MonkeyPatch) -> None:
        patch.setattr(WorkThread, "submit", lambda _, work: work())
        self.lab, self.builds, self.look, self.switches = lab, 0, Look(), set[str]()
        build = ClientScene._build

        def counted(scene: ClientScene, first: PageSnapshot) -> None:
            self.builds += 1
            build(scene, first)

        patch.setattr(ClientScene, "_build", counted)
        client.scene.reset()
        first = take_page_snapshot(lab, 1.0)
        course = lab.lessons.course
        self.scene = ClientScene(client, first, 1, self.look, course, print, print, self.switches)

    def follow(self, *commands: c.Command) -> None:
        """Show the lab after some commands."""
        for command in commands:
            self.lab.post(command)
        self.lab.drain()
        self.scene.show(take_page_snapshot(self.lab, 1.0))


@pytest.fixture
def shown(
    client: viser.ClientHandle, course: Course, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Shown]:
    shown = Shown(Lab(loop_cache(), FIVE_BAR, course), client, monkeypatch)
    yield shown
    shown.scene.close()


def test_only_what_changes_the_picture_has_it_built_anew(shown: Shown, course: Course) -> None:
    """Neither language nor lessons nor large type; dark pages and upright windows do."""
    first, *_ = course.lessons
    shown.follow(c.SetLanguage("de"))
    shown.follow(c.OpenLesson(first))
    shown.follow(c.GoToStep(1), c.Set("presenting", True), c.SetLanguage("en"))
    assert shown.builds == 1
    for name in ("dark", "upright"):
        builds = shown.builds
        setattr(shown.look, name, True)
        shown.follow()
        shown.follow()
        assert shown.builds == builds + 1


@pytest.mark.thorough
def test_a_step_switches_its_drawings_on_and_the_next_one_off(shown: Shown, course: Course) -> None:
    """What its reader has switched on stays. Where the path is edited, the mouse prefers points."""
    shown.switches.add("zone")
    tried = set[bool]()
    for name in course.lessons:
        lesson = course.lesson(name, "en")
        shown.follow(c.OpenLesson(name))
        for index in range(len(lesson.steps)):
            shown.follow(c.GoToStep(index - shown.lab.lessons.index))
            if shown.lab.lessons.index != index:
                break
            setup = lesson.setup_at(index)
            assert shown.switches == {"zone", *setup.show}
            mouse: Any = shown.scene._scene.mouse
            assert mouse.path_first == ("editor" in setup.controls)
            tried.add(bool(setup.show))
    assert tried == {True, False}
