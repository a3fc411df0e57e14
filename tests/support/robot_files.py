"""Writes the robots of assets/robots: `python -m tests.support.robot_files`.

Each is a URDF file with meshes of its links, made by trimesh, and a file with the same meshes as
the lab draws them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from trimesh import Trimesh
from trimesh.creation import capsule, cylinder
from trimesh.transformations import rotation_matrix
from trimesh.util import concatenate

from onpath.assets import asset_path

Z = np.array([0.0, 0.0, 1.0])
ROUND = 16  # points of a circle


@dataclass(frozen=True)
class Link:
    """A moving link of an arm whose joints turn.

    Attributes:
        axis: of the joint before it, in the frame of the link before.
        at: origin of that joint in the frame of the link before, [m].
        end: where the link ends, in its own frame, [m].
        mass: of a rod from the joint to the end, [kg].
        limit: largest angle to either side, [rad]; infinite: none.
        effort: of the motor, [N m].
        damping: [N m s/rad].
        radius: of the link, [m].
        rotor: inertia of its motor, about any axis, [kg m²].
    """

    axis: tuple[float, float, float]
    at: tuple[float, float, float]
    end: tuple[float, float, float]
    mass: float
    limit: float
    effort: float
    damping: float
    radius: float
    rotor: float


PLANAR = (
    Link((0, -1, 0), (0, 0, 0.17), (0.15, 0, 0), 0.6, 3.0, 12.0, 0.02, 0.017, 0.004),
    Link((0, -1, 0), (0.15, 0, 0), (0.13, 0, 0), 0.4, 2.8, 6.0, 0.01, 0.015, 0.002),
    Link((0, -1, 0), (0.13, 0, 0), (0.09, 0, 0), 0.2, 2.8, 2.0, 0.004, 0.012, 0.001),
)
SEVEN = (
    Link((0, 0, 1), (0, 0, 0.06), (0, 0, 0.11), 1.2, 2.9, 40.0, 0.1, 0.034, 0.02),
    Link((0, 1, 0), (0, 0, 0.11), (0, 0, 0.11), 1.0, 2.1, 40.0, 0.1, 0.031, 0.02),
    Link((0, 0, 1), (0, 0, 0.11), (0, 0, 0.1), 0.8, 2.9, 25.0, 0.08, 0.029, 0.015),
    Link((0, 1, 0), (0, 0, 0.1), (0, 0, 0.11), 0.7, 2.3, 25.0, 0.05, 0.027, 0.01),
    Link((0, 0, 1), (0, 0, 0.11), (0, 0, 0.1), 0.5, 2.9, 10.0, 0.03, 0.025, 0.006),
    Link((0, 1, 0), (0, 0, 0.1), (0, 0, 0.05), 0.4, 2.1, 10.0, 0.02, 0.023, 0.005),
    Link((0, 0, 1), (0, 0, 0.05), (0, 0, 0.05), 0.2, 2.9, 5.0, 0.01, 0.016, 0.003),
)

HEAVY = (
    Link((0, 0, 1), (0, 0, 0.35), (0.35, 0, 0.40), 300.0, 3.2, 3000.0, 20.0, 0.2, 30.0),
    Link((0, 1, 0), (0.35, 0, 0.40), (0, 0, 1.25), 350.0, 2.5, 3000.0, 20.0, 0.15, 30.0),
    Link((0, 1, 0), (0, 0, 1.25), (0.90, 0, 0), 250.0, 3.6, 2000.0, 15.0, 0.15, 20.0),
    Link((1, 0, 0), (0.90, 0, 0), (0.25, 0, 0), 60.0, 6.0, 1000.0, 5.0, 0.1, 5.0),
    Link((0, 1, 0), (0.25, 0, 0), (0.15, 0, 0), 40.0, 2.2, 1000.0, 5.0, 0.1, 3.0),
    Link((1, 0, 0), (0.15, 0, 0), (0.1, 0, 0), 20.0, 6.0, 500.0, 2.0, 0.1, 1.0),
)
"""Of the size of a large industrial robot; not written, but for tests."""

LEG = (
    Link((1, 0, 0), (0.2, 0.1, 0), (0, 0.08, 0), 1.0, 0.8, 40.0, 0.1, 0.03, 0.01),
    Link((0, 1, 0), (0, 0.08, 0), (0, 0, -0.25), 1.0, 1.5, 40.0, 0.1, 0.03, 0.01),
    Link((0, 1, 0), (0, 0, -0.25), (0, 0, -0.25), 0.3, 2.5, 40.0, 0.1, 0.02, 0.01),
)
"""A leg of a quadruped whose root is its trunk; not written, but for tests."""


def urdf(name: str, links: Sequence[Link], meshes: str = "") -> str:
    """The file of an arm whose links are rods; the tip is the link "tip".

    Args:
        meshes: folder of the links' meshes; empty: none.
    """
    parts = [f'<link name="base">{_visual(meshes, "base")}</link>']
    before = "base"
    for i, link in enumerate(links, 1):
        parts += [_joint(i, link, before), _link(i, link, meshes)]
        before = f"link{i}"
    parts += [
        f'<joint name="flange" type="fixed"><parent link="{before}"/><child link="tip"/>'
        f'<origin xyz="{_numbers(links[-1].end)}"/></joint>',
        '<link name="tip"/>',
    ]
    body = "\n".join(f"  {part}" for part in parts)
    return f'<?xml version="1.0"?>\n<robot name="{name}">\n{body}\n</robot>\n'


def _numbers(values: Sequence[float] | np.ndarray) -> str:
    return " ".join(f"{value:g}" for value in values)


def _visual(folder: str, name: str) -> str:
    if not folder:
        return ""
    return f'<visual><geometry><mesh filename="{folder}/{name}.stl"/></geometry></visual>'


def _joint(i: int, link: Link, before: str) -> str:
    free = math.isinf(link.limit)
    ends = "" if free else f'lower="{-link.limit:g}" upper="{link.limit:g}" '
    kind = "continuous" if free else "revolute"
    return (
        f'<joint name="joint{i}" type="{kind}"><parent link="{before}"/><child link="link{i}"/>'
        f'<origin xyz="{_numbers(link.at)}"/><axis xyz="{_numbers(link.axis)}"/>'
        f'<limit {ends}effort="{link.effort:g}" velocity="6"/>'
        f'<dynamics damping="{link.damping:g}"/></joint>'
    )


def _link(i: int, link: Link, meshes: str) -> str:
    length = float(np.linalg.norm(link.end))
    across = link.mass * (length**2 / 12 + link.radius**2 / 4)
    along = link.mass * link.radius**2 / 2
    moments = link.rotor + np.where(np.abs(np.array(link.end)) > 0, along, across)
    inertia = " ".join(
        f'{key}="{value:.4g}"' for key, value in zip(("ixx", "iyy", "izz"), moments, strict=True)
    )
    inertia += ' ixy="0" ixz="0" iyz="0"'
    return (
        f'<link name="link{i}"><inertial><origin xyz="{_numbers(np.array(link.end) / 2)}"/>'
        f'<mass value="{link.mass:g}"/><inertia {inertia}/></inertial>'
        f"{_visual(meshes, f'link{i}')}</link>"
    )


def solid_of(parts: Sequence[Trimesh]) -> Trimesh:
    """One mesh of several."""
    solid = concatenate(list(parts))
    assert isinstance(solid, Trimesh)
    return solid


def housing(link: Link) -> Trimesh:
    """A bearing about the joint's axis."""
    radius = 1.25 * link.radius
    solid = cylinder(radius, height=2.3 * link.radius, sections=ROUND)
    axis = np.array(link.axis, dtype=float)
    if abs(axis[2]) < 1:
        solid.apply_transform(rotation_matrix(np.pi / 2, np.cross(Z, axis)))
    return solid


