"""Parts of robots are closed, look outward, and are smooth but for their edges."""

from __future__ import annotations

from collections import Counter
from functools import cache
from typing import Any

import numpy as np
import pytest
import trimesh

from onpath.app.lab import commands as c
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.scene import meshes
from onpath.app.scene.meshes import Mesh
from onpath.app.scene.part_shapes import SHARP, USUAL_LINK, all_parts
from onpath.app.scene.path_nodes import POINT_RADIUS
from onpath.app.scene.scene import Scene
from onpath.app.scene.stage_catalogue import stage_of
from onpath.app.viser_adapter.film_server import FilmServer
from onpath.models.systems.catalogue import ROBOTS
from tests.support.lab import do, new_lab

MOST_TRIANGLES = 23_000  # of all robots' parts in a scene: pages that draw in software are slow
MOST_BYTES = 100_000  # of the meshes that a page is sent, all copies counted once

made = cache(all_parts)
PARTS = sorted(made())


def judged(mesh: Mesh) -> trimesh.Trimesh:
    """The same mesh."""
    return trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)


def open_edges(mesh: Mesh) -> Counter[tuple[int, ...]]:
    """Directed edges that no neighbour runs along in the other direction.

    Solids that touch each other have edges in common, which are then there more often.
    """
    _, numbers = np.unique(np.round(mesh.vertices, 7), axis=0, return_inverse=True)
    faces = numbers.reshape(-1)[mesh.faces]
    edges = Counter(map(tuple, faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2).tolist()))
    return edges - Counter({(b, a): count for (a, b), count in edges.items()})


@pytest.mark.parametrize("part", PARTS)
def test_parts_are_closed_and_look_outward(part: str) -> None:
    mesh = meshes.part(part)
    assert open_edges(mesh) == Counter()
    assert judged(mesh).volume > 0.0
    assert judged(mesh).area_faces.min() > 0.0


def test_a_hole_would_be_noticed() -> None:
    ball = meshes.part("ball")
    assert len(open_edges(Mesh(ball.vertices, ball.faces[1:]))) == 3


@pytest.mark.parametrize("part", PARTS)
def test_the_file_has_the_parts_as_trimesh_makes_them(part: str) -> None:
    """If this fails, `python -m onpath.app.scene.part_shapes` writes the file anew."""
    read, wanted = judged(meshes.part(part)), made()[part]
    assert len(read.faces) == len(wanted.faces)
    np.testing.assert_allclose(read.bounds, wanted.bounds, atol=1e-6)
    assert read.area == pytest.approx(wanted.area, rel=1e-5)
    assert read.volume == pytest.approx(wanted.volume, rel=1e-5)


