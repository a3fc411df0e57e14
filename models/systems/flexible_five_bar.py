"""The five-bar on a rotating waist, whose last link is a beam that bends horizontally.

Coordinates q = (q1, q2, q3, f1..fN): base angles as in the rigid linkage, waist angle, and modal
coordinates of the deflection w(s) = Σ_j φ_j(s) f_j across the vertical plane of the linkage. Inputs
act on q1, q2 and q3. Gravity is balanced. A point s of the beam lies at the radius r = l1 cos q1 -
s cos q2 and at w across it, so that

    T = ½ (M11 q1'² + M22 q2'² + (J0 + J1 cos² q1) q3'²)
        + ½ ρ ∫ ((r' - w q3')² - r'² + (r q3' + w')²) ds,
    V = ½ ρ Σ_j ω_j² f_j².

M11 and M22 include the beam's motion in the plane of the linkage, hence the term -r'².

A payload m at the tip y = h(q) adds ½ m |y'|² to T and, since it is not balanced, m g y3 to V.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import casadi as ca
import numpy as np

from onpath.models.systems.beam import BeamModes, beam_modes
from onpath.models.systems.flexible_links import NAMES, PAYLOAD
from onpath.models.systems.system import MechanicalSystem, mechanical_system
from onpath.models.systems.tip_load import no_load, tip_load

PLANTS = ("lagrangian", "unit_modes")
HOME = np.array([np.pi / 2, np.pi, 0.0])
RIGID = 3  # number of joints, the first coordinates of q


@dataclass(frozen=True, slots=True)
class _Symbols:
    """The terms of the equations of motion.

    Attributes:
        p: parameters by name.
        q, v: coordinates and velocities.
        P, Q: sqrt(l) l1 cos q1 and l^1.5 cos q2, so that Ψ = P a - Q b with the integrals a = ∫ φ
            ds and b = ∫ s φ ds of the unit beam.
        P1, Q2: dP/dq1 and dQ/dq2.
        beam: modes of the beam of unit length.
    """

    p: dict[str, ca.SX]
    q: ca.SX
    v: ca.SX
    P: ca.SX
    Q: ca.SX
    P1: ca.SX
    Q2: ca.SX
    beam: BeamModes

    @property
    def f(self) -> ca.SX:
        """Modal coordinates, (N, 1), [m^3/2]."""
        return self.q[RIGID:]

    @property
    def f_rate(self) -> ca.SX:
        """Their rates f', (N, 1)."""
        return self.v[RIGID:]

    @property
    def coupling(self) -> ca.SX:
        """Ψ_j = ∫ r φ_j ds, (N, 1)."""
        return self.P * ca.DM(self.beam.area) - self.Q * ca.DM(self.beam.moment)

    @property
    def stiffness(self) -> ca.SX:
        """ω_j², (N, 1), [1/s²]."""
        return (self.p["omega1"] * ca.DM(self.beam.overtones)) ** 2

    @property
    def elastic(self) -> ca.SX:
        """ω_j² f_j + 2 ζ ω_j f_j', the beam's elastic and damping force over ρ, (N, 1)."""
        damping = (2 * self.p["zeta"] * self.p["omega1"]) * ca.DM(self.beam.overtones)
        return self.stiffness * self.f + damping * self.f_rate

    @property
    def waist(self) -> ca.SX:
        """M' = J - ρ |Ψ|² for the straight beam: the inertia at q3 with the modes eliminated.

        J = J0 + J1 cos² q1 + ρ ∫ r² ds, and ∫ r² ds = P² - P Q + Q² / 3.
        """
        a, b = self.beam.area, self.beam.moment
        beam = self.P * ((1 - a @ a) * self.P - (1 - 2 * a @ b) * self.Q)
        beam += (1 / 3 - b @ b) * self.Q**2
        return self.p["J0"] + self.p["J1"] * ca.cos(self.q[0]) ** 2 + self.p["rho"] * beam


@dataclass(frozen=True, slots=True)
class _Dynamics:
    """M and c by blocks. The modal rows are divided by ρ, so that their own block of M is I.

    Attributes:
        joints: M of q1 to q3 after elimination of the modes (Schur complement at q3), (3, 3).
        row, column: coupling of the modes into q3's row, and of q3 into the modes' rows, (N, 1).
        bias: c of the joints, (3, 1).
        modal_bias: c of the modes over ρ, (N, 1).
    """

    joints: ca.SX
    row: ca.SX
    column: ca.SX
    bias: ca.SX
    modal_bias: ca.SX


