"""Common parts of robots with rigid links."""

from __future__ import annotations

from typing import Self

import casadi as ca
import numpy as np

from onpath.models.arrays import Array
from onpath.models.errors import Message
from onpath.models.paths.frames import Frame, Plane
from onpath.models.systems.drawing import Drawing
from onpath.models.systems.forces import Grip
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import ArmGeometry, BalancedLinkage

_PLANE, _GRIP, _DRAWING = Plane(), Grip(), Drawing()  # shared, because they are keys of caches


class RigidRobot:
    """Common parts of robots with rigid links."""

    __slots__ = ()

    @property
    def core(self) -> Self:
        """See `Robot.core`: itself."""
        return self

    @property
    def substeps(self) -> int:
        """See `Robot.substeps`."""
        return 1

    def is_calm(self, q: Array, v: Array) -> bool:
        """See `Robot.is_calm`."""
        return False

    def broken(self, q: ca.SX, v: ca.SX) -> ca.SX:
        """See `Robot.broken`: nothing is checked."""
        return ca.SX(0, 1)

    def reasons(self, q: Array | None, parameters: Parameters) -> tuple[Message, ...]:
        """See `Robot.reasons`: none."""
        return ()

    @property
    def geometry(self) -> ArmGeometry | None:
        """See `Robot.geometry`: none."""
        return None

    @property
    def grip(self) -> Grip:
        """See `Robot.grip`."""
        return _GRIP

    @property
    def linkage(self) -> BalancedLinkage | None:
        """See `Robot.linkage`."""
        return None

    @property
    def extra_fields(self) -> tuple[tuple[str, int], ...]:
        """See `Robot.extra_fields`: none."""
        return ()

    def extras(self, q: Array, v: Array, parameters: Parameters) -> dict[str, Array]:
        """See `Robot.extras`: none."""
        return {}

    def marks(self, q: ca.SX) -> ca.SX:
        """See `Robot.marks`: none."""
        return ca.SX(3, 0)


class PlanarRobot(RigidRobot):
    """Common parts of robots with rigid links that move in the vertical plane y = 0.

    The output space is that plane, and the end-point y = 0 lies at `home`.
    """

    __slots__ = ()

    @property
    def home(self) -> tuple[float, float]:
        """The end-point y = 0 in the robot's frame, (x, z), [m]."""
        raise NotImplementedError

    @property
    def frame(self) -> Frame:
        """See `Robot.frame`."""
        return _PLANE

    @property
    def drawing(self) -> Drawing:
        """See `Robot.drawing`: everything follows from the bars."""
        return _DRAWING

    def place(self, y: Array) -> Array:
        """See `Robot.place`."""
        x, z = self.home
        points = np.zeros((*y.shape[:-1], 3))
        points[..., 0], points[..., 2] = y[..., 0] + x, y[..., 1] + z
        return points

    def unplace(self, point: Array) -> Array:
        """See `Robot.unplace`."""
        return point[..., ::2] - np.array(self.home)