def corner_normals(mesh: Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Normals that the page gives the corners of each face, shape (k, 3, 3), and of the faces.

    Those of a vertex are the mean of its faces' normals, weighted by their areas.
    """
    a, b, c = mesh.vertices[mesh.faces].transpose(1, 0, 2).astype(float)
    doubled = np.cross(b - a, c - a)
    sums = np.zeros((len(mesh.vertices), 3))
    for corner in mesh.faces.T:
        np.add.at(sums, corner, doubled)

    def unit(vectors: np.ndarray) -> np.ndarray:
        return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)

    return unit(sums)[mesh.faces], unit(doubled)


@pytest.mark.parametrize("part", PARTS)
def test_no_sharp_edge_is_rounded_by_its_shading(part: str) -> None:
    mesh = meshes.part(part)
    shown = np.array([USUAL_LINK if part == "link" else 1.0, 1.0, 1.0])
    corners, faces = corner_normals(Mesh(mesh.vertices * shown, mesh.faces))
    assert (corners * faces[:, None]).sum(axis=-1).min() > np.cos(SHARP)


@pytest.mark.parametrize(("part", "radius", "axis"), [("motors", 0.026, 1), ("pedestal", 0.1, 2)])
def test_round_parts_are_shaded_as_round(part: str, radius: float, axis: int) -> None:
    mesh = meshes.part(part)
    corners, faces = corner_normals(mesh)
    out = mesh.vertices[mesh.faces].astype(float)
    out[..., axis] = 0.0
    is_outer = np.isclose(np.linalg.norm(out, axis=-1), radius, atol=1e-6)
    on_side = (is_outer & (np.abs(faces[:, axis, None]) < 1e-6)).all(axis=1)
    assert on_side.sum() > 30
    assert (corners * out)[on_side].sum(axis=-1).min() > radius * np.cos(np.radians(3.0))


@pytest.mark.parametrize("radius", [0.01, 1.0])
def test_a_ball_is_round(radius: float) -> None:
    ball = meshes.ball(radius)
    np.testing.assert_allclose(np.linalg.norm(ball.vertices, axis=1), radius, rtol=1e-6)
    assert judged(ball).volume == pytest.approx(4 / 3 * np.pi * radius**3, rel=0.06)


def test_a_link_is_as_long_as_the_bar_and_thin() -> None:
    low, high = judged(meshes.part("link")).bounds
    middle = (low[0] + high[0]) / 2, high[0] - low[0]
    assert middle == pytest.approx((0.5, 1.11), abs=2e-3)
    assert high[1] - low[1] == pytest.approx(meshes.LINK_THICKNESS)


@pytest.mark.parametrize("height", [meshes.FLOOR_DEPTH, 0.4])
def test_a_base_stands_on_its_floor_and_carries_the_pivot(height: float) -> None:
    base, usual = meshes.base(height), meshes.base()
    assert base.vertices[:, 2].min() == pytest.approx(-height)
    assert base.vertices[:, 2].max() == usual.vertices[:, 2].max()
    assert open_edges(base) == Counter()
    added = judged(base).volume - judged(usual).volume
    assert added == pytest.approx((height - meshes.FLOOR_DEPTH) * 0.024 * 0.072, rel=0.2, abs=1e-9)


@pytest.mark.parametrize("name", ROBOTS)
def test_a_scene_has_few_triangles_and_bytes(name: str) -> None:
    lab, studio = new_lab(), FilmServer()
    do(lab, c.ChooseRobot(name))
    stage = stage_of(lab.simulation.robot)
    scene = Scene(studio, stage)  # type: ignore[arg-type]
    scene.build(take_page_snapshot(lab, 1.0))
    nodes: list[Any] = list(studio.scene._handle_from_node_name.values())
    drawn = [node for node in nodes if hasattr(node, "batched_positions")]
    assert len(drawn) >= (6 if stage.parts() else 5)  # the hovercraft has no base
    assert sum(len(n.faces) * len(n.batched_positions) for n in drawn) <= MOST_TRIANGLES
    assert sum(n.faces.nbytes + n.vertices.nbytes for n in drawn) <= MOST_BYTES


def test_a_brake_is_open_at_its_ends_and_presses_from_both_sides() -> None:
    """A closed frame looked like an empty box."""
    guide = meshes.part("guide").vertices
    inner, outer = meshes.RAIL
    assert np.abs(guide[:, 0]).min() == pytest.approx(inner)  # the end-point's way is free
    for side in (-1, 1):
        jaw = guide[side * guide[:, 0] > 2 * outer]
        assert len(jaw) and np.abs(jaw[:, 2]).max() < 0.5 * guide[:, 2].max()


def test_a_grip_points_to_all_four_sides_and_is_before_a_control_point_in_it() -> None:
    grip = meshes.grip()
    begin, end, _ = meshes.ARROWHEAD
    for way in ((1, 0), (0, 1), (-1, 0), (0, -1)):
        at = end * np.array([way[0], 0.0, way[1]])
        found = np.linalg.norm((grip.vertices - at)[:, [0, 2]], axis=1) < 1e-9
        assert (grip.vertices[found, 1] < -POINT_RADIUS).all() and found.any()
    normals = judged(grip).face_normals
    assert (normals[:, 1] < 1e-6).all() and begin < meshes.GRIP[0]  # towards the viewer
