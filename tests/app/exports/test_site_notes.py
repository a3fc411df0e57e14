"""What the static site's script makes of notes: a short text for a platform, and a grade."""

from __future__ import annotations

import copy
import json
import re
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from onpath.app.exports.site import step_data
from onpath.app.exports.site.step_data import site_step
from onpath.lessons.course import BUILT_IN, REFERENCE, Course, read_references
from onpath.lessons.words import ENGLISH
from onpath.models.arrays import Array
from tests.support.built_in import built_in_course
from tests.support.node_page import NodePage, judging_page, needs_node
from tests.support.site_export import LESSON

pytestmark = [pytest.mark.thorough, needs_node]
ROOM = 4096
LEAST = 10
"""Points of a drawn curve that are always kept."""
MOST_DRAWN = 160
"""Points of a curve that the page keeps while it is drawn."""
SENTENCE = (
    "Its clock runs on, so the controller pulls the arm away from where it is held, inwards. "
)
TRIED = 400
FINE = 4095
LETTERS = 'abcdefghijklmnop qrstuvwxyz äöüß "\\ \n ,.;:-!? θλ 漢字 🙂'
SEVERAL = "([all, room]) => all.map(notes => packed(notes, room))"
READ = "all => all.map(unpacked)"
Notes = dict[str, Any]
Steps = list[dict[str, Any]]


@pytest.fixture(scope="module")
def page() -> Iterator[NodePage]:
    page = judging_page()
    yield page
    page.close()


# Notes as a short text.


def some_text(rng: np.random.Generator) -> str:
    size = rng.choice([0, 3, 80, 300, 999])
    return "".join(rng.choice([*LETTERS], size))


def some_curve(rng: np.random.Generator) -> dict[str, list[float]]:
    """As a hand draws it, or as it is typed: numbers with three decimals, times in order."""
    count = rng.choice([2, 3, 9, 40, 147, 160])
    times = np.sort(rng.choice(8001, count, replace=False)) / 1e3
    height = rng.choice([0.0, 0.01, 5.0, 400.0])
    values = np.cumsum(rng.normal(0, height / 10, count)).round(3)
    return {"times": times.tolist(), "values": values.tolist()}


def some_notes(rng: np.random.Generator) -> Notes:
    """Of a lesson of twelve steps with up to six curves and up to eight texts."""
    curves, reasons, written = rng.integers(0, [7, 6, 4])
    answers: dict[str, Any] = {str(i): some_curve(rng) for i in range(curves)}
    for i in range(reasons):
        answers.setdefault(str(i), {"option": int(rng.integers(4))})["why"] = some_text(rng)
    quizzes, numbers, tasks = rng.integers(0, [6, 2, 5])
    given = [event(key, answer={**own, "sure": "certain"}) for key, own in answers.items()]
    for attempt, option in ((1, 1), (2, 2)):
        quiz = (f"{i}.1" for i in range(quizzes))
        given += [event(key, attempt, answer={"option": option}, right=False) for key in quiz]
    given += [event(f"{i}.3", number=1 / 3, right=True) for i in range(numbers)]
    given += [event(f"{i}.2", text=some_text(rng)) for i in range(written)]
    values = rng.random(tasks).round(3).tolist()
    given += [event(f"a-task-{i}", number=each, way=0, hints=1) for i, each in enumerate(values)]
    return {
        "student": "4294967295-4294967295",
        f"notes.{LESSON}": {
            "step": int(rng.integers(12)),
            "seen": 12,
            "truths": {},
            "played": {str(i): True for i in range(rng.integers(6))},
            "hints": {f"a-task-{i}": 1 for i in range(tasks)},
            "given": given,
        },
    }


def event(item: str, attempt: int = 1, **said: Any) -> dict[str, Any]:
    """An answer, as the page notes it."""
    versions = {"lesson": "0123456789ab", "product": "0.2.0"}
    return {"item": item, "attempt": attempt, "time": 1764519000.123, **said, **versions}


