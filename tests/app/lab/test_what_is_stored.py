"""Nothing is stored under a name that does not exist, and what is stored has a bound."""

from __future__ import annotations

import dataclasses
from typing import Any

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.lab import commands as c
from onpath.app.lab.commands.command_codec import MOST_TEXT, command_from, page_commands
from onpath.app.lab.lab import Lab
from onpath.app.lab.setups.stored import from_data
from onpath.app.storage.lab_state import keep
from onpath.app.storage.records import LARGEST
from onpath.lessons.course import Course, read_course
from onpath.lessons.progress import read_progress
from onpath.lessons.schema import Derivation, Lesson, NumberQuestion, OpenQuestion, Quiz
from onpath.models.closed_loop.lab_settings import SETTINGS
from onpath.models.control.laws.registry import LAWS
from onpath.models.control.settable import specs
from onpath.models.systems.catalogue import FIVE_BAR
from tests.support.built_in import built_in_course
from tests.support.fullest_state import fullest_state, size
from tests.support.lab import do, loop_cache, run
from tests.support.lesson_texts import LESSON, write_lesson

MORE = """
# quiz: Count

```number
question = "How many?"
number = 7
tolerance = 1
answer = "Seven."
```

```open
question = "Why?"
answer = "Because."
```
"""
FREE_TEXT = {"typed", "why", "remarks", "sure"}
"""Fields with texts that are no names."""
INDICES = {"index", "block", "option"}
FITTING: dict[str, Any] = {
    "side": "left",
    "law": "set_point",
    "target": np.zeros(2),
    "value": 1.0,
    "block": 0,
    "option": 0,
    "given": 1.0,
    "typed": "because",
    "text": "across = -K1*xi; along = 0",
    "finished": True,
}


@pytest.fixture(scope="module")
def course(tmp_path_factory: pytest.TempPathFactory) -> Course:
    """One small lesson with every kind of question."""
    folder = tmp_path_factory.mktemp("course")
    write_lesson(folder, LESSON + MORE)
    read, problems = read_course([folder])
    assert not problems
    return read


def state_of(lab: Lab) -> dict[str, Any]:
    """What would be stored now."""
    kept = list[dict[str, Any]]()
    keep(lab, lambda make: kept.append(make()))
    return kept[0]


def naming(command: type[Any]) -> list[str]:
    """The fields of a command that name something."""
    return [
        field.name
        for field in dataclasses.fields(command)
        if (str(field.type).startswith("str") and field.name not in FREE_TEXT)
        or field.name in INDICES
    ]


CASES = [(name, field) for name, each in page_commands().items() for field in naming(each)]


@pytest.mark.parametrize(("name", "field"), CASES)
@settings(max_examples=4, deadline=None)
@given(
    text=st.text(st.characters(codec="utf-8"), max_size=MOST_TEXT),
    index=st.integers(1000, 10**9) | st.integers(-(10**9), -1),
    in_lesson=st.booleans(),
)
def test_a_name_that_does_not_exist_is_answered_and_not_stored(
    course: Course, name: str, field: str, text: str, index: int, in_lesson: bool
) -> None:
    lab = Lab(loop_cache(), FIVE_BAR, course)
    if in_lesson:
        do(lab, c.OpenLesson("01-a"), c.GoToStep(1))
    before, told = state_of(lab), lab.messages
    command: Any = page_commands()[name]
    needed = [each.name for each in dataclasses.fields(command) if each.name in FITTING]
    values = {each: FITTING[each] for each in needed}
    do(lab, command(**{**values, field: index if field in INDICES else f"no {text}"}))
    assert state_of(lab) == before and lab.messages > told
    assert len(lab.message) < 1000


ACTIONS = {
    "set": lambda text: {"set": {text: 1}},
    "path": lambda text: {"path": text},
    "robot": lambda text: {"robot": text},
    "laws": lambda text: {"laws": {"left": text}},
    "move": lambda text: {"move": [1000 + len(text), 1, 1]},
}


@pytest.mark.parametrize("kind", ACTIONS)
@pytest.mark.parametrize("text", ["no", "x" * 200_000])
def test_an_action_that_names_what_does_not_exist_is_answered_and_not_stored(
    course: Course, kind: str, text: str
) -> None:
    lab = Lab(loop_cache(), FIVE_BAR, course)
    before, told = state_of(lab), lab.messages
    message = {"do": "Act", "actions": [ACTIONS[kind](text)]}
    do(lab, command_from(msgspec.json.encode(message).decode()))
    assert state_of(lab) == before and lab.messages > told
    assert len(lab.message) < 1000


def known_keys(lesson: Lesson) -> dict[str, set[str]]:
    """The keys under which notes on a lesson may be stored, by field."""
    steps = list(enumerate(lesson.steps))

    def blocks(kind: type[Any]) -> set[str]:
        found = ((i, n, b) for i, step in steps for n, b in enumerate(step.blocks))
        return {f"{i}.{n}" for i, n, block in found if isinstance(block, kind)}

    predictions = {str(i) for i, step in steps if step.predictions()}
    tasks = {task.id for step in lesson.steps for task in step.tasks()}
    return {
        "answers": predictions,
        "truths": predictions,
        "played": {str(i) for i, _ in steps},
        "tasks": tasks,
        "hints": tasks,
        "quiz": blocks(Quiz),
        "numbers": blocks(NumberQuestion),
        "written": blocks(OpenQuestion) | blocks(Derivation),
        "twice": blocks(Quiz) | blocks(NumberQuestion),
        "asked_again": set(),
        "second": set(),
        "unknown": set(),
    }


