"""The virtual output (θ, ξ1, ξ3) of a space curve: coordinates along and across it in R³.

ξ1 and ξ3 are the components of y - σ along two unit normals that depend on the tangent T alone:

    n1 = e3 × σ' / |e3 × σ'|    to the left in the plan view,
    n2 = T × n1                 as far up as a normal can point.

They exist where the tangent is not vertical, that is, wherever the plan view has no cusp, and they
return to themselves on every closed curve. A rotation-minimising frame does not: after one turn it
is rotated by an angle that depends on the whole curve (its holonomy), so that ξ would have several
values. The price is a rotation about T, at the rate w per radian of θ, whose terms appear below.
They are exact, so the dynamics are still ξ'' = v_perp; on a planar path w = 0, and (ξ1, ξ3) are its
signed distance and its height.

Source: eqs. (7)-(10) with p = 3.
"""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from onpath.models.control.virtual_output import VirtualOutput
from onpath.models.paths.frames import PlaneCoordinates
from onpath.models.paths.projection import LEAST_SLOPE, LocalCurve

LEAST_PLAN = 1e-12
"""Keeps |e3 × σ'|² positive, [m²/rad²]; a path with a vertical tangent is refused."""


@dataclass(frozen=True, slots=True)
class Normals:
    """The frame at a point of a space curve.

    Attributes:
        length: |σ'|, [m/rad].
        tangent, left, up: T, n1 and n2, (3, 1).
        bends: n1 · σ'' / |σ'| and n2 · σ'' / |σ'|, which turn the normals towards T, [1/rad].
        twist, twist_rate: w = n1' · n2 [1/rad] and its derivative [1/rad²], per radian of θ.
    """

    length: ca.SX
    tangent: ca.SX
    left: ca.SX
    up: ca.SX
    bends: tuple[ca.SX, ca.SX]
    twist: ca.SX
    twist_rate: ca.SX


def normals(curve: LocalCurve) -> Normals:
    """The frame of a space curve at θ_0.

    With ρ = |z'| the speed of the plan view z and X = z1' z2'' - z2' z1'',

        n1' = -(n1 · σ'' / |σ'|) T + w n2,   n2' = -(n2 · σ'' / |σ'|) T - w n1,
        w   = ζ' X / (ρ² |σ'|).
    """
    first, second, third = curve.first, curve.second, curve.third
    plan2 = ca.fmax(first[0] ** 2 + first[1] ** 2, LEAST_PLAN)
    length2 = ca.dot(first, first)
    length, plan = ca.sqrt(length2), ca.sqrt(plan2)
    tangent = first / length
    left = ca.vertcat(-first[1], first[0], 0) / plan
    up = ca.cross(tangent, left)
    turn = first[0] * second[1] - first[1] * second[0]
    turn_rate = first[0] * third[1] - first[1] * third[0]
    scale = plan2 * length
    twist = first[2] * turn / scale
    growth = 2 * ca.dot(first[:2], second[:2]) / plan2 + ca.dot(first, second) / length2
    twist_rate = (second[2] * turn + first[2] * turn_rate) / scale - growth * twist
    bends = ca.dot(left, second) / length, ca.dot(up, second) / length
    return Normals(
        length=length,
        tangent=tangent,
        left=left,
        up=up,
        bends=bends,
        twist=twist,
        twist_rate=twist_rate,
    )


def space_output(
    closest: LocalCurve, frame: PlaneCoordinates, y: ca.SX, y_rate: ca.SX
) -> VirtualOutput:
    """Coordinates along and across a space curve at the output y.

    With e = y - σ, which is normal to T at the closest point, and D = |σ'|² - e · σ'',

        θ'   = σ' · y' / D,
        θ''  = (σ' · y'' + 2 θ' σ'' · y' - θ'² (3 σ' · σ'' - e · σ''')) / D,
        ξ1'  = n1 · y' + θ' w ξ3,
        ξ3'  = n2 · y' - θ' w ξ1,
        ξ1'' = n1 · y'' + θ' n1' · y' + (θ'' w + θ'² dw/dθ) ξ3 + θ' w ξ3',
        ξ3'' = n2 · y'' + θ' n2' · y' - (θ'' w + θ'² dw/dθ) ξ1 - θ' w ξ1'.

    D is bounded from below as in the plane.

    Args:
        closest: the path about the point closest to y.
        frame: of space curves, see `Frame.space`.
        y, y_rate: (3, 1), [m], [m/s].

    Source: eqs. (7)-(9).
    """
    n, gap = normals(closest), y - closest.sigma
    xi = ca.vertcat(ca.dot(n.left, gap), ca.dot(n.up, gap))
    along = ca.dot(n.tangent, y_rate)
    left, up = ca.dot(n.left, y_rate), ca.dot(n.up, y_rate)
    length2 = n.length**2
    d = ca.fmax(length2 - ca.dot(gap, closest.second), LEAST_SLOPE * length2)  # D
    per_theta = d / n.length
    rate = along / per_theta
    turning = rate * n.twist
    xi_rate = ca.vertcat(left + turning * xi[1], up - turning * xi[0])
    third = 3 * ca.dot(closest.first, closest.second) - ca.dot(gap, closest.third)
    theta_offset = rate * (2 * ca.dot(closest.second, y_rate) - third * rate) / d
    spin = theta_offset * n.twist + rate**2 * n.twist_rate
    offset = ca.vertcat(
        theta_offset,
        rate * (n.twist * up - n.bends[0] * along) + spin * xi[1] + turning * xi_rate[1],
        -rate * (n.twist * left + n.bends[1] * along) - spin * xi[0] - turning * xi_rate[0],
    )
    sideways = n.twist * (xi[0] * n.up - xi[1] * n.left)
    return VirtualOutput(
        theta=closest.theta,
        theta_rate=rate,
        xi=xi,
        xi_rate=xi_rate,
        inverse=ca.horzcat(per_theta * n.tangent + sideways, n.left, n.up),
        offset=offset,
        per_radian=n.length,
        gap=gap,
        spread=d / length2,
        xi_per_metre=ca.SX(1),
        frame=frame,
    )
