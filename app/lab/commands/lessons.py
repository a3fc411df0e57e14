"""Commands for working through the lessons."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import ClassVar

from typing_extensions import override

from onpath.app.lab.commands.scripts import commands_of, player_of
from onpath.app.lab.lab import Command, Lab
from onpath.app.lab.lesson_state import Sent
from onpath.app.lab.plant_state import PlantState
from onpath.assets.messages import languages
from onpath.lessons.action_schema import Action
from onpath.lessons.given import Answer, Sure
from onpath.models.errors import CodedError
from onpath.models.systems.parameter_specs import unknown_name

LONGEST_KEY = 40  # [characters] of the key of an answer
MOST_ACTIONS = 100  # of a link; those of lessons have a few


@dataclass(frozen=True, slots=True)
class OpenLesson(Command):
    """Open a lesson at the step that was open last."""

    name: str

    @override
    def apply(self, lab: Lab) -> None:
        lab.lessons.open(self.name, lab)


@dataclass(frozen=True, slots=True)
class FollowRoute(Command):
    """Open the first step of a route, and follow it from stop to stop."""

    name: str

    @override
    def apply(self, lab: Lab) -> None:
        lab.lessons.follow_route(self.name, lab)


@dataclass(frozen=True, slots=True)
class CloseLesson(Command):
    """Close the lesson and restore the lab as it was before."""

    @override
    def apply(self, lab: Lab) -> None:
        lab.lessons.close(lab)


@dataclass(frozen=True, slots=True)
class FinishLesson(Command):
    """Show the end of the open lesson."""

    @override
    def apply(self, lab: Lab) -> None:
        lab.lessons.finish()


@dataclass(frozen=True, slots=True)
class GoToStep(Command):
    """Go to another step of the open lesson, `by` steps from the current one."""

    by: int

    @override
    def apply(self, lab: Lab) -> None:
        lab.lessons.go(int(self.by), lab)


@dataclass(frozen=True, slots=True)
class _Answering(Command):
    """An answer. Its browser sends it until it is stored, and a frozen lab takes it, too.

    Attributes:
        lesson, step, key: see `Sent`; without a lesson, the open step is meant.
    """

    is_answer: ClassVar[bool] = True
    lesson: str = field(default="", kw_only=True)
    step: int = field(default=0, kw_only=True)
    key: str = field(default="", kw_only=True)

    @override
    def apply(self, lab: Lab) -> None:
        try:
            self.give(lab, Sent(self.lesson, self.step, self.key[:LONGEST_KEY]))
        except ValueError:
            lab.lessons.settle(self.key)
            raise

    def give(self, lab: Lab, sent: Sent) -> None:
        """Hand the answer to the lessons."""
        raise NotImplementedError


@dataclass(frozen=True, slots=True)
class Predict(_Answering):
    """Submit a prediction: an option or a curve; with neither, skip it.

    Attributes:
        sure, reason, why: as in `Answer`.
    """

    option: int | None = None
    times: tuple[float, ...] = ()
    values: tuple[float, ...] = ()
    sure: Sure = ""
    reason: int | None = None
    why: str = ""

    @override
    def give(self, lab: Lab, sent: Sent) -> None:
        answer = Answer(
            option=self.option,
            times=self.times,
            values=self.values,
            sure=self.sure,
            reason=self.reason,
            why=self.why,
        )
        lab.lessons.predict(answer, lab.simulation, sent)
        lab.show_message("")  # clear the reminder that a prediction is missing


@dataclass(frozen=True, slots=True)
class PlayStep(Command):
    """Play the step's demonstration."""

    @override
    def apply(self, lab: Lab) -> None:
        step = lab.lessons.step
        if step is not None and step.script is not None:
            lab.lessons.play(player_of(step.script), lab)


@dataclass(frozen=True, slots=True)
class BeginStepAnew(Command):
    """Set the lab up for the step again."""

    @override
    def apply(self, lab: Lab) -> None:
        lab.lessons.begin_anew(lab)


@dataclass(frozen=True, slots=True)
class ShowHint(Command):
    """Show one more hint."""

    task: str

    @override
    def apply(self, lab: Lab) -> None:
        lab.lessons.hint(self.task)


@dataclass(frozen=True, slots=True)
class AnswerQuiz(_Answering):
    """Choose an option of a question, or of its second try; `block` is its index in the step."""

    block: int
    option: int
    second: bool = False

    @override
    def give(self, lab: Lab, sent: Sent) -> None:
        lab.lessons.answer_quiz(self.block, self.option, sent, second=self.second)


@dataclass(frozen=True, slots=True)
class AnswerNumber(_Answering):
    """Answer a question, or a second try, with a number; `block` is its index in the step."""

    block: int
    given: float
    second: bool = False

    @override
    def give(self, lab: Lab, sent: Sent) -> None:
        lab.lessons.answer_number(self.block, self.given, sent, second=self.second)


@dataclass(frozen=True, slots=True)
class AnswerInWords(_Answering):
    """Answer an open question; `block` is its index in the step."""

    block: int
    typed: str

    @override
    def give(self, lab: Lab, sent: Sent) -> None:
        lab.lessons.answer_in_words(self.block, self.typed, sent)


@dataclass(frozen=True, slots=True)
class Act(Command):
    """Perform the actions of a link in the text, at most `MOST_ACTIONS`."""

    actions: tuple[Action, ...]

    @override
    def apply(self, lab: Lab) -> None:
        for command in self.parts(lab):
            command.apply(lab)

    @override
    def parts(self, lab: Lab) -> Iterator[Command]:
        if len(self.actions) > MOST_ACTIONS:
            raise CodedError("error.too_many_actions", most=MOST_ACTIONS)
        for action in self.actions:
            if action.run:
                lab.lessons.check_unlocked()
            yield from commands_of(action)


@dataclass(frozen=True, slots=True)
class SetLanguage(Command):
    """Set the language of texts and interface."""

    language: str

    @override
    def suits(self, lab: Lab, plant: PlantState) -> bool:
        return True

    @override
    def apply(self, lab: Lab) -> None:
        if self.language not in languages():
            raise unknown_name(self.language, languages(), "language")
        lab.lessons.set_language(self.language)
        lab.clear_message()
