"""A robot that no test knows beforehand: a crane in space, with a rod in a universal joint.

    q = (x, y, z, a, b),   B u = (u1, u2, u3, 0, 0),   e = (sin a cos b, sin b, -cos a cos b),
    y_α = (x, y, z) + α L (e + (0, 0, 1)),

with e the direction of the rod and L the distance of its pen from the joint. With S and J the
rod's first and second moments about the joint, it swings at y_α with e'' = -g e S / (J - α L S):
the critical α is J / (S L), and the zero dynamics are unstable beyond it.
"""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from onpath.models.arrays import Array
from onpath.models.paths.frames import LevelPlane
from onpath.models.systems.drawing import Drawing
from onpath.models.systems.forces import Grip, SpringLimits
from onpath.models.systems.parameter_specs import number, wanted_speed
from onpath.models.systems.parameters import Parameters, own_parameters
from onpath.models.systems.robots import Robot, RobotEntry
from onpath.models.systems.system import GRAVITY, mechanical_system

BRIDGE, TROLLEY, HOIST, ROD = 0.4, 0.3, 0.2, 0.3  # [kg]
LENGTH, PEN = 0.2, 0.12  # of the rod, and from the joint to the pen, [m]
MOMENT, INERTIA = ROD * LENGTH / 2, ROD * LENGTH**2 / 3  # S, J
CRITICAL = INERTIA / (MOMENT * PEN)
HOME, TRAVEL = (0.3, 0.0, -0.3), 0.15  # [m]; of each axis to either side
_SOFT = SpringLimits(stiffness=500.0, damping=10.0, largest=3.0)
GRIP = Grip(hand=SpringLimits(stiffness=100.0, damping=2.0, largest=1.0), hold=_SOFT, wall=_SOFT)


@dataclass(frozen=True, slots=True)
class CraneParameters(Parameters):
    """What a user can set, besides what every robot has."""

    speed: float = wanted_speed(2.0, (-10, 10, 0.1))
    alpha: float = number(
        0.8,
        "",
        (-1, 1.5, 0.01),
        "share of the swing that the controller sees",
        group="basic",
        label="α",
        symbol="α",
    )


def overhead_crane() -> Robot:
    """The crane, of which there is one instance."""
    q, v = ca.SX.sym("q", 5), ca.SX.sym("v", 5)
    alpha = ca.SX.sym("alpha")

    def direction(q: ca.SX) -> ca.SX:
        return ca.vertcat(ca.sin(q[3]) * ca.cos(q[4]), ca.sin(q[4]), -ca.cos(q[3]) * ca.cos(q[4]))

    def point(share: ca.SX | float) -> ca.SX:
        return q[:3] + share * PEN * (direction(q) + ca.DM([0, 0, 1]))

    turning = ca.jtimes(direction(q), q, v)
    moving = ca.DM([BRIDGE + TROLLEY + HOIST, TROLLEY + HOIST, HOIST]) + ROD
    kinetic = ca.dot(moving, v[:3] ** 2) / 2 + MOMENT * ca.dot(v[:3], turning)
    kinetic += INERTIA * ca.dot(turning, turning) / 2
    system = mechanical_system(
        name="overhead_crane",
        q=q,
        v=v,
        coordinate_names=("x_m", "y_m", "z_m", "a_rad", "b_rad"),
        parameters=alpha,
        parameter_names=("alpha",),
        mass=ca.jacobian(ca.gradient(kinetic, v), v),
        potential_energy=GRAVITY * ((HOIST + ROD) * q[2] + MOMENT * direction(q)[2]),
        friction=ca.vertcat(0.5 * v[:3], 0.005 * v[3:]),
        inputs=3,
        output=point(1.0),
        controlled_output=point(alpha),
    )

    def numbers(parameters: Parameters) -> Array:
        return system.parameter_vector({"alpha": own_parameters(CraneParameters, parameters).alpha})

    def skeleton(q: ca.SX, exaggeration: ca.SX) -> tuple[ca.SX, ca.SX]:
        joint = q[:3] + ca.DM(HOME) + ca.DM([0, 0, PEN])
        rail, trolley = ca.vertcat(joint[0], 0, 0), ca.vertcat(joint[:2], 0)
        tip = joint + PEN * direction(q)
        bars = (ca.SX.zeros(3), rail, rail, trolley, trolley, joint, joint, tip)
        return ca.horzcat(*bars), ca.horzcat(rail, trolley, joint)

    return Robot(
        system=system,
        plant=numbers,
        model=numbers,
        inverse=lambda y: ca.vertcat(y, 0, 0),
        skeleton=skeleton,
        home=HOME,
        reach=0.8,
        regularity=ca.fmin(1, 4 * (1 - ca.mmax(ca.fabs(q[:3])) / TRAVEL)),
        frame=LevelPlane(),
        grip=GRIP,
        drawing=Drawing(
            motors=(0, 1),
            axes=((1, 0, 0), (0, 1, 0), (0, 0, 1)),
        ),
    )


CRANE = overhead_crane()
ROBOT = RobotEntry(
    name="overhead_crane",
    label="Overhead crane",
    text="Three motors move a hoist, and none the rod that hangs from it with the pen.",
    parameters=CraneParameters,
    make=lambda _: CRANE,
)
