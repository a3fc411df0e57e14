"""The virtual output (theta, lambda): coordinates along and across the path.

xi = (lambda, its rate) and eta_2 = (theta, its rate) are the states of the normal form (10).
lambda is the signed distance to the curve [m], or the paper's level set s(y) of a conic [m^2];
in R^3 the distance from eq. (23)'s plane joins it. Source: eqs. (8)-(10).
"""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from onpath.models.paths.frames import Frame
from onpath.models.paths.projection import LEAST_SLOPE, LocalCurve


@dataclass(frozen=True, slots=True)
class LevelSet:
    """s(z) = gx (z1 - cx)^2 + gy (z2 - cy)^2 - r2. Source: eq. (15).

    Attributes:
        centre: (2, 1), [m].
        weights: (gx, gy), (2, 1).
        constant: r2, [m^2].
    """

    centre: ca.SX
    weights: ca.SX
    constant: ca.SX

    def at(self, z: ca.SX) -> tuple[ca.SX, ca.SX]:
        """s and its gradient, (2, 1), [m^2], [m]."""
        centred = z - self.centre
        s = ca.dot(self.weights, centred**2) - self.constant
        return s, 2 * self.weights * centred


@dataclass(frozen=True, slots=True)
class VirtualOutput:
    """Coordinates of one instant, and the way back from their accelerations to y's.

    Attributes:
        theta, theta_rate: eta_2, [rad], [rad/s].
        xi, xi_rate: (p - 1, 1), lambda and the plane residual [m], and their rates.
        inverse: columns that turn accelerations of (theta, lambda) into one of z, (2, 2).
        offset: (theta'', lambda'') at z'' = 0, (2, 1).
        per_radian: |sigma'|, [m/rad].
        stretch: its derivative along the path, [m/rad^2].
        frame: the output space.
    """

    theta: ca.SX
    theta_rate: ca.SX
    xi: ca.SX
    xi_rate: ca.SX
    inverse: ca.SX
    offset: ca.SX
    per_radian: ca.SX
    stretch: ca.SX
    frame: Frame

    def acceleration(self, tangential: ca.SX, transversal: ca.SX) -> ca.SX:
        """y'' that gives theta'' = tangential and xi'' = transversal.

        Args:
            tangential: v_par, (1, 1), [rad/s^2].
            transversal: v_perp, (p - 1, 1).

        Returns:
            (p, 1), [m/s^2].

        Source: eq. (16).
        """
        wanted = ca.vertcat(tangential, transversal[0]) - self.offset
        return self.frame.join(self.inverse @ wanted, transversal[1:], rate=True)


def virtual_output(
    closest: LocalCurve, frame: Frame, level_set: LevelSet | None, y: ca.SX, y_rate: ca.SX
) -> VirtualOutput:
    """Coordinates along and across the path at the output y.

    At the closest point z - sigma = lambda N. With D = |sigma'|^2 - lambda N.sigma'' the implicit
    function theorem gives theta' = sigma'.z' / D, and one more derivative theta''.

    Args:
        closest: the path about the closest point to y.
        level_set: what to measure across with; None for the signed distance.
        y, y_rate: (p, 1), [m], [m/s].

    Source: eqs. (7)-(9).
    """
    z, zeta = frame.split(y)
    z_rate, zeta_rate = frame.split(y_rate, rate=True)
    length2 = ca.dot(closest.first, closest.first)
    length = ca.sqrt(length2)
    tangent = closest.first / length
    normal = ca.vertcat(-tangent[1], tangent[0])
    distance = ca.dot(normal, z - closest.sigma)
    along, across = ca.dot(tangent, z_rate), ca.dot(normal, z_rate)
    bend, stretch = ca.dot(normal, closest.second), ca.dot(tangent, closest.second)
    slope = ca.fmax(length2 - distance * bend, LEAST_SLOPE * length2)
    lever = slope / length
    rate = along / lever
    pull = stretch * along + bend * across
    twist = 3 * length * stretch - distance * ca.dot(normal, closest.third)
    theta_offset = rate * (2 * pull - twist * rate) / slope
    if level_set is None:
        xi, xi_rate = distance, across
        offset = -bend * rate * along / length
        inverse = ca.horzcat(lever * tangent, normal)
    else:
        xi, gradient = level_set.at(z)
        xi_rate = ca.dot(gradient, z_rate)
        offset = 2 * ca.dot(level_set.weights, z_rate**2)
        inverse = ca.inv_minor(ca.vertcat((tangent / lever).T, gradient.T))
    return VirtualOutput(
        theta=closest.theta,
        theta_rate=rate,
        xi=ca.vertcat(xi, zeta),
        xi_rate=ca.vertcat(xi_rate, zeta_rate),
        inverse=inverse,
        offset=ca.vertcat(theta_offset, offset),
        per_radian=length,
        stretch=stretch,
        frame=frame,
    )