def _symbols(modes: int, parameters: ca.SX) -> _Symbols:
    p = dict(zip((*NAMES, PAYLOAD), ca.vertsplit(parameters), strict=False))
    q, v = ca.SX.sym("q", RIGID + modes), ca.SX.sym("v", RIGID + modes)
    root = ca.sqrt(p["l"])
    first, second = root * p["l1"], root * p["l"]
    return _Symbols(
        p=p,
        q=q,
        v=v,
        P=first * ca.cos(q[0]),
        Q=second * ca.cos(q[1]),
        P1=-first * ca.sin(q[0]),
        Q2=-second * ca.sin(q[1]),
        beam=beam_modes(modes, 1.0),
    )


def flexible_five_bar(
    modes: int = 3, plant: str = "lagrangian", loaded: bool = False
) -> MechanicalSystem:
    """The robot's equations of motion, with parameters named as in `NAMES`.

    Args:
        modes: number of assumed modes, 1 to 6.
        plant: "lagrangian", or "unit_modes": (20)-(21), which cancel the Coriolis terms beforehand,
            with shapes normalised to ∫ φ² ds = 1 and no friction in the joints. See
            `_unit_modes`.
        loaded: whether there is a parameter `payload`, the mass at the tip. Equations without it
            take less time, and are the same to the last bit as those with a payload of 0.

    Raises:
        ValueError: an unknown plant or number of modes.

    Source: eqs. (20)-(22).
    """
    if plant not in PLANTS:
        raise ValueError(f"plant {plant!r}: expected one of {', '.join(PLANTS)}")
    names = (*NAMES, PAYLOAD) if loaded else NAMES
    parameters = ca.SX.sym("parameters", len(names))
    s = _symbols(modes, parameters)
    rho = s.p["rho"]
    parts = _lagrangian(s) if plant == "lagrangian" else _unit_modes(s)
    w = 2 / ca.sqrt(s.p["l"]) * ca.dot((-1.0) ** np.arange(modes), s.f)
    tip = _end_point(s, w)
    modal = (f"f{j + 1}_m1.5" for j in range(modes))  # because φ is in m^-0.5
    load = tip_load(s.p[PAYLOAD], s.q, s.v, tip, waist=2) if loaded else no_load(s.q.numel())
    return mechanical_system(
        name="flexible",
        q=s.q,
        v=s.v,
        parameters=parameters,
        parameter_names=names,
        coordinate_names=("q1_rad", "q2_rad", "q3_rad", *modal),
        mass=_mass(parts, rho) + load.inertia,
        bias=ca.vertcat(parts.bias, rho * parts.modal_bias) + load.bias,
        inputs=RIGID,
        modes=modes,
        output=tip,
        controlled_output=_end_point(s, s.p["alpha"] * w),
        potential_energy=rho / 2 * ca.dot(s.stiffness, s.f**2) + load.energy,
        solve=lambda _, rhs: load.solve(partial(_solve, parts, rho), rhs),
    )


def _end_point(s: _Symbols, w: ca.SX) -> ca.SX:
    """y of a tip that is displaced by w from the straight link. Source: eq. (22)."""
    l1, beam = s.p["l1"], s.p["l"]
    radius = l1 * ca.cos(s.q[0]) - beam * ca.cos(s.q[1])
    c3, s3 = ca.cos(s.q[2]), ca.sin(s.q[2])
    height = l1 * ca.sin(s.q[0]) - beam * ca.sin(s.q[1]) - l1
    return ca.vertcat(radius * c3 - w * s3, radius * s3 + w * c3, height)


