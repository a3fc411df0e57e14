"""Systems that the catalogue does not have: more inputs than outputs, and an input matrix B(q)."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import casadi as ca

from onpath.models.systems.system import MechanicalSystem, lagrange_bias, mechanical_system

NONE = ca.SX(0, 1)
LENGTHS = (0.14, 0.12, 0.1)  # [m]
TIP = (0.08, 0.03)  # of the body, in its own axes, [m]


@cache
def redundant_arm() -> MechanicalSystem:
    """A planar arm with three joints under gravity, m = 3 motors and p = 2 outputs.

    Each link is a rod of mass 0.3 kg; y is the arm's tip, (x - 0.2, z - 0.1).
    """
    q, v = ca.SX.sym("q", 3), ca.SX.sym("v", 3)
    rod, angle = 0.3, [q[0], q[0] + q[1], q[0] + q[1] + q[2]]
    joint, kinetic, potential = ca.SX.zeros(2, 1), ca.SX(0), ca.SX(0)
    for i, length in enumerate(LENGTHS):
        along = ca.vertcat(ca.cos(angle[i]), ca.sin(angle[i]))
        rate = ca.jtimes(joint + length / 2 * along, q, v)
        turning = ca.jtimes(angle[i], q, v)
        kinetic += rod / 2 * (ca.dot(rate, rate) + length**2 / 12 * turning**2)
        potential += 9.81 * rod * (joint[1] + length / 2 * along[1])
        joint += length * along
    return mechanical_system(
        name="redundant_arm",
        q=q,
        v=v,
        parameters=NONE,
        parameter_names=(),
        mass=ca.jacobian(ca.gradient(kinetic, v), v),
        bias=lagrange_bias(q, v, kinetic, potential, 0.02 * v),
        inputs=3,
        output=joint - ca.DM([0.2, 0.1]),
        potential_energy=potential,
    )


@cache
def thrusters(inputs: int) -> MechanicalSystem:
    """A body on a table, q = (x, y, φ), pushed by forces along its own axes and, if m = 3, turned.

        M = diag(2, 2, 0.01),   B(q) = [[R(φ), 0], [a × e_i, 1]],

    with R(φ) the rotation and a = (0, 0.02) m the point where the forces act. Its output is a tip
    fixed to it.
    """
    q, v = ca.SX.sym("q", 3), ca.SX.sym("v", 3)
    c, s = ca.cos(q[2]), ca.sin(q[2])
    rows = [[c, -s, 0], [s, c, 0], [-0.02, 0, 1]]
    return mechanical_system(
        name="thrusters",
        q=q,
        v=v,
        parameters=NONE,
        parameter_names=(),
        mass=ca.diag(ca.SX(ca.DM([2.0, 2.0, 0.01]))),
        bias=ca.vertcat(0.5 * v[:2], 1e-3 * v[2]),
        inputs=inputs,
        actuation=ca.blockcat(rows)[:, :inputs],
        output=q[:2] + ca.vertcat(c * TIP[0] - s * TIP[1], s * TIP[0] + c * TIP[1]),
        potential_energy=ca.SX(0),
    )


@cache
def belted_arm() -> MechanicalSystem:
    """Two joints and two motors at the base, of which the second turns link 2 by a belt.

    u2 acts on the absolute angle q1 + q2: its generalized forces are (u2, u2).
    """
    q, v = ca.SX.sym("q", 2), ca.SX.sym("v", 2)
    both, coupling = q[0] + q[1], 0.006 * ca.cos(q[1])
    mass = ca.blockcat([[0.03 + 2 * coupling, 0.008 + coupling], [0.008 + coupling, 0.008]])
    kinetic = ca.dot(v, mass @ v) / 2
    potential = 1.2 * ca.sin(q[0]) + 0.2 * ca.sin(both)
    along = [ca.vertcat(ca.cos(angle), ca.sin(angle)) for angle in (q[0], both)]
    return mechanical_system(
        name="belted_arm",
        q=q,
        v=v,
        parameters=NONE,
        parameter_names=(),
        mass=mass,
        bias=lagrange_bias(q, v, kinetic, potential, 0.03 * v),
        inputs=2,
        actuation=ca.SX(ca.DM([[1, 1], [0, 1]])),
        output=0.22 * along[0] + 0.2 * along[1] - ca.DM([0.2, 0.22]),
        potential_energy=potential,
    )


@cache
def standing(system: MechanicalSystem) -> MechanicalSystem:
    """The same system, n = m, with a posture u0 = B⁻¹ (c - M (8 v + 20 (q - 0.1)))."""
    away = 8 * system.v + 20 * (system.q - 0.1)
    posture = ca.solve(system.actuation, system.bias - system.mass @ away)
    return replace(system, name=f"standing_{system.name}", posture=posture)
