"""A student's progress through the lessons: the open step, predictions, and passed tasks.

It does not depend on a lab; `app.lab.lesson_run` plays the steps on one.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Collection
from dataclasses import dataclass
from typing import Any

from msgspec.structs import replace

from onpath.app.common.product import product_version
from onpath.app.lab.answers import kept_number, kept_text, with_answer
from onpath.lessons.adaptive.branches import is_shown
from onpath.lessons.concept_test.concept_test import own_test
from onpath.lessons.course import Course
from onpath.lessons.derivation.typed import read_formula, spellings
from onpath.lessons.given import MOST_TEXT, Answer, Given
from onpath.lessons.kept.known_choices import marked
from onpath.lessons.kept.option_keys import second_key
from onpath.lessons.pace import Pace
from onpath.lessons.progress import Notes, Progress, given_to
from onpath.lessons.right import is_right
from onpath.lessons.routes import Route
from onpath.lessons.schema import (
    Block,
    Choice,
    Derivation,
    Lesson,
    NumberQuestion,
    OpenQuestion,
    Prediction,
    Quiz,
    Step,
)
from onpath.lessons.second_try import SECOND_TRY, is_missed, second_at, second_item
from onpath.lessons.votes import Vote
from onpath.lessons.words import Words
from onpath.models.errors import CodedError, Message

MOST_ROUNDS = 1000  # questions that were asked again, in one lesson
MOST_SENT = 20  # answers of which a page hears that they have been stored


@dataclass(frozen=True, slots=True)
class Sent:
    """Where an answer belongs, as its browser says.

    Attributes:
        lesson, step: what was asked; without a lesson, the open step is meant.
        key: see `Given`.
    """

    lesson: str = ""
    step: int = 0
    key: str = ""


UNSENT = Sent()


class LessonState:
    """One student's progress through the lessons.

    Attributes:
        course: all lessons.
        progress: the part that is saved.
        words: texts in the student's language.
        version: changes whenever the page must be redrawn.
        pace: the steps within which the teacher lets the student go; None if anywhere.
        first_form: index of the form of the concept test that comes before the course; see `own`.
        votes: what the class is asked now. Until they are closed, nobody learns what is right.
        stored: the progress that is in the database; None if nobody stores it.
        answers_given: how many answers were given here so far.
        settled: keys of answers that cannot be taken, and so need not be sent again.
        clock: seconds since 1970.
    """

    def __init__(
        self,
        course: Course,
        progress: Progress | None = None,
        words: Words | None = None,
        clock: Callable[[], float] = time.time,
    ) -> None:
        self.course = course
        self.progress = progress or Progress()
        self.words = words or Words(self.progress.language)
        self.version = 0
        self.pace: Pace | None = None
        self.first_form = 0
        self.votes: tuple[Vote, ...] = ()
        self.stored: Progress | None = None
        self.settled: tuple[str, ...] = ()
        self.answers_given = 0
        self.clock = clock
        self._product = product_version()
        self._told_of = self.progress, _latest_keys(self.progress)

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

    def own(self, name: str) -> str:
        """A test in the form that this student gets; the name of a lesson is itself."""
        return own_test(name, self.course.tests, self.progress, self.first_form)

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
        if pace != self.pace:
            self.pace = pace
            self.version += 1

    def set_votes(self, votes: tuple[Vote, ...]) -> None:
        """The class is asked something else now, or nothing."""
        if votes != self.votes:
            self.votes = votes
            self.version += 1

    def is_voted_on(self, item: str, lesson: str = "") -> bool:
        """Whether the class is asked a question now, by default one of the open lesson."""
        lesson = lesson or self.progress.lesson
        return any((each.lesson, each.item) == (lesson, item) for each in self.votes)

    @property
    def told(self) -> Progress:
        """The progress without what the class is asked now, which a report would judge."""
        notes = dict(self.progress.notes)
        for name, known in notes.items():
            if asked := {each.item for each in self.votes if each.lesson == name}:
                truths = {k: truth for k, truth in known.truths.items() if k not in asked}
                given = tuple(each for each in known.given if not _is_of(each.item, asked))
                notes[name] = replace(known, truths=truths, given=given)
        return replace(self.progress, notes=notes)

    def _is_beyond_a_vote(self, name: str, index: int) -> bool:
        return any(each.lesson == name and index > each.step for each in self.votes)

    def may_go(self, by: int) -> bool:
        """Whether the teacher lets the student go `by` steps from the open one."""
        name, index = self.beside(by)
        if self._is_beyond_a_vote(name, index + (by > 0 and self.at_end)):
            return False
        return self.pace is None or self.pace.holds(name, index)

    def check_within(self, name: str, index: int) -> None:
        """Raise ValueError if the teacher does not let the student go to a step."""
        if self._is_beyond_a_vote(name, index):
            raise CodedError("class.vote_is_open")
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
        self.note(asked_again=(*self.notes.asked_again, found[0])[-MOST_ROUNDS:])

    @property
    def waits(self) -> bool:
        """Whether a prediction is pending."""
        return self.prediction() is not None and self.answer() is None

    @property
    def is_test(self) -> bool:
        """Whether the open lesson is the concept test, before or after the course."""
        return self.progress.lesson in self.course.tests

    @property
    def is_voting(self) -> bool:
        """Whether the class is asked for the open step's prediction now."""
        found = self.prediction()
        return found is not None and self.is_voted_on(found[0])

    @property
    def locked(self) -> Message | None:
        """Why time must not run (a prediction is pending, or a test is open); None if it may."""
        if self.is_test and not self.notes.handed_in:
            return Message("test.locked")
        if self.waits:
            return Message("lesson.locked")
        return Message("class.vote_is_open") if self.is_voting else None

    def check_unlocked(self) -> None:
        """Raise ValueError if time must not run; see `locked`."""
        if self.is_test and not self.notes.handed_in:
            raise CodedError("test.locked")
        if self.waits:
            raise CodedError("lesson.locked")
        if self.is_voting:
            raise CodedError("class.vote_is_open")

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

    def answer_quiz(
        self, block: int, option: int, sent: Sent = UNSENT, *, second: bool = False
    ) -> None:
        """Choose an option of a quiz, given its index among its step's blocks.

        Args:
            second: choose one of its second try, or of a prediction's.

        Raises:
            ValueError: there is no such quiz or option, it is not asked (any more), or the test has
                been handed in.
        """
        lesson, index = self._asked(sent)
        if self._notes_on(lesson).handed_in:
            raise CodedError("test.over")
        item, quiz = self._question(lesson, index, block, second)
        if not isinstance(quiz, Quiz) or option not in range(len(quiz.options)):
            raise CodedError("lesson.no_such_option")
        self._give(lesson, quiz, Given(item, answer=Answer(option=option)), sent)

    def answer_number(
        self, block: int, given: float, sent: Sent = UNSENT, *, second: bool = False
    ) -> None:
        """Answer a question with a number; `block` is its index among its step's blocks.

        Args:
            second: answer its second try, or a prediction's.

        Raises:
            ValueError: there is no such question, it is not asked (any more), or the answer is not
                a number.
        """
        lesson, index = self._asked(sent)
        item, asked = self._question(lesson, index, block, second)
        if not isinstance(asked, NumberQuestion):
            raise CodedError("lesson.no_such_option")
        self._give(lesson, asked, Given(item, number=kept_number(given)), sent)

    def _question(
        self, lesson: Lesson, index: int, block: int, second: bool
    ) -> tuple[str, Block | None]:
        """The item of an answer to a question, and what is asked.

        Raises:
            ValueError: it is a second try, and the first one was right or is still awaited; or the
                first one was wrong, and the second try asks something else.
        """
        asked = _block(lesson, index, block)
        if second:
            if not self.is_second_tried(lesson, index, block):
                raise CodedError("lesson.no_such_option")
            item = second_item(index, block)
            return item, None if self._is_answered(lesson, item) else second_at(lesson.steps, item)
        item = f"{index}.{block}"
        if isinstance(asked, Quiz) and self.is_second_tried(lesson, index, block):
            raise CodedError("lesson.second_try")
        return item, asked

    def is_second_tried(self, lesson: Lesson, index: int, block: int) -> bool:
        """Whether the second try of a question has begun: its first answer is wrong, and may be
        known to be so. A prediction is not judged before its run."""
        asked, notes, item = _block(lesson, index, block), self._notes_on(lesson), str(index)
        if not isinstance(asked, Choice | Quiz) or asked.second is None:
            return False
        if isinstance(asked, Choice):
            if item not in notes.truths:
                return False
            answers = notes.second if item in notes.asked_again else notes.answers
            given = [Given(item, answer=answers[item])] if item in answers else []
        else:
            item = f"{index}.{block}"
            given = [each for each in given_to(notes, item) if not each.lost]
        return not self.is_voted_on(item, lesson.name) and is_missed(asked, given)

    def _is_answered(self, lesson: Lesson, item: str) -> bool:
        return any(not each.lost for each in given_to(self._notes_on(lesson), item))

    def answer_in_words(self, block: int, typed: str, sent: Sent = UNSENT) -> None:
        """Answer an open question, or take the answer back with an empty one; or answer the next
        line of a derivation, which stays answered.

        Raises:
            ValueError: there is no such question, or the line cannot be read.
        """
        lesson, index = self._asked(sent)
        asked = _block(lesson, index, block)
        if not isinstance(asked, OpenQuestion | Derivation):
            raise CodedError("lesson.no_such_option")
        item, text = f"{index}.{block}", kept_text(typed)
        if isinstance(asked, Derivation):
            read_formula(text, spellings(asked.names), ",")
            before = self._notes_on(lesson).written.get(item, "")
            text = f"{before}\n{text}".strip()[:MOST_TEXT]
        self._give(lesson, asked, Given(item, text=text), sent)

    def note_passed(self, task: str, value: float, way: int) -> None:
        """A task of the open lesson has been passed.

        Args:
            value: its `Task.best`, or 0.
            way: see `lessons.checks.way_of`.
        """
        lesson, notes = self.lesson, self.notes
        best = notes.tasks.get(task)
        better = best is None or value < best
        if lesson is not None and (better or way != notes.ways.get(task, 0)):
            number = round(value, 3) if best is None else min(best, round(value, 3))
            self._keep(lesson, Given(task, number=number, right=True, way=way), UNSENT)

    def settle(self, key: str) -> None:
        """An answer cannot be taken: its browser need not send it again."""
        self.settled = (*self.settled, key)[-MOST_SENT:]

    @property
    def sent(self) -> tuple[str, ...]:
        """Keys of the latest answers that browsers need not send again."""
        progress = self.progress if self.stored is None else self.stored
        if self._told_of[0] is not progress:
            self._told_of = progress, _latest_keys(progress)
        return (*self._told_of[1], *self.settled)

    def _asked(self, sent: Sent) -> tuple[Lesson, int]:
        """The lesson and the step that an answer belongs to: what was open when it was given.

        Raises:
            ValueError: there is no such step.
        """
        if not sent.lesson and self.lesson is not None:
            return self.lesson, self.index
        if not self.course.has_steps(sent.lesson, sent.step, sent.step):
            raise CodedError("lesson.no_such_option")
        return self.course.lesson(sent.lesson, self.progress.language), sent.step

    def _give(self, lesson: Lesson, block: Block, given: Given, sent: Sent) -> None:
        """Keep one more answer to a prediction or a question; see `_keep`."""
        self._keep(lesson, replace(marked(lesson, given), right=is_right(block, given)), sent)

    def _keep(self, lesson: Lesson, given: Given, sent: Sent) -> None:
        """Keep one more answer to an item, unless it was here before; see `with_answer`."""
        notes = self._notes_on(lesson)
        if sent.key and any(each.key == sent.key for each in notes.given):
            return
        new = replace(
            given,
            time=round(self.clock(), 3),
            key=sent.key,
            lesson=lesson.version,
            product=self._product,
        )
        answers = with_answer(notes, new)
        if answers is None:
            self.settle(sent.key)
            return
        self._note_on(lesson, given=answers)
        self.answers_given += 1

    def set_language(self, language: str) -> None:
        """Set the language of texts and interface."""
        self.words = Words(language)
        self.progress = replace(self.progress, language=self.words.language)
        self.version += 1

    def note_answer(self, answer: Answer, sent: Sent = UNSENT) -> None:
        """Store an answer to a prediction. Who has skipped one may still make it."""
        lesson, item, prediction = self.predicted(sent)
        self._give(lesson, prediction, Given(item, answer=answer), sent)

    def predicted(self, sent: Sent = UNSENT) -> tuple[Lesson, str, Prediction]:
        """Lesson, key and prediction that an answer belongs to: what it names, or the open step's.

        Raises:
            ValueError: nothing is to be predicted there.
        """
        if sent.lesson:
            lesson, index = self._asked(sent)
            for prediction in lesson.steps[index].predictions():
                return lesson, str(index), prediction
        elif self.lesson is not None and (found := self.prediction()) is not None:
            return self.lesson, *found
        raise CodedError("lesson.nothing_to_predict")

    def is_unknown(self, key: str = "") -> bool:
        """Whether a stored choice can no longer be identified, because the lesson has changed.

        Args:
            key: of a quiz in the notes; without one, the open step's prediction is meant.
        """
        notes, found = self.notes, self.prediction()
        key = key or (found[0] if found else "")
        noted = second_key(key) if key in notes.asked_again else key
        return noted in notes.unknown

    def note(self, **changes: Any) -> None:
        """Change the saved notes on the open lesson."""
        self._change(self.progress.lesson, changes)

    def _notes_on(self, lesson: Lesson) -> Notes:
        return self.progress.notes.get(lesson.name, Notes())

    def _note_on(self, lesson: Lesson, **changes: Any) -> None:
        self._change(lesson.name, changes)

    def _change(self, name: str, changes: dict[str, Any]) -> None:
        notes = replace(self.progress.notes.get(name, Notes()), **changes)
        self.progress = replace(self.progress, notes={**self.progress.notes, name: notes})
        self.version += 1


def _latest_keys(progress: Progress) -> tuple[str, ...]:
    given = [each for notes in progress.notes.values() for each in notes.given if each.key]
    return tuple(each.key for each in sorted(given, key=lambda each: each.time)[-MOST_SENT:])


def _is_of(item: str, asked: Collection[str]) -> bool:
    """Whether an answer is one to some questions, or a second try at one."""
    question = item.removesuffix(SECOND_TRY)
    tried = item != question and question.partition(".")[0] in asked
    return question in asked or tried


def _block(lesson: Lesson, index: int, block: int) -> Block | None:
    """A block of a step, or None."""
    blocks = lesson.steps[index].blocks
    return blocks[block] if block in range(len(blocks)) else None
