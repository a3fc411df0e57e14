"""A chain of rigid bodies as plain data; `rigid_chain.py` has its equations of motion.

Each body has one joint, which connects it to the body before it, and a frame at that joint whose
axis z is the joint's: it turns about z, or slides along z. A rotation E and a translation p place
the frame of body i in that of the body before it, for q_i = 0. All sums of mass are about the
origin of the body's frame: its mass m, the first moment m c, and the inertia

    I = -Σ dm [r] [r],   [r] s = r x s.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from onpath.models.arrays import Array


@dataclass(frozen=True, slots=True, eq=False)
class Joint:
    """A joint of a chain. Units: rad and N m for a turning, m and N for a sliding one.

    Attributes:
        name: as in the file.
        slides: whether it slides along its axis, instead of turning about it.
        low, high: of its coordinate; infinite without limits.
        effort: largest torque or force of its motor; infinite if the file names none.
        damping: viscous friction, [N m s/rad] or [N s/m].
        armature: inertia of the motor's rotor as seen at the joint, [kg m²] or [kg].
    """

    name: str
    slides: bool = False
    low: float = -math.inf
    high: float = math.inf
    effort: float = math.inf
    damping: float = 0.0
    armature: float = 0.0

    @property
    def unit(self) -> str:
        """Of what its motor gives."""
        return "N" if self.slides else "N m"


@dataclass(frozen=True, slots=True, eq=False)
class Shape:
    """What a file draws for a body: a mesh, or a simple solid about its own origin.

    Attributes:
        kind: "mesh", "box", "sphere", "cylinder" or "capsule", whose axis is z.
        file: absolute path of a mesh; empty if its triangles are given.
        size: edges of a box; radius, radius and length of a cylinder, and of the cylinder of a
            capsule; radii of a sphere or ellipsoid; scale of a mesh along its axes.
        rotation, translation: of the shape in its body's frame, (3, 3) and (3,), [m].
        triangles: vertices of a mesh, (k, 3), [m], and the indices of each triangle's, (l, 3).
    """

    kind: str
    file: str
    size: tuple[float, float, float]
    rotation: Array
    translation: Array
    triangles: tuple[Array, np.ndarray] | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """A moving body of a chain; see the module's docstring.

    Attributes:
        name: of its link in the file.
        joint: by which it moves.
        rotation, translation: E and p, shapes (3, 3) and (3,), [m].
        mass: [kg].
        moment: m c, shape (3,), [kg m].
        inertia: I, shape (3, 3), [kg m²].
        shapes: what is drawn of it.
    """

    name: str
    joint: Joint
    rotation: Array
    translation: Array
    mass: float
    moment: Array
    inertia: Array
    shapes: tuple[Shape, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class Chain:
    """A chain of bodies.

    Attributes:
        bodies: from the base on.
        tip: the end-point in the frame of the last body, shape (3,), [m].
        facing: direction of the tip's own axis z in the frame of the last body, shape (3,).
        base: what is drawn of the base, in its frame.
    """

    bodies: tuple[Body, ...]
    tip: Array
    facing: Array
    base: tuple[Shape, ...] = ()

    @property
    def joints(self) -> tuple[Joint, ...]:
        """The joints of the bodies."""
        return tuple(body.joint for body in self.bodies)

    @property
    def n(self) -> int:
        """Number of coordinates."""
        return len(self.bodies)

    @property
    def limits(self) -> tuple[Array, Array]:
        """Low and high ends of the coordinates, shape (n,) each, infinite without limits."""
        ends = np.array([(joint.low, joint.high) for joint in self.joints])
        return ends[:, 0], ends[:, 1]

    @property
    def limited(self) -> list[int]:
        """Numbers of the joints whose travel is limited."""
        return [i for i, joint in enumerate(self.joints) if joint.high - joint.low < math.inf]
