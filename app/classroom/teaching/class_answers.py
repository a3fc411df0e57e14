"""The class's answers to a step, without names, for the teacher's page."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

from onpath.app.classroom import class_html as page
from onpath.app.classroom.classroom import MOST_MEMBERS, Display
from onpath.app.classroom.concept_test_results import gain_view, item_distribution, question_at
from onpath.app.classroom.results import (
    Asked,
    Distribution,
    asked_at,
    distribution,
    is_asked_again,
    truth_of,
)
from onpath.app.classroom.sketches_html import Picks
from onpath.app.classroom.teaching.lesson_labels import step_label
from onpath.app.classroom.teaching.steps_for_all import StepsForAll
from onpath.app.classroom.teaching.teacher_context import TeacherContext
from onpath.app.lab.dry_runs.step_truth import computed_truth
from onpath.lessons.concept_test.concept_test import TESTS
from onpath.lessons.course import Course
from onpath.lessons.kept.known_choices import of_today
from onpath.lessons.progress import Progress, Truth
from onpath.lessons.schema import Lesson, NumberQuestion, Prediction, Quiz
from onpath.lessons.votes import vote_on
from onpath.lessons.words import Words


@dataclass(frozen=True, slots=True)
class Students:
    """The members of a class who count: their progress, and whether each is here."""

    progress: list[Progress]
    here: list[bool]


class ClassAnswers:
    """The answers to the displayed question.

    Args:
        submit: runs what takes long, perhaps later; the truth is not known until then.
    """

    def __init__(
        self,
        course: Course,
        words: Words,
        teaching: TeacherContext,
        submit: Callable[[Callable[[], None]], None] = lambda work: work(),
    ) -> None:
        self._course, self._words, self._teaching = course, words, teaching
        self._submit = submit
        self._computed: dict[tuple[str, int], Truth | None] = {}

    @property
    def _display(self) -> Display:
        classroom = self._teaching.classroom
        return classroom.display.seen(classroom.now())

    def view(self, large: bool) -> str:
        """The answers to what the displayed step asks, or to a question of a test."""
        steps = StepsForAll(self._course, self._words.language)
        name, index = steps.shown(self._display)
        lesson = self._course.lesson(name, self._words.language)
        members = list(self._teaching.classroom.present().values())
        students = Students(
            [of_today(self._course, member.progress) for member in members],
            [member.connected for member in members],
        )
        if name in self._course.tests:
            return self._test(lesson, index, students.progress, large)
        views = [
            self._question(lesson, item, block, students, large)
            if isinstance(block, Quiz | NumberQuestion)
            else self._prediction(lesson, int(item), block, students, large)
            for item, block in asked_at(lesson, index).items()
        ]
        title = step_label(lesson, index, self._words)
        return "".join(views) or page.step_view(title, self._words("class.no_prediction"), large)

    def _test(self, test: Lesson, index: int, students: list[Progress], large: bool) -> str:
        """A question of the test, answered before and after the course, and the class's gain."""
        words, display, question = self._words, self._display, question_at(test, index)
        rounds = [
            (words(title), item_distribution(test, index, name, students))
            for name, title in zip(TESTS, ("test.before", "test.after"), strict=True)
        ]
        if display.shown:
            asked = page.choices_view(question, rounds, display.revealed, words, large)
        else:
            asked = page.hidden_view(question, rounds[TESTS.index(test.name)][1], words, large)
        return gain_view(test, students, display.revealed, words, large) + asked

    def _question(
        self,
        lesson: Lesson,
        item: str,
        block: Quiz | NumberQuestion,
        students: Students,
        large: bool,
    ) -> str:
        """The answers to a quiz or to a question for a number."""
        words, display = self._words, self._display
        found = self._counted(block, lesson.name, item, students)
        if not display.shown:
            view = page.hidden_view(block, found, words, large)
        elif isinstance(block, Quiz):
            view = page.choices_view(block, [("", found)], display.revealed, words, large)
        else:
            view = page.numbers_view(block, found, display.revealed, words, large)
        return view + self._of_vote(lesson.name, item)

    def _counted(
        self, block: Asked, lesson: str, item: str, students: Students, again: bool = False
    ) -> Distribution:
        vote = vote_on(self._teaching.classroom.votes, lesson, item, again)
        return distribution(
            block, lesson, item, students.progress, again=again, here=students.here, vote=vote
        )

    def _of_vote(self, lesson: str, item: str, again: bool = False) -> str:
        """Whether the vote is closing or closed."""
        classroom = self._teaching.classroom
        vote = vote_on(classroom.votes, lesson, item, again)
        line = "" if vote is None else page.vote_line(vote, classroom.now(), self._words)
        return page.remark(line) if line else ""

    def _prediction(
        self, lesson: Lesson, at: int, block: Prediction, students: Students, large: bool
    ) -> str:
        words, display, item = self._words, self._display, str(at)
        revealed = display.revealed
        truth = truth_of(lesson.name, at, [*students.progress, self._teaching.progress()])
        if truth is None and revealed:
            truth = self._truth_at(lesson, at)
        first = self._counted(block, lesson.name, item, students)
        second, again = None, is_asked_again(lesson.name, at, students.progress)
        if again:
            second = self._counted(block, lesson.name, item, students, again=True)
        closing = self._of_vote(lesson.name, item, again)
        if not display.shown:
            return page.hidden_view(block, second or first, words, large) + closing
        laws = lesson.laws_shown(at)
        picks = self._picks(lesson.name, at, first, second)
        view = page.prediction_view(
            block, first, truth, revealed, words, large, laws=laws, second=second, picks=picks
        )
        missing = revealed and not first.counts and truth is None
        return view + (page.remark(words("class.no_truth")) if missing else "") + closing

    def _picks(
        self, lesson: str, at: int, first: Distribution, second: Distribution | None
    ) -> Picks:
        """The sketches that the teacher has picked; each gets its number when first seen."""
        chosen, numbers = self._teaching.chosen, []
        for again, found in ((False, first), (True, second)):
            if found is None:
                continue
            seen = chosen.numbered.setdefault((lesson, at, again), [])
            seen.extend(sketch for sketch in found.sketches if sketch not in seen)
            numbers.append(tuple(seen.index(sketch) + 1 for sketch in found.sketches))
        return Picks(chosen.picked, tuple(numbers))

    def _truth_at(self, lesson: Lesson, at: int) -> Truth | None:
        """The result of the experiment, computed once if nobody has run it."""
        key = lesson.name, at

        def compute() -> None:
            self._computed[key] = computed_truth(lesson, at)

        if key not in self._computed:
            self._computed[key] = None
            self._submit(compute)
        return self._computed[key]


def picked(typed: str) -> tuple[int, ...]:
    """The numbers in a text, each once; everything else in it is ignored."""
    found = (int(number) for number in re.findall(r"(?a:\d{1,4})", typed[:200]))
    return tuple(dict.fromkeys(number for number in found if 0 < number <= MOST_MEMBERS))
