"""A missed question is answered by its own answer, then something else is asked, then the truth is
told; a lab sends none of it earlier, and a prediction is not judged before its run."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pytest

from onpath.app.exports.report import report
from onpath.app.lab import commands as c
from onpath.app.lab.commands import TakeStep
from onpath.app.lab.lab import Lab
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.view.lesson_message import lesson_message
from onpath.app.view.lesson_view import LessonView
from onpath.app.view.report_facts import fitting
from onpath.lessons.course import read_course
from onpath.lessons.parse import read_lesson
from onpath.lessons.problems import LessonError
from onpath.lessons.votes import Vote
from onpath.models.systems.catalogue import FIVE_BAR
from tests.support.lab import do, loop_cache, run
from tests.support.lesson_texts import LESSON, write_lesson

NAME, PREDICT, ASK = "01-a", 3, 7
OPTIONS = """[
  { text = "left", answer = "LEFT" },
  { text = "up", answer = "UP", right = true },
]"""
REASON = f'second.question = "Why, then?"\nsecond.options = {OPTIONS}\n'
FIGURE = """second.question = "How far, then?"
second.number = 5
second.tolerance = 0.5
second.unit = "mm"
second.answer = "FIVE"
"""


def with_second_tries(predicted: str, asked: str) -> str:
    """A lesson with a prediction of two options (the first is wrong) and such a quiz."""
    text = LESSON.replace('question = "Which?"', f'{predicted}question = "Which?"')
    return text.replace('question = "And?"', f'{asked}question = "And?"').replace(
        '{ text = "b", answer = "B" }', '{ text = "b", answer = "NOT B" }'
    )


def lab_of(folder: Path, predicted: str = REASON, asked: str = FIGURE) -> Lab:
    write_lesson(folder, with_second_tries(predicted, asked))
    course, problems = read_course([folder])
    assert not problems
    return Lab(loop_cache(), FIVE_BAR, course)


def sent(lab: Lab) -> tuple[str, list[dict[str, Any]]]:
    """The text of the open step and of the prediction it shows, and the data of their blocks."""
    run, lesson = lab.lessons, take_page_snapshot(lab, 1.0).lesson
    message = lesson_message(LessonView(run.course, run.words, lesson), lab.simulation.robot)
    blocks = [block for step in message.steps for block in step["blocks"]]
    return "".join(message.sections.values()), blocks


def tried(second: str, step: int, *, right: bool = True) -> c.Command:
    """An answer to a second try."""
    if second == FIGURE:
        given = 5.2 if right else 6.0
        return c.AnswerNumber(lesson=NAME, step=step, block=0, given=given, second=True)
    return c.AnswerQuiz(lesson=NAME, step=step, block=0, option=int(right), second=True)


def at_a_miss(folder: Path, second: str, step: int) -> Lab:
    """A lab in which the prediction or the quiz has been missed, and may be judged."""
    lab = lab_of(folder, second, second)
    if step == PREDICT:
        do(lab, TakeStep(NAME, PREDICT), c.Predict(option=0), c.GoToStep(1), c.PlayStep())
        run(lab, 1.5)
    else:
        do(lab, TakeStep(NAME, ASK), c.AnswerQuiz(block=0, option=1))
    return lab


@pytest.mark.parametrize("second", [REASON, FIGURE])
def test_a_prediction_is_not_judged_before_its_run(tmp_path: Path, second: str) -> None:
    lab = lab_of(tmp_path, predicted=second)
    do(lab, TakeStep(NAME, PREDICT))
    for commands in ((), (c.Predict(option=0),), (c.GoToStep(1),)):
        do(lab, *commands)
        said, blocks = sent(lab)
        assert not any(word in said for word in ("data-answer", ", then?", "LEFT", "FIVE"))
        assert all(block.keys() <= {"kind", "followed", "when", "links"} for block in blocks)
        do(lab, tried(second, step=PREDICT))
        assert f"{PREDICT}.0.second" not in lab.lessons.notes.by_item


@pytest.mark.parametrize("right", [True, False])
@pytest.mark.parametrize("second", [REASON, FIGURE])
@pytest.mark.parametrize("step", [PREDICT, ASK])
def test_its_own_answer_comes_first_then_the_second_try_then_the_truth(
    tmp_path: Path, step: int, second: str, right: bool
) -> None:
    truth, own = ("yes", "no") if step == PREDICT else ("A", "NOT B")
    lab = at_a_miss(tmp_path, second, step)
    answers = f"<b>that</b>: {truth}" if step == PREDICT else f"<b>a</b>: {truth}"
    said, (block, *_) = sent(lab)
    assert (f": {own}</li>" in said and "Why, then?" in said) or "How far, then?" in said
    assert answers not in said and not any(word in said for word in ("LEFT", "UP", "FIVE"))
    assert "right" not in block and not {"right", "number"} & block["second"].keys()

    do(lab, tried(second, step, right=right))
    said, (block, *_) = sent(lab)
    assert answers in said and ("FIVE" if second == FIGURE else "UP") in said
    assert "right" in block and {"right", "number"} & block["second"].keys()
    (event,) = lab.lessons.notes.by_item[f"{step}.0.second"]
    assert (event.attempt, event.right) == (2, right)
    notes = lab.lessons.notes
    do(lab, tried(second, step, right=not right), c.AnswerQuiz(block=0, option=0))
    assert lab.lessons.notes == notes  # both are over
    record = report(lab.lessons, "", datetime(2026, 1, 1, tzinfo=UTC)).decode()
    assert (("FIVE" if second == FIGURE else "UP") in record) and own in record
    lesson = lab.lessons.lesson
    assert lesson is not None and fitting(lesson, notes) == (notes, 0)


def test_neither_a_right_answer_nor_an_open_vote_is_followed_by_one(tmp_path: Path) -> None:
    lab = lab_of(tmp_path)
    do(lab, TakeStep(NAME, ASK), c.AnswerQuiz(block=0, option=0), tried(FIGURE, ASK))
    assert "How far, then?" not in sent(lab)[0] and len(lab.lessons.notes.given) == 1
    other = at_a_miss(tmp_path, FIGURE, ASK)
    other.lessons.set_votes((Vote(NAME, f"{ASK}.0", ASK),))
    said = sent(other)[0]
    assert "How far, then?" not in said and "NOT B" not in said
    do(other, c.AnswerQuiz(block=0, option=0))  # who votes may change the answer
    other.lessons.set_votes(())
    assert "How far, then?" not in sent(other)[0]


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        (REASON.replace("Why, then?", "And?"), "not the same once more"),
        (REASON.replace(", right = true", ""), "0 right"),
        (FIGURE.replace("tolerance = 0.5", "tolerance = 0.0"), "above 0"),
        (FIGURE.replace('answer = "FIVE"', 'answer = ""'), "a number has an answer"),
        (FIGURE + f"second.options = {OPTIONS}\n", "either options or a number"),
        (REASON + 'second.unit = "mm"\n', "are a number's"),
        ('second.question = "Why?"\n', "either options or a number"),
        (REASON.replace("second.options", "second.option"), "did you mean options"),
    ],
)
def test_what_is_wrong_with_one_is_named(tmp_path: Path, asked: str, said: str) -> None:
    with pytest.raises(LessonError, match=said):
        read_lesson(write_lesson(tmp_path, with_second_tries(REASON, asked)))


def test_a_translation_has_the_same_second_tries(tmp_path: Path) -> None:
    file = write_lesson(tmp_path, with_second_tries(REASON, FIGURE))
    text = file.read_text()
    for other in (text.replace("number = 5", "number = 6"), text.replace(REASON, "")):
        file.with_name("de.md").write_text(other)
        assert len(read_course([tmp_path])[1]) == 1
