"""What a page is told of the lessons: every step, what it may know, and what its buttons send."""

from __future__ import annotations

import json
import re
from html import unescape
from itertools import product
from typing import Any

import pytest
from msgspec.structs import replace

from onpath.app.channel.messages import encoded
from onpath.app.lab import commands as c
from onpath.app.lab.commands import TakeStep
from onpath.app.lab.commands.command_codec import command_from
from onpath.app.lab.lab import Lab
from onpath.app.lab.plot_rows import row_data
from onpath.app.lab.plot_samples import sample_layout
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.steps.block_data import limits_data
from onpath.app.view.lesson_message import lesson_message, measured
from onpath.app.view.lesson_view import LessonView
from onpath.app.view.step_navigation import RECORD
from onpath.lessons.concept_test.concept_test import AFTER, BEFORE
from onpath.lessons.given import Answer
from onpath.lessons.progress import Notes, Truth
from onpath.lessons.schema import (
    KINDS,
    Choice,
    Derivation,
    NumberQuestion,
    OpenQuestion,
    Quiz,
    Sketch,
    Step,
)
from onpath.lessons.words import ENGLISH, Words
from onpath.models.systems.catalogue import FIVE_BAR, ROBOTS
from tests.support.built_in import built_in_course
from tests.support.given import notes_with
from tests.support.lab import do, loop_cache, run
from tests.support.pupil import expanded

COURSE = built_in_course()[0]
STEPS = [
    (name, index)
    for name in (*COURSE.lessons, BEFORE)
    for index in range(len(COURSE.lesson(name, "en").steps))
]
TRUTH = Truth("distance", (0.0, 0.5, 2.0), (0.0, 47.0, 1.0), (0.0, 2.0, 0.5))


@pytest.fixture(scope="module")
def lab() -> Lab:
    return Lab(loop_cache(), FIVE_BAR, COURSE)


def view(lab: Lab, student: str = "") -> LessonView:
    """The lessons of a lab, as its page sees them."""
    snapshot = take_page_snapshot(lab, 1.0)
    return LessonView(COURSE, Words(lab.lessons.progress.language), snapshot.lesson, student)


def told(lab: Lab, student: str = "") -> dict[str, Any]:
    """The message, as the page reads it."""
    return json.loads(encoded(lesson_message(view(lab, student), lab.simulation.robot)))


def at(lab: Lab, name: str, index: int, **notes: Any) -> None:
    """Open a step, with these notes on its lesson and no others."""
    lab.lessons.progress = replace(lab.lessons.progress, notes={}, route="", ended=False)
    do(lab, TakeStep(name, index))
    lessons = lab.lessons
    noted = notes_with(**notes)
    kept = {name: getattr(noted, name) for name in notes if name in Notes.__struct_fields__}
    changed = replace(lessons.notes, given=noted.given, **kept)
    lessons.progress = replace(lessons.progress, notes={name: changed})


def given_in(message: dict[str, Any]) -> dict[str, dict[str, Any]]:
    """The answers that the page is told, by item, none of which says what is right."""
    assert not any("right" in each for each in message["notes"]["given"])
    return {each["item"]: each for each in message["notes"]["given"]}


def html(message: dict[str, Any]) -> str:
    """Everything that is shown, and the hidden step with the question."""
    return "".join([message["head"], *message["sections"].values(), message["pager"]])


def sent(page: str) -> list[dict[str, Any]]:
    """All commands of the buttons in a page."""
    found = list[dict[str, Any]]()
    for text in re.findall(r"data-send='([^']*)'", page):
        commands = json.loads(unescape(text))
        found += commands if isinstance(commands, list) else [commands]
    return found


def step_of(lab: Lab) -> Step:
    step = lab.lessons.step
    assert step is not None
    return step


@pytest.mark.parametrize("language", COURSE.languages())
@pytest.mark.parametrize(("name", "index"), STEPS)
def test_every_step_is_told_with_all_its_parts(
    lab: Lab, name: str, index: int, language: str
) -> None:
    do(lab, c.SetLanguage(language))
    at(lab, name, index)
    message, step = told(lab), step_of(lab)
    shown = message["sections"][str(index)]
    assert step.title in unescape(shown) and message["index"] == index
    blocks = message["steps"][index]["blocks"]
    for place, (block, data) in enumerate(zip(step.blocks, blocks, strict=True)):
        if data["kind"] == "hidden":
            assert f'data-block="{place}"' not in shown and getattr(block, "when", "")
            continue
        assert data["kind"] == KINDS[type(block)]
        assert shown.count(f'data-block="{place}"') == 1
    for command in sent(html(message)):
        command_from(json.dumps(command))
    for data in blocks:
        for link in data.get("links", ()):
            command_from(json.dumps({"do": "Act", "actions": link}))


