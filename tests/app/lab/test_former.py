"""What was kept or shared before is read as it was meant: `app/lab/setups/former.py`.

`tests/data/setups_version_2.json` was written with version 2 of the defaults: the defaults of all
robots, and share codes with what they meant and where the end-points were after 0.4 s, held from
0.2 s on. `tests/data/two_laws` was written when a lab had two fixed laws: a database with two labs,
one in a lesson with a sketch, its truth and two passed tasks, and with a class of two that was sent
a set-up.
"""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Mapping
from contextlib import closing
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from onpath.app.classroom.class_state import push_data, read_push
from onpath.app.exports.report import report
from onpath.app.lab import commands as c
from onpath.app.lab.commands import TakeSetup
from onpath.app.lab.lab import Lab
from onpath.app.lab.lesson_state import LessonState
from onpath.app.lab.setups import former, stored
from onpath.app.lab.setups.capture import capture
from onpath.app.lab.setups.former import CHANGES, DEFAULTS, Change, former_defaults
from onpath.app.lab.setups.setup import RobotSetup, Setup
from onpath.app.lab.setups.share_code import decode, encode
from onpath.app.lab.setups.stored import from_data, to_data, without_absent_laws
from onpath.app.storage.lab_state import keep, put_back
from onpath.app.storage.records import Records, file_url
from onpath.models.control.settable import value_of, values_of
from onpath.models.control.sides import DEFAULT_LAWS, LEFT
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.flexible_parameters import FlexibleParameters
from onpath.models.systems.parameter_specs import FORMER_NAMES
from tests.support.built_in import built_in_course
from tests.support.cases import drawn
from tests.support.checkout import ROOT
from tests.support.lab import do, loop_cache, new_lab, run, states, y

WRITTEN = json.loads((ROOT / "tests/data/setups_version_2.json").read_text("utf-8"))
CASES = {case["name"]: case for case in WRITTEN["cases"]}
CODES: dict[str, tuple[str, dict[str, dict[str, Any]]]] = {
    "new lab": ("ONPATH1-VOXAKAA-XSDALPI", {}),
    "another K1": (
        "ONPATH1-VNDISD44OEAHFNRFFBKIATVKAUAA-KMEYZHI",
        {"five_bar": {"K1": 900.0}},
    ),
    "K3 and encoders": (
        "ONPATH1-VNDISD44OEAPEARMLCYAOF6QVW2QA-BERF3EY",
        {"five_bar": {"K3": 2000.0, "encoder_counts": 2000.0}},
    ),
    "two-link arm": (
        "ONPATH1-VNDI5D4S6J6GBQHEMXDSOFXFMLDAHVD3YZ5ANNMYSYRFZDEIOQKOG2QB-PBL5LVQ",
        {"two_link_arm": {"speed": 3.0}},
    ),
    "flexible link": (
        "ONPATH1-VNDISD44OGAOD522UATZBIYPFXFGAALOAQGDP5HYVAC6TRM2RDIBGSZNAA-2FWQ3ZY",
        {"five_bar": {"control_rate": 100}, "flexible": {"output": "redefined", "alpha": 0.25}},
    ),
    "K3 with a flexible link": (
        "ONPATH1-VPDBKH5IOEAPFARJFBKIATWCCKV3KAA-GBN4THY",
        {"flexible": {"K3": 500.0}},
    ),
}
"""Made with version 1, when K3 was 0 and acted in the tracker, too; and what they meant then."""
VERSION_1 = ("five_bar", "two_link_arm", "flexible")
"""The robots that there were."""
SINCE_2 = {"at_limit_for": "path_following", "observer_time": 0.0, "observer_bound": 10.0}
"""Former values of what every robot has had since version 2."""


def parameters(lab: Lab, robot: str) -> Any:
    do(lab, c.ChooseRobot(robot))
    return lab.simulation.parameters


def opened(code: str) -> Lab:
    lab = new_lab()
    do(lab, c.UseShared(code))
    assert lab.message == lab.words("say.set_up")
    return lab


def held(lab: Lab) -> dict[str, np.ndarray]:
    """The states after 0.4 s, held from 0.2 s on."""
    run(lab, 0.2)
    do(lab, c.Hold(True))
    run(lab, 0.2)
    return states(lab.simulation)


