"""Answers that are a number or a text, and what is said beside a prediction: how sure, and why."""

from __future__ import annotations

import json
import math
import re
import tempfile
from datetime import UTC, datetime
from pathlib import Path

import msgspec
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.classroom.classroom import Member
from onpath.app.common.templates import render
from onpath.app.exports.guide import guide, worksheet
from onpath.app.exports.report import report
from onpath.app.lab import commands as c
from onpath.app.lab.answers import kept_text
from onpath.app.lab.lab import Lab
from onpath.lessons.course import Course, read_course, read_versions
from onpath.lessons.given import MOST_TEXT, SURENESS, Answer
from onpath.lessons.kept.known_choices import of_today
from onpath.lessons.parse import read_lesson
from onpath.lessons.problems import LessonError
from onpath.lessons.progress import Progress, read_progress
from onpath.lessons.schema import Choice, NumberQuestion, Quiz
from onpath.lessons.words import ENGLISH
from onpath.models.errors import CodedError
from tests.support.built_in import built_in_course
from tests.support.given import notes_with
from tests.support.lab import do, loop_cache
from tests.support.lesson_texts import LESSON, write_lesson
from tests.support.record import record

NUMBER = """
```number
question = "How many millimetres?"
number = 2.5
tolerance = 0.1
unit = "mm"
answer = "Half of five."
```
"""
OPEN = """
```open
question = "What is a path?"
answer = "A set of points."
```
"""
REASONS = 'reasons = ["It is late", "It is early"]\n'
CHOICE = 'kind = "choice"\n'
TEXT = LESSON.replace(CHOICE, CHOICE + REASONS).replace(
    'kind = "sketch"\n', 'kind = "sketch"\nwhy = true\n'
)
TEXT = f"{TEXT}{NUMBER}{OPEN}"
NUMBER_AT, OPEN_AT = 1, 2  # blocks of the last step
HOSTILE = "<b>x</b>\ud800\x00\u202e=1"


def course_of(folder: Path) -> Course:
    write_lesson(folder, TEXT)
    course, problems = read_course([folder])
    assert problems == []
    return course


def lab_at(folder: Path, index: int) -> Lab:
    lab = Lab(loop_cache(), course=course_of(folder))
    do(lab, c.TakeStep("01-a", index))
    return lab


@pytest.mark.parametrize(
    ("right", "wrong", "said"),
    [
        ("number = 2.5", "numbr = 2.5", "did you mean number"),
        ("tolerance = 0.1", "tolerence = 0.1", "did you mean tolerance"),
        ("tolerance = 0.1", "tolerance = 0.0", "above 0"),
        ("tolerance = 0.1", "tolerance = 3.0", "0 would be accepted"),
        ("number = 2.5", "number = inf", "within"),
        ("number = 2.5", 'number = "two"', "float"),
        ('answer = "A set', 'anser = "A set', "did you mean answer"),
        ("```number", "```nummber", "did you mean number"),
        (REASONS.strip(), 'reasons = ["It is late"]', "two or more"),
        (REASONS, f"{REASONS}why = true\n", "own words"),
    ],
)
def test_what_is_wrong_is_named_with_its_line(
    tmp_path: Path, right: str, wrong: str, said: str
) -> None:
    assert right in TEXT
    text = TEXT.replace(right, wrong, 1)
    with pytest.raises(LessonError) as caught:
        read_lesson(write_lesson(tmp_path, text))
    (problem, *_) = [each for each in caught.value.problems if said in each.text]
    lines = text.split("\n")
    wanted = next(i for i, line in enumerate(lines, 1) if wrong.split("\n")[0] in line)
    assert abs(problem.line - wanted) <= 1


def test_a_translation_has_the_same_number_and_reasons(tmp_path: Path) -> None:
    file = write_lesson(tmp_path, TEXT)
    for changed in (
        TEXT.replace("number = 2.5", "number = 2.6"),
        TEXT.replace(REASONS, 'reasons = ["a", "b", "c"]\n'),
    ):
        file.with_name("de.md").write_text(changed)
        assert len(read_course([tmp_path])[1]) == 1


def test_answers_are_kept_and_judged(tmp_path: Path) -> None:
    lab = lab_at(tmp_path, 7)
    do(lab, c.AnswerNumber(NUMBER_AT, 2.58), c.AnswerInWords(OPEN_AT, "  A curve.\n"))
    notes = lab.lessons.notes
    assert notes.numbers == {"7.1": 2.58} and notes.written == {"7.2": "A curve."}
    kept = read_progress(json.loads(msgspec.json.encode(lab.lessons.progress)))
    assert kept == lab.lessons.progress
    block = lab.lessons.course.lesson("01-a", "en").steps[7].blocks[NUMBER_AT]
    assert isinstance(block, NumberQuestion)
    assert block.accepts(2.4) and block.accepts(2.6) and not block.accepts(2.61)
    do(lab, c.AnswerInWords(OPEN_AT, " "))
    assert lab.lessons.notes.written == {}


