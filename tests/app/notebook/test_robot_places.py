"""Robots that are given by a file, a folder or a name of robot_descriptions."""

from __future__ import annotations

import sys
import warnings
from pathlib import Path

import pytest

import onpath
from onpath.app.cli.main import run_command
from onpath.app.common.robot_places import is_from_file, only_file_in, robot_place
from onpath.models.errors import CodedError
from onpath.models.systems.catalogue import ROBOTS
from tests.support.robot_files import PLANAR, urdf

ARM = urdf("own", PLANAR)
POSE = {"joint1": 2.0, "joint2": -1.3, "joint3": -0.9}


def test_a_folder_stands_for_the_only_robot_in_it(tmp_path: Path) -> None:
    inner = tmp_path / "description" / "urdf"
    inner.mkdir(parents=True)
    (inner / "arm.urdf").write_text(ARM, "utf-8")
    (inner / "arm.urdf.xacro").write_text(ARM, "utf-8")  # from which it was made
    (tmp_path / "package.xml").write_text("<package><name>arm</name></package>", "utf-8")
    (tmp_path / "notes.urdf").write_text("no robot", "utf-8")
    arm = onpath.robot(tmp_path, tip="tip", pose=POSE)
    assert arm == onpath.robot(inner / "arm.urdf", tip="tip", pose=POSE)
    assert is_from_file(str(tmp_path)) and is_from_file(tmp_path)


def test_a_folder_with_several_lists_what_to_type(tmp_path: Path) -> None:
    for name in ("left arm.urdf", "right.urdf"):
        (tmp_path / name).write_text(ARM, "utf-8")
    with pytest.raises(CodedError) as caught:
        only_file_in(tmp_path)
    assert f"--robot '{tmp_path / 'left arm.urdf'}'" in str(caught.value)
    assert f"--robot {tmp_path / 'right.urdf'}" in str(caught.value)


def test_a_folder_without_a_robot_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run_command(["names", "--robot", str(tmp_path)]) == 2
    told = capsys.readouterr().err
    assert str(tmp_path) in told and told.count("\n") == 1


def test_links_and_depths_of_a_folder_are_not_followed(tmp_path: Path) -> None:
    deep, elsewhere = tmp_path.joinpath("arms", *"abcdefgh"), tmp_path / "elsewhere"
    deep.mkdir(parents=True)
    elsewhere.mkdir()
    for folder in (deep, elsewhere):
        (folder / "arm.urdf").write_text(ARM, "utf-8")
    (tmp_path / "arms" / "link").symlink_to(elsewhere)
    (tmp_path / "arms" / "circle").symlink_to(tmp_path)
    with pytest.raises(CodedError):
        only_file_in(tmp_path / "arms")


def test_a_name_of_the_catalogue_is_no_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ROBOTS:
        (tmp_path / name).mkdir()
        assert not is_from_file(name)
    assert not is_from_file("no_such_robot") and not is_from_file("")


def test_the_home_folder_is_expanded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    (tmp_path / "arm.urdf").write_text(ARM, "utf-8")
    assert robot_place("~/arm.urdf").file == robot_place("~").file == tmp_path / "arm.urdf"


@pytest.fixture
def descriptions(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A package that is called like the real one, and fetches nothing."""
    package, arm = tmp_path / "robot_descriptions", tmp_path / "own_arm"
    package.mkdir()
    arm.mkdir()
    (arm / "arm.urdf").write_text(ARM, "utf-8")
    (package / "__init__.py").write_text("", "utf-8")
    (package / "own_description.py").write_text(
        f"PACKAGE_PATH, URDF_PATH = {str(arm)!r}, {str(arm / 'arm.urdf')!r}", "utf-8"
    )
    (package / "lost_description.py").write_text("raise OSError('no network')", "utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    for name in [name for name in sys.modules if name.startswith("robot_descriptions")]:
        monkeypatch.delitem(sys.modules, name)
    return arm


def test_a_name_of_robot_descriptions_is_taken(descriptions: Path) -> None:
    place = robot_place("own_description")
    assert place.file == descriptions / "arm.urdf" and place.packages == {"own_arm": descriptions}
    arm = onpath.robot("own_description", tip="tip", pose=POSE)
    assert arm.name.startswith("arm_")


def test_what_cannot_be_fetched_says_why(descriptions: Path) -> None:
    with pytest.raises(CodedError, match="lost_description: no network"):
        onpath.robot("lost_description")
    with pytest.raises(ValueError, match="unknown robot 'unknown_description'"):
        onpath.simulate("unknown_description")


def test_a_guess_is_told_once_and_settled_by_its_line(tmp_path: Path) -> None:
    file = tmp_path / "arm.urdf"
    fork = '<joint name="j" type="fixed"><parent link="link3"/><child link="tool0"/></joint>'
    file.write_text(ARM.replace("</robot>", f'{fork}<link name="tool0"/></robot>'), "utf-8")
    with pytest.warns(UserWarning) as caught:
        guessed = onpath.robot(file, pose=POSE)
    (guess,) = guessed.guesses
    assert guess.kind == "tip" and guess.line == "--tip tool0"
    assert [guess.line in str(each.message) for each in caught] == [True]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        settled = onpath.robot(file, tip="tool0", pose=POSE)
    assert settled == guessed and settled.name == guessed.name
    assert settled.guesses == () and ROBOTS[settled.name].guesses == ()
