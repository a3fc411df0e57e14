"""Where a robot from a file stands, if the file does not say it, and what is refused."""

from __future__ import annotations

import shlex
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from onpath.models.errors import CodedError
from onpath.models.paths.curve_faults import curve_faults
from onpath.models.paths.path_design import USUAL_RADIUS, presets
from onpath.models.robot_files import whole_chain
from onpath.models.robot_files.file_chain import Options
from onpath.models.robot_files.file_masses import INSTALL
from onpath.models.robot_files.hull_process import LIBRARY, Hull
from onpath.models.studies.experiments import experiments
from onpath.models.studies.path_text import curve_from_text
from onpath.models.systems.catalogue import FIVE_BAR, ROBOTS
from onpath.models.systems.home_pose import length_of
from onpath.models.systems.robot_file import RobotFile, read_robot
from tests.support.robot_files import HEAVY, LEG, PLANAR, SEVEN, Link, urdf


def read(folder: Path, links: tuple[Link, ...], text: str = "", **options: object) -> RobotFile:
    file = folder / "arm.urdf"
    file.write_text(text or urdf("arm", links), "utf-8")
    return read_robot(file, Options(**options))  # type: ignore[arg-type]


def tip_height(found: RobotFile) -> float:
    """The tip over the first joint at home, [m]."""
    entry = found.entry
    assert entry.source is not None
    return entry.make(entry.parameters()).home[2] - entry.source.chain.bodies[0].translation[2]


def pose_guess(found: RobotFile) -> tuple[str, str]:
    ((code, line),) = [(g.message.code, g.line) for g in found.guesses if g.kind == "pose"]
    return code.removeprefix("robot_file."), line


@pytest.mark.parametrize("links", [SEVEN, HEAVY, LEG], ids=["seven", "heavy", "leg"])
def test_a_chosen_pose_has_room_for_a_tenth_of_its_length(
    tmp_path: Path, links: tuple[Link, ...]
) -> None:
    found = read(tmp_path, links)
    assert found.entry.source is not None
    assert found.circle >= 0.1 * length_of(found.entry.source.chain)


def test_the_line_of_a_chosen_pose_settles_it(tmp_path: Path) -> None:
    found = read(tmp_path, SEVEN)
    code, line = pose_guess(found)
    assert code == "guessed_pose"
    words = shlex.split(line)
    assert words[::2] == ["--pose"] * 7
    pose = {name: float(value) for name, value in (each.split("=") for each in words[1::2])}
    settled = read(tmp_path, SEVEN, pose=pose)
    assert settled.guesses == ()
    sources = found.entry.source, settled.entry.source
    assert sources[0] is not None and sources[1] is not None
    assert sources[1].home == pytest.approx(sources[0].home, rel=1e-3)


def test_a_first_joint_on_the_floor_is_no_matter(tmp_path: Path) -> None:
    """No pose can move its origin."""
    on_floor = (replace(SEVEN[0], at=(0, 0, 0)), *SEVEN[1:])
    assert pose_guess(read(tmp_path, on_floor))[0] == "guessed_pose"


def test_the_tip_of_a_leg_is_below_its_hip_and_that_of_an_arm_above_the_floor(
    tmp_path: Path,
) -> None:
    leg = read(tmp_path, LEG)
    assert pose_guess(leg)[0] == "guessed_pose" and tip_height(leg) < -0.05
    assert tip_height(read(tmp_path, SEVEN)) > -SEVEN[0].at[2]


@pytest.mark.thorough
def test_a_rule_that_forbids_all_is_given_up_and_said(tmp_path: Path) -> None:
    """An arm whose waist cannot turn its other joints to the front."""
    behind = [replace(each, at=(-2 * abs(each.at[0]) - 0.9, 0, each.at[2])) for each in SEVEN[1:2]]
    found = read(tmp_path, (replace(SEVEN[0], limit=0.3), *behind, *SEVEN[2:]))
    assert pose_guess(found)[0] == "guessed_pose_ahead"


def test_two_joints_draw_in_their_plane(tmp_path: Path) -> None:
    found = read(tmp_path, PLANAR[:2])
    assert found.entry.make(found.entry.parameters()).system.p == 2
    assert found.circle > 0.02


def test_a_last_joint_that_turns_the_tip_on_the_spot_leaves_it_in_its_plane(
    tmp_path: Path,
) -> None:
    roll = replace(PLANAR[2], axis=(1, 0, 0), at=PLANAR[1].end, end=PLANAR[2].end)
    found = read(tmp_path, (*PLANAR[:2], roll))
    made = found.entry.make(found.entry.parameters())
    assert (made.system.p, made.system.n) == (2, 3)


WRIST = tuple(replace(each, at=(0, 0, 0)) for each in SEVEN[:3])


@pytest.mark.parametrize(
    "code, links",
    [("single", PLANAR[:1]), ("two_across", SEVEN[:2]), ("no_pose", WRIST)],
    ids=["a single joint", "a camera's mount", "a wrist"],
)
def test_what_is_no_arm_is_refused_in_one_sentence(
    tmp_path: Path, code: str, links: tuple[Link, ...]
) -> None:
    with pytest.raises(CodedError) as caught:
        read(tmp_path, links)
    assert caught.value.message.code == f"robot_file.{code}"
    assert "--tip" in str(caught.value)


