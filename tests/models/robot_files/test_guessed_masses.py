"""Masses and inertias that a file leaves out, or that no body has."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import casadi as ca
import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.models.arrays import Array
from onpath.models.errors import CodedError
from onpath.models.robot_files import file_masses
from onpath.models.robot_files.chain import Chain, Shape
from onpath.models.robot_files.file_chain import FileChain, Options
from onpath.models.robot_files.file_masses import repaired
from onpath.models.robot_files.hull_process import LIBRARY, Hull
from onpath.models.robot_files.urdf_file import read_urdf
from onpath.models.robot_files.xml_elements import root_of, safe_name
from onpath.models.systems.rigid_chain import (
    bias_forces,
    chain_frames,
    chain_inertias,
    mass_matrix,
    tip_of,
)
from onpath.models.systems.robot_file import read_robot
from onpath.models.systems.system import GRAVITY
from tests.support.random_trees import Tree, random_trees, tree_urdf
from tests.support.robot_files import PLANAR, urdf

STATED = urdf("arm", PLANAR)
BARE = re.sub("<inertial>.*?</inertial>", "", STATED)
SPHERE = '<visual><geometry><sphere radius="0.05"/></geometry></visual>'
JOINTS = [f"joint{i + 1}" for i in range(len(PLANAR))]
DUMMY = '<inertial><mass value="{}"/><inertia ixx="{}" iyy="{}" izz="{}"/></inertial>'


def read(text: str, options: Options | None = None) -> FileChain:
    return read_urdf(Path("arm.urdf"), root_of(text.encode()), options or Options())


def masses(text: str, options: Options | None = None) -> list[float]:
    return [body.mass for body in read(text, options).chain.bodies]


def kinds(text: str, options: Options | None = None) -> list[str]:
    return [guess.kind for guess in read(text, options).guesses]


def equations(chain: Chain, q: Sequence[float], v: Sequence[float]) -> tuple[Array, Array, Array]:
    """M, c and the tip."""
    symbols, rates, one = ca.SX.sym("q", chain.n), ca.SX.sym("v", chain.n), ca.SX(1)
    frames = chain_frames(chain, symbols)
    sums = chain_inertias(chain, one, ca.SX(0))
    mass = mass_matrix(chain, frames, sums, one)
    bias = bias_forces(chain, frames, sums, sums, rates)
    found = ca.Function("all", [symbols, rates], [mass, bias, tip_of(chain, frames)])(q, v)
    m, c, tip = (np.array(part) for part in found)
    return m, c[:, 0], tip[:, 0]


def of_mujoco(tree: Tree, joints: Sequence[str], q: Array, v: Array) -> tuple[Array, Array, Array]:
    """The same of MuJoCo, for some joints; the others stand still at 0."""
    api: Any = pytest.importorskip("mujoco")
    spec = api.MjSpec.from_string(tree_urdf(tree, plain=True))
    spec.compiler.fusestatic, spec.compiler.discardvisual = False, False
    spec.compiler.balanceinertia = True
    model = spec.compile()
    model.opt.gravity, model.opt.disableflags = (0, 0, -GRAVITY), 0x10 | 0x8
    data = api.MjData(model)
    at = [model.joint(name).dofadr[0] for name in joints]
    data.qpos[at], data.qvel[at] = q, v
    api.mj_forward(model, data)
    full = np.zeros((model.nv, model.nv))
    api.mj_fullM(model, data, full)
    tip = data.body(f"link{len(tree.links) - 1}").xpos.copy()
    return full[np.ix_(at, at)], data.qfrc_bias[at].copy(), tip


@settings(deadline=None, max_examples=12)
@given(random_trees(), st.integers(0, 99))
def test_random_trees_are_those_of_mujoco(tree: Tree, seed: int) -> None:
    """M, c and the tip, whatever their names; some or all without masses, which boxes give."""
    last = len(tree.links) - 1
    chain = read(tree_urdf(tree), Options(tip=safe_name(tree.links[last].name))).chain
    joints = [f"joint{i}" for i in tree.way(last)]
    rng = np.random.default_rng(seed)
    q, v = rng.uniform(-1, 1, (2, chain.n))
    expected = of_mujoco(tree, joints, q, v)
    for own, peer in zip(equations(chain, q.tolist(), v.tolist()), expected, strict=True):
        assert np.abs(own - peer).max() < 1e-4 * max(1.0, float(np.abs(peer).max()))


symmetric = st.lists(st.floats(-1, 1), min_size=6, max_size=6).map(
    lambda x: np.array([[x[0], x[3], x[4]], [x[3], x[1], x[5]], [x[4], x[5], x[2]]])
)


@given(symmetric)
def test_a_repaired_inertia_is_one_of_a_body_and_a_good_one_stays(inertia: Array) -> None:
    found = repaired(inertia)
    low, middle, high = np.linalg.eigvalsh(found)
    assert low >= -1e-9 and low + middle >= high - 1e-9
    assert np.abs(repaired(found) - found).max() < 1e-9


def test_masses_of_the_file_are_kept_and_nothing_is_said() -> None:
    assert masses(STATED) == pytest.approx([0.6, 0.4, 0.2]) and kinds(STATED) == []
    assert read(STATED).rests == ""


@pytest.mark.parametrize("dummy", [("1e-15",) * 4, ("0",) * 4, ("1",) * 4, ("1.0",) * 4])
def test_dummies_are_no_masses(dummy: tuple[str, ...]) -> None:
    dummies = re.sub("<inertial>.*?</inertial>", DUMMY.format(*dummy), STATED)
    assert masses(dummies) == masses(BARE) and kinds(dummies) == ["mass"]


def test_density_and_mass_scale_what_is_guessed() -> None:
    light, heavy = masses(BARE, Options(density=500)), masses(BARE, Options(density=2000))
    assert heavy == pytest.approx([4 * mass for mass in light], rel=1e-4)
    assert sum(masses(BARE, Options(mass=7.5))) == pytest.approx(7.5, rel=1e-4)
    one = STATED.replace('<mass value="0.6"/>', '<mass value="0"/>').replace(
        '<link name="link1">', f'<link name="link1">{SPHERE}'
    )
    assert masses(one, Options(mass=1.0)) == pytest.approx([0.4, 0.4, 0.2], rel=1e-4)
    with pytest.raises(CodedError) as caught:
        read(one, Options(mass=0.5))
    assert "0.6 kg" in str(caught.value) and caught.value.message.text("de")


def test_what_is_drawn_is_weighed_then_what_is_solid_then_capsules() -> None:
    ball = 4 / 3 * np.pi * 0.05**3 * 1000
    drawn = BARE.replace('<link name="link1">', f'<link name="link1">{SPHERE}')
    solid = drawn.replace("visual>", "collision>")
    assert masses(drawn)[0] == pytest.approx(ball, rel=0.05)
    assert masses(solid) == masses(drawn)
    assert masses(BARE)[0] != pytest.approx(ball, rel=0.05) and min(masses(BARE)) > 0


def test_a_body_without_mass_between_two_with_some_stays_so() -> None:
    """Joints that meet in a point have nothing between them."""
    between = re.sub('(name="link2">)<inertial>.*?</inertial>', r"\1", STATED, count=1)
    assert masses(between) == pytest.approx([0.6, 0, 0.2]) and kinds(between) == []
    last = re.sub('(name="link3">)<inertial>.*?</inertial>', r"\1", STATED, count=1)
    assert min(masses(last)) > 0 and kinds(last) == ["mass"]


def test_a_mass_without_inertia_is_a_solid_of_this_mass() -> None:
    points = re.sub("<inertia .*?/>", "", STATED)
    found = read(points)
    assert [guess.kind for guess in found.guesses] == ["inertia"]
    assert [body.mass for body in found.chain.bodies] == pytest.approx([0.6, 0.4, 0.2])
    assert all(np.linalg.eigvalsh(body.inertia)[0] > 0 for body in found.chain.bodies)


def test_an_impossible_inertia_is_repaired_and_said_once() -> None:
    wrong = re.sub('ixx="[^"]*"', 'ixx="-0.01"', STATED)
    (guess,) = read(wrong).guesses
    assert guess.kind == "inertia" and "link1, link2, link3" in str(guess.message)


def test_the_name_says_on_what_the_motion_rests(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Equal files and options have equal names; with other guessed numbers, they differ."""
    file = tmp_path / "arm.urdf"
    file.write_text(BARE.replace('<link name="link1">', f'<link name="link1">{SPHERE}'))
    pose = {f"joint{i + 1}": x for i, x in enumerate((2.0, -1.3, -0.9))}

    def name(density: float | None = None) -> str:
        return read_robot(file, Options(pose=pose, density=density)).entry.name

    own = name()
    assert name() == own and name(density=900) != own
    hulls = file_masses.hulls_of

    def without(shapes: Sequence[Shape]) -> list[Hull]:
        drawn = [shape.kind == "sphere" and shape.size[0] == 0.05 for shape in shapes]
        return [
            Hull(fault=LIBRARY) if missing else hull
            for missing, hull in zip(drawn, hulls(shapes), strict=True)
        ]

    monkeypatch.setattr(file_masses, "hulls_of", without)
    lacking = read_robot(file, Options(pose=pose))
    assert lacking.entry.name != own
    assert any("pip install" in guess.line for guess in lacking.guesses)


@pytest.mark.thorough
def test_another_mesh_is_another_robot_exactly_where_it_is_weighed(tmp_path: Path) -> None:
    """The same file, with another mesh of about the same size."""
    visual = '<visual><geometry><mesh filename="link.stl"/></geometry></visual></link>'
    for text, count in ((BARE, 2), (STATED, 1)):
        file = tmp_path / "arm.urdf"
        file.write_text(
            re.sub("<visual>.*?</visual>", "", text).replace("</link>", visual), "utf-8"
        )
        names = set[str]()
        for sections in (8, 12, 8):
            trimesh.creation.cylinder(0.02, 0.1, sections=sections).export(tmp_path / "link.stl")
            names.add(read_robot(file, Options(pose=dict.fromkeys(JOINTS, 0.7))).entry.name)
        assert len(names) == count