def as_then(robot: str, own: Mapping[str, Any]) -> dict[str, Any]:
    """A robot's parameters as they were written, by their present names."""
    values: dict[str, Any] = {**WRITTEN["defaults"][robot], **own}
    return {FORMER_NAMES.get(name, name): value for name, value in values.items()}


@pytest.mark.thorough
@pytest.mark.parametrize("name", drawn([*CASES], 4))
def test_a_share_code_means_what_it_meant(name: str) -> None:
    case = CASES[name]
    lab = opened(case["code"])
    assert lab.simulation.entry.name == case["robot"]
    assert lab.simulation.laws == case["laws"] and lab.simulation.editor.design.name == case["path"]
    assert from_data(case["data"]) == decode(case["code"]) == capture(lab.simulation)
    for robot in WRITTEN["defaults"]:
        found = values_of(parameters(lab, robot))
        expected = as_then(robot, case["parameters"].get(robot, {}))
        assert {name: found[name] for name in expected} == expected


@pytest.mark.thorough
@pytest.mark.parametrize("name", drawn([*CASES], 4))
def test_a_share_code_moves_as_it_moved(name: str) -> None:
    case = CASES[name]
    lab = opened(case["code"])
    moved = held(lab)
    for side, place in case["end_points"].items():
        assert y(lab.simulation, side) == pytest.approx(place, abs=1e-9)  # of another machine
    told = opened(case["code"])
    do(told, *(c.Set(n, v) for n, v in written_out(case).items()), c.Reset())
    for side, state in held(told).items():
        assert np.array_equal(state, moved[side])


def written_out(case: Mapping[str, Any]) -> dict[str, Any]:
    """All parameters of a case's robot, with their values."""
    return as_then(case["robot"], case["parameters"].get(case["robot"], {}))


@pytest.mark.thorough
@pytest.mark.parametrize("name", drawn([*CASES], 4))
def test_a_kept_lab_and_a_set_up_of_a_class_too(name: str) -> None:
    data = CASES[name]["data"]
    lab = new_lab()
    put_back(lab, {"setup": data, "lessons": {}, "before": data})
    assert capture(lab.simulation) == lab.lessons.before == decode(CASES[name]["code"])
    sent = read_push({"setup": data})
    assert isinstance(sent, TakeSetup) and sent.setup == from_data(data)


@pytest.mark.parametrize("robot", WRITTEN["defaults"])
def test_a_default_that_has_changed_has_a_line(robot: str) -> None:
    present = values_of(ROBOTS[robot].parameters())
    then = former_defaults(robot, WRITTEN["version"])
    for name, value in as_then(robot, {}).items():
        assert then.get(name, present[name]) == value, f"add a line to CHANGES for {name}"


@pytest.mark.parametrize("robot", ROBOTS)
def test_a_change_is_one_line(robot: str, monkeypatch: pytest.MonkeyPatch) -> None:
    old = {"defaults": DEFAULTS, "robot": robot, "benches": {robot: {"parameters": {"K2": 30.0}}}}
    monkeypatch.setattr(former, "CHANGES", (*CHANGES, Change(DEFAULTS + 1, "K1", 123.0)))
    found = from_data(old)
    assert found.robots[robot].parameters == {"K1": 123.0, "K2": 30.0}
    others = [name for name in ROBOTS if name != robot]
    assert all(found.robots[name].parameters == {"K1": 123.0} for name in others)


def test_the_value_of_a_version_is_that_before_the_next_change(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    changes = (*CHANGES[:2], Change(3, "K1", 123.0), Change(4, "K3", 77.0), Change(5, "K1", 321.0))
    monkeypatch.setattr(former, "CHANGES", changes)
    values = [former_defaults("five_bar", version) for version in range(1, 6)]
    assert [value.get("K1") for value in values] == [123.0, 123.0, 321.0, 321.0, None]
    assert [value.get("K3") for value in values] == [0.0, 77.0, 77.0, None, None]
    assert [change.since for change in CHANGES] == sorted(change.since for change in CHANGES)


def test_a_gain_of_a_law_whose_default_has_changed_keeps_its_value() -> None:
    old = from_data({"defaults": 3, "benches": {"five_bar": {"parameters": {"observer_rate": 9}}}})
    assert old.robots["five_bar"].parameters["observer_bound"] == 10.0
    assert (
        "observer_bound"
        not in from_data({"defaults": DEFAULTS}).robots.get("five_bar", RobotSetup()).parameters
    )


def test_a_share_code_of_a_newer_version_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stored, "DEFAULTS", DEFAULTS + 1)
    code = encode(Setup())
    lab = new_lab()
    do(lab, c.UseShared(code))
    assert lab.message == lab.words("error.share_newer")


