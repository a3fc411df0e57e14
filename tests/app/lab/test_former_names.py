"""What was stored or typed when the plant unit_modes was called as_printed is still understood."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from onpath.app.cli.main import run_command
from onpath.app.lab import commands as c
from onpath.app.lab.commands import TakeSetup
from onpath.app.lab.commands.scripts import player_of
from onpath.app.lab.lab import Lab
from onpath.app.lab.lesson_record import Beginning, record_of
from onpath.app.lab.setups.capture import capture
from onpath.app.lab.setups.stored import from_data
from onpath.app.storage.lab_state import keep, put_back
from onpath.lessons.checks import judge
from onpath.lessons.course import Course, read_course
from onpath.lessons.words import Words
from onpath.models.systems.flexible_parameters import FlexibleParameters
from tests.support.lab import do, new_lab, run, store
from tests.support.lesson_texts import LESSON, write_lesson

OLD, NEW = "as_printed", "unit_modes"
SHARED = "ONPATH1-VPDBKH3IOEAASQKDSCTQU4QS6NAODHCYDRPVBFEZA6ZAZ2CQFRYV2CYA-NCGI2VI"
"""Made when the plant had its old name."""
SETUP = {"robot": "flexible", "benches": {"flexible": {"parameters": {"plant": OLD}}}}
LESSON_OF_THEN = (
    LESSON.replace("minutes = 1\n", 'minutes = 1\nrobot = "flexible"\n')
    .replace("K1 = 300", f'plant = "{OLD}"')
    .replace("{ at = 0.5, hold = true }", f'{{ at = 0.5, set = {{ plant = "{OLD}" }} }}')
    .replace(
        'kind = "bound"\nquantity = "distance"\nduring = "held"\nleast = 1.0\nbelow = 5.0',
        f'kind = "setting"\nname = "plant"\nequals = "{OLD}"',
    )
)


def plant(lab: Lab) -> str:
    assert isinstance(lab.session.parameters, FlexibleParameters)
    assert lab.session.robot.system.name == "flexible_five_bar"
    return lab.session.parameters.plant


def test_an_old_share_code_opens() -> None:
    lab = new_lab()
    do(lab, c.UseShared(SHARED))
    assert plant(lab) == NEW
    own = {
        "plant": NEW,
        "alpha": 1.0,
        "tracker_integral": "on",
        "at_limit_for": "path_following",
    }  # as it was then
    assert capture(lab.session).robots["flexible"].parameters == own


def test_an_old_stored_lab_is_restored_and_stored_under_the_new_name() -> None:
    lab, kept = new_lab(), list[dict[str, Any]]()
    put_back(lab, {"setup": SETUP, "lessons": {}, "before": SETUP})
    assert plant(lab) == NEW
    keep(lab, lambda state: kept.append(state()))
    assert NEW in json.dumps(kept[0]["setup"]) and OLD not in json.dumps(kept[0]["setup"])


def test_an_old_set_up_of_a_teacher_is_accepted() -> None:
    lab = new_lab()
    lab.post(TakeSetup(from_data(SETUP)))
    lab.drain()
    assert plant(lab) == NEW


@pytest.fixture
def course(tmp_path: Path) -> Course:
    write_lesson(tmp_path, LESSON_OF_THEN)
    found, problems = read_course([tmp_path])
    assert problems == []
    return found


def test_an_old_lesson_sets_and_checks_it(course: Course) -> None:
    assert LESSON_OF_THEN.count(OLD) == 3
    lab = Lab(store(), course=course)
    do(lab, c.OpenLesson("01-a"), c.GoToStep(0))
    assert plant(lab) == NEW
    lesson = course.lessons["01-a"]["en"]
    (task,) = lesson.tasks()
    record = record_of(lab.session, Beginning.now(lab.session))
    assert [v.passed for v in judge(task, record, Words())] == [True]
    lagrangian = replace(record, parameters=FlexibleParameters())
    assert [v.passed for v in judge(task, lagrangian, Words())] == [False]

    script = next(step.script for step in lesson.steps if step.script)
    do(lab, c.SetParameter("plant", "lagrangian"))
    lab.script = player_of(script)
    run(lab, 0.6)
    assert plant(lab) == NEW


@pytest.mark.parametrize(
    "command", [["experiment", "flexible", "--set", "duration=0.02"], ["zero-dynamics"]]
)
def test_the_command_line_takes_both_names(
    command: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    outputs = list[str]()
    for name in (OLD, NEW):
        assert run_command([*command, "--set", f"plant={name}", "--json"]) == 0
        outputs.append(capsys.readouterr().out)
    assert outputs[0] == outputs[1] and OLD not in outputs[0]


def test_another_name_is_refused_and_the_present_ones_are_told(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert run_command(["zero-dynamics", "--set", "plant=printed"]) == 2
    assert "lagrangian, unit_modes" in capsys.readouterr().err
