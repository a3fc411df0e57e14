"""Which link is taken for the tip, which joints are locked, and what is said of it."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.models.robot_files.file_chain import MOST_JOINTS, FileChain, Options
from onpath.models.robot_files.tip_guess import MOST_TIPS
from onpath.models.robot_files.urdf_file import read_urdf
from onpath.models.robot_files.xml_elements import root_of
from tests.support.robot_files import PLANAR, urdf

MASS = '<inertial><mass value="0.5"/><inertia ixx="0.01" iyy="0.01" izz="0.01"/></inertial>'


def robot(*limbs: str) -> str:
    """A file of limbs: "parent: child child …"; what begins with "-" is fixed to what is before."""
    links, joints = ["base"], list[str]()
    for limb in limbs:
        before, _, names = limb.partition(":")
        for name in names.split():
            still, child = name.startswith("-"), name.lstrip("-")
            links.append(child)
            joints.append(
                f'<joint name="{child}_joint" type="{"fixed" if still else "revolute"}">'
                f'<parent link="{before}"/><child link="{child}"/><origin xyz="0 0 0.1"/>'
                '<axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="9" velocity="1"/></joint>'
            )
            before = child
    return (
        "<robot>"
        + "".join(f'<link name="{name}">{MASS}</link>' for name in links)
        + "".join(joints)
    )


def read(text: str, options: Options | None = None) -> FileChain:
    return read_urdf(Path("arm.urdf"), root_of(f"{text}</robot>".encode()), options or Options())


ARM = "base: a1 a2 a3 a4 a5 a6"
TORSO = "base: waist1 waist2 waist3"
TIPS = {
    "its only end": ([ARM], "a6"),
    "a tool's name": ([ARM + " -tool0", "a6: -zz_marker"], "tool0"),
    "before the fingers": ([ARM + " -palm", "palm: left_finger", "palm: right_finger"], "palm"),
    "before unnamed fingers": ([ARM, "a6: f1 f2", "a6: g1 g2", "a6: h1"], "a6"),
    "not a camera": ([ARM + " -flange", "a6: -camera_link -camera_optical_frame"], "flange"),
    "not a head": (["base: neck1 neck2 neck3 head", "base: arm1 arm2 arm3 hand"], "hand"),
    "an arm, not a leg": (["base: r_hip r_knee r_foot", "base: r_arm r_elbow r_hand"], "r_hand"),
    "the right one": (
        ["base: l_arm l_elbow l_hand", "base: r_arm r_elbow r_hand", "base: neck head"],
        "r_hand",
    ),
    "the longest": (["base: a1 a2 a3", "base: b1 b2 b3 b4", "base: wheel"], "b4"),
    "not its jaw": ([ARM, "a6: moving_jaw"], "a6"),
    "in words run together": ([ARM, "a6: -wristCamera", "a6: -EndEffector"], "EndEffector"),
}


@pytest.mark.parametrize("case", TIPS)
def test_the_tip_is(case: str) -> None:
    limbs, tip = TIPS[case]
    found = read(robot(*limbs))
    assert found.tips[0] == tip and len(found.tips) <= MOST_TIPS
    said = [guess.line for guess in found.guesses if guess.kind == "tip"]
    assert said == ([] if case == "its only end" else [f"--tip {tip}"])
    settled = read(robot(*limbs), Options(tip=tip))
    assert settled.tips[0] == tip and settled.chain.n == found.chain.n
    assert all(guess.kind != "tip" for guess in settled.guesses)


def test_both_arms_are_suggested_and_no_finger() -> None:
    limbs = [TORSO, "waist3: l1 l2 l3 -l_tool", "waist3: r1 r2 r3 -r_tool", "waist3: neck head"]
    found = read(robot(*limbs, "r_tool: r_finger", "l_tool: l_finger"))
    assert found.tips[:2] == ("r_tool", "l_tool")
    assert not {"r_finger", "l_finger", "head"} & {*found.tips}


@pytest.mark.parametrize("most", [MOST_JOINTS - 3, MOST_JOINTS - 1])
def test_a_long_way_begins_where_another_limb_branches_off(most: int) -> None:
    """The joints of an arm move, not the waist's; without another limb, the last ones do."""
    arm = " ".join(f"a{i}" for i in range(most))
    torso = "base: " + " ".join(f"w{i}" for i in range(6))
    branched = read(robot(torso, f"w5: {arm}", "w5: left1 left2"))
    assert [joint.name for joint in branched.chain.joints] == [f"a{i}_joint" for i in range(most)]
    alone = read(robot(torso, f"w5: {arm}"))
    assert alone.chain.n == MOST_JOINTS
    held = next(guess for guess in alone.guesses if guess.kind == "lock")
    assert held.line == " ".join(f"--lock w{i}_joint=0" for i in range(6 + most - MOST_JOINTS))
    locked = dict.fromkeys((f"w{i}_joint" for i in range(6 + most - MOST_JOINTS)), 0.0)
    assert read(robot(torso, f"w5: {arm}"), Options(lock=locked)).guesses == ()


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('type="revolute"', 'type="floating"'),
        ('type="revolute"', 'type="planar"'),
        ("</joint>", '<mimic joint="joint2"/></joint>'),
    ],
)
def test_joints_that_cannot_move_stay_and_it_is_said_once(old: str, new: str) -> None:
    text = urdf("arm", PLANAR * 2).replace(old, new, 1).removesuffix("</robot>\n")
    found = read(text)
    assert [joint.name for joint in found.chain.joints] == [f"joint{i}" for i in range(2, 7)]
    assert [guess.kind for guess in found.guesses] == ["lock"]
    assert all(found.guesses[0].message.text(language) for language in ("en", "de"))
    assert read(text, Options(lock={"joint1": 0.0})).guesses == ()


