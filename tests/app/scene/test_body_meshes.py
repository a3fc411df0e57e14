"""Bodies of robots from files: their frames, their meshes, and files that cannot be trusted."""

from __future__ import annotations

import logging
from pathlib import Path
from typing import Any

import casadi as ca
import numpy as np
import pytest
import trimesh

from onpath.app.scene.body_meshes import (
    DRAWN_TRIANGLES,
    MOST_DRAWN,
    body_meshes,
    keep_shapes,
    read_shapes,
)
from onpath.app.server.robot_shapes import prepare_shapes
from onpath.assets import asset_path
from onpath.models.robot_files.chain import Chain
from onpath.models.robot_files.file_chain import Options
from onpath.models.robot_files.urdf_file import read_urdf
from onpath.models.robot_files.xml_elements import root_of
from onpath.models.systems.rigid_chain import chain_frames, frame_poses, tip_of
from onpath.models.systems.robot_file import read_robot
from tests.support.robot_files import PLANAR, urdf
from tests.support.some_chains import random_arm


def chain_of(text: str, folder: Path = Path()) -> Chain:
    return read_urdf(folder / "arm.urdf", root_of(text.encode()), Options(tip="tip")).chain


@pytest.mark.parametrize("text", [urdf("planar", PLANAR), random_arm(2)], ids=["planar", "random"])
def test_the_quaternions_are_those_of_the_frames(text: str) -> None:
    """Rotated by them, the axes are the columns of the frames' rotations, at random angles."""
    chain = chain_of(text)
    q = ca.SX.sym("q", chain.n)
    places, turns = frame_poses(chain, q)
    frames = chain_frames(chain, q)
    function = ca.Function("frames", [q], [places, turns, *frames.rotations, *frames.origins])
    rng = np.random.default_rng(0)
    for _ in range(20):
        found, quaternions, *rest = (
            x.full() for x in function.call([ca.DM(rng.normal(size=chain.n))])
        )
        for i in range(chain.n):
            w, vector = quaternions[0, i], quaternions[1:, i]
            across = np.cross(vector, np.eye(3))
            rotated = np.eye(3) + 2 * (w * across + np.cross(vector, across))
            assert pytest.approx(rest[i], abs=1e-12) == rotated.T
            assert found[:, i] == pytest.approx(rest[chain.n + i][:, 0], abs=1e-12)


def test_bodies_without_a_mesh_reach_from_joint_to_joint_and_the_base_stands_on_the_floor() -> None:
    chain = chain_of(urdf("planar", PLANAR))
    meshes = body_meshes(chain)
    assert meshes.floor == pytest.approx(0.0, abs=1e-6)
    assert meshes.base.vertices[:, 2].max() > PLANAR[0].at[2]
    ends = [*(body.translation for body in chain.bodies[1:]), chain.tip]
    for mesh, end in zip(meshes.moving, ends, strict=True):
        along = mesh.vertices @ (end / np.linalg.norm(end))
        assert along.max() > np.linalg.norm(end) and along.min() < 0
        beside = np.ptp(mesh.vertices[:, 2])  # the bearing turns about z, and is wider than the rod
        assert beside == pytest.approx(np.ptp(mesh.vertices, axis=0).min(), abs=0.02)


@pytest.mark.thorough
@pytest.mark.parametrize("robot", ["planar_arm", "seven_axes"])
def test_the_tip_of_our_own_robots_is_at_the_end_of_their_last_mesh(robot: str) -> None:
    source = read_robot(asset_path(f"robots/{robot}.urdf"), Options()).entry.source
    assert source is not None
    chain, meshes = source.chain, body_meshes(source.chain)
    tip = tip_of(chain, chain_frames(chain, ca.SX(ca.DM(source.home))))
    q = np.array([source.home])
    corners = meshes.corners(chain, q)[-8:]
    point = ca.evalf(ca.densify(tip)).full()[:, 0]
    assert (corners.min(axis=0) - 0.02 < point).all() and (point < corners.max(axis=0) + 0.02).all()
    assert meshes.floor == pytest.approx(0.0, abs=1e-6)


def robot_with(folder: Path, **meshes: Any) -> Chain:
    """The planar arm whose first links have meshes of these names and contents."""
    (folder / "meshes").mkdir(exist_ok=True)
    text = urdf("planar", PLANAR)
    for i, (name, content) in enumerate(meshes.items(), 1):
        file = f"meshes/{name.replace('_', '.')}"
        (folder / file).write_bytes(content)
        visual = f'<visual><geometry><mesh filename="{file}"/></geometry></visual>'
        text = text.replace(f'<link name="link{i}">', f'<link name="link{i}">{visual}')
    return chain_of(text, folder)