def is_kept(drawn: Notes, kept: Notes) -> bool:
    """Ends and extremes to the last digit; the others are drawn points, but for the resolution."""
    times, values, t, v = (
        np.array(each[name]) for each in (drawn, kept) for name in ("times", "values")
    )
    assert t[0] == times[0] and t[-1] == times[-1] and len(t) == len(v) <= len(times)
    assert v.min() == values.min() and v.max() == values.max()
    step = 0.51 * np.array([np.ptp(times), np.ptp(values)]) / FINE + 1e-12
    points, found = np.stack([times, values], 1), np.stack([t, v], 1)
    near = (np.abs(points[:, None] - found[None]) <= step).all(2)
    assert near.any(0).all()
    left = np.abs(np.interp(times, t, v) - values).max() > step[1] + 1e-9
    assert len(t) >= min(LEAST, len(times)) or not left
    return len(t) == len(times)


def differences(notes: Notes, read: Notes, cut: bool) -> list[str]:
    """What was left out, by what it is; asserts that all the rest is the same."""
    found = list[str]()
    given, own = (copy.deepcopy(each)[f"notes.{LESSON}"] for each in (notes, read))
    for one, other in zip(given["given"], own["given"], strict=True):
        answer, kept = one.get("answer", {}), other.get("answer", {})
        if "times" in answer:
            found += [] if is_kept(answer, kept) else ["points"]
            answer |= {name: kept[name] for name in ("times", "values")}
        found += shortened(answer, kept, "why") + shortened(one, other, "text")
    assert own == given and read["student"] == notes["student"]
    assert cut or "letters" not in found
    return found


def shortened(given: Notes, own: Notes, key: str) -> list[str]:
    """Makes them equal if one is the beginning of the other."""
    if key not in given or given[key] == own[key]:
        return []
    assert own[key][-1] == "…" and given[key].startswith(own[key][:-1]) and len(own[key]) >= 60
    own[key] = given[key]
    return ["letters"]


def test_notes_always_fit_and_come_back(page: NodePage) -> None:
    rng = np.random.default_rng(1)
    every = [some_notes(rng) for _ in range(TRIED)]
    packed = page.evaluate(SEVERAL, [every, ROOM])
    assert all(len(each["text"].encode("utf-16-le")) <= 2 * ROOM for each in packed)
    read = page.evaluate(READ, [each["text"] for each in packed])
    left = [
        differences(notes, own, each["cut"])
        for notes, own, each in zip(every, read, packed, strict=True)
    ]
    whole = sum(not each["cut"] for each in packed)
    assert TRIED / 4 < whole < TRIED  # both are tried
    assert sum("points" in each for each in left) > TRIED / 20
    again = page.evaluate(READ, [p["text"] for p in page.evaluate(SEVERAL, [read, ROOM])])
    assert again == read


def test_where_there_is_room_nothing_is_left_out(page: NodePage) -> None:
    rng = np.random.default_rng(2)
    every = [some_notes(rng) for _ in range(40)]
    packed = page.evaluate(SEVERAL, [every, 64_000])
    read = page.evaluate(READ, [each["text"] for each in packed])
    for notes, own, each in zip(every, read, packed, strict=True):
        assert differences(notes, own, each["cut"]) == [] and not each["cut"]


def arches(count: int) -> Array:
    return 40 * np.abs(np.sin(np.linspace(0, 4 * np.pi, count)))


def test_six_curves_and_three_long_reasons_have_room(page: NodePage) -> None:
    """And a curve of 147 points beside three long reasons looks as it was drawn."""
    times = np.linspace(0, 8, 147).round(3).tolist()
    curve = {"times": times, "values": arches(147).round(3).tolist(), "sure": "fairly"}
    rng = np.random.default_rng(3)
    for curves, most in ((6, 4.0), (1, 0.6)):  # of 40
        notes = some_notes(rng)
        answers: Notes = {str(i): dict(curve) for i in range(curves)}
        for i in range(3):
            answers.setdefault(str(i), {"option": 1})["why"] = "Because " * 124
        given = [event(key, answer=each) for key, each in answers.items()]
        notes[f"notes.{LESSON}"]["given"] = given
        (packed,) = page.evaluate(SEVERAL, [[notes], ROOM])
        assert not packed["cut"]
        (read,) = page.evaluate(READ, [packed["text"]])
        own = read[f"notes.{LESSON}"]["given"][0]["answer"]
        assert np.abs(np.interp(times, own["times"], own["values"]) - arches(147)).max() < most