@pytest.mark.thorough
def test_no_answer_is_told_before_it_is_due(lab: Lab) -> None:
    """Nor what is right: pages could be read by whoever wants to know."""
    do(lab, c.SetLanguage("en"))
    for name, index in STEPS:
        at(lab, name, index)
        message = told(lab)
        blocks = [block for step in message["steps"] for block in step["blocks"]]
        assert not any({"right", "number", "tolerance"} & set(block) for block in blocks)
        assert "data-answer" not in html(message) and 'class="after"' not in html(message)


def places(kind: type) -> list[tuple[str, int, int]]:
    """All questions of a kind: lesson, step, and place in the step."""
    return [
        (name, index, place)
        for name in COURSE.lessons
        for index, step in enumerate(COURSE.lesson(name, "en").steps)
        for place, block in enumerate(step.blocks)
        if isinstance(block, kind)
    ]


@pytest.mark.parametrize(("name", "index", "place"), places(Quiz))
def test_a_quiz_is_judged_once_it_is_answered(lab: Lab, name: str, index: int, place: int) -> None:
    """What is right is told with a right or a second answer, the reply to a wrong one at once.

    Where something else is asked second, another choice tells nothing.
    """
    do(lab, c.SetLanguage("en"))
    key = f"{index}.{place}"
    at(lab, name, index)
    block = step_of(lab).blocks[place]
    assert isinstance(block, Quiz)
    for option, twice in product(range(len(block.options)), (False, True)):
        at(lab, name, index, quiz={key: option}, attempt=1 + twice)
        message = told(lab)
        data = message["steps"][index]["blocks"][place]
        is_told = block.options[option].right or (twice and block.second is None)
        assert ("right" in data) == is_told and (not is_told or block.options[data["right"]].right)
        assert given_in(message)[key]["answer"] == {"option": option}
        answers = re.findall(r'data-answer="(.)"', message["sections"][str(index)])
        assert answers == ([*map(str, range(len(block.options)))] if is_told else [str(option)])


def test_a_number_is_judged_once_it_is_answered(lab: Lab) -> None:
    """As a quiz is; a wrong number that is known is replied to."""
    do(lab, c.SetLanguage("en"))
    for name, index, place in places(NumberQuestion):
        key = f"{index}.{place}"
        at(lab, name, index)
        block = step_of(lab).blocks[place]
        assert isinstance(block, NumberQuestion)
        known = [each.number for each in block.wrong]
        for number, twice in product((block.number, block.number + 1e3, *known), (False, True)):
            at(lab, name, index, numbers={key: number}, attempt=1 + twice)
            message = told(lab)
            data = message["steps"][index]["blocks"][place]
            is_told = number == block.number or twice
            assert data.get("number") == (block.number if is_told else None)
            assert given_in(message)[key]["number"] == number
            answers = [int(i) for i in re.findall(r'data-answer="(.)"', html(message))]
            replies = [known.index(number)] if number in known else []
            assert answers == ([*range(len(known))] if is_told else replies)


def test_a_known_mistake_of_a_line_is_replied_to(lab: Lab) -> None:
    """By its own answer alone, and the line is told once it is closed."""
    do(lab, c.SetLanguage("en"))
    for name, index, place in places(Derivation):
        at(lab, name, index)
        block = step_of(lab).blocks[place]
        assert isinstance(block, Derivation)
        for number in range(len(block.line[0].wrong)):
            typed = [expanded(block, 0, block.line[0].wrong[number].formula)]
            for rows in (typed, [*typed, expanded(block, 0)]):
                at(lab, name, index, written={f"{index}.{place}": "\n".join(rows)})
                told_now = told(lab)
                state, *_ = told_now["steps"][index]["blocks"][place]["states"]
                assert state["closed"] == (len(rows) == 2)
                found = html(told_now).split(f'data-block="{place}"')[1].split("</ol>")[0]
                assert re.findall(r'data-answer="(.)"', found) == [str(number)]
                assert ('class="after"' in found) == state["closed"]


