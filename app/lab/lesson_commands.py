"""What a student can ask of the lessons; see app/lab/commands.py."""

from __future__ import annotations

from dataclasses import dataclass

from onpath.lessons.schema import Action


@dataclass(frozen=True, slots=True)
class OpenLesson:
    """Open a lesson where it was left."""

    name: str


@dataclass(frozen=True, slots=True)
class CloseLesson:
    """Back to the lab as it was before."""


@dataclass(frozen=True, slots=True)
class GoToStep:
    """Another step of the open lesson, `by` so many from the present one."""

    by: int


@dataclass(frozen=True, slots=True)
class Predict:
    """Commit to a prediction: an option, or a curve; with neither, skip it."""

    option: int | None = None
    times: tuple[float, ...] = ()
    values: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class PlayStep:
    """Let the lab do what the step shows."""


@dataclass(frozen=True, slots=True)
class BeginStepAnew:
    """Set the lab up again as the step wants it."""


@dataclass(frozen=True, slots=True)
class ShowHint:
    """One hint more."""

    task: str


@dataclass(frozen=True, slots=True)
class AnswerQuiz:
    """Choose an option of a question; `block` is its place in the step."""

    block: int
    option: int


@dataclass(frozen=True, slots=True)
class Act:
    """What a link in the text does."""

    actions: tuple[Action, ...]


@dataclass(frozen=True, slots=True)
class SetLanguage:
    """Of texts and interface."""

    language: str


@dataclass(frozen=True, slots=True)
class SetPresenting:
    """Large type for a projector, or not."""

    on: bool


LessonCommand = (
    OpenLesson
    | CloseLesson
    | GoToStep
    | Predict
    | PlayStep
    | BeginStepAnew
    | ShowHint
    | AnswerQuiz
    | Act
    | SetLanguage
    | SetPresenting
)