@pytest.mark.thorough
def test_a_process_reads_meshes_and_leaves_out_what_it_cannot_read(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """A box is drawn as it is; garbage becomes a capsule, and is told."""
    box = trimesh.creation.box(extents=(0.2, 0.1, 0.1)).export(file_type="stl")
    chain = robot_with(tmp_path, good_stl=box, bad_stl=b"garbage" * 50)
    with caplog.at_level(logging.WARNING):
        prepare_shapes(chain)
    assert "bad.stl" in caplog.text and "good.stl" not in caplog.text
    meshes = body_meshes(chain)
    assert np.ptp(meshes.moving[0].vertices, axis=0).max() == pytest.approx(0.2)
    assert len(meshes.moving[1].faces) > 50


def test_large_meshes_are_simplified_or_left_out(tmp_path: Path) -> None:
    ball = trimesh.creation.icosphere(subdivisions=5, radius=0.1)
    assert len(ball.faces) > MOST_DRAWN
    chain = robot_with(tmp_path, ball_stl=ball.export(file_type="stl"))
    (mesh, *_), left_out = read_shapes(chain)[0][1:], read_shapes(chain)[1]
    if mesh is None:  # without the extra
        assert "onpath[meshes]" in left_out[0][1]
    else:
        assert len(mesh.faces) <= 1.1 * DRAWN_TRIANGLES
        assert np.linalg.norm(mesh.vertices, axis=1) == pytest.approx(0.1, abs=0.003)


def test_an_obj_file_cannot_name_other_files(tmp_path: Path) -> None:
    """Its material library and texture are not looked for."""
    (tmp_path / "meshes").mkdir()
    (tmp_path / "meshes" / "m.mtl").write_text("newmtl a\nmap_Kd secret.png\n")
    text = b"mtllib m.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
    shapes, left_out = read_shapes(robot_with(tmp_path, part_obj=text))
    assert left_out == [] and shapes[1] is not None and len(shapes[1].faces) == 1


def test_kept_shapes_are_drawn(tmp_path: Path) -> None:
    chain = robot_with(tmp_path, part_obj=b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    shapes, _ = read_shapes(chain)
    keep_shapes(chain, shapes)
    assert body_meshes(chain).moving[0] is shapes[1]


MJCF = """<mujoco><asset><mesh name="wedge" file="wedge.stl"/></asset><worldbody>
<geom type="plane" size="1 1 1"/><geom type="box" size=".1 .1 .05" pos="0 0 .05"/>
<body name="one" pos="0 0 .2"><joint name="j1" axis="0 1 0"/>
 <geom type="mesh" mesh="wedge" pos=".1 0 0" euler="0 0 30"/>
 <geom type="sphere" size=".5" group="3"/><geom type="sphere" size=".5" rgba="0 0 0 0"/>
 <body name="two" pos=".3 0 0"><joint name="j2" axis="0 1 0"/>
  <geom type="capsule" fromto="0 0 0 .2 0 0" size=".03"/>
  <geom type="ellipsoid" size=".02 .03 .05" pos=".2 0 0"/>
  <site name="tip" pos=".25 0 0"/></body></body></worldbody></mujoco>"""


@pytest.mark.thorough
def test_a_robot_from_mjcf_is_drawn_as_mujoco_draws_it(tmp_path: Path) -> None:
    """Vertices of its mesh are where MuJoCo has them, although it moves the mesh to its centre."""
    api: Any = pytest.importorskip("mujoco")
    wedge = np.array([[0, 0, 0], [0.1, 0, 0], [0, 0.05, 0], [0, 0, 0.08]])
    solid = trimesh.Trimesh(wedge, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    solid.export(tmp_path / "wedge.stl")
    file = tmp_path / "arm.xml"
    file.write_text(MJCF)
    entry = read_robot(file, Options(pose={"j1": -1.2, "j2": 1.5})).entry
    assert entry.source is not None
    chain, home = entry.source.chain, np.array(entry.source.home)
    prepare_shapes(chain)
    meshes = body_meshes(chain)
    assert meshes.base.vertices.max(axis=0) == pytest.approx([0.1, 0.1, 0.1])
    assert meshes.floor == pytest.approx(0.0)
    q = ca.SX.sym("q", chain.n)
    frames = chain_frames(chain, q)
    function = ca.Function("frames", [q], [*frames.rotations, *frames.origins])
    one, two, origin, other = (x.full() for x in function.call([ca.DM(home)]))
    data = api.MjData(model := api.MjModel.from_xml_path(str(file)))
    data.qpos[:] = home
    api.mj_forward(model, data)
    about = np.pi / 6  # "euler"
    turn = np.array([[np.cos(about), -np.sin(about)], [np.sin(about), np.cos(about)]])
    flat = np.column_stack([wedge[:, :2] @ turn.T + [0.1, 0], wedge[:, 2]])
    expected = flat @ data.body("one").xmat.reshape(3, 3).T + data.body("one").xpos
    found = meshes.moving[0].vertices @ one.T + origin[:, 0]
    nearest = np.linalg.norm(found[:, None] - expected, axis=2)
    assert nearest.min(axis=0).max() < 1e-6 and nearest.min(axis=1).max() < 1e-6
    end = meshes.moving[1].vertices @ two.T + other[:, 0] - data.body("two").xpos
    along = end @ data.body("two").xmat.reshape(3, 3)
    assert along.min(axis=0) == pytest.approx([-0.03, -0.03, -0.05], abs=2e-3)
    assert along.max(axis=0) == pytest.approx([0.23, 0.03, 0.05], abs=2e-3)