def test_a_text_is_kept_and_the_model_answer_is_told(lab: Lab) -> None:
    for name, index, place in places(OpenQuestion):
        at(lab, name, index, written={f"{index}.{place}": "<b>so"})
        message = told(lab)
        assert given_in(message)[f"{index}.{place}"]["text"] == "<b>so"
        assert "after" in message["sections"][str(index)]
        at(lab, name, index)
        assert 'class="after"' not in told(lab)["sections"][str(index)]


@pytest.mark.thorough
@pytest.mark.parametrize(("name", "index", "place"), [*places(Choice), *places(Sketch)])
def test_what_is_right_is_told_by_the_run_that_shows_it(
    lab: Lab, name: str, index: int, place: int
) -> None:
    do(lab, c.SetLanguage("en"))
    steps = COURSE.lesson(name, "en").steps
    block, shows = steps[index].blocks[place], index if steps[index].kind == "run" else index + 1
    drawn = Answer(times=(0.0, 1.0), values=(1.0, 2.0))
    answer = Answer(option=1, sure="certain") if isinstance(block, Choice) else drawn
    for seen in (False, True):
        notes: dict[str, Any] = {"answers": {str(index): answer}}
        if seen:
            notes |= {"truths": {str(index): TRUTH}, "played": (str(shows),)}
        at(lab, name, shows, **notes)
        message = told(lab)
        data = message["steps"][index]["blocks"][place]
        section = message["sections"][str(index)]
        tells = isinstance(block, Choice) and (block.options[1].right or block.second is None)
        assert ("right" in data) == (seen and tells)  # else after the second try
        assert ("data-answer" in section) == (seen and isinstance(block, Choice))
        kept = message["notes"]
        assert given_in(message)[str(index)]["answer"]["option" if answer.option else "times"]
        assert (str(index) in kept["truths"]) == seen and bool(kept["played"]) == seen
        assert ("You were: certain" in unescape(section)) == isinstance(block, Choice)


def test_options_stand_in_the_students_order_and_for_a_projector_in_the_authors(lab: Lab) -> None:
    name, index, place = places(Quiz)[0]
    at(lab, name, index)

    def order(student: str) -> list[str]:
        return re.findall(r'data-option="(\d)"', told(lab, student)["sections"][str(index)])

    orders = {tuple(order(f"student {i}")) for i in range(20)}
    assert len(orders) > 3
    do(lab, c.Set("presenting", True))
    block = step_of(lab).blocks[place]
    assert isinstance(block, Quiz)
    assert order("student 1")[: len(block.options)] == [str(i) for i in range(len(block.options))]
    do(lab, c.Set("presenting", False))


def test_the_concept_test_tells_nothing_and_is_handed_in(lab: Lab) -> None:
    do(lab, c.SetLanguage("en"))
    last = len(COURSE.lesson(BEFORE, "en").steps) - 1
    at(lab, BEFORE, last, quiz={f"{last}.0": 2})
    message = told(lab)
    assert message["test"] and given_in(message)[f"{last}.0"]["answer"] == {"option": 2}
    assert "data-answer" not in html(message) and "right" not in message["steps"][last]["blocks"][0]
    assert "1 of 12 answered" in message["pager"] and "Hand in" in message["pager"]
    assert "CloseLesson" in html(message) and "BeginStepAnew" not in html(message)
    do(lab, c.FinishLesson())
    ended = told(lab)
    assert ended["ended"] and "Handed in" in html(ended) and ended["charts"] == []
    steps = COURSE.lesson(BEFORE, "en").steps
    quizzes = [block for step in steps for block in step.blocks if isinstance(block, Quiz)]
    options = [option for quiz in quizzes for option in quiz.options]
    assert options and not any(str(option.answer) in html(ended) for option in options)
    at(lab, AFTER, 0, handed_in=True)
    do(lab, c.FinishLesson())
    assert "Correct answer" in html(told(lab))


def test_a_curve_that_is_drawn_again_is_told_with_the_first_one(lab: Lab) -> None:
    do(lab, c.SetLanguage("en"))
    for name, index, place in places(Sketch)[:3]:
        at(lab, name, index)
        for _ in range(2):  # before the first answer, and after it
            assert "before" not in told(lab)["steps"][index]["blocks"][place]
            do(lab, c.Predict(times=(0.0, 1.0), values=(0.0, 1.0)))
        do(lab, TakeStep(name, index, again=True))
        asked = told(lab)
        first = asked["steps"][index]["blocks"][place]["before"]
        assert first == {"times": [0.0, 1.0], "values": [0.0, 1.0]}
        assert ENGLISH("lesson.discuss_curve") in unescape(html(asked))
        do(lab, c.Predict(times=(0.0, 1.0), values=(0.0, 2.0)))
        answered = told(lab)
        assert answered["steps"][index]["blocks"][place]["before"] == first
        assert given_in(answered)[str(index)]["answer"]["values"] == [0.0, 2.0]


