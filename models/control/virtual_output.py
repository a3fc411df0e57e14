"""The virtual output (θ, λ): coordinates of the end-point along and across the path.

ξ = (λ, λ') and η2 = (θ, θ') are the states of the normal form (10). θ = ϖ(y) is the parameter of
the closest point. λ is either the signed distance to the curve [m] or the paper's level set s(y) of
a conic [m²]; in R³ the distance from the plane of eq. (23) is its second component.

Source: eqs. (8)-(10).
"""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from onpath.models.control.implicit_level import ImplicitLevel
from onpath.models.paths.frames import PlaneCoordinates
from onpath.models.paths.projection import LEAST_SLOPE, LocalCurve


@dataclass(frozen=True, slots=True)
class LevelSet:
    """s(z) = (z - c)ᵀ G (z - c) - r², with a symmetric G.

    Attributes:
        centre: c, (2, 1), [m].
        weights: (G11, G22, G12), (3, 1), [1].
        constant: r², [m²].

    Source: eqs. (15), (23).
    """

    centre: ca.SX
    weights: ca.SX
    constant: ca.SX

    def at(self, z: ca.SX) -> tuple[ca.SX, ca.SX]:
        """s and its gradient ∇s = 2 G (z - c); (1, 1), [m²] and (2, 1), [m]."""
        centred = z - self.centre
        half = self._turned(centred)
        return ca.dot(centred, half) - self.constant, 2 * half

    def bent(self, z: ca.SX, z_rate: ca.SX) -> ca.SX:
        """The second derivative of s at z'' = 0, which is z'ᵀ 2 G z', [m²/s²]."""
        return 2 * ca.dot(z_rate, self._turned(z_rate))

    def _turned(self, z: ca.SX) -> ca.SX:
        """G z, (2, 1)."""
        g11, g22, g12 = ca.vertsplit(self.weights)
        return ca.vertcat(g11 * z[0] + g12 * z[1], g12 * z[0] + g22 * z[1])


@dataclass(frozen=True, slots=True)
class VirtualOutput:
    """The virtual output at one instant, and the inverse of its second derivative.

    With z the planar coordinates of y, (θ'', λ'') depends affinely on z'':

        z'' = inverse @ ((θ'', λ'') - offset).

    For a space curve, z = y, and both components of ξ take the place of λ.

    Attributes:
        theta, theta_rate: η2 = (θ, θ'), [rad], [rad/s].
        xi: λ and, for p = 3, the distance from the plane, (p - 1, 1), [m] (a level set: [m²]).
        xi_rate: its rate, (p - 1, 1).
        inverse: (d, d) with d = 2, or 3 for a space curve.
        offset: (θ'', λ'') at z'' = 0, (d, 1).
        per_radian: |σ'|, [m/rad].
        gap: y - σ, from the closest point to the output, (p, 1), [m].
        spread: 1 - λκ with the signed distance λ: 1 on the path and 0 at its centre of curvature,
            where the closest point is not unique. For a level set, at most ∇s·N as a share of its
            value on the path: 0 where (θ, s) are no coordinates. At least `LEAST_SLOPE`.
        xi_per_metre: |∂ξ1/∂z|: 1 for a distance, |∇s| [m] for a level set.
        frame: how the plane of the path lies in the output space.
    """

    theta: ca.SX
    theta_rate: ca.SX
    xi: ca.SX
    xi_rate: ca.SX
    inverse: ca.SX
    offset: ca.SX
    per_radian: ca.SX
    gap: ca.SX
    spread: ca.SX
    xi_per_metre: ca.SX
    frame: PlaneCoordinates

    def acceleration(self, tangential: ca.SX, transversal: ca.SX) -> ca.SX:
        """The output acceleration y'' that gives θ'' = v_par and λ'' = v_perp.

        This inverts the decoupling of (16) in the output space; `linearization` in
        models/control/linearization.py then turns y'' into torques.

        Args:
            tangential: v_par, (1, 1), [rad/s²].
            transversal: v_perp, (p - 1, 1), [m/s²] (a level set: [m²/s²]).

        Returns:
            (p, 1), [m/s²].

        Source: eq. (16).
        """
        across = self.offset.numel() - 1  # components of ξ that the curve determines
        wanted = ca.vertcat(tangential, transversal[:across]) - self.offset
        return self.frame.join(self.inverse @ wanted, transversal[across:], rate=True)

    @property
    def acceleration_per_along(self) -> ca.SX:
        """dy''/dv_par at constant v_perp, (p, 1), [m/rad]."""
        none = ca.SX.zeros(self.frame.p - 2, 1)
        return self.frame.join(self.inverse[:, 0], none, rate=True)


def virtual_output(
    closest: LocalCurve,
    frame: PlaneCoordinates,
    level: LevelSet | ImplicitLevel | None,
    y: ca.SX,
    y_rate: ca.SX,
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

    and the level set λ = s(z) has λ' = ∇s · z' and λ'' = ∇s · z'' + z'ᵀ (∂²s/∂z²) z'.

    D is bounded from below, because it vanishes at the centre of curvature, where θ is undefined.
    So is ∇s·N, which vanishes at the centre of an ellipse.

    Args:
        closest: the path about the point closest to y.
        frame: how the plane of the path lies in the output space.
        level: s for λ = s(y); None for the signed distance.
        y, y_rate: (p, 1), [m], [m/s].

    Source: eqs. (7)-(9).
    """
    (z, zeta), (z_rate, zeta_rate) = frame.split(y), frame.split(y_rate, rate=True)
    length = ca.sqrt(length2 := ca.dot(closest.first, closest.first))
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
    spread = d / length2
    if level is None:
        xi, xi_rate = distance, across
        offset, xi_per_metre = -second_n * rate * along / length, ca.SX(1)
        inverse = ca.horzcat(per_theta * tangent, normal)
    else:
        xi, gradient = level.at(z)
        xi_rate = ca.dot(gradient, z_rate)
        offset, xi_per_metre = level.bent(z, z_rate), ca.sqrt(ca.dot(gradient, gradient))
        there = ca.dot(level.at(closest.sigma)[1], normal)
        share = ca.dot(gradient, normal) / there
        lacking = ca.fmax(LEAST_SLOPE - share, 0)
        steep = gradient + lacking * there * normal
        inverse = ca.inv_minor(ca.vertcat((tangent / per_theta).T, steep.T))
        spread = ca.fmin(spread, share + lacking)
    return VirtualOutput(
        theta=closest.theta,
        theta_rate=rate,
        xi=ca.vertcat(xi, zeta),
        xi_rate=ca.vertcat(xi_rate, zeta_rate),
        inverse=inverse,
        offset=ca.vertcat(theta_offset, offset),
        per_radian=length,
        gap=frame.join(z - closest.sigma, zeta, rate=True),
        spread=spread,
        xi_per_metre=xi_per_metre,
        frame=frame,
    )