@pytest.mark.usefixtures("no_figures")
def test_honest_work_on_a_whole_lesson_has_room(page: NodePage, course: Course) -> None:
    """Curves as fine as the page allows, a sentence for each reason, three for each answer."""
    times = np.linspace(0, 8, MOST_DRAWN).round(3).tolist()
    curve = {"times": times, "values": arches(MOST_DRAWN).round(3).tolist()}
    for name in course.lessons:
        notes = all_done(steps_of(course, name))
        for each in notes["given"]:
            if each["item"].isdecimal():
                more = curve if "times" in each["answer"] else {"why": SENTENCE}
                each["answer"] |= {"sure": "certain"} | more
            elif "text" in each:
                each["text"] = 3 * SENTENCE
        kept = {"student": "4294967295-4294967295", f"notes.{name}": notes}
        (packed,) = page.evaluate(SEVERAL, [[kept], ROOM])
        (read,) = page.evaluate(READ, [packed["text"]])
        own = [each.get("answer", {}) for each in read[f"notes.{name}"]["given"]]
        assert not packed["cut"], name
        assert all(len(each["times"]) == MOST_DRAWN for each in own if "times" in each), name


def test_notes_of_earlier_packages_are_read(page: NodePage) -> None:
    rng = np.random.default_rng(4)
    every = [some_notes(rng) for _ in range(10)]
    assert page.evaluate(READ, list(map(json.dumps, every))) == every
    assert page.evaluate("[unpacked(''), unpacked('{'), unpacked('1,2')]") == [None] * 3


# Grades.


@pytest.fixture(scope="module")
def course() -> Course:
    return built_in_course()[0]


@pytest.fixture
def no_figures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of a page's data nothing is made but what is asked and played."""
    monkeypatch.setattr(step_data, "figure_of", lambda figure, words: {})


def steps_of(course: Course, name: str) -> Steps:
    lesson = course.lesson(name, "en")
    references, _ = read_references(lesson, BUILT_IN / name / REFERENCE)
    steps = [site_step(lesson, i, references, ENGLISH).data for i in range(len(lesson.steps))]
    return json.loads(json.dumps(steps))


def empty(steps: Steps) -> Notes:
    kinds = ("truths", "played", "hints")
    return {"step": 0, "seen": len(steps), "given": [], **{kind: {} for kind in kinds}}


def right_rows(lines: list[dict[str, Any]]) -> Iterator[str]:
    """What is right in each line of a derivation, without the names of earlier lines."""
    known = dict[str, str]()
    for line in lines:
        text = line["formula"]
        for name, earlier in known.items():
            text = re.sub(rf"\b{name}\b", f"({earlier})", text)
        yield text
        if line["name"]:
            known[line["name"]] = text


def all_done(steps: Steps) -> Notes:
    """Everything that is not optional, and all of it right."""
    notes = empty(steps)
    for i, step in enumerate(steps):
        if step["optional"]:
            continue
        if step["script"]:
            notes["played"][str(i)] = True
        for j, block in enumerate(step["blocks"]):
            key = f"{i}.{j}"
            if block["kind"] == "sketch":
                said = event(str(i), answer={"times": [0, 1], "values": [0, 1]})
            elif block["kind"] == "choice":  # a wrong one
                said = event(str(i), answer={"option": 1 - min(1, block["right"])}, right=False)
            elif block["kind"] == "quiz" and "uncounted" not in block:
                said = event(key, answer={"option": block["right"]}, right=True)
            elif block["kind"] == "number":
                said = event(key, number=block["number"], right=True)
            elif block["kind"] == "open":
                said = event(key, text="Because.")
            elif block["kind"] == "derivation":
                said = event(key, text="\n".join(right_rows(block["lines"])), right=True)
            elif "checks" in block and not block.get("exploratory"):
                said = event(block["id"], number=0, right=True, way=0)
            else:
                continue
            notes["given"].append(said)
    return notes


def graded(page: NodePage, steps: Steps, notes: Notes) -> tuple[float, float | None]:
    found = page.evaluate("([steps, notes]) => gradeOf(steps, notes)", [steps, notes])
    return found["progress"], found["score"]


NAMES = [*built_in_course()[0].lessons]


