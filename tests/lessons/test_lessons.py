"""Every lesson is all right, and each task's solution passes where its failure does not."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from pathlib import Path

import pytest
from markupsafe import Markup

from onpath.app.cli.main import run_command
from onpath.app.lab.dry_runs.course_check import lab_at, play, play_course, solved
from onpath.app.lab.lesson_record import Beginning, record_of
from onpath.app.steps.step_html import part_of, step_html
from onpath.lessons.checks import verdict
from onpath.lessons.course import BUILT_IN, REFERENCE, read_course, read_references
from onpath.lessons.labels import setting_label
from onpath.lessons.schema import Choice, Lesson, Quiz, Step
from onpath.lessons.task_schema import Once, Order, Setting, Task
from onpath.lessons.words import Words, languages
from tests.support.built_in import built_in_course
from tests.support.lab import loop_cache
from tests.support.lesson_texts import LESSON, write_lesson
from tests.support.lesson_texts import REFERENCE as EXAMPLE

COURSE, PROBLEMS = built_in_course()
ENGLISH = [versions["en"] for versions in COURSE.lessons.values()]
TASKS = [
    (lesson, step, task) for lesson in ENGLISH for step in lesson.steps for task in step.tasks()
]
SCRIPTS = [(lesson, step) for lesson in ENGLISH for step in lesson.steps if step.script]


def label(value: object) -> str:
    """For pytest's names of tests."""
    if isinstance(value, Lesson):
        return value.name
    return value.id if isinstance(value, Task) else getattr(value, "title", "")


def test_every_lesson_is_all_right() -> None:
    assert PROBLEMS == []
    assert len(ENGLISH) >= 8 and "de" in COURSE.languages()


def test_no_rule_of_thumb_finds_the_right_options() -> None:
    """Neither the first, the second…, nor the longest, nor the shortest one is mostly right."""
    asked = [
        block.options
        for lesson in ENGLISH
        for step in lesson.steps
        for block in step.blocks
        if isinstance(block, Choice | Quiz)
    ]
    found: Counter[object] = Counter()
    for options in asked:
        sizes = [len(Markup(option.text).striptags()) for option in options]
        for place, option in enumerate(options):
            rules = (place, *(most for most in (max, min) if sizes[place] == most(sizes)))
            found.update(rules if option.right else ())
    assert len(asked) > 20
    assert max(found.values()) <= 0.45 * len(asked), found


@pytest.mark.thorough
@pytest.mark.parametrize(("lesson", "step", "task"), TASKS, ids=label)
def test_solution_passes_and_failure_does_not(lesson: Lesson, step: Step, task: Task) -> None:
    reference = read_references(lesson, BUILT_IN / lesson.name / REFERENCE)[0][task.id]
    passed, last = solved(lab_at(lesson, step, loop_cache()), reference.solution, task)
    assert passed, [verdict.words for verdict in last]
    passed, last = solved(lab_at(lesson, step, loop_cache()), reference.failure, task)
    assert not passed, [verdict.words for verdict in last]


@pytest.mark.parametrize(("lesson", "step"), SCRIPTS, ids=label)
def test_every_script_of_a_step_plays_to_its_end(lesson: Lesson, step: Step) -> None:
    assert step.script is not None
    lab = lab_at(lesson, step, loop_cache())
    assert not any(play(lab, step.script))  # there is no task to judge
    assert lab.simulation.time > 0


@pytest.mark.parametrize("language", languages())
def test_checks_speak_of_parameters_by_their_labels(language: str) -> None:
    """A line such as "encoder_counts is 500" names nothing that the page shows."""
    words, seen = Words(language), Counter[str]()
    for lesson, step, task in TASKS:
        lab = lab_at(lesson, step, loop_cache())
        record = record_of(lab.simulation, Beginning.now(lab.simulation))
        for check in task.check:
            said = verdict(check, record, words).words
            if isinstance(check, Setting | Once):
                names = [check.name]
            elif isinstance(check, Order):
                names = [event.partition(":")[2] for event in check.events]
            else:
                continue
            for name in filter(None, names):
                label = setting_label(name, record.parameters, words)
                assert label in said and "_" not in said, said
                seen[label] += 1
    assert len(seen) > 8


def test_every_task_says_why_it_worked_and_only_then() -> None:
    words = Words("en")
    for lesson, step, task in TASKS:
        index, place = lesson.steps.index(step), step.blocks.index(task)
        for done in (False, True):
            part = replace(part_of(lesson, index, place, words), told=done)
            page = step_html(lesson, index, [part], words)
            assert task.passed and ('class="after"' in page) == done


def test_a_prediction_is_shown_after_the_text_before_it() -> None:
    words = Words("en")
    for lesson in ENGLISH:
        for index, step in enumerate(lesson.steps):
            if step.kind == "predict":
                parts = [part_of(lesson, index, at, words) for at in range(len(step.blocks))]
                page = step_html(lesson, index, parts, words)
                places = [page.index(f'data-block="{at}"') for at in range(len(parts))]
                assert places == sorted(places), step.title


def test_references_are_where_the_lessons_are() -> None:
    for lesson in ENGLISH:
        assert Path(BUILT_IN / lesson.name / REFERENCE).is_file()


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("reference", "line", "words"),
    [
        (EXAMPLE.replace("until = 3.0", "until = 1.5"), 2, "0.4 of 1 s"),
        (EXAMPLE.replace("until = 1.5", "until = 3.0"), 5, "passes the task"),
        (EXAMPLE.replace("hold = true", "reset = true"), 2, "0.0 of 1 s"),
    ],
    ids=["a solution that fails", "a failure that passes", "a solution that does nothing"],
)
def test_an_invalid_solution_is_found(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], reference: str, line: int, words: str
) -> None:
    file = write_lesson(tmp_path).with_name(REFERENCE)
    assert run_command(["lessons", "check", str(tmp_path)]) == 0
    assert "1 lesson," in capsys.readouterr().out
    file.write_text(reference)
    assert run_command(["lessons", "check", str(tmp_path)]) == 1
    said = capsys.readouterr().err
    assert said.startswith(f"{file}:{line}: hold.") and words in said


def test_a_lesson_may_have_typed_laws(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """In its scenes and in its scripts; its reference solution is played under them."""
    law = "across = -K1*xi - K2*dxi; along = -K5*(dtheta - speed)"
    change = f'{{ at = 0.2, laws = {{ right = "{law}" }} }}'
    own = LESSON.replace("{ at = 0.5, hold", f"{change}, {{ at = 0.5, hold")
    own = own.replace('path = "ellipse"', f'path = "ellipse"\nlaws = {{ right = "{law}" }}')
    write_lesson(tmp_path, own)
    assert run_command(["lessons", "check", str(tmp_path)]) == 0
    write_lesson(tmp_path, own.replace("K1*xi", "K1*xii"))
    capsys.readouterr()
    assert run_command(["lessons", "check", str(tmp_path)]) == 1
    assert capsys.readouterr().err.count("did you mean xi?") == 2


def test_a_script_that_the_lab_refuses_is_found(tmp_path: Path) -> None:
    level_set = '{ at = 0.4, path = "clover" }, { at = 0.5, set = { across = "level_set" } }'
    own = LESSON.replace("{ at = 0.5, hold = true }", level_set)
    file = write_lesson(tmp_path, own)
    course, problems = read_course([tmp_path])
    assert problems == []
    (problem,) = play_course(course, tmp_path, loop_cache())
    assert problem.path == str(file) and "no level set" in problem.text
    assert own.split("\n")[problem.line - 1].startswith("# run")