def bar(link: Link) -> Trimesh:
    """A rod with round ends from the joint to the end of the link."""
    end = np.array(link.end, dtype=float)
    length = float(np.linalg.norm(end))
    solid = capsule(height=length, radius=link.radius, count=[ROUND, 6])
    solid.apply_translation([0, 0, length / 2])
    direction = end / length
    if abs(direction[2]) < 1:
        solid.apply_transform(rotation_matrix(np.pi / 2, np.cross(Z, direction)))
    return solid


def foot(links: Sequence[Link]) -> Trimesh:
    """A plate on the floor and a column below the first joint."""
    first = links[0]
    height = first.at[2]
    plate = cylinder(2.2 * first.radius, height=0.014, sections=2 * ROUND)
    plate.apply_translation([0, 0, 0.007])
    column = cylinder(1.3 * first.radius, height=height, sections=2 * ROUND)
    column.apply_translation([0, 0, height / 2])
    return solid_of([plate, column])


def meshes(links: Sequence[Link]) -> dict[str, Trimesh]:
    """The meshes of an arm's links by name."""
    made = {"base": foot(links)}
    for i, link in enumerate(links, 1):
        made[f"link{i}"] = solid_of([housing(link), bar(link)])
    return made


def write(folder: Path, name: str, links: Sequence[Link]) -> None:
    """Write the file of an arm, and a folder of its meshes."""
    (folder / name).mkdir(parents=True, exist_ok=True)
    for link, mesh in meshes(links).items():
        mesh.export(folder / name / f"{link}.stl")
    (folder / f"{name}.urdf").write_text(urdf(name, links, name), "utf-8")


if __name__ == "__main__":
    for arm, parts in (("planar_arm", PLANAR), ("seven_axes", SEVEN)):
        turning = [replace(link, limit=math.inf) for link in parts]  # a pull must not stop them
        write(asset_path(".") / "robots", arm, turning)
