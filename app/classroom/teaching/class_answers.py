"""The class's answers to a step, without names, for the teacher's page and for the wall."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from math import ceil, inf
from typing import Protocol

from onpath.app.classroom import class_html as page
from onpath.app.classroom.classroom import MOST_MEMBERS, Classroom, Display, Member
from onpath.app.classroom.concept_test_results import gain_view, item_distribution, question_at
from onpath.app.classroom.results import (
    Asked,
    Distribution,
    asked_at,
    distribution,
    is_asked_again,
    is_same,
    moves,
    truth_of,
    votes_at,
)
from onpath.app.classroom.sketches_html import Picks
from onpath.app.classroom.teaching.lesson_labels import step_label
from onpath.app.classroom.teaching.steps_for_all import StepsForAll
from onpath.app.classroom.teaching.teacher_context import TeacherChoices
from onpath.app.lab.dry_runs.step_truth import computed_truth
from onpath.lessons.concept_test.concept_test import FORMS, SITTINGS
from onpath.lessons.course import Course
from onpath.lessons.given import Given
from onpath.lessons.kept.known_choices import of_today
from onpath.lessons.progress import Notes, Progress, Truth
from onpath.lessons.schema import Lesson, NumberQuestion, Prediction, Quiz, Sketch
from onpath.lessons.votes import Vote, counted, vote_on
from onpath.lessons.words import Words

FEW, MANY = 0.3, 0.7
"""Shares of right answers below which a teacher may explain, and above which go on; between them,
a discussion helps most (Crouch and Mazur, American Journal of Physics 69, 2001)."""
PROPOSALS = "class.proposal_explain", "class.proposal_discuss", "class.proposal_go_on"
NOTHING = Notes()


@dataclass(frozen=True, slots=True)
class Students:
    """The members of a class who count: who each is, see `people`, and whether they are here."""

    members: list[Member]
    who: list[str]
    progress: list[Progress]
    here: list[bool]


@dataclass(frozen=True, slots=True)
class VotedQuestion:
    """A question, and the votes on it: before a discussion, and after it; None without one."""

    lesson: str
    item: str
    block: Asked
    votes: tuple[Vote | None, ...]

    def last(self, first: Given | None, second: Given | None) -> Given | None:
        """The answer that counts now; a second vote begins without any."""
        return first if self.votes[1] is None else second


class AnswersContext(Protocol):
    """What the answers need of where they are shown; a `TeacherContext` has it."""

    @property
    def classroom(self) -> Classroom:
        """The class."""
        ...

    @property
    def chosen(self) -> TeacherChoices:
        """What has been picked."""
        ...

    @property
    def progress(self) -> Callable[[], Progress]:
        """Of the lab that is shown there."""
        ...


class ClassAnswers:
    """The answers to the displayed question.

    Args:
        submit: runs what takes long, perhaps later; the truth is not known until then.
        peeks: whether the answers are looked at before they are shown.
    """

    def __init__(
        self,
        course: Course,
        words: Words,
        teaching: AnswersContext,
        submit: Callable[[Callable[[], None]], None] = lambda work: work(),
        *,
        peeks: bool = False,
    ) -> None:
        self._peeks = peeks
        self._course, self._words, self._teaching = course, words, teaching
        self._submit = submit
        self._computed: dict[tuple[str, int], Truth | None] = {}

    @property
    def _display(self) -> Display:
        classroom = self._teaching.classroom
        display = classroom.display.seen(classroom.now())
        return replace(display, shown=True) if self._peeks else display

    def view(self, large: bool, *, silent: bool = False) -> str:
        """The answers to what the displayed step asks, or to a question of a test.

        Args:
            silent: tell nothing of answers that are not shown, not even how many there are, nor
                whether the votes are closed; see `closing`.
        """
        steps = StepsForAll(self._course, self._words.language)
        name, index = steps.shown(self._display)
        lesson = self._course.lesson(name, self._words.language)
        if silent and not self._display.shown:
            return self._asked(lesson, index, large)
        students = self._students()
        if name in self._course.tests:
            return self._test(index, students, large)
        views = list[str]()
        for item, block in asked_at(lesson, index).items():
            if isinstance(block, Quiz | NumberQuestion):
                views.append(self._question(lesson, item, block, students, large))
            else:
                views.append(self._prediction(lesson, int(item), block, students, large))
        if not silent:
            views += self._of_votes(lesson, index)
        title = step_label(lesson, index, self._words)
        return "".join(views) or page.step_view(title, self._words("class.no_prediction"), large)

    def _students(self) -> Students:
        present = self._teaching.classroom.present()
        members = list(present.values())
        return Students(
            members,
            [member.word or lab for lab, member in present.items()],
            [of_today(self._course, member.progress) for member in members],
            [member.connected for member in members],
        )

    def dots(self) -> str:
        """Who is here, as dots without names; see `grid`."""
        return page.dots_view(self._states(self._students()), self._words)

    def grid(self) -> str:
        """Who is here, by name: whether each has answered what the step asks first, is right, or
        has changed the answer after a discussion."""
        students = self._students()
        here = [each for each in students.members if each.connected]
        return page.grid_view(list(zip(here, self._states(students), strict=True)), self._words)

    def _states(self, students: Students) -> list[page.State]:
        """What each student who is here has done, in order of joining."""
        asked, states = self._first_question(), list[page.State]()
        for first, second in self._answers_here(asked, students):
            last = None if asked is None else asked.last(first, second)
            if last is None or last.is_skipped:
                states.append("here")
            elif second is not None and first is not None and not is_same(first, second):
                states.append("changed")
            else:
                states.append("right" if last.right else "answered")
        return states

    def proposal(self) -> str:
        """What might be done next, by how many are right, once the votes are closed; or nothing."""
        asked, classroom = self._first_question(), self._teaching.classroom
        if asked is None or isinstance(asked.block, Sketch):
            return ""
        votes = [each for each in asked.votes if each is not None]
        if not votes or any(each.is_open(classroom.now()) for each in votes):
            return ""
        last = [asked.last(*both) for both in self._answers_here(asked, self._students())]
        given = [each for each in last if each is not None and not each.is_skipped]
        if not given:
            return ""
        share = sum(each.right is True for each in given) / len(given)
        explain, discuss, go_on = PROPOSALS
        key = explain if share < FEW else discuss if share <= MANY else go_on
        return self._words(key, percent=round(100 * share))

    def _first_question(self) -> VotedQuestion | None:
        """What the displayed step of a lesson asks first."""
        name, index = StepsForAll(self._course, self._words.language).shown(self._display)
        asked = asked_at(self._course.lesson(name, self._words.language), index)
        if name in self._course.tests or not asked:
            return None
        item, block = next(iter(asked.items()))
        votes = self._teaching.classroom.votes
        both = tuple(vote_on(votes, name, item, again) for again in (False, True))
        return VotedQuestion(name, item, block, both)

    def _answers_here(
        self, asked: VotedQuestion | None, students: Students
    ) -> list[tuple[Given | None, Given | None]]:
        """Of each student who is here, the first answer that counts, and the one after a
        discussion."""
        found = list[tuple[Given | None, Given | None]]()
        for progress, is_here in zip(students.progress, students.here, strict=True):
            if not is_here:
                continue
            if asked is None:
                found.append((None, None))
                continue
            notes = progress.notes.get(asked.lesson, NOTHING)
            first, second = (
                counted(notes, asked.item, vote, again)
                for vote, again in zip(asked.votes, (False, True), strict=True)
            )
            found.append((first, second))
        return found

    def _asked(self, lesson: Lesson, index: int, large: bool) -> str:
        """What the step asks, or the question of a test."""
        words, blocks = self._words, asked_at(lesson, index).values()
        if lesson.name in self._course.tests:
            return page.step_view(words("test.alone"), "", large)
        views = [page.hidden_view(block, None, words, large) for block in blocks]
        return "".join(views) or page.step_view(step_label(lesson, index, words), "", large)

    def closing(self) -> tuple[int | None, str]:
        """The seconds until the votes on the displayed step are closed, and a note once they are.

        None: no time is set, or it is over; an empty text: they are not closed.
        """
        steps = StepsForAll(self._course, self._words.language)
        name, index = steps.shown(self._display)
        lesson = self._course.lesson(name, self._words.language)
        classroom = self._teaching.classroom
        times = [each.closes for each in votes_at(lesson, index, classroom.votes)]
        last = max((inf if each is None else each for each in times), default=inf)
        left = last - classroom.now()
        if left == inf:
            return None, ""
        return (ceil(left), "") if left > 0 else (None, self._words("class.closed"))

    def _test(self, index: int, students: Students, large: bool) -> str:
        """The class's gain, and a question of the test in each of its forms, answered before and
        after the course. How many have handed in is said with the gain."""
        words, display, forms = self._words, self._display, self._course.forms(self._words.language)
        known = list(zip(students.who, students.progress, strict=True))
        views = [gain_view(forms, known, display.revealed, words, large)]
        for form, lesson in enumerate(forms):
            question = question_at(lesson, index)
            rounds = [
                (words(title), item_distribution(forms, form, index, sitting, known))
                for sitting, title in zip(SITTINGS, ("test.before", "test.after"), strict=True)
            ]
            if len(forms) > 1:
                views.append(page.step_view(words("test.form", form=FORMS[form]), "", large))
            if display.shown:
                shown = page.choices_view(question, rounds, display.revealed, words, large)
            else:
                shown = page.hidden_view(question, None, words, large)
            views.append(shown)
        return "".join(views)

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
            return page.hidden_view(block, found, words, large)
        if isinstance(block, Quiz):
            return page.choices_view(block, [("", found)], display.revealed, words, large)
        return page.numbers_view(block, found, display.revealed, words, large)

    def _counted(
        self, block: Asked, lesson: str, item: str, students: Students, again: bool = False
    ) -> Distribution:
        vote = vote_on(self._teaching.classroom.votes, lesson, item, again)
        return distribution(
            block, lesson, item, students.progress, again=again, here=students.here, vote=vote
        )

    def _of_votes(self, lesson: Lesson, index: int) -> list[str]:
        """Whether the votes on a step are closing or closed."""
        classroom = self._teaching.classroom
        votes = votes_at(lesson, index, classroom.votes)
        lines = [page.vote_line(each, classroom.now(), self._words) for each in votes]
        return [page.remark(line) for line in lines if line]

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
        if not display.shown:
            return page.hidden_view(block, second or first, words, large)
        laws = lesson.laws_shown(at)
        picks = self._picks(lesson.name, at, first, second)
        view = page.prediction_view(
            block, first, truth, revealed, words, large, laws=laws, second=second, picks=picks
        )
        if second is not None:
            votes = self._teaching.classroom.votes
            both = (vote_on(votes, lesson.name, item), vote_on(votes, lesson.name, item, True))
            moved = moves(block, lesson.name, item, students.progress, both)
            view += page.moves_view(block, moved, words, large) if moved else ""
        missing = revealed and not first.counts and truth is None
        return view + (page.remark(words("class.no_truth")) if missing else "")

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
