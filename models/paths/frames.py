"""How the plane of the path lies in the output space.

A point y of the output space has planar coordinates z (2) and residuals ζ (p - 2) that are zero on
the plane of the path. For p = 2 there are no residuals; for the plane of eq. (23), ζ = y1 - b y2 -
d. A space curve (z(θ), ζ(θ)) rises above the plane by ζ; z(θ) is its plan view.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, Self

import casadi as ca
import numpy as np
from typing_extensions import override

from onpath.models.arrays import Array


class PlaneCoordinates(Protocol):
    """An affine map between the output space R^p and planar coordinates, for symbols.

    Because the map is affine, time derivatives are mapped by its linear part: `rate=True`.

    Attributes:
        p: dimension of the output space.
    """

    p: int

    def split(self, y: ca.SX, rate: bool = False) -> tuple[ca.SX, ca.SX]:
        """y -> (z, ζ), shapes (p, 1) -> (2, 1), (p - 2, 1), [m].

        Args:
            rate: whether y is a time derivative, which is mapped without the constant offset.
        """
        ...

    def join(self, z: ca.SX, zeta: ca.SX, rate: bool = False) -> ca.SX:
        """The inverse of `split`: (z, ζ) -> y."""
        ...


class Frame(PlaneCoordinates, Protocol):
    """The plane of the path: its coordinates, also for arrays, and its position."""

    def planar(self, y: Array) -> Array:
        """Planar coordinates z of points y, shape (..., p) -> (..., 2), [m]."""
        ...

    def lift(self, z: Array) -> Array:
        """Points y of the plane (ζ = 0), shape (..., 2) -> (..., p), [m].

        Points (z, ζ) of a space curve, shape (..., 3), are lifted to their heights ζ.
        """
        ...

    @property
    def numbers(self) -> tuple[float, float, float]:
        """The numbers b, d and the centre of a plane that the user can move; else zeros."""
        ...

    def at(self, numbers: ca.SX) -> PlaneCoordinates:
        """The coordinates of such a plane with other numbers, symbols (3, 1)."""
        ...

    @property
    def axes(self) -> tuple[int, int]:
        """Numbers of the output coordinates that are those of z, counted from 1."""
        ...

    @property
    def space(self) -> Frame | None:
        """The frame of space curves, whose z is (z, ζ); None if the robot takes none.

        Distances in (z, ζ) must be those in the output space.
        """
        ...


class _FixedPlane(Frame, Protocol):
    """Common parts of frames that the user cannot move; z consists of y1 and y2."""

    @property
    @override
    def numbers(self) -> tuple[float, float, float]:
        return 0.0, 0.0, 0.0

    @override
    def at(self, numbers: ca.SX) -> Self:
        return self

    @property
    @override
    def axes(self) -> tuple[int, int]:
        return 1, 2


@dataclass(frozen=True, slots=True)
class Plane(_FixedPlane):
    """The output space is the plane of the path: p = 2 and z = y."""

    p: int = 2

    @override
    def split(self, y: ca.SX, rate: bool = False) -> tuple[ca.SX, ca.SX]:
        return y, ca.SX(0, 1)

    @override
    def join(self, z: ca.SX, zeta: ca.SX, rate: bool = False) -> ca.SX:
        return z

    @override
    def planar(self, y: Array) -> Array:
        return y

    @override
    def lift(self, z: Array) -> Array:
        return z

    @property
    @override
    def space(self) -> None:
        return  # the output space has no third dimension


@dataclass(frozen=True, slots=True)
class LevelPlane(_FixedPlane):
    """The horizontal plane y3 = 0 in R³, with z = (y1, y2) and the height ζ = y3."""

    p: int = 3

    @override
    def split(self, y: ca.SX, rate: bool = False) -> tuple[ca.SX, ca.SX]:
        return y[:2], y[2]

    @override
    def join(self, z: ca.SX, zeta: ca.SX, rate: bool = False) -> ca.SX:
        return ca.vertcat(z, zeta)

    @override
    def planar(self, y: Array) -> Array:
        return y[..., :2]

    @override
    def lift(self, z: Array) -> Array:
        return z if z.shape[-1] == 3 else np.concatenate([z, np.zeros_like(z[..., :1])], axis=-1)

    @property
    @override
    def space(self) -> Space:
        return _SPACE


@dataclass(frozen=True, slots=True)
class Space(_FixedPlane):
    """All of R³, for space curves: z = y, and no residuals."""

    p: int = 3

    @override
    def split(self, y: ca.SX, rate: bool = False) -> tuple[ca.SX, ca.SX]:
        return y, ca.SX(0, 1)

    @override
    def join(self, z: ca.SX, zeta: ca.SX, rate: bool = False) -> ca.SX:
        return z

    def planar(self, y: Array) -> Array:
        """The plan view of points y, shape (..., 3) -> (..., 2), [m]."""
        return y[..., :2]

    @override
    def lift(self, z: Array) -> Array:
        return LevelPlane().lift(z)

    @property
    @override
    def space(self) -> Space:
        return self


_SPACE = Space()  # shared, because it is part of a key of kept kernels


@dataclass(frozen=True, slots=True)
class SlantedPlane(Frame):
    """The plane y1 = b y2 + d in R³, with z = (y2, y3 - c) and ζ = y1 - b y2 - d.

    A circle of z is an ellipse in space, longer along y2 by sqrt(1 + b²).

    Attributes:
        b: slope.
        d: offset, [m].
        centre: c, the height y3 of z = 0, [m].
        p: dimension of the output space.

    Source: eq. (23), with the paper's b and d; its c is ℓ1, in other coordinates than here.
    """

    b: float = 0.1
    d: float = 0.5
    centre: float = 0.0
    p: int = 3

    @override
    def split(self, y: ca.SX, rate: bool = False) -> tuple[ca.SX, ca.SX]:
        return self._coordinates.split(y, rate)

    @override
    def join(self, z: ca.SX, zeta: ca.SX, rate: bool = False) -> ca.SX:
        return self._coordinates.join(z, zeta, rate)

    @override
    def planar(self, y: Array) -> Array:
        return y[..., 1:] - np.array([0.0, self.centre])

    @override
    def lift(self, z: Array) -> Array:
        lifted = np.concatenate([self.b * z[..., :1] + self.d, z], axis=-1)
        return lifted + np.array([0.0, 0.0, self.centre])

    @property
    @override
    def numbers(self) -> tuple[float, float, float]:
        return self.b, self.d, self.centre

    @override
    def at(self, numbers: ca.SX) -> PlaneCoordinates:
        b, d, centre = ca.vertsplit(numbers)
        return _SlantedCoordinates(b, d, centre)

    @property
    def _coordinates(self) -> PlaneCoordinates:
        return self.at(ca.SX(ca.DM(list(self.numbers))))

    @property
    @override
    def axes(self) -> tuple[int, int]:
        return 2, 3

    @property
    @override
    def space(self) -> None:
        return  # ζ is not measured at right angles to the plane


@dataclass(frozen=True, slots=True, eq=False)
class _SlantedCoordinates(PlaneCoordinates):
    """Coordinates of a slanted plane; see `SlantedPlane`."""

    b: ca.SX
    d: ca.SX
    centre: ca.SX
    p: int = 3

    @override
    def split(self, y: ca.SX, rate: bool = False) -> tuple[ca.SX, ca.SX]:
        if rate:
            return y[1:], y[0] - self.b * y[1]
        return ca.vertcat(y[1], y[2] - self.centre), y[0] - self.b * y[1] - self.d

    @override
    def join(self, z: ca.SX, zeta: ca.SX, rate: bool = False) -> ca.SX:
        if rate:
            return ca.vertcat(zeta + self.b * z[0], z)
        return ca.vertcat(zeta + self.b * z[0] + self.d, z[0], z[1] + self.centre)
