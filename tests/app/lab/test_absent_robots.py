"""Set-ups with a robot from a file name it with its digest, and say so where it is absent."""

from __future__ import annotations

import shlex
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.app.common.robot_files import robot_of_file
from onpath.app.lab.lab import Lab
from onpath.app.lab.setups.capture import capture
from onpath.app.lab.setups.setup import RobotSetup, Setup
from onpath.app.lab.setups.share_code import decode, encode
from onpath.app.lab.setups.stored import to_data
from onpath.app.storage.lab_state import LabState, put_back
from onpath.models.errors import CodedError
from onpath.models.robot_files.file_chain import Options
from onpath.models.robot_files.xml_elements import shown
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.robot_file import read_robot
from onpath.models.systems.robots import RobotEntry
from tests.support.lab import loop_cache
from tests.support.robot_files import PLANAR, urdf


def own(folder: Path, mass: str = "0.6") -> RobotEntry:
    file = folder / "Own Arm.urdf"
    file.write_text(urdf("own", PLANAR).replace('mass value="0.6"', f'mass value="{mass}"'))
    return read_robot(file, Options(pose={"joint1": 2.0, "joint2": -1.3, "joint3": -0.9})).entry


def test_the_name_follows_from_the_file_and_the_options(tmp_path: Path) -> None:
    first = own(tmp_path)
    assert first.name.startswith("own_arm_") and first.label == "Own Arm"
    assert own(tmp_path).name == first.name != own(tmp_path, mass="0.7").name


def test_a_share_code_restores_the_robot_or_says_that_it_is_absent(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    entry = own(tmp_path)
    monkeypatch.setitem(ROBOTS, entry.name, entry)
    lab = Lab(loop_cache(), entry)
    setup = capture(lab.simulation)
    code = encode(setup)
    assert decode(code) == setup and setup.robot == entry.name
    monkeypatch.delitem(ROBOTS, entry.name)
    with pytest.raises(CodedError) as caught:
        decode(code)
    assert entry.name in str(caught.value) and "onpath --robot FILE" in str(caught.value)


@given(file=st.text(max_size=80), tip=st.text(max_size=80))
def test_a_share_code_says_what_to_type_and_no_more(file: str, tip: str) -> None:
    robots = {"arm_0a1b2c3d": RobotSetup(file=file, tip=tip)}
    code = encode(Setup(robot="arm_0a1b2c3d", robots=robots))
    with pytest.raises(CodedError) as caught:
        decode(code)
    told = str(caught.value)
    assert told.isprintable()
    line = told.partition("start the lab with ")[2].rpartition(", and with the options")[0]
    typed = shlex.split(line)
    assert typed[:2] == ["onpath", "--robot"]
    assert typed[2] == (shown(file, 80) or "FILE")
    assert typed[3:] == (["--tip", shown(tip, 80)] if tip else [])


def test_a_robot_that_was_given_is_named_by_its_file_and_tip(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "Own Arm.urdf"
    file.write_text(urdf("own", PLANAR))
    entry, _ = robot_of_file(file, Options(tip="tip"))
    code = encode(capture(Lab(loop_cache(), entry).simulation))
    assert decode(code).robots[entry.name].tip == "tip"
    monkeypatch.delitem(ROBOTS, entry.name)
    with pytest.raises(CodedError, match=r"onpath --robot 'Own Arm\.urdf' --tip tip"):
        decode(code)


def test_a_kept_lab_goes_on_without_an_absent_robot_and_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    entry = own(tmp_path)
    monkeypatch.setitem(ROBOTS, entry.name, entry)
    lab = Lab(loop_cache(), entry)
    lab.simulation.choose_robot(ROBOTS["two_link_arm"])
    lab.simulation.choose_robot(entry)
    state: LabState = {"setup": to_data(capture(lab.simulation)), "lessons": {}, "before": None}
    monkeypatch.delitem(ROBOTS, entry.name)
    other = Lab(loop_cache())
    put_back(other, state)
    assert other.simulation.entry.name == "five_bar"
    assert entry.name in other.message
