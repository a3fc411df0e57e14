"""A virtual constraint: the path acts like a smooth wire, and the end-point slides on it freely."""

from __future__ import annotations

from dataclasses import replace

import casadi as ca
import numpy as np

from onpath.models.control.laws.law import ControlAction, Law, View
from onpath.models.control.laws.path_following import followed, transversal
from onpath.models.control.place import Place
from onpath.models.control.poles import Channel, Complex, channels
from onpath.models.errors import Message
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.system import coriolis


def virtual_constraint(view: View) -> ControlAction:
    """Commanded y'', (p, 1), [m/s²]: (18) across the path, and no force along it.

    Gravity and friction are compensated by the model, u = c - C v + J^T F with C the Coriolis
    matrix, so that the motors act like a force F at the end-point,

        F = J⁻ᵀ M J⁻¹ (y'' - J' v) + J⁻ᵀ C v.

    y'' = a + b v_par is affine in v_par, eq. (16), with v_perp from (18). The law takes the v_par
    for which F has no component along the path, F · T = 0. On the path F then does no work, and in
    continuous time the kinetic energy is constant, like that of a bead on a wire. With torques that
    are held, it grows with the square of the interval: at 1000 Hz and 0.6 m/s, by 1.4 to 2.1 % in
    20 s on the rigid robots.

    It is no orbital stabilization: no orbit is chosen, and none attracts; see
    `orbital_stabilization.py`.

    Source: virtual holonomic constraints, as in Mettin et al. [7] and Shiriaev et al. [8].
    """
    system, output, q, v = view.system, view.output, view.q, view.v
    model = view.model
    jacobian = ca.jacobian(system.controlled_output, system.q)
    turning = ca.jtimes(jacobian @ system.v, system.q, system.v)
    inverse = ca.inv_minor(jacobian)
    inputs = [system.q, system.v, system.parameters]
    outputs = [inverse, turning, system.mass, coriolis(system) @ system.v]
    back, turned, mass, gyration = ca.Function("wire", inputs, outputs)(q, v, model)
    direction = output.acceleration_per_along
    along_joints = back @ direction  # dq/dθ along the path
    resting = output.acceleration(ca.SX(0), transversal(view))
    force_there = mass @ (back @ (resting - turned)) + gyration
    free = -ca.dot(along_joints, force_there) / ca.dot(along_joints, mass @ along_joints)
    return replace(followed(view, free, transversal(view), wanted=ca.SX(0)), theta_ref=output.theta)


def wire_channels(parameters: Parameters, place: Place) -> tuple[Channel, Channel]:
    """The channels of (18) across, and of a bead on a wire along.

    With m(θ) the inertia along the path and g = m' / (2 m), the bead keeps ½ m θ'²:

        θ'' = -g θ'²,   and near a motion at θ' = w:   δθ'' = -2 g w δθ' - g' w² δθ.

    Both coefficients vary along the path. Poles in the right half-plane mean that a growing inertia
    slows the bead down, or a falling one speeds it up; over a lap, nothing grows or decays.
    """
    across = channels(parameters)[0]
    damping, stiffness = 2 * place.slope * place.rate, place.bend * place.rate**2
    poles: Complex = np.roots([1.0, damping, stiffness]).astype(np.complex128)
    along = Channel(
        name="along",
        poles=poles,
        stable=False,
        integral=False,
        at=place.theta,
        message=Message("behaviour.free"),
    )
    return across, along


LAW = Law(
    name="virtual_constraint",
    label="Bead on a wire",
    text="Holds the end-point on the curve by a virtual constraint, and leaves it alone along it.",
    source="after virtual constraints, Mettin et al. [7], Shiriaev, Perram and Canudas-de Wit [8]",
    command=virtual_constraint,
    aim="theta",
    square=True,
    pace="free",
    channels=wire_channels,
    good="It keeps to the curve and leaves the pace to whoever pushes it along.",
    limits="It does not travel by itself: at rest it stays where it is.",
    objection="Its authors stabilize orbits of robots with fewer motors than joints, which"
    " a bead on a wire is not.",
)
