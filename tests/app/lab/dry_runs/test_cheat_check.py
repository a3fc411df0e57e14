"""No task of the course is passed without what it asks, and an author is told where one is."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import pytest
from msgspec.structs import replace

from onpath.app.cli.main import run_command
from onpath.app.lab.dry_runs.cheat_check import (
    Asked,
    asked_tasks,
    attempts,
    cheat_faults,
    passes_of,
)
from onpath.app.lab.dry_runs.course_check import lab_at, solved
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.lessons import cheating
from onpath.lessons.action_schema import Action, Script
from onpath.lessons.cheating import cheats
from onpath.lessons.course import BUILT_IN, REFERENCE, read_course, read_references
from onpath.lessons.students import MOST_PASS, random_students
from onpath.lessons.task_schema import Only, Setting
from onpath.models.control.settable import specs
from onpath.models.paths.path_design import presets
from onpath.models.systems.catalogue import FIVE_BAR
from tests.support.built_in import built_in_course
from tests.support.cases import drawn
from tests.support.lesson_texts import LESSON, write_lesson

COURSE = built_in_course()[0]
HELD = (Action(at=2.0, hold=True), Action(at=5.0, hold=False))
TWICE = (
    *(Action(at=3.0, hold=True), Action(at=5.1, hold=False)),
    *(Action(at=7.0, hold=True), Action(at=9.1, hold=False)),
)
STIFF = Action(at=0.2, set={"K1": 1600.0, "K2": 80.0, "K5": 5.0})
CHEATS, TASKS = 120, 3
EXPLOITS = [
    ("01", "hold-two-seconds", 6.0, (Action(set={"speed": 0.0}), *HELD)),
    ("01", "hold-two-seconds", 6.0, (Action(set={"K5": 0.0}), *HELD)),
    ("01", "thirty-times", 6.0, (Action(set={"K5": 0.0}), *HELD)),
    ("06b", "lower-the-jumps", 16.0, (Action(at=1.0, set={"stiction": 0.05}),)),
    ("06b", "lower-the-jumps", 16.0, (Action(at=1.0, set={"coulomb": 0.1}),)),
    ("06b", "get-it-going", 6.0, (Action(at=0.5, set={"speed": 8.0}),)),
    (
        "07",
        "broken-promise",
        6.0,
        (
            Action(at=0.5, set={"alpha": 0.8}),
            Action(at=1.0, set={"modes": 2}),
            Action(at=4.0, set={"modes": 3}),
        ),
    ),
    (
        "07",
        "broken-promise",
        6.0,
        (
            Action(at=0.5, set={"modes": 1}),
            Action(at=3.5, set={"alpha": 0.8}),
            Action(at=3.6, set={"modes": 3}),
        ),
    ),
    *(
        pytest.param(
            "08",
            task,
            12.5,
            (Action(path=path), STIFF, Action(at=0.5, reset=True), *TWICE),
            marks=() if path == "clover" else pytest.mark.thorough,
        )
        for task in ("own-path", "real-one")
        for path in presets()
    ),
]


@pytest.fixture(scope="module")
def loop_cache() -> LoopCache:
    return LoopCache(at_once=True)


@pytest.mark.thorough
@pytest.mark.parametrize(("lesson", "task", "until", "do"), EXPLOITS)
def test_what_once_passed_without_what_is_asked_does_not(
    loop_cache: LoopCache, lesson: str, task: str, until: float, do: tuple[Action, ...]
) -> None:
    name = next(each for each in COURSE.lessons if each.startswith(f"{lesson}-"))
    version = COURSE.lesson(name, "en")
    asked = next((step, each) for step in version.steps for each in step.tasks() if each.id == task)
    lab = lab_at(version, asked[0], loop_cache)
    try:
        passed = solved(lab, Script(do, until), asked[1])[0]
    except ValueError:  # this robot cannot follow that path
        passed = False
    assert not passed


ASKED = {asked.task.id: asked for asked in asked_tasks(COURSE, BUILT_IN)}


def without(asked: Asked, name: str) -> Asked:
    """A task without its check of a setting, which is its price."""
    kept = [c for c in asked.task.check if not (isinstance(c, Setting) and c.name == name)]
    return dataclasses.replace(asked, task=replace(asked.task, check=tuple(kept)))


# `onpath lessons check --cheat` tries everything, which takes minutes. It is run each week, and by
# whoever changes a task, a law or a robot; here, some are drawn.


@pytest.mark.thorough
def test_no_cheat_of_those_drawn_passes_its_task(loop_cache: LoopCache) -> None:
    tried = drawn(attempts(COURSE, BUILT_IN), CHEATS)
    assert not [str(fault) for fault in cheat_faults(tried, loop_cache)]


@pytest.mark.thorough
def test_who_does_not_think_passes_no_task_of_those_drawn(loop_cache: LoopCache) -> None:
    for task in drawn(sorted(ASKED), TASKS):
        assert not [str(fault) for fault in passes_of(ASKED[task], loop_cache).problems()]


@pytest.mark.thorough
@pytest.mark.parametrize("task", ["hold-two-seconds", "get-it-going"])
def test_who_does_not_think_does_not_pass(loop_cache: LoopCache, task: str) -> None:
    found = passes_of(ASKED[task], loop_cache, count=20)
    assert not found.thoughtless and found.random <= MOST_PASS


@pytest.mark.thorough
def test_without_its_price_a_task_is_passed_by_sliders_and_chance(loop_cache: LoopCache) -> None:
    found = passes_of(without(ASKED["hold-two-seconds"], "K1"), loop_cache, count=20)
    assert {"K1 = 2500", "K1 = 2500 and K2 = 200"} <= set(found.thoughtless)
    first, second = (problem.text for problem in found.problems())
    assert "of 20 students who draw at random" in first and "K1 = 2500" in second
    trying = dataclasses.replace(found.asked, task=replace(found.asked.task, exploratory=True))
    assert not list(dataclasses.replace(found, asked=trying).problems())


def test_a_link_that_evokes_a_note_is_no_refusal(loop_cache: LoopCache) -> None:
    """A path that crosses itself is followed, with a note, and once passed this task."""
    assert not passes_of(ASKED["cheap"], loop_cache, count=0).thoughtless
    found = passes_of(without(ASKED["cheap"], "path"), loop_cache, count=0)
    assert found.thoughtless == ["link 'A path that crosses itself' and nothing else"]


@pytest.mark.thorough
def test_a_hint_that_is_the_solution_is_found(loop_cache: LoopCache) -> None:
    asked = ASKED["get-it-going"]
    for hint, passed in (("Set K5 to 20, and wait.", True), ("K5 = 12 is not enough.", False)):
        told = dataclasses.replace(asked, task=replace(asked.task, hints=(hint,)))
        words = passes_of(told, loop_cache, count=0).thoughtless
        assert ("hint 1" in words) == passed


def test_random_students_are_always_the_same() -> None:
    for asked in ASKED.values():
        about = asked.lesson, asked.index, asked.task, asked.reference.solution
        few, many = (list(random_students(*about, count)) for count in (3, 6))
        assert many[:3] == few and len({repr(script) for script in many}) == 6


def test_every_task_of_the_course_has_three_other_solutions() -> None:
    for task, asked in ASKED.items():
        scripts = [asked.reference.solution, *asked.reference.variant]
        assert len({repr(script) for script in scripts}) >= 4, task


def test_every_control_is_tried_at_its_extremes_unless_the_task_forbids_it() -> None:
    name = "06b-friction-and-the-integral"
    lesson = COURSE.lesson(name, "en")
    references = read_references(lesson, BUILT_IN / name / REFERENCE)[0]
    index, task = next((i, step.tasks()[0]) for i, step in enumerate(lesson.steps) if step.tasks())
    free = replace(task, check=tuple(c for c in task.check if not isinstance(c, Only)))
    tried = cheats(lesson, index, free, references[task.id])
    known = specs(FIVE_BAR.parameters)
    assert {cheat.control for cheat in tried} == {*known, "path", "laws", "start"} - {"K1", "K2"}
    values = {
        value
        for cheat in tried
        for action in cheat.script.do
        for key, value in (action.set or {}).items()
        if key == "speed"
    }
    spec = known["speed"]
    assert values == {spec.low, 0.0, spec.high}
    assert {cheat.control for cheat in cheats(lesson, index, task, references[task.id])} == {"K3"}


TASK = LESSON.replace(
    'during = "held"\nleast = 1.0\nbelow = 5.0', 'during = "held"\nleast = 1.0\nbelow = 3.0'
)
REFERENCES = """
[hold.solution]
until = 3.5
do = [{ at = 0.1, set = { K1 = 1600, K2 = 80 } }, { at = 1.0, hold = true }]
[hold.failure]
until = 3.5
do = [{ at = 1.0, hold = true }]
"""
FORCE = """
[[check]]
kind = "bound"
quantity = "force"
during = "held"
stat = "mean"
above = 0.1
"""
ONLY = '\n[[check]]\nkind = "only"\nnames = ["K1", "K2"]\n'


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("check", "fair", "found"),
    [("", "", True), (FORCE, "", False), (ONLY, "", False), ("", 'fair = ["speed"]', False)],
)
def test_an_author_is_told_and_can_mend_it_or_declare_it_fair(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    check: str,
    fair: str,
    found: bool,
) -> None:
    action = Action(set={"speed": 0.0})
    monkeypatch.setattr(cheating, "_controls", lambda entry: [("speed", "speed = 0", action)])
    text = TASK.replace("below = 3.0\n", f"below = 3.0\n{check}")
    write_lesson(tmp_path, text, f"\n[hold]\n{fair}\n{REFERENCES}")
    assert run_command(["lessons", "check", str(tmp_path), "--cheat"]) == found
    told = capsys.readouterr().err
    assert ("'hold' is passed with speed = 0 and the rest of the solution" in told) == found
    assert (f"{REFERENCE}:5: " in told) == found


def test_what_is_fair_is_the_name_of_a_control(tmp_path: Path) -> None:
    write_lesson(tmp_path, TASK, f'[hold]\nfair = ["sped"]\n{REFERENCES}')
    (problem,) = read_course([tmp_path])[1]
    assert "did you mean speed" in problem.text