@pytest.mark.thorough
@pytest.mark.parametrize("case", CODES)
def test_a_share_code_of_version_1_keeps_its_physics(case: str) -> None:
    code, own = CODES[case]
    lab = opened(code)
    for robot in VERSION_1:
        found = parameters(lab, robot)
        expected = {"K3": 0.0, "tracker_integral": "on", **own.get(robot, {})}
        assert {name: value_of(found, name) for name in expected} == expected


@pytest.mark.thorough
def test_an_old_stored_lab_is_restored_and_stored_with_its_version() -> None:
    lab, kept = new_lab(), list[dict[str, Any]]()
    old = {"benches": {"five_bar": {"parameters": {"K1": 900.0}}}}
    put_back(lab, {"setup": old, "lessons": {}, "before": old})
    assert (lab.simulation.parameters.K1, lab.simulation.parameters.K3) == (900.0, 0.0)
    assert lab.lessons.before == from_data(old)
    keep(lab, lambda state: kept.append(state()))
    assert kept[0]["setup"]["defaults"] == kept[0]["before"]["defaults"] == DEFAULTS
    again = new_lab()
    put_back(again, kept[0])
    assert capture(again.simulation) == capture(lab.simulation)


def test_an_old_push_of_a_teacher_is_accepted() -> None:
    sent = read_push({"setup": {"benches": {"five_bar": {"parameters": {"K2": 60.0}}}}})
    assert isinstance(sent, TakeSetup)
    own = {"K2": 60.0, "K3": 0.0, "tracker_integral": "on", **SINCE_2}
    assert sent.setup.robots["five_bar"] == RobotSetup(own)
    assert read_push(push_data(sent)) == sent


def test_a_robot_added_since_has_its_own_defaults() -> None:
    assert "spatial_arm" not in VERSION_1
    found = from_data({"benches": {"spatial_arm": {}}, "defaults": 2}).robots["spatial_arm"]
    assert found == RobotSetup(SINCE_2)
    assert from_data({"benches": {"spatial_arm": {}}}).robots["spatial_arm"] == found


def test_a_new_lab_has_the_integral_and_its_data_say_so() -> None:
    lab = new_lab()
    assert parameters(lab, "five_bar").K3 == parameters(lab, "two_link_arm").K3 == 1000.0
    assert parameters(lab, "flexible").K3 == 0.0
    assert from_data(to_data(Setup())) == Setup()


@pytest.mark.parametrize("version", [0, DEFAULTS + 1, -1, True, "2", 1.5, None])
def test_an_invalid_version_is_refused(version: object) -> None:
    with pytest.raises(ValueError):
        from_data({"defaults": version})


# A lab had two fixed laws.

DATA = ROOT / "tests" / "data" / "two_laws"
COURSE = built_in_course()[0]
LESSON = "01-path-or-timetable"
DAY = datetime(2026, 11, 23)
ELLIPSE = (
    "ONPATH1-VNDISD44OEAHFNRFFBKGVCNRJ7LRYGECAY5EAO4MFXGQZDMB62MBXGUYQD42MIAJCNBYRKAFJAKKMFRCBAITHUEB"
    "FDKEKEUMVUC5UXKSTYHYZOV45T4MJIS4FSXAIBVRWEY5BEKAAAAA-MX2GGNI"
)
"""An ellipse with a point moved and K1 = 900, and K2 = 33 for the two-link arm."""
SLOW = "ONPATH1-VNDI2L6UXA2UDC22RTMKYBIA-C45SUEI"
"""The flexible robot in slow motion, drawn four times larger, without copying."""


@pytest.fixture
def records(tmp_path: Path) -> Records:
    file = tmp_path / "onpath.db"
    with closing(sqlite3.connect(file)) as raw:
        raw.executescript((DATA / "database.sql").read_text("utf-8"))
    return Records(file_url(file), lambda: 1.8e9)