def assert_bounded(lab: Lab) -> None:
    """Assert that a lab can be stored and read again, and stores nothing that does not exist."""
    state, course = state_of(lab), lab.lessons.course
    stored = msgspec.json.decode(msgspec.json.encode(state))
    assert read_progress(stored["lessons"]) == lab.lessons.progress
    from_data(stored["setup"])
    for name, notes in lab.lessons.progress.notes.items():
        known = known_keys(course.lesson(name, "en"))
        for field, keys in known.items():
            assert set(getattr(notes, field)) <= keys, field
        assert notes.step <= len(course.lesson(name, "en").steps) >= notes.seen
    assert size(state) <= size(fullest_state(course)) < LARGEST


SHORT = st.sampled_from(["", "x" * MOST_TEXT, "\u20ac" * MOST_TEXT, "nobody", '"\\\n' * 300])
NUMBERS = st.floats(-1e9, 1e9) | st.floats(-1, 1)
POINTS = st.tuples(NUMBERS, NUMBERS).map(np.array)
LINES = st.lists(st.tuples(NUMBERS, NUMBERS), max_size=25).map(np.array)
CURVES = st.lists(NUMBERS, min_size=300, max_size=400).map(tuple)
NAMES: dict[str, st.SearchStrategy[Any]] = {
    "task": st.sampled_from(["hold", "hold"]) | SHORT,
    "law": st.sampled_from([*LAWS, "across = -K1*xi; along = 0"]) | SHORT,
    "text": st.sampled_from(["across = -K1*xi; along = 0"]) | SHORT,
    "side": st.sampled_from(["left", "right"]) | SHORT,
    "direction": st.sampled_from(["along", "across"]) | SHORT,
    "language": st.sampled_from(["en", "de"]) | SHORT,
    "sure": st.sampled_from(["", "fairly", "certain"]),
    "block": st.integers(-1, 3),
    "option": st.integers(-1, 2),
    "reason": st.none() | st.integers(-1, 2),
    "by": st.sampled_from([1, 1, 1, -1, 10**9]),
    "times": st.just(()) | CURVES,
    "values": st.just(()) | CURVES,
    "stroke": LINES,
    "given": NUMBERS,
    "actions": st.just(()),
}
BY_TYPE: dict[str, st.SearchStrategy[Any]] = {
    "bool": st.booleans(),
    "int": st.integers(-1, 30),
    "float": NUMBERS,
    "str": SHORT,
    "Any": NUMBERS | SHORT,
    "Array": POINTS,
}


def values_of(command: type[Any], field: dataclasses.Field[Any]) -> st.SearchStrategy[Any]:
    names = {
        c.OpenLesson: ["01-a", "01-a", "x"],
        c.FollowRoute: ["x"],
        c.ChoosePath: ["circle", "clover", "x"],
        c.ChooseRobot: ["five_bar", "x"],
        c.Set: [*specs(FIVE_BAR.parameters), *SETTINGS, "x"],
    }
    if field.name == "name":
        return st.sampled_from(names[command])
    kind, *maybe = str(field.type).split(" | ")
    found = NAMES[field.name] if field.name in NAMES else BY_TYPE[kind]
    return st.none() | found if maybe else found


def some_command(command: type[Any]) -> st.SearchStrategy[Any]:
    fields = {each.name: values_of(command, each) for each in dataclasses.fields(command)}
    return st.fixed_dictionaries(fields).map(lambda given: command(**given))


LESSONS = (c.OpenLesson, c.GoToStep, c.Predict, c.AnswerQuiz, c.AnswerNumber, c.AnswerInWords)
ANY = st.one_of(
    *(some_command(each) for each in (*LESSONS, c.ShowHint, c.PlayStep)),
    *(some_command(each) for each in page_commands().values()),
)


def bounded_after(course: Course, sequence: list[c.Command]) -> None:
    lab = Lab(loop_cache(), FIVE_BAR, course)
    do(lab, c.OpenLesson("01-a"))
    for command in sequence:
        do(lab, command)
        run(lab, 0.05)
    assert_bounded(lab)


@pytest.mark.thorough
@settings(max_examples=5, deadline=None)
@given(st.lists(ANY, min_size=10, max_size=40))
def test_what_is_stored_stays_below_its_bound(course: Course, sequence: list[c.Command]) -> None:
    bounded_after(course, sequence)


@pytest.mark.thorough
@settings(max_examples=60, deadline=None)
@given(st.lists(ANY, min_size=20, max_size=120))
def test_what_is_stored_stays_below_its_bound_for_long(
    course: Course, sequence: list[c.Command]
) -> None:
    bounded_after(course, sequence)


def test_the_bound_is_that_of_every_answer_at_its_longest() -> None:
    """The built-in course, all robots, and 1,000 characters wherever words are asked for."""
    course, _ = built_in_course()
    assert size(fullest_state(course)) < LARGEST / 2
