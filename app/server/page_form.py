"""Tells a page its form and the values of the fields, and carries out what it sets."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import lru_cache, partial
from typing import ClassVar

import numpy as np
from msgspec import Struct
from typing_extensions import override

from onpath.app.channel.form_messages import (
    AskForm,
    FieldValue,
    FormMessage,
    SetField,
)
from onpath.app.classroom.teaching.teacher_form import NO_CLASS
from onpath.app.common.background import Background, Submit
from onpath.app.lab.commands import ChooseLaw, ChoosePath, PlacePoint, SelectPoint, Set, TypeLaw
from onpath.app.lab.lab import Command, Lab
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot, parameters_of, robot_of
from onpath.app.scene.client_scene import ClientScene
from onpath.app.scene.overlays import Overlays
from onpath.app.scene.rank_nodes import largest
from onpath.app.server.told_values import ToldValues
from onpath.app.view.lab_form import (
    NO_STEP,
    PULLS,
    SWITCHES,
    drawn_form,
    form_of,
    refusals_in,
    switch_name,
    values_in,
)
from onpath.app.view.lesson_view import NO_SETUP, LessonView
from onpath.app.view.notes import rank_note, tube_note
from onpath.lessons.action_schema import StepSetup
from onpath.lessons.course import Course
from onpath.lessons.words import Words
from onpath.models.control.laws.own import OWN
from onpath.models.control.rank_test import rank_map
from onpath.models.control.settable import parameters_from
from onpath.models.control.sides import SIDES
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import Parameters

_DRAWN = {switch_name(name): name for name in SWITCHES}
TURNED = 0.05
"""To which joint angles are rounded for the critical α, which varies slowly, [rad]."""
MOST_LIMITS = 512  # critical values of α in the cache; a lap along a path needs many
_COORDINATES = {"point_z1": "first", "point_z2": "second"}


@dataclass(frozen=True, slots=True)
class _Mark(Command):
    """Stands behind a command in a lab's queue: that one counts in the snapshots from now on."""

    from_teacher: ClassVar[bool] = True  # also applied while the lab is frozen
    pass_by: Callable[[], None]

    @override
    def apply(self, lab: Lab) -> None:
        self.pass_by()