def test_an_invalid_answer_is_refused(tmp_path: Path) -> None:
    run = lab_at(tmp_path, 7).lessons
    for typed in (math.nan, math.inf, "2", None, True):
        with pytest.raises(CodedError):
            run.answer_number(NUMBER_AT, typed)  # type: ignore[arg-type]
    for block in (0, OPEN_AT, 99, -1):
        with pytest.raises(CodedError):
            run.answer_number(block, 1.0)
    with pytest.raises(CodedError):
        run.answer_in_words(NUMBER_AT, "text")
    assert run.notes.numbers == run.notes.written == {}


@given(st.text(max_size=2 * MOST_TEXT))
@settings(max_examples=100, deadline=None)
def test_a_kept_text_can_be_stored_and_is_kept_as_it_is(typed: str) -> None:
    kept = kept_text(typed)
    assert len(kept) <= MOST_TEXT and kept_text(kept) == kept
    kept.encode()


def test_how_sure_and_why_are_kept_with_a_prediction(tmp_path: Path) -> None:
    lab = lab_at(tmp_path, 3)
    for reason in (2, -1):
        with pytest.raises(CodedError):
            lab.lessons.predict(Answer(option=1, reason=reason), lab.simulation)
    do(lab, c.Predict(option=1, sure="certain", reason=1))
    assert lab.lessons.notes.answers["3"] == Answer(option=1, sure="certain", reason=1)
    do(lab, c.TakeStep("01-a", 1), c.Predict(None, (0.0, 2.0), (0.0, 9.0), "fairly", None, "So."))
    sketch = lab.lessons.notes.answers["1"]
    assert (sketch.sure, sketch.why) == ("fairly", "So.")
    asked = lab.lessons.course.lesson("01-a", "en").steps[3].predictions()[0]

    def said(answer: Answer) -> str:
        beside = render("lesson/beside.html", block=asked, answer=answer, words=ENGLISH)
        return beside.strip()

    told = said(Answer(option=1, sure="guessing", reason=0))
    assert ENGLISH("sure.guessing") in told and "It is late" in told
    assert said(Answer()) == said(Answer(option=1)) == ""
    assert all(ENGLISH(f"sure.{sure}") for sure in SURENESS)


def test_a_skipped_prediction_says_nothing(tmp_path: Path) -> None:
    lab = lab_at(tmp_path, 3)
    do(lab, c.Predict(sure="certain", reason=1))
    assert lab.lessons.notes.answers["3"] == Answer()


def test_record_and_class_show_all_of_it(tmp_path: Path) -> None:
    lab = lab_at(tmp_path, 1)
    do(lab, c.Predict(None, (0.0, 2.0), (0.0, 9.0), "certain", None, HOSTILE))
    do(lab, c.TakeStep("01-a", 3), c.Predict(option=0, sure="fairly", reason=1))
    do(lab, c.TakeStep("01-a", 7), c.AnswerNumber(1, 7.0), c.AnswerInWords(2, HOSTILE))
    told = report(lab.lessons, "", datetime(2026, 1, 1, tzinfo=UTC)).decode()
    for part in ("certain", "It is early", "&lt;b&gt;x", "A set of points", "Half of five"):
        assert part in told
    assert "<b>x" not in told
    member = Member(1, "Ada", lab.lessons.progress)
    every = record([member], lab.lessons.course)["Answers"]
    rows = {(row["kind"], row["step"]): row for row in every}
    items = [row["item"] for row in every if row["kind"] in ("question", "number", "words")]
    assert len(items) == len(set(items)) == 3  # several in one step are told apart
    assert (rows["prediction", 4]["sure"], rows["prediction", 4]["reason"]) == ("fairly", "B")
    assert str(rows["prediction", 2]["why"]).startswith("<b>x</b>")
    assert (rows["number", 8]["right"], rows["number", 8]["value"]) == (0, 7)
    assert rows["words", 8]["result"] == "answered" and rows["words", 8]["text"]


def test_guide_and_worksheet_have_the_questions(tmp_path: Path) -> None:
    course = course_of(tmp_path)
    told = guide(course, tmp_path, ["01-a"], ENGLISH)
    sheet, key = worksheet(course, tmp_path, "01-a", ENGLISH)
    for question in ("How many millimetres?", "What is a path?"):
        assert question in told and question in sheet and question in key
    for answer in ("Half of five.", "A set of points."):
        assert answer in told and answer in key and answer not in sheet


