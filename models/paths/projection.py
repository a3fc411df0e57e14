"""The closest point of the path, as CasADi expressions for the compiled loop.

In every tick the curve and its derivatives are evaluated once, at a predicted θ_0. Newton's method
for (z - σ(θ)) · σ'(θ) = 0 then runs on the cubic Taylor polynomial about θ_0, with a fixed number
of steps and no further evaluation of the series. At 1 kHz the prediction is good to about 1e-4 rad,
where the polynomial is exact to rounding; the next tick starts from the result. Time derivatives of
θ follow from the implicit function theorem, see models/control/virtual_output.py.

Source: eq. (7).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, overload

import casadi as ca
import numpy as np

from onpath.models.paths.curves import HARMONICS, ORDERS, PERIOD
from onpath.models.paths.spline_curves import MOST_PIECES, WINDOW, piece_basis

NEWTON_STEPS = 2
LARGEST_STEP = 0.5  # [rad], of one Newton step on a series
LEAST_SLOPE = 0.05  # least Newton derivative in units of |σ'|²; it is 0 at the centre of curvature


def basis(theta: ca.SX, closed: bool) -> ca.SX:
    """The basis {1, C_1..C_K, S_1..S_K} of models/paths/curves.py at θ, (TERMS, 1).

    Both cos kθ, sin kθ (with x = cos θ) and T_k(x) obey P_(k+1) = 2 x P_k - P_(k-1), so that one
    sine and one cosine suffice for all harmonics.
    """
    if closed:
        cosine, sine = ca.cos(theta), ca.sin(theta)
        return ca.vertcat(1, _recurrence(cosine, cosine, 1), _recurrence(cosine, sine, 0))
    x = _clamped(theta) / np.pi
    return ca.vertcat(1, _recurrence(x, x, 1), ca.DM.zeros(HARMONICS, 1))


def _recurrence(x: ca.SX, first: ca.SX, before: float) -> ca.SX:
    """P_1..P_K of P_(k+1) = 2 x P_k - P_(k-1), from P_0 = before and P_1 = first, (K, 1)."""
    terms = [ca.SX(before), first]
    double = x + x
    for _ in range(HARMONICS - 1):
        terms.append(double * terms[-1] - terms[-2])
    return ca.vertcat(*terms[1:])


def _clamped(theta: ca.SX) -> ca.SX:
    """θ limited to [-π, π]."""
    return ca.fmin(ca.fmax(theta, -np.pi), np.pi)


def spline_basis(theta: ca.SX, closed: bool, pieces: ca.SX) -> tuple[ca.SX, ca.SX]:
    """The basis of σ..σ''' at θ as columns, (WINDOW, ORDERS), and the number of the piece.

    The number is that of a piece of the table whatever θ and `pieces` are, also if they are not
    numbers: fmin and fmax return the other argument of a NaN.
    """
    inner = wrap(theta, True) if closed else _clamped(theta)
    per_radian = pieces / PERIOD
    place = (inner + np.pi) * per_radian
    last = ca.fmin(ca.fmax(ca.floor(pieces) - 1, 0), MOST_PIECES - 1)
    piece = ca.fmin(ca.fmax(ca.floor(place), 0), last)
    orders: list[ca.SX] = [ca.vertcat(*row) for row in piece_basis(place - piece, per_radian)]
    return ca.horzcat(*orders), piece


@overload
def windowed(windows: Sequence[ca.SX], basis: ca.SX) -> ca.SX: ...
@overload
def windowed(windows: Sequence[ca.MX], basis: ca.MX) -> ca.MX: ...
def windowed(windows: Sequence[Any], basis: Any) -> Any:
    """σ, σ', σ'' and σ''' below one another, a column for each window: (d ORDERS, windows).

    Args:
        windows: control points, (d, WINDOW) each.
        basis: of all windows, side by side, (WINDOW, ORDERS) each.
    """
    parts = ca.horzsplit(basis, ORDERS)
    columns: list[ca.SX] = [ca.vec(w @ e) for w, e in zip(windows, parts, strict=True)]
    return ca.horzcat(*columns)


def window(table: ca.MX, piece: ca.MX) -> ca.MX:
    """The control points of a piece, (d, WINDOW), from a (d, TABLE_POINTS) table."""
    d = table.size1()
    return ca.reshape(ca.vec(table)[piece * d + ca.DM(range(d * WINDOW))], d, WINDOW)


@dataclass(frozen=True, slots=True)
class LocalCurve:
    """A curve near θ_0, as its cubic Taylor polynomial; columns (d, 1).

        P(δ) = σ + δ σ' + δ²/2 σ'' + δ³/6 σ'''

    Attributes:
        theta: θ_0, [rad].
        sigma, first, second, third: σ, σ', σ'' and σ''' at θ_0, [m], [m/rad], [m/rad²], [m/rad³].
        reach: largest step of `project`, [rad].
    """

    theta: ca.SX
    sigma: ca.SX
    first: ca.SX
    second: ca.SX
    third: ca.SX
    reach: ca.SX | float = LARGEST_STEP

    @staticmethod
    def from_values(theta: ca.SX, closed: bool, values: ca.SX) -> LocalCurve:
        """The polynomial from the product of the curve's table with `basis` at θ.

        Outside [-π, π] an open curve continues along its end tangent.

        Args:
            theta: θ_0, [rad].
            closed: whether the curve is closed.
            values: `Curve.table` times `basis(theta, closed)`, (4 d, 1).
        """
        sigma, first, second, third = ca.vertsplit(values, values.size1() // ORDERS)
        if closed:
            return LocalCurve(theta=theta, sigma=sigma, first=first, second=second, third=third)
        beyond = theta - _clamped(theta)
        curved = beyond == 0
        return LocalCurve(
            theta=theta,
            sigma=sigma + beyond * first,
            first=first,
            second=curved * second,
            third=curved * third,
        )

    @property
    def turning(self) -> ca.SX:
        """κ |σ'| >= 0, by which the tangent turns per radian of θ; 1 on a circle."""
        first, second = self.first, self.second
        turned = ca.dot(first, second) / ca.dot(first, first)
        return ca.norm_2(second - turned * first) / ca.norm_2(first)

    def moved(self, step: ca.SX) -> LocalCurve:
        """The same polynomial expanded about θ_0 + step."""
        half, bend = step / 2, step * self.third
        second = self.second + bend
        first = self.first + half * (self.second + second)
        sigma = self.sigma + step * (self.first + half * (self.second + bend / 3))
        theta = self.theta + step
        return replace(self, theta=theta, sigma=sigma, first=first, second=second)

    def project(self, z: ca.SX) -> LocalCurve:
        """The polynomial expanded about the point closest to z.

        Newton's method for (z - σ) · σ' = 0:

            δ = (z - σ) · σ' / max(|σ'|² - (z - σ) · σ'', LEAST_SLOPE |σ'|²),   |δ| <= reach.

        Args:
            z: a point in the coordinates of the curve, (d, 1), [m].
        """
        local = self
        for _ in range(NEWTON_STEPS):
            gap = z - local.sigma
            tangent2 = ca.dot(local.first, local.first)
            slope = ca.fmax(tangent2 - ca.dot(gap, local.second), LEAST_SLOPE * tangent2)
            step = ca.dot(gap, local.first) / slope
            local = local.moved(ca.fmin(ca.fmax(step, -self.reach), self.reach))
        return local


def wrap(angle: ca.SX, closed: bool) -> ca.SX:
    """The angle modulo 2π, in [-π, π), on a closed curve; unchanged on an open one. [rad]"""
    return angle - 2 * np.pi * ca.floor(angle / (2 * np.pi) + 0.5) if closed else angle