@pytest.mark.parametrize("folder", ["package://arm_parts", "."])
def test_a_far_end_that_needs_a_package_names_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, folder: str
) -> None:
    """The mesh of the last link is in another package, or of a kind that a package reads."""
    (tmp_path / "link2.stl").touch()
    lacking = [Hull(fault=LIBRARY)]
    monkeypatch.setattr(whole_chain, "hulls_of", lambda shapes: lacking * len(shapes))
    with pytest.raises(CodedError) as caught:
        read(tmp_path, PLANAR[:2], urdf("arm", PLANAR[:2], folder), tip="link2")
    line = INSTALL if folder == "." else "--package arm_parts=FOLDER"
    assert line in str(caught.value) and line in caught.value.message.text("de")


@pytest.mark.thorough
def test_motors_without_limits_are_said_to_be_unlimited(tmp_path: Path) -> None:
    text = urdf("arm", SEVEN)
    none = text.replace('effort="', 'effort="-1" old="')
    some = text.replace('effort="5"', 'effort="0"')
    for data, code in ((none, "guessed_efforts"), (some, "guessed_effort"), (text, "")):
        found = read(tmp_path, SEVEN, data)
        codes = [g.message.code for g in found.guesses if g.kind == "effort"]
        assert codes == ([f"robot_file.{code}"] if code else [])
        assert found.entry.source is not None and found.entry.source.guesses == found.guesses


def test_a_pose_is_chosen_that_the_motors_can_hold(tmp_path: Path) -> None:
    """Shoulders that cannot hold the arm stretched out give half of their torque at most."""
    weak = tuple(
        replace(each, effort=6.0 if i < 2 else each.effort) for i, each in enumerate(SEVEN)
    )
    entry = read(tmp_path, weak).entry
    robot, parameters = entry.make(entry.parameters()), entry.parameters()
    rest, bias = robot.rest(np.zeros(3)), robot.system.function("bias")
    held = np.array(bias(rest, np.zeros(7), robot.plant(parameters)))[:, 0]
    assert (np.abs(held) <= [0.5 * each.effort for each in weak]).all()


@pytest.mark.thorough
def test_the_same_file_has_the_same_pose(tmp_path: Path) -> None:
    homes = [read(tmp_path, SEVEN).entry.source for _ in range(2)]
    assert homes[0] is not None and homes[1] is not None
    assert np.array_equal(homes[0].home, homes[1].home)


@pytest.mark.thorough
def test_the_predefined_paths_of_a_small_robot_are_smaller(tmp_path: Path) -> None:
    """In experiments and path texts alike; they fit, and those of larger robots stay."""
    small = [
        replace(
            each,
            at=tuple(0.12 * x for x in each.at),
            end=tuple(0.12 * x for x in each.end),
            mass=0.1,
        )
        for each in SEVEN
    ]
    found = read(tmp_path, tuple(small))
    robot = found.entry.make(found.entry.parameters())
    assert found.circle < USUAL_RADIUS and 0.008 < robot.radius < found.circle
    assert found.entry.radius == robot.radius
    for name in ("circle", "segment"):
        design = presets(robot.radius)[name]
        assert curve_faults(robot.margin, design.curve) == []
        assert np.array_equal(
            curve_from_text(name, robot.radius).coefficients, design.curve.coefficients
        )
    ROBOTS[found.entry.name] = found.entry
    try:
        experiment = experiments(found.entry.name)["obstruction"]
    finally:
        del ROBOTS[found.entry.name]
    assert experiment.schedule.r == robot.radius
    large = read(tmp_path, SEVEN).entry
    assert large.radius == USUAL_RADIUS == FIVE_BAR.radius


def tree(root: str, chains: int, joints: int, name: str = "part") -> str:
    """A file with chains of links that leave its root."""
    parts = [f'<link name="{root}"/>']
    for i in range(chains):
        before = root
        for k in range(joints):
            link = f"{name}_{i}_{k}"
            parts.append(f'<link name="{link}"/>')
            parts.append(
                f'<joint name="j_{link}" type="revolute"><parent link="{before}"/>'
                f'<child link="{link}"/><origin xyz="0.1 0 0.1"/>'
                f'<axis xyz="{k % 2} {1 - k % 2} 0"/><limit lower="-1" upper="1"/></joint>'
            )
            before = link
    return f"<robot name='tree'>{''.join(parts)}</robot>"


@pytest.mark.parametrize(
    "code, text",
    [
        ("no_joints", tree("body", 0, 0)),
        ("single", tree("body", 4, 1, "rotor")),
        ("hand", tree("palm", 4, 4)),
        ("hand", tree("base", 2, 1, "finger")),
    ],
    ids=["a rigid body", "a drone with rotors", "a hand", "a gripper"],
)
def test_a_file_without_an_arm_or_leg_says_what_it_is(tmp_path: Path, code: str, text: str) -> None:
    with pytest.raises(CodedError) as caught:
        read(tmp_path, (), text)
    assert caught.value.message.code == f"robot_file.{code}"


def test_an_abdomen_in_the_middle_is_no_finger(tmp_path: Path) -> None:
    assert read(tmp_path, (), tree("pelvis", 1, 12, "middle_abdomen")).circle > 0


def test_the_legs_of_a_trunk_are_no_fingers(tmp_path: Path) -> None:
    assert read(tmp_path, (), tree("trunk", 4, 4)).circle > 0