def _lagrangian(s: _Symbols) -> _Dynamics:
    """Lagrange's equations for T and V of this module; a test checks them by differentiation.

    With A = Σ a_j f_j and B = Σ b_j f_j, the terms of T that couple beam and joints are ρ q3' (Ψ ·
    f' - P1 q1' A + Q2 q2' B).
    """
    rho, (v1, v2, v3) = s.p["rho"], ca.vertsplit(s.v[:RIGID])
    a, b = ca.DM(s.beam.area), ca.DM(s.beam.moment)
    A, B, A_rate, B_rate = (ca.dot(k, x) for x in (s.f, s.f_rate) for k in (a, b))
    rho1, rho2 = rho * s.P1, rho * s.Q2
    turn1 = rho1 * (2 * s.P - s.Q) - 2 * s.p["J1"] * ca.cos(s.q[0]) * ca.sin(s.q[0])
    turn2 = rho2 * (2 / 3 * s.Q - s.P)  # dJ/dq1 and dJ/dq2
    swing = turn1 * v1 + turn2 * v2 + 2 * rho * ca.dot(s.f, s.f_rate)
    to1, to2 = 2 * v3 * v1 * s.P1, 2 * v3 * v2 * s.Q2
    return _Dynamics(
        joints=ca.blockcat(
            [
                [s.p["M11"], 0, -rho1 * A],
                [0, s.p["M22"], rho2 * B],
                [-rho1 * A, rho2 * B, s.waist + rho * ca.dot(s.f, s.f)],
            ]
        ),
        row=rho * s.coupling,
        column=s.coupling,
        bias=ca.vertcat(
            s.p["b1"] * v1 - v3 * (2 * rho1 * A_rate + turn1 / 2 * v3),
            s.p["b2"] * v2 + v3 * (2 * rho2 * B_rate - turn2 / 2 * v3),
            (s.p["b3"] + swing) * v3 + rho * (s.P * v1**2 * A - s.Q * v2**2 * B),
        ),
        modal_bias=s.elastic + to1 * a - to2 * b - v3**2 * s.f,
    )


def _unit_modes(s: _Symbols) -> _Dynamics:
    """M' q3'' = u3 + Ψ · Ω and f'' = -ρ Ψ q3'' - Ω / ρ, with ∫ φ² ds = 1.

    The paper defines Ψ, Ω and M' in [15] only. With mass-normalised shapes, ρ ∫ φ_i φ_j ds = δ_ij,
    these equations are Lagrange's for small deflections, as a test shows. With the shapes of this
    project, the units of ρ Ψ q3'' are not those of f'', the waist acts on the modes ρ times (in SI)
    as strongly as in Lagrange's equations, the mass matrix is not symmetric, and energy is not
    conserved. This reading is kept only because, with ρ = 0.2 and the actual tip, it agrees with
    the paper's text about figures 6 and 7. Like (20), it has no friction in the joints: b1 to b3
    have no effect.

    Source: eqs. (20)-(21), with Ω_j = ρ (ω_j² f_j + 2 ζ ω_j f_j').
    """
    rho = s.p["rho"]
    return _Dynamics(
        joints=ca.diag(ca.vertcat(s.p["M11"], s.p["M22"], s.waist)),
        row=rho * s.coupling,
        column=rho * s.coupling,
        bias=ca.SX(RIGID, 1),
        modal_bias=s.elastic,
    )


def _mass(parts: _Dynamics, rho: ca.SX) -> ca.SX:
    """M, with the modes that `_Dynamics.joints` eliminates put back."""
    joints, n = ca.SX(parts.joints), parts.row.numel()
    joints[2, 2] += ca.dot(parts.row, parts.column)
    above = ca.horzcat(joints, ca.vertcat(ca.SX(2, n), parts.row.T))
    return ca.vertcat(above, rho * ca.horzcat(ca.SX(n, 2), parts.column, ca.SX.eye(n)))


def _solve(parts: _Dynamics, rho: ca.SX, rhs: ca.SX) -> ca.SX:
    """M⁻¹ R: q3 first, since it couples to everything, while nothing else is coupled."""
    joints, modal = parts.joints, _over(rho, rhs[RIGID:, :])
    arm1, arm2 = _over(joints[0, 0], joints[0, 2]), _over(joints[1, 1], joints[1, 2])
    waist = joints[2, 2] - arm1 * joints[0, 2] - arm2 * joints[1, 2]
    pull = parts.row.T @ modal + arm1 * rhs[0, :] + arm2 * rhs[1, :]
    third = (rhs[2, :] - pull) / waist
    return ca.vertcat(
        _over(joints[0, 0], rhs[0, :]) - arm1 * third,
        _over(joints[1, 1], rhs[1, :]) - arm2 * third,
        third,
        modal - parts.column @ third,
    )


def _over(divisor: ca.SX, value: ca.SX) -> ca.SX:
    """value / divisor as (2 / divisor) (value / 2).

    CasADi would turn a product with 1 / divisor back into a division; 2 / divisor can be shared.
    """
    return (2 / divisor) * (0.5 * value)