def test_verdicts_and_curves_are_measured(lab: Lab) -> None:
    do(lab, c.SetLanguage("en"))
    at(lab, "01-path-or-timetable", 6)
    run(lab, 1.0)
    found = json.loads(encoded(measured(view(lab))))
    assert found["truth"] is None and found["verdicts"]
    for verdicts in found["verdicts"].values():
        assert all(
            set(each) == {"passed", "words", "share", "begun", "broken"} for each in verdicts
        )


def test_what_is_optional_is_named_so_on_the_way_to_the_end_and_there(lab: Lab) -> None:
    do(lab, c.SetLanguage("en"))
    at(lab, "01-path-or-timetable", 9)
    pager = told(lab)["pager"]
    assert "Skip the optional steps and finish" in pager and ">Finish<" not in pager
    do(lab, c.FinishLesson())
    end = html(told(lab))
    assert "0 of 2 tasks passed" in end
    assert (end.count("○ Not passed yet"), end.count("(optional)")) == (3, 1)


@pytest.mark.parametrize("name", COURSE.lessons)
def test_the_end_has_a_place_for_each_chart(lab: Lab, name: str) -> None:
    do(lab, c.SetLanguage("en"))
    lesson = COURSE.lesson(name, "en")
    drawn = Answer(times=(0.0, 1.0), values=(1.0, 2.0))
    answers = {
        str(i): drawn if isinstance(block, Sketch) else Answer(option=0)
        for i, step in enumerate(lesson.steps)
        for block in step.predictions()
    }
    at(lab, name, len(lesson.steps) - 1, answers=answers)
    do(lab, c.FinishLesson())
    message = told(lab)
    page = html(message)
    assert page.count("data-chart") == len(message["charts"])
    assert len(message["charts"]) == sum(
        isinstance(b, Sketch) for s in lesson.steps for b in s.blocks
    )
    for command in sent(page):
        if command != RECORD:
            command_from(json.dumps(command))
    assert [str(point) in page for point in lesson.front.takeaway] == [True] * len(
        lesson.front.takeaway
    )


def plain(page: str) -> str:
    """The words of a page."""
    return " ".join(unescape(re.sub("<[^>]*>", "", page)).split())


def test_what_is_said_after_a_task_depends_on_how_it_was_passed(lab: Lab) -> None:
    """Nothing before; a way that the task has no more is told as the usual one."""
    do(lab, c.SetLanguage("en"))
    seen = 0
    for name, index in STEPS:
        for task in COURSE.lesson(name, "en").steps[index].tasks():
            texts = {way: plain(str(text)) for way, text in task.explanations.items()}
            for way in (*texts, len(task.way) + 1) if task.way else ():
                at(lab, name, index)
                before = plain(html(told(lab)))
                at(lab, name, index, tasks={task.id: 0.0}, way=way)
                page, expected = plain(html(told(lab))), way if way in texts else 0
                assert not any(text in before for text in texts.values())
                assert [each for each, text in texts.items() if text in page] == [expected]
                seen += 1
    assert seen > 5


def test_what_a_task_wants_is_drawn_in_a_row_that_its_robot_has() -> None:
    drawn = 0
    lessons = [lesson for languages in COURSE.lessons.values() for lesson in languages.values()]
    for lesson in lessons:
        for index, step in enumerate(lesson.steps):
            name = lesson.setup_at(index).robot or lesson.front.robot
            robot = ROBOTS[name].make(ROBOTS[name].parameters())
            rows = {row.name for row in row_data(sample_layout(robot).fields, False, ENGLISH)}
            for task in step.tasks():
                limits = limits_data(task, lesson.laws_shown(index), ENGLISH)
                drawn += len(limits)
                assert {limit["plot"] for limit in limits} <= rows, (lesson.name, index)
                for limit in limits:
                    assert (limit["below"], limit["above"]) != (None, None) and limit["label"]
    assert drawn > 40
