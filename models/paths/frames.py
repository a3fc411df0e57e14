"""Where the planar curve lies in the output space.

A point y of the output space has planar coordinates z (2) and residuals zeta (p - 2) that vanish
on the plane of the path: none in the plane, y1 - b y2 - d for the slanted plane of eq. (23).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import casadi as ca
import numpy as np

from onpath.models.arrays import Array


class Frame(Protocol):
    """How planar curves are put into R^p; all maps are affine, so rates map alike."""

    @property
    def p(self) -> int:
        """Dimension of the output space."""
        ...

    def split(self, y: ca.SX, rate: bool = False) -> tuple[ca.SX, ca.SX]:
        """y -> (z, zeta), shapes (2, 1), (p - 2, 1); with `rate`, of a time derivative of y."""
        ...

    def join(self, z: ca.SX, zeta: ca.SX, rate: bool = False) -> ca.SX:
        """The inverse of `split`."""
        ...

    def planar(self, y: Array) -> Array:
        """z of points, shape (..., p) -> (..., 2), [m]."""
        ...

    def lift(self, z: Array) -> Array:
        """Points on the plane, shape (..., 2) -> (..., p), [m]."""
        ...


@dataclass(frozen=True, slots=True)
class Plane:
    """The output space is the plane itself, p = 2."""

    p: int = 2

    def split(self, y: ca.SX, rate: bool = False) -> tuple[ca.SX, ca.SX]:
        """See `Frame.split`."""
        return y, ca.SX(0, 1)

    def join(self, z: ca.SX, zeta: ca.SX, rate: bool = False) -> ca.SX:
        """See `Frame.join`."""
        return z

    def planar(self, y: Array) -> Array:
        """See `Frame.planar`."""
        return y

    def lift(self, z: Array) -> Array:
        """See `Frame.lift`."""
        return z


@dataclass(frozen=True, slots=True)
class SlantedPlane:
    """The plane y1 = b y2 + d in R^3, with z = (y2, y3). Source: eq. (23)."""

    b: float = 0.1
    d: float = 0.5  # [m]
    p: int = 3

    def split(self, y: ca.SX, rate: bool = False) -> tuple[ca.SX, ca.SX]:
        """See `Frame.split`."""
        return y[1:], y[0] - self.b * y[1] - (0.0 if rate else self.d)

    def join(self, z: ca.SX, zeta: ca.SX, rate: bool = False) -> ca.SX:
        """See `Frame.join`."""
        return ca.vertcat(zeta + self.b * z[0] + (0.0 if rate else self.d), z)

    def planar(self, y: Array) -> Array:
        """See `Frame.planar`."""
        return y[..., 1:]

    def lift(self, z: Array) -> Array:
        """See `Frame.lift`."""
        return np.concatenate([self.b * z[..., :1] + self.d, z], axis=-1)
