"""The closest point of the path, inside the compiled loop.

Once a tick the curve and its derivatives are evaluated at a predicted theta_0; Newton on
(sigma(theta) - y) . sigma'(theta) = 0 then runs, unrolled, on the cubic Taylor polynomial there.
The prediction is good to about 1e-4 rad at 1 kHz, where that polynomial is exact to rounding, and
the next tick starts from the result. Derivatives of theta come from the implicit function theorem.
Source: eq. (7).
"""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca
import numpy as np

from onpath.models.paths.curves import HARMONICS

NEWTON_STEPS = 2
LARGEST_STEP = 0.5  # [rad]
LEAST_SLOPE = 0.05  # of |sigma'|^2: keeps Newton going near a centre of curvature


def basis(theta: ca.SX, closed: bool) -> ca.SX:
    """{1, C_1..C_K, S_1..S_K} at theta, (TERMS, 1); see models/paths/curves.py.

    Fourier and Chebyshev bases obey one three-term recurrence: P_k+1 = 2 x P_k - P_k-1.
    """
    if closed:
        cosine, sine = ca.cos(theta), ca.sin(theta)
        return ca.vertcat(1, _recurrence(cosine, cosine, 1), _recurrence(cosine, sine, 0))
    x = _clamped(theta) / np.pi
    return ca.vertcat(1, _recurrence(x, x, 1), ca.DM.zeros(HARMONICS, 1))


def _recurrence(x: ca.SX, first: ca.SX, before: float) -> ca.SX:
    """P_1..P_K from P_0 = before, P_1 = first."""
    terms = [ca.SX(before), first]
    double = x + x
    for _ in range(HARMONICS - 1):
        terms.append(double * terms[-1] - terms[-2])
    return ca.vertcat(*terms[1:])


def _clamped(theta: ca.SX) -> ca.SX:
    return ca.fmin(ca.fmax(theta, -np.pi), np.pi)


@dataclass(frozen=True, slots=True)
class LocalCurve:
    """A curve near theta_0 as its cubic Taylor polynomial; columns (2, 1).

    Attributes:
        theta: theta_0, [rad].
        sigma, first, second, third: the curve and its derivatives there.
    """

    theta: ca.SX
    sigma: ca.SX
    first: ca.SX
    second: ca.SX
    third: ca.SX

    @staticmethod
    def from_values(theta: ca.SX, closed: bool, values: ca.SX) -> LocalCurve:
        """From the (8, 1) product of the curve's table with `basis` at theta.

        An open curve goes on along its end tangents.
        """
        sigma, first, second, third = ca.vertsplit(values, 2)
        if closed:
            return LocalCurve(theta, sigma, first, second, third)
        beyond = theta - _clamped(theta)
        curved = beyond == 0
        return LocalCurve(theta, sigma + beyond * first, first, curved * second, curved * third)

    def moved(self, step: ca.SX) -> LocalCurve:
        """The same polynomial expanded about theta + step."""
        half, bend = step / 2, step * self.third
        second = self.second + bend
        first = self.first + half * (self.second + second)
        sigma = self.sigma + step * (self.first + half * (self.second + bend / 3))
        return LocalCurve(self.theta + step, sigma, first, second, self.third)

    def project(self, z: ca.SX) -> LocalCurve:
        """Expanded about the closest point to z, (2, 1), [m]."""
        local = self
        for _ in range(NEWTON_STEPS):
            gap = z - local.sigma
            tangent2 = ca.dot(local.first, local.first)
            slope = ca.fmax(tangent2 - ca.dot(gap, local.second), LEAST_SLOPE * tangent2)
            step = ca.dot(gap, local.first) / slope
            local = local.moved(ca.fmin(ca.fmax(step, -LARGEST_STEP), LARGEST_STEP))
        return local


def wrap(angle: ca.SX, closed: bool) -> ca.SX:
    """The angle in [-pi, pi) on a closed curve; unchanged on an open one."""
    return angle - 2 * np.pi * ca.floor(angle / (2 * np.pi) + 0.5) if closed else angle
