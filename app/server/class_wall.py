"""The wall of a class: one lab, simulated for all pages at the class's address for projectors.

It follows what the class is shown. Such a page has neither controls nor names, and nothing that it
sends changes anything.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache, partial
from time import monotonic

from msgspec import structs
from typing_extensions import override

from onpath.app.channel.class_messages import WallMessage
from onpath.app.channel.data_frame import FrameSource, frame_message, path_message
from onpath.app.channel.messages import Alive, changes, encoded, encoded_changes
from onpath.app.channel.state_messages import Said, StateMessage
from onpath.app.classroom.class_html import class_code
from onpath.app.classroom.classroom import Classroom
from onpath.app.classroom.teaching.class_answers import ClassAnswers
from onpath.app.classroom.teaching.steps_for_all import StepsForAll
from onpath.app.classroom.teaching.teacher_context import TeacherChoices
from onpath.app.common.work_thread import WorkThread
from onpath.app.lab.commands import DemonstrateStep, Freeze, TakeStep
from onpath.app.lab.lab import Lab
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.lab.snapshots.snapshot import Motion, PathSnapshot
from onpath.app.lab.snapshots.take_snapshot import take_motion, take_page_snapshot
from onpath.app.server.first_projection import FirstProjection
from onpath.app.server.lab_registry import LabRegistry
from onpath.app.server.page_data import BEAT, EVERY, lit_message
from onpath.app.server.site_address import is_local
from onpath.app.server.visit import Visit
from onpath.app.simulation.display_rate import is_turn
from onpath.app.simulation.scheduled_lab import LabDisplay, ScheduledLab
from onpath.app.view.page_words import words_message
from onpath.app.view.state_message import state_message
from onpath.app.viser_adapter.addresses import class_address
from onpath.app.viser_adapter.data_channel import Message
from onpath.lessons.course import Course
from onpath.lessons.progress import Progress
from onpath.lessons.words import Words

LOOKS = 0.5  # [s] between looks at the class


@dataclass(eq=False, slots=True)
class WallPage:
    """One page.

    Attributes:
        site: the address of the site for students.
        opened: for which of its connections it has been told what follows.
        path, state, message: what it has been told last.
        told: when it was told anything last, [s].
    """

    visit: Visit
    site: str
    opened: int = 0
    path: PathSnapshot | None = None
    state: StateMessage | None = None
    message: WallMessage | None = None
    told: float = 0.0

    @property
    def place(self) -> tuple[str, str]:
        """What its texts depend on."""
        return self.visit.language, self.site


@dataclass(frozen=True, slots=True)
class WallContext:
    """See `class_answers.AnswersContext`."""

    classroom: Classroom
    progress: Callable[[], Progress]
    chosen: TeacherChoices = field(default_factory=TeacherChoices)


class ClassWall(LabDisplay):
    """All walls of a class. They share one lab, and each message is made once for all of them.

    Args:
        send: sends what has been handed over for all pages.
    """

    def __init__(
        self,
        classroom: Classroom,
        *,
        course: Course,
        registry: LabRegistry,
        send: Callable[[], None],
    ) -> None:
        self._class, self._course, self._registry, self._send = classroom, course, registry, send
        self._walls: tuple[WallPage, ...] = ()
        self._scheduled: ScheduledLab | None = None
        self._source = FrameSource(tells_past=False)
        self._thread, self._computing = WorkThread("wall"), WorkThread("wall's truth")
        self._first_projection = FirstProjection(self._thread.submit)
        self._answers = dict[str, ClassAnswers]()  # by language
        self._looked = dict[tuple[str, str], WallMessage]()  # by `WallPage.place`
        self._next, self._busy = 0.0, False
        self._given: TakeStep | DemonstrateStep | None = None
        self._last: PageSnapshot | Motion | None = None
        self._whole: PageSnapshot | None = None

    def add(self, visit: Visit, site: str) -> None:
        """Show the wall on a page, until its visit ends. Not in the simulation thread."""
        wall, scheduled = WallPage(visit, site), self._scheduled or self._registry.unowned_lab()
        self._registry.thread.call(partial(self._begin, wall, scheduled))
        visit.stream.receive = _deaf
        visit.at_end(lambda: self._registry.thread.call(partial(self._remove, wall)))

    def close(self) -> None:
        """Start no further work."""
        self._thread.close()
        self._computing.close()

    # In the simulation thread

    def _begin(self, wall: WallPage, scheduled: ScheduledLab) -> None:
        self._walls = (*self._walls, wall)
        if self._scheduled is None:
            self._scheduled, self._given, self._looked = scheduled, None, {}
            scheduled.display = self
            self._registry.thread.add(scheduled)

    def _remove(self, wall: WallPage) -> None:
        self._walls = tuple(each for each in self._walls if each is not wall)
        if not self._walls and self._scheduled is not None:
            self._registry.thread.remove(self._scheduled)
            self._scheduled = self._last = self._whole = None

    @property
    @override
    def is_outdated(self) -> bool:
        return False

    @override
    def is_turn(self, lab: Lab, frame: int, stride: float) -> bool:
        return is_turn(frame, max(stride, EVERY))

    @override
    def show(self, lab: Lab, frame: int, stride: float) -> None:
        if any(each.visit.stream.opened != each.opened for each in self._walls):
            self._source.forget()  # what one of them does not know is sent to all again
        self._source.note(lab.simulation)
        if self._whole is None or not self.is_turn(lab, frame, stride):
            return
        self._last = motion = take_motion(lab, self._last)
        robot, path = lab.simulation.robot, motion.path
        told_path = cache(lambda: encoded(path_message(robot, path)))
        news = list[Message]()
        if (taken := self._source.take(lab)) is not None:
            news.append(cache(lambda: encoded(frame_message(taken))))
            news.append(cache(lambda: encoded(lit_message("bars", robot, motion))))
        for wall in self._walls:
            opened = wall.visit.stream.opened
            if opened != wall.opened:
                wall.opened, wall.path, wall.state, wall.message = opened, None, None, None
            if path is wall.path:
                self._hand_over(wall, news)
            elif self._hand_over(wall, [told_path, *news]):
                wall.path = path

    @override
    def refresh(self, lab: Lab, achieved: float) -> None:
        self._follow(lab)
        snapshot = take_page_snapshot(lab, achieved, self._whole)
        self._last = self._whole = snapshot
        if monotonic() >= self._next and not self._busy:
            self._next, self._busy = monotonic() + LOOKS, True
            self._thread.submit(partial(self._look, lab))
        seen = self._first_projection.of(lab.simulation.robot)
        if seen is None:
            return
        states = {
            language: _silent(state_message(snapshot, Words(language), {}, Said(), seen))
            for language in {each.visit.language for each in self._walls}
        }
        for wall in self._walls:
            if wall.visit.stream.opened == wall.opened:
                self._tell(wall, states[wall.visit.language])

    def _tell(self, wall: WallPage, state: StateMessage) -> None:
        """Tell a page what has changed."""
        if wall.visit.stream.is_busy:
            return
        messages = list[Message]()
        if wall.state is None:
            messages.append(partial(words_message, state.language))
        if news := changes(state, wall.state):
            wall.state = state
            messages.append(partial(encoded_changes, StateMessage, news))
        message = self._looked.get(wall.place)
        if message is not None and message != wall.message:
            wall.message = message
            messages.append(partial(encoded, message))
        if not messages and monotonic() > wall.told + BEAT:
            messages.append(partial(encoded, Alive()))
        self._hand_over(wall, messages)

    def _hand_over(self, wall: WallPage, messages: list[Message]) -> bool:
        """Hand messages over, unless there are none or the page is not ready for them."""
        stream = wall.visit.stream
        if not messages or not stream.is_open or stream.is_busy:
            return False
        wall.told = monotonic()
        stream.hand_over(*messages)
        return True

    def _follow(self, lab: Lab) -> None:
        """Have the lab show the step that the class is shown, and its run with the truth."""
        classroom, steps = self._class, StepsForAll(self._course, lab.words.language)
        display = classroom.display.seen(classroom.now())
        if not self._course.has(display.lesson):
            return  # nothing has been shown yet
        wanted = steps.demonstration(display) if display.revealed else None
        if (wanted := wanted or TakeStep(*steps.shown(display))) != self._given:
            self._given = wanted
            lab.post(wanted)
        if classroom.orders.frozen != lab.frozen:
            lab.post(Freeze(classroom.orders.frozen))

    @override
    def send(self) -> None:
        self._send()

    # In a thread

    def _look(self, lab: Lab) -> None:
        """Look at the class, which may be large."""
        try:
            places = {each.place for each in self._walls}
            self._looked = {place: self._seen(lab, *place) for place in places}
        finally:
            self._busy = False

    def _seen(self, lab: Lab, language: str, site: str) -> WallMessage:
        words, code = Words(language), self._class.code
        answers = self._answers.get(language)
        if answers is None:
            context = WallContext(self._class, lambda: lab.lessons.progress)
            answers = ClassAnswers(self._course, words, context, self._computing.submit)
            self._answers[language] = answers
        joining = class_code(
            address=f"{site}{class_address(code)}",
            is_local=is_local(site),
            code=code,
            count=None,
            words=words,
            large=True,
        )
        if not self._course.has(self._class.display.lesson):
            return WallMessage(joining, "", None, "")
        closing, note = answers.closing()
        return WallMessage(joining, answers.view(large=True, silent=True), closing, note)


def _silent(state: StateMessage) -> StateMessage:
    """The state without what its lab says to a user."""
    return structs.replace(state, message="", level="", messages=0, own=False)


def _deaf(_: str) -> bytes:
    """Whatever a wall sends only says that it is there."""
    return b""
