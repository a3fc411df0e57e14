"""The virtual output (θ, λ): coordinates of the end-point along and across the path.

ξ = (λ, λ') and η2 = (θ, θ') are the states of the normal form (10). θ = ϖ(y) is the parameter of
the closest point. λ is either the signed distance to the curve [m] or the paper's level set s(y) of
a conic [m²]; in R³ the distance from the plane of eq. (23) is its second component.

Source: eqs. (8)-(10).
"""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from onpath.models.paths.frames import Frame
from onpath.models.paths.projection import LEAST_SLOPE, LocalCurve


@dataclass(frozen=True, slots=True)
class LevelSet:
    """s(z) = g1 (z1 - c1)² + g2 (z2 - c2)² - r².

    Attributes:
        centre: c, (2, 1), [m].
        weights: g, (2, 1), [1].
        constant: r², [m²].

    Source: eq. (15).
    """

    centre: ca.SX
    weights: ca.SX
    constant: ca.SX

    def at(self, z: ca.SX) -> tuple[ca.SX, ca.SX]:
        """s and its gradient ∇s = 2 g (z - c), componentwise; (1, 1), [m²] and (2, 1), [m]."""
        centred = z - self.centre
        s = ca.dot(self.weights, centred**2) - self.constant
        return s, 2 * self.weights * centred


@dataclass(frozen=True, slots=True)
class VirtualOutput:
    """The virtual output at one instant, and the inverse of its second derivative.

    With z the planar coordinates of y, (θ'', λ'') depends affinely on z'':

        z'' = inverse @ ((θ'', λ'') - offset).

    Attributes:
        theta, theta_rate: η2 = (θ, θ'), [rad], [rad/s].
        xi: λ and, for p = 3, the distance from the plane, (p - 1, 1), [m] (a level set: [m²]).
        xi_rate: its rate, (p - 1, 1).
        inverse: (2, 2).
        offset: (θ'', λ'') at z'' = 0, (2, 1).
        per_radian: |σ'|, [m/rad].
        stretch: d|σ'|/dθ = σ' · σ'' / |σ'|, [m/rad²].
        frame: how the plane of the path lies in the output space.
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
        """The output acceleration y'' that gives θ'' = v_par and λ'' = v_perp.

        This inverts the decoupling of (16) in the output space; `linearization` in
        models/control/laws.py then turns y'' into torques.

        Args:
            tangential: v_par, (1, 1), [rad/s²].
            transversal: v_perp, (p - 1, 1), [m/s²] (a level set: [m²/s²]).

        Returns:
            (p, 1), [m/s²].

        Source: eq. (16).
        """
        wanted = ca.vertcat(tangential, transversal[0]) - self.offset
        return self.frame.join(self.inverse @ wanted, transversal[1:], rate=True)


def virtual_output(
    closest: LocalCurve, frame: Frame, level_set: LevelSet | None, y: ca.SX, y_rate: ca.SX
) -> VirtualOutput:
    """Coordinates along and across the path at the output y.

    At the closest point z - σ = λ N with the unit tangent T and normal N. Differentiating (z -
    σ(θ)) · σ'(θ) = 0 twice (implicit function theorem), with D = |σ'|² - λ N · σ'' = |σ'|² (1 -
    λκ), gives

        θ'  = σ' · z' / D,
        θ'' = (σ' · z'' + 2 θ' σ'' · z' - θ'² (3 σ' · σ'' - λ N · σ''')) / D.

    The signed distance λ = N · (z - σ) has

        λ'  = N · z',
        λ'' = N · z'' - (N · σ'' / |σ'|) θ' (T · z'),

    and the level set λ = s(z) has λ' = ∇s · z' and λ'' = ∇s · z'' + 2 Σ g_i z_i'².

    D is bounded from below, because it vanishes at the centre of curvature, where θ is undefined.

    Args:
        closest: the path about the point closest to y.
        frame: how the plane of the path lies in the output space.
        level_set: s for λ = s(y); None for the signed distance.
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
    second_n, second_t = ca.dot(normal, closest.second), ca.dot(tangent, closest.second)
    d = ca.fmax(length2 - distance * second_n, LEAST_SLOPE * length2)  # D
    per_theta = d / length  # dz/dθ along the tangent, at constant λ
    rate = along / per_theta
    second_z_rate = second_t * along + second_n * across  # σ'' · z'
    third = 3 * length * second_t - distance * ca.dot(normal, closest.third)
    theta_offset = rate * (2 * second_z_rate - third * rate) / d
    if level_set is None:
        xi, xi_rate = distance, across
        offset = -second_n * rate * along / length
        inverse = ca.horzcat(per_theta * tangent, normal)
    else:
        xi, gradient = level_set.at(z)
        xi_rate = ca.dot(gradient, z_rate)
        offset = 2 * ca.dot(level_set.weights, z_rate**2)
        inverse = ca.inv_minor(ca.vertcat((tangent / per_theta).T, gradient.T))
    return VirtualOutput(
        theta=closest.theta,
        theta_rate=rate,
        xi=ca.vertcat(xi, zeta),
        xi_rate=ca.vertcat(xi_rate, zeta_rate),
        inverse=inverse,
        offset=ca.vertcat(theta_offset, offset),
        per_radian=length,
        stretch=second_t,
        frame=frame,
    )
