"""How the plane of the path lies in the output space.

A point y of the output space has planar coordinates z (2) and residuals ζ (p - 2) that are zero on
the plane of the path. For p = 2 there are no residuals; for the plane of eq. (23), ζ = y1 - b y2 -
d.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import casadi as ca
import numpy as np

from onpath.models.arrays import Array


class Frame(Protocol):
    """An affine map between the output space R^p and planar coordinates.

    Because the map is affine, time derivatives are mapped by its linear part: `rate=True`.
    """

    @property
    def p(self) -> int:
        """Dimension of the output space."""
        ...

    def split(self, y: ca.SX, rate: bool = False) -> tuple[ca.SX, ca.SX]:
        """y -> (z, ζ), shapes (p, 1) -> (2, 1), (p - 2, 1), [m].

        Args:
            rate: whether y is a time derivative, which is mapped without the constant offset.
        """
        ...

    def join(self, z: ca.SX, zeta: ca.SX, rate: bool = False) -> ca.SX:
        """The inverse of `split`: (z, ζ) -> y."""
        ...

    def planar(self, y: Array) -> Array:
        """Planar coordinates z of points y, shape (..., p) -> (..., 2), [m]."""
        ...

    def lift(self, z: Array) -> Array:
        """Points y of the plane (ζ = 0), shape (..., 2) -> (..., p), [m]."""
        ...


@dataclass(frozen=True, slots=True)
class Plane:
    """The output space is the plane of the path: p = 2 and z = y."""

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
    """The plane y1 = b y2 + d in R³, with z = (y2, y3) and ζ = y1 - b y2 - d.

    Attributes:
        b: slope.
        d: offset, [m].
        p: dimension of the output space.

    Source: eq. (23), with the paper's b and d.
    """

    b: float = 0.1
    d: float = 0.5
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
