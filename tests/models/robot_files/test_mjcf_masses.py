"""Masses of an MJCF file that says nothing of them, or only of some."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.models.errors import CodedError
from onpath.models.robot_files.chain import Body
from onpath.models.robot_files.file_chain import Options
from onpath.models.systems.robot_file import RobotFile, read_robot

pytest.importorskip("mujoco")
STATED = {
    "": "",
    "a mass": 'mass="0.7"',
    "a density": 'density="300"',
    "an inertial": '<inertial pos="0.01 0 0.1" mass="0.4" diaginertia="0.01 0.012 0.008"/>',
}
"""What a body says of how heavy it is, as attributes of its geom or an element beside it."""


def arm(bodies: list[str], **usual: float) -> str:
    """An arm in a plane of one link for each entry of `bodies`, which are keys of `STATED`.

    Args:
        usual: attributes that every geom has which says nothing.
    """
    said = "".join(f' {name}="{value:.17g}"' for name, value in usual.items())
    inner = '<site name="tip" pos="0 0 0.2"/>'
    for i, each in reversed([*enumerate(bodies)]):
        beside = STATED[each] if each == "an inertial" else ""
        own = said if not each else "" if beside else f" {STATED[each]}"
        inner = (
            f'<body name="link{i}" pos="0 0 0.2"><joint name="joint{i}" axis="0 1 0"/>{beside}'
            f'<geom type="capsule" fromto="0 0 0.02 0.03 0 0.18" size="0.0{i + 2}"{own}/>'
            f"{inner}</body>"
        )
    return f"<mujoco><worldbody>{inner}</worldbody></mujoco>"


def read(folder: Path, text: str, **options: Any) -> RobotFile:
    file = folder / "arm.xml"
    file.write_text(text, "utf-8")
    pose = {f"joint{i}": 0.6 * (i + 1) for i in range(text.count("<joint"))}
    return read_robot(file, Options(tip="tip", pose=pose, **options))


def bodies_of(robot: RobotFile) -> tuple[Body, ...]:
    assert robot.entry.source is not None
    return robot.entry.source.chain.bodies


def are_equal(one: RobotFile, other: RobotFile) -> bool:
    return all(
        np.allclose(getattr(a, name), getattr(b, name), rtol=1e-9, atol=1e-12)
        for a, b in zip(bodies_of(one), bodies_of(other), strict=True)
        for name in ("mass", "moment", "inertia")
    )


kinds = st.lists(st.sampled_from([*STATED]), min_size=2, max_size=4)


@pytest.mark.thorough
@settings(max_examples=6, deadline=None)
@given(bodies=kinds, density=st.floats(50.0, 9000.0))
def test_a_density_acts_as_if_the_file_said_it(
    tmp_path_factory: pytest.TempPathFactory, bodies: list[str], density: float
) -> None:
    folder = tmp_path_factory.mktemp("arm")
    given_here = read(folder, arm(bodies), density=density)
    assert are_equal(given_here, read(folder, arm(bodies, density=density)))


@pytest.mark.thorough
@settings(max_examples=6, deadline=None)
@given(bodies=kinds, more=st.floats(0.1, 50.0))
def test_a_mass_is_that_of_all_that_moves_and_stated_ones_stay(
    tmp_path_factory: pytest.TempPathFactory, bodies: list[str], more: float
) -> None:
    folder = tmp_path_factory.mktemp("arm")
    usual = read(folder, arm(bodies))
    stated = sum(b.mass for b, said in zip(bodies_of(usual), bodies, strict=True) if said)
    found = read(folder, arm(bodies), mass=stated + more)
    if "" in bodies:
        assert sum(body.mass for body in bodies_of(found)) == pytest.approx(stated + more)
        with pytest.raises(CodedError):
            read(folder, arm(bodies), mass=0.999 * stated)
    for before, after, said in zip(bodies_of(usual), bodies_of(found), bodies, strict=True):
        assert not said or before.mass == after.mass


@pytest.mark.parametrize("bodies", [["", "a mass"], ["a density", "an inertial"], ["", ""]])
def test_what_is_weighed_is_said_and_its_line_settles_it(tmp_path: Path, bodies: list[str]) -> None:
    robot = read(tmp_path, arm(bodies))
    said = [guess for guess in robot.guesses if guess.kind == "mass"]
    names = ", ".join(f"link{i}" for i, each in enumerate(bodies) if not each)
    assert [str(guess.message).endswith(names) for guess in said] == [True] * ("" in bodies)
    assert all(guess.line == "" for guess in read(tmp_path, arm(bodies), density=1000.0).guesses)


def test_the_mass_of_a_dummy_is_that_of_what_is_drawn(tmp_path: Path) -> None:
    """MuJoCo takes 1e-15 kg, with which no arm can be simulated."""
    dummy = arm(["a mass", "an inertial"]).replace('mass="0.4"', 'mass="1e-15"')
    robot = read(tmp_path, dummy)
    assert [str(guess.message).endswith("link1") for guess in robot.guesses[:1]] == [True]
    length, radius = float(np.hypot(0.03, 0.16)), 0.03
    volume = np.pi * radius**2 * (length + 4 / 3 * radius)
    assert 0.9 * volume < bodies_of(robot)[1].mass / 1000 < volume  # a polyhedron in the capsule


def test_bodies_of_meshes_that_are_not_there_are_weighed_as_capsules(tmp_path: Path) -> None:
    """As in a URDF file; what MuJoCo gets for them is no mass."""
    drawn = re.sub('<geom type="capsule"[^>]*>', '<geom type="mesh" mesh="m"/>', arm(["", ""]))
    assets = '<asset><mesh name="m" file="no.stl"/></asset><worldbody>'
    robot = read(tmp_path, drawn.replace("<worldbody>", assets))
    assert min(body.mass for body in bodies_of(robot)) > 0.01
    assert [guess.kind for guess in robot.guesses if guess.kind == "mass"] == ["mass"]
    assert ["no.stl" in str(remark) for remark in robot.remarks] == [True]


KEYS = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")


def urdf(inertia: list[float]) -> str:
    """The arm of `arm(["a mass", "an inertial"])` with another inertia of its last link."""
    links, before = '<link name="world"/>', "world"
    for name, six in {"link0": [1.0, 1.0, 1.0], "link1": inertia}.items():
        moments = " ".join(f'{key}="{value!r}"' for key, value in zip(KEYS, six, strict=False))
        links += (
            f'<link name="{name}"><inertial><origin xyz="0.01 0 0.1"/><mass value="0.4"/>'
            f"<inertia {moments}/></inertial></link>"
            f'<joint name="{name.replace("link", "joint")}" type="continuous">'
            f'<parent link="{before}"/><child link="{name}"/><origin xyz="0 0 0.2"/>'
            '<axis xyz="0 1 0"/></joint>'
        )
        before = name
    return (
        f'<robot name="arm">{links}<link name="tip"/><joint name="end" type="fixed">'
        f'<parent link="{before}"/><child link="tip"/><origin xyz="0 0 0.2"/></joint></robot>'
    )


moments, products = (
    st.lists(st.floats(least, 0.02), min_size=3, max_size=3) for least in (1e-4, -0.02)
)


@pytest.mark.thorough
@settings(max_examples=5, deadline=None)
@given(st.one_of(moments, st.builds(list.__add__, moments, products)))
def test_an_inertia_of_no_body_is_taken_as_in_a_urdf_file(
    tmp_path_factory: pytest.TempPathFactory, inertia: list[float]
) -> None:
    folder = tmp_path_factory.mktemp("arm")
    kind = "full" if len(inertia) == 6 else "diag"
    said = f'{kind}inertia="{" ".join(map(repr, inertia))}"'
    text = arm(["a mass", "an inertial"]).replace('diaginertia="0.01 0.012 0.008"', said)
    file = folder / "arm.urdf"
    file.write_text(urdf(inertia), "utf-8")
    robot = read(folder, text)
    peer = read_robot(file, Options(tip="tip", pose={"joint0": 0.6, "joint1": 1.2}))
    one, other = bodies_of(robot)[1], bodies_of(peer)[1]
    assert np.allclose(one.inertia, other.inertia, rtol=1e-9, atol=1e-12)
    repaired, repaired_there = (
        [str(guess.message) for guess in each.guesses if guess.kind == "inertia"]
        for each in (robot, peer)
    )
    assert repaired == repaired_there


@pytest.mark.thorough
def test_another_mesh_is_another_robot(tmp_path: Path) -> None:
    """The same file, whose mesh is another one of the same size."""
    mesh = '<geom type="mesh" mesh="link"/>'
    text = arm(["", ""]).replace("<worldbody>", '<asset><mesh file="link.stl"/></asset><worldbody>')
    text = text.replace('<site name="tip"', f'{mesh}<site name="tip"')
    names = set[str]()
    for sections in (8, 12, 8):
        trimesh.creation.cylinder(0.02, 0.1, sections=sections).export(tmp_path / "link.stl")
        names.add(read(tmp_path, text).entry.name)
    assert len(names) == 2
