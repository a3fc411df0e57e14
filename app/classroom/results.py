"""Predictions and results of a class as numbers, for the projector."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from onpath.lessons.given import Answer, Given
from onpath.lessons.kept.option_keys import second_key
from onpath.lessons.measures.shapes import shape_of
from onpath.lessons.progress import Notes, Progress, Truth, given_to
from onpath.lessons.schema import Choice, Lesson, NumberQuestion, Prediction, Quiz, Step
from onpath.lessons.votes import Vote, counted, is_late

Asked = Prediction | Quiz | NumberQuestion


@dataclass(frozen=True, slots=True)
class Distribution:
    """The answers of a class to a question.

    Attributes:
        counts: number of answers per option; empty for a sketch.
        sketches: the sketched curves.
        skipped: number of students who skipped it.
        unknown: number of answers that cannot be recovered, since the lesson has changed.
        waiting: number of students who are here and have not answered.
        numbers: the answers to a question for a number.
        here, away: numbers of students who are here and who are not.
        answered: number of those here who have answered.
        late: number of answers that came after the vote was closed, and do not count.
    """

    counts: tuple[int, ...]
    sketches: tuple[Answer, ...]
    skipped: int
    waiting: int
    unknown: int = 0
    numbers: tuple[float, ...] = ()
    here: int = 0
    away: int = 0
    answered: int = 0
    late: int = 0


def prediction_at(lesson: Lesson, index: int) -> tuple[int, Prediction] | None:
    """The prediction that a step asks for or whose truth it shows, and the index of its step."""
    before = index - 1 if lesson.steps[index].kind == "run" else index
    for at in dict.fromkeys((index, before)):
        if at >= 0:
            for prediction in lesson.steps[at].predictions():
                return at, prediction
    return None


def questions_of(step: Step, index: int) -> dict[str, Quiz | NumberQuestion]:
    """The quizzes and the questions for a number of a step, by their items."""
    return {
        f"{index}.{at}": block
        for at, block in enumerate(step.blocks)
        if isinstance(block, Quiz | NumberQuestion)
    }


def asked_at(lesson: Lesson, index: int) -> dict[str, Asked]:
    """What a class votes on in a step, by item: its prediction, and its questions."""
    found = prediction_at(lesson, index)
    predicted: dict[str, Asked] = {} if found is None else {str(found[0]): found[1]}
    return {**predicted, **questions_of(lesson.steps[index], index)}


def votes_at(lesson: Lesson, index: int, votes: Iterable[Vote]) -> list[Vote]:
    """The votes on what a step asks; on what was asked again, the second ones."""
    asked = asked_at(lesson, index)
    found = [each for each in votes if each.lesson == lesson.name and each.item in asked]
    again = {each.item for each in found if each.again}
    return [each for each in found if each.again == (each.item in again)]


def distribution(
    block: Asked,
    lesson: str,
    item: str,
    students: Sequence[Progress],
    *,
    again: bool = False,
    here: Sequence[bool] = (),
    vote: Vote | None = None,
) -> Distribution:
    """Count the answers of the class: of each student the first one in time.

    Args:
        item: of the question; see `Given.item`.
        students: progress of all students.
        again: whether to count the second answers, after a discussion, instead of the first ones.
        here: whether each student is here; everybody, if it is empty.
        vote: on the question, if it was put to the class.
    """
    notes = [_notes(each, lesson) for each in students]
    here = here or [True] * len(notes)
    found = [counted(each, item, vote, again) for each in notes]
    given = [each for each in found if each is not None]
    marked = second_key(item) if again else item
    both = list(zip(notes, found, strict=True))
    lost = sum(marked in each.unknown and one is not None for each, one in both)
    answers = [each.answer for each in given if each.answer is not None]
    options = range(len(block.options)) if isinstance(block, Choice | Quiz) else ()
    is_here = [one for one, present in zip(found, here, strict=True) if present]
    return Distribution(
        counts=tuple(sum(answer.option == option for answer in answers) for option in options),
        sketches=tuple(answer for answer in answers if answer.times),
        skipped=sum(answer.skipped for answer in answers) - lost,
        waiting=sum(one is None for one in is_here),
        unknown=lost,
        numbers=tuple(each.number for each in given if each.number is not None),
        here=len(is_here),
        away=len(notes) - len(is_here),
        answered=sum(one is not None and not one.is_skipped for one in is_here),
        late=sum(
            one is None and any(is_late(vote, each) for each in given_to(of, item))
            for of, one in both
        ),
    )


def group_of(block: Prediction, given: Given | None) -> int | None:
    """The place of the option that was chosen or of the shape that was drawn, or one more for a
    curve without one; None if nothing was predicted, or the curves have no groups.
    """
    answer = None if given is None else given.answer
    if answer is None or answer.skipped:
        return None
    if isinstance(block, Choice):
        return answer.option
    if not block.shapes or not answer.times:
        return None
    shape = shape_of(block, answer)
    return len(block.shapes) if shape is None else block.shapes.index(shape)


def moves(
    block: Prediction,
    lesson: str,
    item: str,
    students: Sequence[Progress],
    votes: tuple[Vote | None, Vote | None],
) -> dict[tuple[int, int], int]:
    """How many went from one group to another by a discussion, or stayed in theirs.

    Args:
        votes: on the first answers, and on the second ones; None without one.

    Returns:
        Groups before and after, see `group_of`, -> number of students who answered both times.
    """
    found = Counter[tuple[int, int]]()
    for notes in (_notes(each, lesson) for each in students):
        before, after = (
            group_of(block, counted(notes, item, vote, again))
            for again, vote in zip((False, True), votes, strict=True)
        )
        if before is not None and after is not None:
            found[before, after] += 1
    return dict(found)


def is_same(one: Given, other: Given) -> bool:
    """Whether two answers say the same."""
    said = [
        (each.number, each.answer and (each.answer.option, each.answer.values))
        for each in (one, other)
    ]
    return said[0] == said[1]


def have_all_answered(students: Sequence[Progress], votes: Iterable[Vote]) -> bool:
    """Whether each student has answered, or skipped, all questions of some votes."""
    return bool(students) and all(
        counted(_notes(each, vote.lesson), vote.item, vote, vote.again) is not None
        for vote in votes
        for each in students
    )


def is_asked_again(lesson: str, step: int, students: Iterable[Progress]) -> bool:
    """Whether a prediction has been asked a second time in the class."""
    return any(str(step) in _notes(each, lesson).asked_again for each in students)


def truth_of(lesson: str, step: int, students: Iterable[Progress]) -> Truth | None:
    """The truth, taken from the first lab in which it has been measured."""
    found = (_notes(each, lesson).truths.get(str(step)) for each in students)
    return next((truth for truth in found if truth is not None and truth.times), None)


def tasks_passed(progress: Progress, lesson: Lesson) -> tuple[int, int]:
    """Numbers of passed tasks and of all tasks in a lesson, without optional ones."""
    tasks, passed = lesson.required_tasks(), _notes(progress, lesson.name).tasks
    return sum(task.id in passed for task in tasks), len(tasks)


def _notes(progress: Progress, lesson: str) -> Notes:
    return progress.notes.get(lesson, Notes())
