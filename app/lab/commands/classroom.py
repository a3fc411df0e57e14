"""Commands from the teacher's page to labs. A student's page cannot send them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

from typing_extensions import override

from onpath.app.lab.commands.lessons import PlayStep
from onpath.app.lab.commands.path import finish
from onpath.app.lab.lab import Command, Lab
from onpath.app.lab.setups.setup import Setup
from onpath.lessons.given import Answer
from onpath.lessons.pace import Pace
from onpath.lessons.votes import Vote


@dataclass(frozen=True, slots=True)
class Freeze(Command):
    """Stop time and refuse the student's commands, or resume."""

    from_teacher: ClassVar[bool] = True
    on: bool

    @override
    def apply(self, lab: Lab) -> None:
        if self.on == lab.frozen:
            return
        if self.on:
            lab.simulation.forces.release()
            if lab.simulation.editor.proposed is not None:  # a point is being dragged
                finish(lab)
        lab.frozen = self.on
        lab.clear_message()
        _tell(lab)


@dataclass(frozen=True, slots=True)
class TakeSetup(Command):
    """Apply a set-up, in the free lab or in the open step."""

    from_teacher: ClassVar[bool] = True
    setup: Setup

    @override
    def apply(self, lab: Lab) -> None:
        run = lab.lessons
        run.take(self.setup, lab)
        text = run.words("class.setup" if run.lesson is None else "class.setup_in_step")
        lab.show_message(text)
        _tell(lab)


@dataclass(frozen=True, slots=True)
class TakeStep(Command):
    """Open a step of a lesson, wherever the student is.

    Attributes:
        route: the route to follow from there; if empty, the student's route stays.
        again: whether the prediction of the step is asked once more, after a discussion.
    """

    from_teacher: ClassVar[bool] = True
    lesson: str
    step: int
    route: str = ""
    again: bool = False

    @override
    def apply(self, lab: Lab) -> None:
        run = lab.lessons
        elsewhere = run.lesson is not None and run.progress.lesson != run.own(self.lesson)
        run.open_at(self.lesson, self.step, lab, self.route)
        key = "class.step_elsewhere" if elsewhere else "class.step"
        if self.again:
            run.ask_again()
            run.begin_anew(lab)
            key = "class.step_again"
        lab.show_message(run.words(key))
        _tell(lab)


@dataclass(frozen=True, slots=True)
class DemonstrateStep(Command):
    """Play a step's demonstration, whatever is open in the lab; a pending prediction is skipped."""

    from_teacher: ClassVar[bool] = True
    lesson: str
    step: int

    @override
    def apply(self, lab: Lab) -> None:
        run = lab.lessons
        run.open_at(self.lesson, self.step, lab)
        if run.waits:
            run.predict(Answer(), lab.simulation)
        PlayStep().apply(lab)


@dataclass(frozen=True, slots=True)
class KeepWithin(Command):
    """Restrict the student to some steps, and bring them there; None lifts the restriction."""

    from_teacher: ClassVar[bool] = True
    pace: Pace | None

    @override
    def apply(self, lab: Lab) -> None:
        run = lab.lessons
        run.set_pace(self.pace)
        if self.pace is not None and not self.pace.holds(run.progress.lesson, run.index):
            run.open_at(self.pace.lesson, self.pace.first, lab)
            lab.show_message(run.words("class.step"))
        _tell(lab)


@dataclass(frozen=True, slots=True)
class DealForm(Command):
    """Give the student a form of the concept test, by its index, to answer before the course."""

    from_teacher: ClassVar[bool] = True
    form: int

    @override
    def apply(self, lab: Lab) -> None:
        lab.lessons.first_form = self.form


@dataclass(frozen=True, slots=True)
class HoldVotes(Command):
    """What the class is asked now; none: every vote is closed."""

    from_teacher: ClassVar[bool] = True
    votes: tuple[Vote, ...]

    @override
    def apply(self, lab: Lab) -> None:
        lab.lessons.set_votes(self.votes)
        if lab.lessons.is_voting:
            lab.simulation.running = False


@dataclass(frozen=True, slots=True)
class SayLate(Command):
    """Say that an answer came after the vote was closed."""

    from_teacher: ClassVar[bool] = True

    @override
    def apply(self, lab: Lab) -> None:
        lab.show_message(lab.words("class.came_late"), "warning")


@dataclass(frozen=True, slots=True)
class ReportState(Command):
    """Report the lab's current state to a callback, which must not block."""

    from_teacher: ClassVar[bool] = True
    to: Callable[[Lab], None]

    @override
    def apply(self, lab: Lab) -> None:
        self.to(lab)


def _tell(lab: Lab) -> None:
    """Tell the student if the lab is frozen."""
    if lab.frozen:
        lab.show_message(lab.words("class.frozen"), "stop")