def test_limits_that_an_exporter_leaves_at_zero_are_none() -> None:
    """Both zero, as effort and speed; with an effort, the joint is meant to stay."""
    zero = 'lower="0" upper="0" effort="0" velocity="0"'
    text = robot(ARM).replace('lower="-1" upper="1" effort="9" velocity="1"', zero)
    found = read(text)
    assert found.chain.n == 6 and np.isinf(found.chain.limits).all()
    assert [guess.kind for guess in found.guesses] == ["lock"]
    still = text.replace('effort="0"', 'effort="9"', 2)
    assert [joint.name for joint in read(still).chain.joints] == [
        f"a{i}_joint" for i in (3, 4, 5, 6)
    ]


def ending(count: int, length: float, angle: float, frame: str) -> str:
    """An arm of some joints, whose last link draws a bar of a length, and what else it has."""
    joints = " ".join(f"a{i}" for i in range(1, count + 1))
    x, z = length * math.cos(angle), length * math.sin(angle)
    bar = (
        f'<visual><origin xyz="{x / 2!r} 0.01 {z / 2!r}" rpy="0 {math.pi / 2 - angle!r} 0"/>'
        f'<geometry><box size="0.02 0.03 {length!r}"/></geometry></visual>'
    )
    last = f'<link name="a{count}">'
    text = robot(f"base: {joints}").replace(last, last + bar)
    return text + (frame and frame.format(parent=f"a{count}", place=f"{x!r} 0.01 {z!r}"))


FRAME = (
    '<link name="end"/><joint name="end" type="fixed"><parent link="{parent}"/>'
    '<child link="end"/><origin xyz="{place}"/></joint>'
)


@settings(max_examples=20, deadline=None)
@given(count=st.integers(2, 3), length=st.floats(0.1, 0.9), angle=st.floats(-np.pi, np.pi))
def test_a_last_link_without_a_frame_ends_where_its_bar_does(
    count: int, length: float, angle: float
) -> None:
    found = read(ending(count, length, angle, ""))
    framed = read(ending(count, length, angle, FRAME))
    assert found.chain.tip == pytest.approx(framed.chain.tip, abs=1e-5)
    told = [guess for guess in found.guesses if guess.kind == "tip"]
    assert [f"of a{count}," in str(guess.message) for guess in told] == [True]
    told_place = re.search(r" at ([-+.e\d ]+) m ", str(told[0].message))
    place = [float(each) for each in told_place[1].split()] if told_place else []
    assert place == pytest.approx([length * np.cos(angle), 0.01, length * np.sin(angle)], abs=1e-3)
    assert not any(guess.kind == "tip" for guess in framed.guesses)
    named = read(ending(count, length, angle, ""), Options(tip=f"a{count}"))
    assert np.array_equal(named.chain.tip, found.chain.tip)


def test_a_tip_that_enough_joints_move_stays() -> None:
    found = read(ending(4, 0.3, 0.5, ""))
    assert found.guesses == () and not found.chain.tip.any()
