"""What was stored when K3 was 0 by default keeps the physics that it had then."""

from __future__ import annotations

from typing import Any

import pytest

from onpath.app.classroom.class_state import push_data, read_push
from onpath.app.lab import commands as c
from onpath.app.lab.commands import TakeSetup
from onpath.app.lab.lab import Lab
from onpath.app.lab.setups.capture import capture
from onpath.app.lab.setups.setup import RobotSetup, Setup, to_data
from onpath.app.lab.setups.stored import from_data
from onpath.app.storage.lab_state import keep, put_back
from onpath.models.systems.catalogue import ROBOTS
from tests.support.lab import do, new_lab

CODES: dict[str, tuple[str, dict[str, dict[str, Any]]]] = {
    "new lab": ("ONPATH1-VOXAKAA-XSDALPI", {}),
    "another K1": (
        "ONPATH1-VNDISD44OEAHFNRFFBKIATVKAUAA-KMEYZHI",
        {"five_bar": {"K1": 900.0}},
    ),
    "K3 and encoders": (
        "ONPATH1-VNDISD44OEAPEARMLCYAOF6QVW2QA-BERF3EY",
        {"five_bar": {"K3": 2000.0, "encoder_counts": 2000.0, "tracker_integral": "on"}},
    ),
    "two-link arm": (
        "ONPATH1-VNDI5D4S6J6GBQHEMXDSOFXFMLDAHVD3YZ5ANNMYSYRFZDEIOQKOG2QB-PBL5LVQ",
        {"two_link_arm": {"speed": 3.0}},
    ),
    "flexible link": (
        "ONPATH1-VNDISD44OGAOD522UATZBIYPFXFGAALOAQGDP5HYVAC6TRM2RDIBGSZNAA-2FWQ3ZY",
        {"five_bar": {"control_rate": 100}, "flexible": {"law": "redefined", "alpha": 0.25}},
    ),
    "K3 with a flexible link": (
        "ONPATH1-VPDBKH5IOEAPFARJFBKIATWCCKV3KAA-GBN4THY",
        {"flexible": {"K3": 500.0, "tracker_integral": "on"}},
    ),
}
"""Made before the default changed, and what they meant then."""
ALL = ("five_bar", "two_link_arm", "flexible")


def parameters(lab: Lab, robot: str) -> Any:
    do(lab, c.ChooseRobot(robot))
    return lab.session.parameters


@pytest.mark.parametrize("case", CODES)
def test_an_old_share_code_keeps_its_physics(case: str) -> None:
    code, own = CODES[case]
    lab = new_lab()
    do(lab, c.UseShared(code))
    assert lab.message_level != "warning"
    for robot in ALL:
        found, expected = parameters(lab, robot), {"K3": 0.0, **own.get(robot, {})}
        assert {name: getattr(found, name) for name in expected} == expected
        assert found.tracker_integral == expected.get("tracker_integral", "off")


def test_an_old_stored_lab_is_restored_and_stored_with_its_version() -> None:
    lab, kept = new_lab(), list[dict[str, Any]]()
    old = {"benches": {"five_bar": {"parameters": {"K1": 900.0}}}}
    put_back(lab, {"setup": old, "lessons": {}, "before": old})
    assert (lab.session.parameters.K1, lab.session.parameters.K3) == (900.0, 0.0)
    assert lab.lessons.before == from_data(old)
    keep(lab, lambda state: kept.append(state()))
    assert kept[0]["setup"]["defaults"] == kept[0]["before"]["defaults"] == 2
    again = new_lab()
    put_back(again, kept[0])
    assert capture(again.session) == capture(lab.session)


def test_an_old_push_of_a_teacher_is_accepted() -> None:
    sent = read_push({"setup": {"benches": {"five_bar": {"parameters": {"K2": 60.0}}}}})
    assert isinstance(sent, TakeSetup)
    assert sent.setup.robots["five_bar"] == RobotSetup({"K2": 60.0, "K3": 0.0})
    assert read_push(push_data(sent)) == sent


def test_a_robot_added_since_has_its_own_defaults(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setitem(ROBOTS, "new", ROBOTS["five_bar"])
    assert from_data({"benches": {"new": {}}}).robots["new"] == RobotSetup()


def test_a_new_lab_has_the_integral_and_its_data_say_so() -> None:
    lab = new_lab()
    assert parameters(lab, "five_bar").K3 == parameters(lab, "two_link_arm").K3 == 1000.0
    assert parameters(lab, "flexible").K3 == 0.0
    assert from_data(to_data(Setup())) == Setup()


@pytest.mark.parametrize("version", [0, 3, -1, True, "2", 1.5, None])
def test_an_invalid_version_is_refused(version: object) -> None:
    with pytest.raises(ValueError):
        from_data({"defaults": version})