def test_each_variant_of_a_worksheet_has_the_letters_of_its_key_and_0_those_of_the_guide(
    tmp_path: Path,
) -> None:
    course = course_of(tmp_path)
    blocks = [block for step in course.lesson("01-a", "en").steps for block in step.blocks]
    asked = [block.options for block in blocks if isinstance(block, Choice | Quiz)]
    right = {option.text for options in asked for option in options if option.right}
    orders = list[tuple[str, ...]]()
    for variant in range(4):
        pages = worksheet(course, tmp_path, "01-a", ENGLISH, variant)
        assert all(ENGLISH("worksheet.variant", number=variant) in page for page in pages)
        shown = re.findall(r'class="letter">☐ (\w)</span>(.*?)</li>', pages[0])
        told = re.findall(rf"{ENGLISH('guide.right')} (\w)\.</span> (.*)", pages[1])
        assert set(told) <= set(shown) and {text for _, text in told} == right
        orders.append(tuple(text for _, text in shown))
    assert orders[0] == tuple(option.text for options in asked for option in options)
    assert len(set(orders)) > 1


def test_numbers_asked_for_in_the_course_are_those_of_the_formulas() -> None:
    course, problems = built_in_course()
    asked = {
        (name, block.number): block.tolerance
        for name in course.lessons
        for step in course.lesson(name, "en").steps
        for block in step.blocks
        if isinstance(block, NumberQuestion)
    }
    computed = {
        "04b-poles-and-gains": 2 * math.sqrt(900),
        "09b-the-theorem-and-section-iii": 1e3 * (math.sqrt(0.05**2 + 0.0005) - 0.05),
    }
    assert problems == [] and {name for name, _ in asked} == set(computed)
    for (name, number), tolerance in asked.items():
        assert abs(number - computed[name]) < tolerance / 2


@pytest.mark.parametrize("language", ["en", "de"])
def test_no_answer_begins_with_what_the_page_says_before_it(language: str) -> None:
    """As in "Right. Yes. A curve", or "The answer: Yes"."""
    course = built_in_course()[0]
    lessons = [course.lesson(name, language) for name in course.lessons]
    blocks = [block for lesson in lessons for step in lesson.steps for block in step.blocks]
    told = [
        str(option.answer)
        for block in blocks
        if isinstance(block, Choice | Quiz)
        for option in block.options
    ]
    verdict = re.compile(r"(Yes|No|Right|Wrong|Ja|Nein|Richtig|Falsch)[.,]")
    assert len(told) > 100 and [text for text in told if verdict.match(text)] == []


WARM_UP = """```quiz
warm_up = "{drawn}"
question = "What was that?"
options = [
  {{ text = "This", right = true, answer = "Yes." }},
  {{ text = "That", answer = "No." }},
]
```
"""
WARM_UP_NO_MORE = WARM_UP.replace('warm_up = "{drawn}"\n', "").format()
LESSONS = ("01-a", "01b-a", "02-a", "03-a", "03b-a", "10-a")


@given(st.sampled_from(LESSONS), st.sampled_from([*LESSONS, "04-a"]))
@settings(max_examples=10)
def test_a_warm_up_question_is_drawn_from_a_lesson_at_least_two_back(at: str, drawn: str) -> None:
    with tempfile.TemporaryDirectory() as folder:
        for name in LESSONS:
            more = WARM_UP.format(drawn=drawn) if name == at else ""
            write_lesson(Path(folder), f"{LESSON}{more}", name=name)
        _, problems = read_course([Path(folder)])
    numbers = {name: int(re.findall(r"\d+", name)[0]) for name in LESSONS}
    counts = {name: i for i, name in enumerate(dict.fromkeys(numbers.values()), 1)}
    back = counts[numbers[at]] - counts[numbers[drawn]] if drawn in numbers else 0
    assert [drawn in each.text for each in problems] == [True] * (back < 2)


def test_each_lesson_from_the_third_on_begins_with_two_warm_up_questions() -> None:
    course, problems = built_in_course()
    assert problems == []
    for name, number in course.numbers().items():
        first, *rest = course.lesson(name, "en").steps
        asked = [block for block in first.blocks if isinstance(block, Quiz)]
        late = int(number.rstrip("bc")) >= 3
        assert [bool(block.warm_up) for block in asked] == [True, True] * late, name
        assert not any(b.warm_up for step in rest for b in step.blocks if isinstance(b, Quiz))


@pytest.mark.parametrize("drawn", ["", "01-a"])
def test_a_warm_up_question_counts_nothing_in_the_record(tmp_path: Path, drawn: str) -> None:
    write_lesson(tmp_path, LESSON + (WARM_UP.format(drawn=drawn) if drawn else WARM_UP_NO_MORE))
    versions, _ = read_versions(tmp_path / "01-a")
    course = Course({"01-a": versions})
    at = f"{len(versions['en'].steps) - 1}.{len(versions['en'].steps[-1].blocks) - 1}"
    marks = {at: versions["en"].keys[at][0]}
    progress = of_today(course, Progress(notes={"01-a": notes_with(quiz={at: 0}, marks=marks)}))
    rows = record([Member(1, "Ann", progress)], course)["Answers"]
    (row,) = [row for row in rows if row["result"] == "answered"]
    assert row["chosen"] == "A" and row["right"] == ("" if drawn else 1)
