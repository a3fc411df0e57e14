"""A student's progress through the lessons: the open step, predictions, and passed tasks.

It does not depend on a lab; `app.lab.lesson_run` plays the steps on one.
"""

from __future__ import annotations

from typing import Any

from msgspec.structs import replace

from onpath.app.lab.answers import kept_number, kept_text
from onpath.lessons.adaptive.branches import is_shown
from onpath.lessons.course import Course
from onpath.lessons.kept.known_choices import mark_of, marks_of
from onpath.lessons.kept.option_keys import second_key
from onpath.lessons.pace import Pace
from onpath.lessons.progress import Answer, Notes, Progress
from onpath.lessons.routes import Route
from onpath.lessons.schema import (
    Block,
    Lesson,
    NumberQuestion,
    OpenQuestion,
    Prediction,
    Quiz,
    Step,
)
from onpath.lessons.words import Words
from onpath.models.errors import CodedError, Message


class LessonState:
    """One student's progress through the lessons.

    Attributes:
        course: all lessons.
        progress: the part that is saved.
        words: texts in the student's language.
        version: changes whenever the page must be redrawn.
        pace: the steps within which the teacher lets the student go; None if anywhere.
    """

    def __init__(
        self, course: Course, progress: Progress | None = None, words: Words | None = None
    ) -> None:
        self.course = course
        self.progress = progress or Progress()
        self.words = words or Words(self.progress.language)
        self.version = 0
        self.pace: Pace | None = None

    @property
    def lesson(self) -> Lesson | None:
        """The open lesson, or None."""
        name = self.progress.lesson
        if not self.course.has(name):
            return None
        return self.course.lesson(name, self.progress.language)

    @property
    def notes(self) -> Notes:
        """Saved notes on the open lesson."""
        return self.progress.notes.get(self.progress.lesson, Notes())

    @property
    def index(self) -> int:
        """Index of the open step."""
        return self.left_at(self.progress.lesson)

    def left_at(self, name: str) -> int:
        """Index of the step of a lesson that was last open; 0 if there is no such lesson."""
        if not self.course.has(name):
            return 0
        last = len(self.course.lesson(name, self.progress.language).steps) - 1
        return min(self.progress.notes.get(name, Notes()).step, last)

    @property
    def step(self) -> Step | None:
        """The open step, or None."""
        lesson = self.lesson
        return lesson.steps[self.index] if lesson else None

    @property
    def route(self) -> Route | None:
        """The route that the student follows, or None; a test is on no route."""
        if self.is_test:
            return None
        return self.course.routes.get(self.progress.route)

    def beside(self, by: int) -> tuple[str, int]:
        """Lesson and index of a step `by` steps from the open one; at an end, of the last one.

        On a route, the step after the last one of a stop is the first one of the next stop. Steps
        for other answers than the student's are passed over.
        """
        lesson = self.lesson
        if lesson is None:
            return "", 0
        here = lesson.name, self.index
        at = self._moved(here, by)
        while not self._is_open(at):
            further = self._moved(at, 1 if by > 0 else -1)
            if further == at:
                return here
            at = further
        return at

    def _moved(self, at: tuple[str, int], by: int) -> tuple[str, int]:
        """Like `beside`, but from any step, and regardless of the answers."""
        name, index = at
        if self.route is None:
            index += by
        else:
            name, index = self.route.beside(name, index, by) or at
        steps = self.course.lesson(name, self.progress.language).steps
        return name, min(max(index, 0), len(steps) - 1)

    def _is_open(self, at: tuple[str, int]) -> bool:
        """Whether a step is meant for the student's answers."""
        name, index = at
        steps = self.course.lesson(name, self.progress.language).steps
        notes = self.progress.notes.get(name, Notes())
        return is_shown(steps[index].when, steps, notes, index)

    @property
    def at_end(self) -> bool:
        """Whether the open step is the last one, of the lesson or of the route."""
        return self.lesson is not None and self.beside(1) == (self.lesson.name, self.index)

    @property
    def ended(self) -> bool:
        """Whether the end of the open lesson is shown in place of a step."""
        return self.progress.ended and self.lesson is not None

    def set_pace(self, pace: Pace | None) -> None:
        """Restrict the student to some steps; None lifts the restriction."""
        self.pace = pace
        self.version += 1

    def may_go(self, by: int) -> bool:
        """Whether the teacher lets the student go `by` steps from the open one."""
        name, index = self.beside(by)
        return self.pace is None or self.pace.holds(name, index)

    def check_within(self, name: str, index: int) -> None:
        """Raise ValueError if the teacher does not let the student go to a step."""
        pace = self.pace
        if pace is not None and not pace.holds(name, index):
            raise CodedError("lesson.out_of_pace", first=pace.first + 1, last=pace.last + 1)

    def past_optional(self) -> int | None:
        """Number of steps to the next one that is not optional, if the very next one is optional.

        None if it is not, or is not on the route; 0 if only optional ones are left.
        """
        lesson, index = self.lesson, self.index
        after = () if lesson is None else lesson.steps[index + 1 :]
        if lesson is None or not after or not after[0].optional:
            return None
        if self.beside(1) != (lesson.name, index + 1):
            return None
        return next((i for i, step in enumerate(after, 1) if not step.optional), 0)

    def prediction(self) -> tuple[str, Prediction] | None:
        """Key and prediction of the open step, from this step or the previous one."""
        lesson = self.lesson
        if lesson is None:
            return None
        for index in (self.index, self.index - 1):
            step = lesson.steps[index] if index >= 0 else None
            if step is not None and (step is self.step or self.step_is("run")):
                for prediction in step.predictions():
                    return str(index), prediction
        return None

    def step_is(self, kind: str) -> bool:
        """Whether the open step is of a kind."""
        return self.step is not None and self.step.kind == kind

    def answer(self) -> Answer | None:
        """Answer to the open step's prediction, the latest one, or None while one is awaited."""
        found, notes = self.prediction(), self.notes
        if found is None:
            return None
        return (notes.second if found[0] in notes.asked_again else notes.answers).get(found[0])

    def first_answer(self) -> Answer | None:
        """The answer before a discussion, if the open step's prediction is asked again; or None."""
        found, notes = self.prediction(), self.notes
        again = found is not None and found[0] in notes.asked_again
        return notes.answers.get(found[0]) if found is not None and again else None

    def ask_again(self) -> None:
        """Ask for the open step's prediction again, even if it was never answered."""
        if (found := self.prediction()) is None:
            return
        key, notes = found[0], self.notes
        self.note(
            asked_again=tuple(dict.fromkeys((*notes.asked_again, key))),
            second={k: answer for k, answer in notes.second.items() if k != key},
            unknown=tuple(each for each in notes.unknown if each != second_key(key)),
        )

    @property
    def waits(self) -> bool:
        """Whether a prediction is pending."""
        return self.prediction() is not None and self.answer() is None

    @property
    def is_test(self) -> bool:
        """Whether the open lesson is the concept test, before or after the course."""
        return self.progress.lesson in self.course.tests

    @property
    def locked(self) -> Message | None:
        """Why time must not run (a prediction is pending, or a test is open); None if it may."""
        if self.is_test and not self.notes.handed_in:
            return Message("test.locked")
        return Message("lesson.locked") if self.waits else None

    def check_unlocked(self) -> None:
        """Raise ValueError if time must not run; see `locked`."""
        if self.is_test and not self.notes.handed_in:
            raise CodedError("test.locked")
        if self.waits:
            raise CodedError("lesson.locked")

    def has_played(self) -> bool:
        """Whether the open step's demonstration has been played, now or earlier."""
        return str(self.index) in self.notes.played

    def hint(self, task: str) -> None:
        """Show one more hint of a task of the open step.

        Raises:
            ValueError: there is no such task, or it has no further hint.
        """
        tasks = {each.id: each for each in self.step.tasks()} if self.step else {}
        if task not in tasks:
            raise CodedError("lesson.no_such_task")
        shown = self.notes.hints.get(task, 0) + 1
        if shown > len(tasks[task].hints):
            raise CodedError("lesson.no_more_hints")
        self.note(hints={**self.notes.hints, task: shown})

    def answer_quiz(self, block: int, option: int) -> None:
        """Choose an option of a quiz, given its index among the open step's blocks.

        Raises:
            ValueError: there is no such quiz or option, or the test has been handed in.
        """
        if self.notes.handed_in:
            raise CodedError("test.over")
        quiz = self._block(block)
        if not isinstance(quiz, Quiz) or option not in range(len(quiz.options)):
            raise CodedError("lesson.no_such_option")
        assert self.lesson is not None
        key = f"{self.index}.{block}"
        before = None if key in self.notes.unknown else self.notes.quiz.get(key)
        self._note_second(key, before, option)
        self._note_chosen(key, mark_of(self.lesson, key, option), "quiz", option)

    def answer_number(self, block: int, given: float) -> None:
        """Answer a question with a number; `block` is its index among the open step's blocks.

        Raises:
            ValueError: there is no such question, or the answer is not a number.
        """
        if not isinstance(self._block(block), NumberQuestion):
            raise CodedError("lesson.no_such_option")
        number, key = kept_number(given), f"{self.index}.{block}"
        self._note_second(key, self.notes.numbers.get(key), number)
        self.note(numbers={**self.notes.numbers, key: number})

    def answer_in_words(self, block: int, typed: str) -> None:
        """Answer an open question, or take the answer back with an empty one.

        Raises:
            ValueError: there is no such question.
        """
        if not isinstance(self._block(block), OpenQuestion):
            raise CodedError("lesson.no_such_option")
        key, text = f"{self.index}.{block}", kept_text(typed)
        others = {k: kept for k, kept in self.notes.written.items() if k != key}
        self.note(written={**others, **({key: text} if text else {})})

    def _note_second(self, key: str, before: float | None, given: float) -> None:
        """Note that a question of the open step is answered again, and otherwise than before."""
        if before not in (None, given) and not self.is_test:
            self.note(twice=tuple(dict.fromkeys((*self.notes.twice, key))))

    def _block(self, block: int) -> Block | None:
        """A block of the open step, or None."""
        step = self.step
        return step.blocks[block] if step and block in range(len(step.blocks)) else None

    def set_language(self, language: str) -> None:
        """Set the language of texts and interface."""
        self.words = Words(language)
        self.progress = replace(self.progress, language=self.words.language)
        self.version += 1

    def note_answer(self, answer: Answer) -> None:
        """Store the answer to the open step's prediction, the second one if it is asked again."""
        found, lesson = self.prediction(), self.lesson
        assert found is not None and lesson is not None
        key, again = found[0], found[0] in self.notes.asked_again
        marks = marks_of(lesson, key, answer, again)
        self._note_chosen(key, marks, "second" if again else "answers", answer)

    def is_unknown(self, key: str = "") -> bool:
        """Whether a stored choice can no longer be identified, because the lesson has changed.

        Args:
            key: of a quiz in the notes; without one, the open step's prediction is meant.
        """
        notes, found = self.notes, self.prediction()
        key = key or (found[0] if found else "")
        noted = second_key(key) if key in notes.asked_again else key
        return noted in notes.unknown

    def _note_chosen(self, key: str, marks: dict[str, str], kind: str, chosen: object) -> None:
        """Store a choice in a field of the notes, with the marks that identify it later."""
        notes = self.notes
        noted = second_key(key) if kind == "second" else key
        self.note(
            **{kind: {**getattr(notes, kind), key: chosen}},
            marks={**notes.marks, **marks},
            unknown=tuple(each for each in notes.unknown if each != noted),
        )

    def note(self, **changes: Any) -> None:
        """Change the saved notes on the open lesson."""
        notes = {**self.progress.notes, self.progress.lesson: replace(self.notes, **changes)}
        self.progress = replace(self.progress, notes=notes)
        self.version += 1
