"""Tells a page its form and the values of the fields, and carries out what it sets."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import ClassVar

from msgspec import Struct
from typing_extensions import override

from onpath.app.channel.messages import (
    AskForm,
    FieldValue,
    FormMessage,
    SetField,
    ValuesMessage,
)
from onpath.app.lab.commands import ChooseLaw, ChoosePath, PlacePoint, SelectPoint, Set, TypeLaw
from onpath.app.lab.lab import Command, Lab
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.page.page import Page
from onpath.app.view.lab_form import (
    NO_STEP,
    SWITCHES,
    form_of,
    refusals_in,
    switch_name,
    values_in,
)
from onpath.app.view.lesson_view import NO_SETUP, LessonView
from onpath.lessons.action_schema import StepSetup
from onpath.lessons.course import Course
from onpath.lessons.words import Words
from onpath.models.control.laws.own import OWN
from onpath.models.control.sides import SIDES

_DRAWN = {switch_name(name): name for name in SWITCHES}
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
    """

    def __init__(self, post: Callable[[Command], None]) -> None:
        self._post, self.is_asked = post, False
        self._heard = dict[str, int]()
        self._own = deque[SetField]()  # what concerns the page alone
        self._typing = set[str]()  # sides for which a law is being typed
        self.restart()

    def restart(self) -> None:
        """Forget what the page knows, and what it has asked for."""
        self.is_asked = False
        self._forms: tuple[FormMessage | None, ...] = None, None
        self._values, self._refused = dict[str, FieldValue](), dict[str, str]()
        self._told = dict[str, int]()

    def hear(self, message: AskForm | SetField, is_own: bool) -> None:
        """Carry out what a page has set. On the event loop.

        Args:
            is_own: whether the page may change the lab that it shows.
        """
        if isinstance(message, AskForm):
            self.is_asked = True
            return
        name, value = message.name, message.value
        if name in _DRAWN or not is_own:
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

    def news(
        self, snapshot: PageSnapshot, page: Page | None, course: Course, words: Words
    ) -> Iterator[Struct]:
        """What has changed since the last time. In the simulation thread.

        Args:
            page: viser's part, if it is there; it has the drawings.
        """
        switches = set[str]() if page is None else page.switches
        heard = dict(self._heard)
        while self._own:
            message = self._own.popleft()
            if message.name in _DRAWN:
                change = switches.add if message.value else switches.discard
                change(_DRAWN[message.name])
            self._hear(message.name, message.number)
            heard[message.name] = message.number
        setup = _setup(snapshot, course, words)
        step = NO_STEP if setup is None else form_of(snapshot, setup, words)
        forms = form_of(snapshot, None, words), step
        for form, before in zip(forms, self._forms, strict=True):
            if form is not before:
                yield form
        self._forms = forms
        drawn = {name: name in switches for name in SWITCHES}
        values = values_in(snapshot, drawn, self._typing, words)
        refused = refusals_in(snapshot)
        changed = dict[str, FieldValue]()
        if values != self._values:
            changed = {n: v for n, v in values.items() if self._values.get(n) != v}
        why = {n: w for n, w in refused.items() if self._refused.get(n) != w}
        why |= {n: "" for n in self._refused if n not in refused}
        new = {n: k for n, k in heard.items() if self._told.get(n) != k}
        if changed or why or new:
            self._values, self._refused, self._told = values, refused, heard
            yield ValuesMessage(changed, why, new)


def _setup(snapshot: PageSnapshot, course: Course, words: Words) -> StepSetup | None:
    """What the open step of a lesson needs; None without one."""
    if not snapshot.key.in_lesson:
        return None
    view = LessonView(course, words, snapshot.lesson)
    return NO_SETUP if view.ended else view.setup