@pytest.mark.usefixtures("no_figures")
@pytest.mark.parametrize("name", NAMES)
def test_a_grade_is_for_what_is_done_and_right(page: NodePage, course: Course, name: str) -> None:
    steps = steps_of(course, name)
    assert graded(page, steps, all_done(steps)) == (1, 1)
    progress, score = graded(page, steps, empty(steps))  # Next was pressed until the end
    assert progress < 1 and score is None
    whole = all_done(steps)
    derived = {
        f"{i}.{j}"
        for i, step in enumerate(steps)
        for j, block in enumerate(step["blocks"])
        if block["kind"] == "derivation"
    }
    for key in whole["played"]:
        played = {each: True for each in whole["played"] if each != key}
        assert graded(page, steps, {**whole, "played": played})[0] < 1
    for each in whole["given"]:
        others = [other for other in whole["given"] if other is not each]
        progress, score = graded(page, steps, {**whole, "given": others})
        assert progress < 1
        assert (score is None) == (not any(is_judged(other, derived) for other in others))
        assert score is None or (score < 1) == is_judged(each, derived)
        if each["item"].isdecimal():
            skipped = [*others, event(each["item"], answer={})]
            assert graded(page, steps, {**whole, "given": skipped})[0] < 1
    assert graded(page, steps, {**whole, "seen": 0})[0] < 1


def is_judged(given: dict[str, Any], derived: set[str]) -> bool:
    """Whether an answer counts in a score: to a question that is judged, or to a task."""
    return given["item"] in derived or ("right" in given and not given["item"].isdecimal())


@pytest.mark.usefixtures("no_figures")
def test_a_second_answer_counts_half_and_a_task_after_its_recipe_nothing(
    page: NodePage, course: Course
) -> None:
    """Of everything that was right at once, some at random is right at the second answer, some
    never, and some tasks are passed after some hints: each costs what the page says."""
    rng = np.random.default_rng(9)
    for name in course.lessons:
        steps = steps_of(course, name)
        blocks = [block for step in steps for block in step["blocks"]]
        hints = {block["id"]: block["hints"] for block in blocks if block.get("checks")}
        whole = all_done(steps)
        lines = sum(
            len(block["lines"])
            for step in steps
            if not step["optional"]
            for block in step["blocks"]
            if block["kind"] == "derivation"
        )
        given, points = list[dict[str, Any]](), [1.0] * lines
        for each in whole["given"]:
            item = each["item"]
            if item in hints:
                seen = int(rng.integers(hints[item] + 1))
                given.append({**each, "hints": seen})
                points.append(float(not hints[item] or seen < hints[item]))
            elif "right" in each and not item.isdecimal() and "text" not in each:
                second = int(rng.integers(3))  # right at once, then, or never
                wrong = {**each, "right": False}
                given += (
                    [each] if not second else [wrong, {**each, "attempt": 2, "right": second == 1}]
                )
                points.append((1.0, 0.5, 0.0)[second])
            else:
                given.append(each)
        progress, score = graded(page, steps, {**whole, "given": given})
        assert progress == 1 and score == (pytest.approx(np.mean(points)) if points else None)


@pytest.mark.usefixtures("no_figures")
def test_tasks_to_be_found_by_trying_and_warm_up_questions_count_nothing(
    page: NodePage, course: Course
) -> None:
    """As if the step had a text in their place, passed and answered or not."""
    rng, seen = np.random.default_rng(8), 0
    for name in course.lessons:
        marked = steps_of(course, name)
        without, whole = copy.deepcopy(marked), all_done(marked)
        for step, other in zip(marked, without, strict=True):
            for place, block in enumerate(step["blocks"]):
                is_quiz = block["kind"] == "quiz" and "uncounted" not in block
                if (is_quiz or "checks" in block) and not step["optional"] and rng.random() < 0.6:
                    block["uncounted" if is_quiz else "exploratory"], seen = True, seen + 1
                    other["blocks"][place] = {"kind": "text"}
        judged = [each for each in whole["given"] if "way" in each or is_judged(each, set())]
        some = {**empty(marked), "given": judged}
        for notes in (all_done(without), whole, some, empty(marked)):
            assert graded(page, marked, notes) == graded(page, without, notes)
    assert seen > 10


def test_without_anything_to_judge_there_is_no_score(page: NodePage) -> None:
    choice: dict[str, Any] = {"kind": "choice", "right": 0}
    step = {"optional": False, "script": None, "blocks": [choice, {"kind": "open"}]}
    optional = {"optional": True, "script": None, "blocks": [{"kind": "quiz", "right": 0}]}
    notes = empty([step, optional]) | {"given": [event("0", answer={"option": 1}, right=False)]}
    assert graded(page, [step, optional], notes) == (pytest.approx(2 / 3), None)
    notes["given"].append(event("0.1", text="So."))
    assert graded(page, [step, optional], notes) == (1, None)