class PageForm:
    """The forms of one page: of its lab, and of the open step of a lesson.

    Args:
        post: of the lab that the page may change.
        submit: runs a function in another thread.
        switches: names of what is drawn besides the robots; changed by what the page has set.
        teaches: whether the page is a teacher's, which has no form of a step; of a student's lab
            it has what is drawn alone.
    """

    def __init__(
        self,
        post: Callable[[Command], None],
        submit: Submit,
        switches: set[str],
        teaches: bool = False,
    ) -> None:
        self._post, self._switches = post, switches
        self.is_asked, self._teaches = False, teaches
        self._heard = dict[str, int]()
        self._own = deque[SetField]()  # what concerns the page alone
        self._typing = set[str]()  # sides for which a law is being typed
        self._critical = Background[float](submit)
        self._rank = Background[float](submit)
        self.restart()

    def restart(self) -> None:
        """Forget what the page knows, and what it has asked for."""
        self.is_asked = False
        self._forms: tuple[FormMessage | None, ...] = (None,) * 3
        self._told = ToldValues()

    def hear(self, message: AskForm | SetField, is_own: bool) -> None:
        """Carry out what a page has set. On the event loop.

        Args:
            is_own: whether the page may change the lab that it shows.
        """
        if isinstance(message, AskForm):
            self.is_asked = True
            return
        name, value = message.name, message.value
        if name in _DRAWN or name == "pull" or not is_own:
            self._own.append(message)
            return
        for command in self._commands(name, value):
            self._post(command)
        self._post(_Mark(lambda: self._hear(name, message.number)))

    def _hear(self, name: str, number: int) -> None:
        self._heard[name] = max(number, self._heard.get(name, 0))

    def _commands(self, name: str, value: FieldValue) -> Iterator[Command]:
        if name in SIDES:
            self._typing.discard(name)
            if value == OWN:
                self._typing.add(name)
            else:
                yield ChooseLaw(name, str(value))
        elif name == "path":
            yield ChoosePath(str(value))
        elif name in ("point", *_COORDINATES):
            if isinstance(value, str):
                return
            if name == "point":
                yield SelectPoint(int(value) - 1 if value else None)
            else:
                yield PlacePoint(**{_COORDINATES[name]: float(value)})
        elif name.startswith("typed_"):
            yield TypeLaw(name.removeprefix("typed_"), str(value))
        else:
            yield Set(name, value)
            if name == "alpha":  # which only that output uses
                yield Set("output", "redefined")

    def _critical_alpha(self, snapshot: PageSnapshot) -> float | None:
        """The right robot's, if its output is one with an α; None while it is not known yet."""
        robot, now = snapshot.key.robot, snapshot.parameters
        link = ROBOTS[robot].flexible_link
        if link is None or now["output"] != "redefined":
            return None
        beam = parameters_from(ROBOTS[robot].parameters, {name: now[name] for name in link.beam})
        joints = TURNED * np.round(snapshot.joints[: link.joints] / TURNED)
        key = robot, beam, tuple(joints.tolist())
        self._critical.ask(key, lambda: _limit_of(*key))
        return self._critical.value

    def _least_rank(self, snapshot: PageSnapshot, words: Words) -> str:
        """What the rank test says of the path; empty while it is not known yet."""
        robot, parameters = robot_of(snapshot), parameters_of(snapshot)
        key = snapshot.path.version, robot.plant(parameters).tobytes()
        sampled = snapshot.edit.sampled
        self._rank.ask(key, lambda: float(np.min(rank_map(robot, parameters, sampled))))
        least = self._rank.value
        return "" if least is None else words("design.rank", number=f"{least:.2f}")

    def news(
        self, snapshot: PageSnapshot, scene: ClientScene | None, course: Course, words: Words
    ) -> Iterator[Struct]:
        """What has changed since the last time. In the simulation thread.

        Args:
            scene: the robots' picture, if it is there.
        """
        switches, heard = self._switches, dict(self._heard)
        while self._own:
            message = self._own.popleft()
            if message.name in _DRAWN:
                change = switches.add if message.value else switches.discard
                change(_DRAWN[message.name])
            elif message.name == "pull" and scene is not None and message.value in PULLS:
                scene.pull = str(message.value)
            self._hear(message.name, message.number)
            heard[message.name] = message.number
        setup = None if self._teaches else _setup(snapshot, course, words)
        step = NO_STEP if setup is None else form_of(snapshot, setup, words)
        make = drawn_form if snapshot.key.student else partial(form_of, setup=None)
        klass = None if self._teaches else NO_CLASS
        forms = make(snapshot, words=words), step, klass
        for form, before in zip(forms, self._forms, strict=True):
            if form is not None and form is not before:
                yield form
        self._forms = forms
        drawn = {name: name in switches for name in SWITCHES}
        values = values_in(snapshot, drawn, self._typing, words, self._critical_alpha(snapshot))
        values["pull"] = PULLS[0] if scene is None else scene.pull
        values["least_rank"] = self._least_rank(snapshot, words)
        values |= _notes_on(None if scene is None else scene.overlays, snapshot, words)
        yield from self._told.news(values, refusals_in(snapshot), heard)


def _notes_on(
    overlays: Overlays | None, snapshot: PageSnapshot, words: Words
) -> dict[str, FieldValue]:
    """What the form says of the drawings that are shown."""
    notes: dict[str, FieldValue] = {"tube_sizes": "", "rank_scale": ""}
    if overlays is None:
        return notes
    if (shape := overlays.shape) is not None:
        steps = (shape.step, shape.degrees) if "grid" in overlays.switches else None
        notes["tube_sizes"] = tube_note(shape.width, words, steps)
    if (found := overlays.rank_map) is not None:
        is_flexible = ROBOTS[snapshot.key.robot].flexible_link is not None
        alpha = float(snapshot.parameters["alpha"]) if is_flexible else None
        notes["rank_scale"] = rank_note(largest(found.values), alpha, words)
    return notes


@lru_cache(maxsize=MOST_LIMITS)
def _limit_of(robot: str, parameters: Parameters, joints: tuple[float, ...]) -> float:
    """The critical α of a robot with a flexible link; takes about 10 ms."""
    link = ROBOTS[robot].flexible_link
    return np.inf if link is None else link.critical_alpha(parameters, np.array(joints))


def _setup(snapshot: PageSnapshot, course: Course, words: Words) -> StepSetup | None:
    """What the open step of a lesson needs; None without one."""
    if not snapshot.key.in_lesson:
        return None
    view = LessonView(course, words, snapshot.lesson)
    return NO_SETUP if view.ended else view.setup
