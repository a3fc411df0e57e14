"""Parts of robots are closed solids with split edges; trimesh judges that independently."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from onpath.app.scene import meshes
from onpath.app.scene.meshes import SHARP, Mesh

CRISP = ["link", "bearing", "motors", "base", "cross", "blade", "pedestal", "turntable"]


def judged(mesh: Mesh) -> trimesh.Trimesh:
    """The same mesh."""
    return trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)


@pytest.mark.parametrize("part", [*CRISP, "grip"])
def test_parts_are_solids_that_look_outward(part: str) -> None:
    mesh = judged(getattr(meshes, part)())
    mesh.merge_vertices()
    assert mesh.is_watertight and mesh.volume > 0.0


@pytest.mark.parametrize("part", CRISP)
def test_faces_share_their_vertices_where_edges_are_not_sharp(part: str) -> None:
    mesh = getattr(meshes, part)()
    whole = judged(mesh)
    whole.merge_vertices(digits_vertex=8)
    ours, theirs = mesh, trimesh.graph.smooth_shade(whole, angle=SHARP, facet_minarea=None)
    assert len(ours.vertices) == len(theirs.vertices)
    assert triangles(ours.corners) == triangles(theirs.triangles)


def triangles(corners: np.ndarray) -> list[list[list[float]]]:
    """Triangles in an order of their own, each beginning with its smallest corner."""
    found = []
    for corner in np.round(corners, 7).tolist():
        first = corner.index(min(corner))
        found.append(corner[first:] + corner[:first])
    return sorted(found)


@pytest.mark.parametrize("radius", [0.01, 1.0])
def test_a_ball_is_round(radius: float) -> None:
    ball = meshes.ball(radius)
    assert np.linalg.norm(ball.vertices, axis=1).max() == pytest.approx(radius)
    assert judged(ball).volume == pytest.approx(4 / 3 * np.pi * radius**3, rel=0.06)


def test_joined_parts_keep_their_triangles() -> None:
    one, other = meshes.ball(1.0), meshes.blade()
    corners = np.concatenate([one.corners, other.corners])
    np.testing.assert_array_equal(meshes.joined(one, other).corners, corners)