@pytest.mark.thorough
@pytest.mark.parametrize("code", [ELLIPSE, SLOW])
def test_a_share_code_sets_up_the_usual_laws(code: str) -> None:
    lab = new_lab()
    lab.simulation.change_law(LEFT, "set_point")
    do(lab, c.UseShared(code))
    assert lab.message == lab.words("say.set_up") and lab.simulation.laws == DEFAULT_LAWS
    assert decode(code).laws == {} and "laws" not in to_data(capture(lab.simulation))
    if code == ELLIPSE:
        assert lab.simulation.parameters.K1 == 900.0
        assert lab.simulation.earlier["two_link_arm"][0].K2 == 33.0
    else:
        simulation = lab.simulation
        told = (
            simulation.entry.name,
            simulation.settings.rate,
            simulation.settings.copy,
            simulation.settings.larger,
        )
        assert told == ("flexible", 0.5, False, 4.0)


@pytest.mark.thorough
def test_a_kept_lab_opens_in_its_lesson(records: Records) -> None:
    kept = records.load("c0de01")
    assert kept is not None
    lab = Lab(loop_cache(), course=COURSE)
    put_back(lab, kept)
    assert lab.simulation.laws == DEFAULT_LAWS and lab.lessons.progress.lesson == LESSON
    notes = lab.lessons.notes
    assert notes.answers["1"].values == (0.0, 1.0, 30.0, 2.0)
    assert max(notes.truths["1"].tracker) > 40 > 5 > max(notes.truths["1"].follower)
    assert set(notes.tasks) == {"hold-two-seconds", "thirty-times"}
    page = report(LessonState(COURSE, lab.lessons.progress), "", DAY).decode()
    assert "Tracker" in page and "Follower" in page
    do(lab, c.CloseLesson())
    assert lab.simulation.parameters.K1 == 900.0 and lab.simulation.editor.design.name == "edited"
    records.close()


# What the flexible robot controls was called `law`, now `output`.


def test_a_lab_that_called_the_output_law_is_restored_and_stored_with_its_new_name() -> None:
    old = {"benches": {"flexible": {"parameters": {"law": "redefined"}}}, "robot": "flexible"}
    remaining, absent = without_absent_laws({"defaults": DEFAULTS, **old})
    assert absent == () and from_data(remaining) == from_data({"defaults": DEFAULTS, **old})
    lab, kept = new_lab(), list[dict[str, Any]]()
    put_back(lab, {"setup": {"defaults": DEFAULTS, **old}, "lessons": {}, "before": None})
    assert value_of(lab.simulation.parameters, "output") == "redefined"
    keep(lab, lambda state: kept.append(state()))
    stored = {"parameters": {"output": "redefined"}}
    assert kept[0]["setup"]["benches"]["flexible"] == stored


# The plant unit_modes was called as_printed.

OLD, NEW = "as_printed", "unit_modes"
SHARED = "ONPATH1-VPDBKH3IOEAASQKDSCTQU4QS6NAODHCYDRPVBFEZA6ZAZ2CQFRYV2CYA-NCGI2VI"
"""Made when the plant had its old name."""
OLD_PLANT = {"robot": "flexible", "benches": {"flexible": {"parameters": {"plant": OLD}}}}


def plant(lab: Lab) -> str:
    assert isinstance(lab.simulation.parameters, FlexibleParameters)
    assert lab.simulation.robot.system.name == "flexible"
    return lab.simulation.parameters.plant


def test_a_share_code_with_the_old_name_opens() -> None:
    lab = new_lab()
    do(lab, c.UseShared(SHARED))
    assert plant(lab) == NEW
    own = {
        "plant": NEW,
        "alpha": 1.0,
        "tracker_integral": "on",
        **SINCE_2,
    }  # as it was then
    assert capture(lab.simulation).robots["flexible"].parameters == own


def test_an_old_stored_plant_is_restored_and_stored_under_the_new_name() -> None:
    lab, kept = new_lab(), list[dict[str, Any]]()
    put_back(lab, {"setup": OLD_PLANT, "lessons": {}, "before": OLD_PLANT})
    assert plant(lab) == NEW
    keep(lab, lambda state: kept.append(state()))
    assert NEW in json.dumps(kept[0]["setup"]) and OLD not in json.dumps(kept[0]["setup"])


def test_a_teacher_s_set_up_with_the_old_name_is_accepted() -> None:
    lab = new_lab()
    lab.post(TakeSetup(from_data(OLD_PLANT)))
    lab.drain()
    assert plant(lab) == NEW
