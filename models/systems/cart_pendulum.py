"""A cart with a pendulum, on a rail in a vertical plane, and a pen that slides up and down on it.

    q = (x, z, φ),   B u = (u1, u2, 0),   y = h = (x, z),

with φ the pendulum's angle from rest, hanging (s = 1) or upright (s = -1), and no motor at its
pivot. It is a rod of length l and mass m. With S = s m l / 2, J = m l² / 3, A the mass that moves
right, and m2 that of the pen, which has no part in the pendulum's motion,

    T = ½ A x'² + ½ m2 z'² + ½ J φ'² + S x' φ' cos φ,   V = g (m2 z - S cos φ).

Held at y, it swings with φ'' = -s g sin φ / (2 l / 3): upright it falls over at the rate
sqrt(3 g / (2 l)), wherever the pen is, and no choice of gains changes that. The decoupling matrix
has full rank wherever the pendulum is. The usual cart with a pendulum has one motor and so one
output (theorem 2.1), too few for a path in a plane: here the pen has the second motor. Illustrative
values.

Source: eqs. (1)-(3), (10).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import casadi as ca

from onpath.models.arrays import Array
from onpath.models.systems.drawing import Angle, Drawing
from onpath.models.systems.parameter_specs import (
    choice,
    number,
    pivot_damping,
    unknown_payload,
    wanted_speed,
)
from onpath.models.systems.parameters import Parameters, own_parameters
from onpath.models.systems.robots import Robot, RobotEntry
from onpath.models.systems.slides import buffers, crushed, room
from onpath.models.systems.system import GRAVITY, MechanicalSystem, mechanical_system

CART, PEN, FRICTION = 0.6, 0.2, 0.5  # [kg]; friction of both slides, [N s/m]
LENGTH = 0.2  # l, [m]
RAIL, TRAVEL = 0.5, 0.15  # [m]; length, and travel of the pen to either side
ASIDE = 0.06  # of the cart's middle: the pivot on the left, the pen on the right, [m]
HOME = (0.27, 0.0, -0.2)  # the pen at y = 0; the origin is the rail's left end, [m]
SIDES = {"hanging": 1.0, "upright": -1.0}
DRAWING = Drawing(
    motors=(1,),
    box=((-0.07, -0.03, -0.37), (RAIL + 0.05, 0.03, LENGTH + 0.13)),
    angles=(Angle("φ", bar=2, after=3, near=0.0),),
)
NAMES = ("right", "pen", "moment", "inertia", "pivot")


@dataclass(frozen=True, slots=True)
class CartParameters(Parameters):
    """Parameters of the cart. `pendulum` selects the instance of the robot."""

    speed: float = wanted_speed(2.0, (-10, 10, 0.1))
    pendulum: str = choice(
        "hanging",
        tuple(SIDES),
        "whether the pendulum hangs from the cart or stands on it",
        group="robot",
        label="Pendulum",
        compiles=True,
    )
    mass: float = number(
        0.1, "kg", (0.01, 0.5, 0.01), "mass of the pendulum", group="robot", label="Mass"
    )
    pivot: float = pivot_damping(0.001)
    payload: float = unknown_payload((0, 0.3, 0.01), on=0.1)


@lru_cache(maxsize=1)
def equations() -> MechanicalSystem:
    """The equations of motion, with parameters named as in `NAMES`."""
    q, v = ca.SX.sym("q", 3), ca.SX.sym("v", 3)
    numbers = ca.SX.sym("numbers", len(NAMES))
    right, pen, moment, inertia, pivot = ca.vertsplit(numbers)
    coupling = moment * ca.cos(q[2])
    return mechanical_system(
        name="cart_pendulum",
        q=q,
        v=v,
        coordinate_names=("x_m", "z_m", "phi_rad"),
        parameters=numbers,
        parameter_names=NAMES,
        mass=ca.blockcat([[right, 0, coupling], [0, pen, 0], [coupling, 0, inertia]]),
        potential_energy=GRAVITY * (pen * q[1] - coupling),
        friction=ca.vertcat(FRICTION * v[:2], pivot * v[2]),
        inputs=2,
        ends=ca.vertcat(buffers(q[:2], v[:2], TRAVEL), 0),
        output=q[:2],
    )


@lru_cache(maxsize=len(SIDES))
def cart(pendulum: str) -> Robot:
    """The only instance for its pendulum."""
    side, system = SIDES[pendulum], equations()

    def plant(parameters: Parameters) -> Array:
        own = own_parameters(CartParameters, parameters)
        pen = PEN + own.payload
        values = {"right": CART + pen + own.mass, "pen": pen, "pivot": own.pivot}
        values["moment"] = side * own.mass * LENGTH / 2
        values["inertia"] = own.mass * LENGTH**2 / 3
        return system.parameter_vector(values)

    def model(parameters: Parameters) -> Array:
        return plant(replace(own_parameters(CartParameters, parameters), payload=0.0))

    def skeleton(q: ca.SX, exaggeration: ca.SX) -> tuple[ca.SX, ca.SX]:
        """Rail, cart, pendulum and the pen's slide; joints: pivot, and the slide on the cart."""
        slide = ca.vertcat(HOME[0] + q[0], 0, 0)
        pivot = slide - ca.vertcat(2 * ASIDE, 0, 0)
        end = pivot + side * LENGTH * ca.vertcat(ca.sin(q[2]), 0, -ca.cos(q[2]))
        pen = slide + ca.vertcat(0, 0, HOME[2] + q[1])
        rail = ca.horzcat(ca.SX.zeros(3), ca.vertcat(RAIL, 0, 0))
        return ca.horzcat(rail, pivot, slide, pivot, end, slide, pen), ca.horzcat(pivot, slide)

    return Robot(
        system=system,
        plant=plant,
        model=model,
        inverse=lambda y: ca.vertcat(y, 0),
        skeleton=skeleton,
        home=HOME,
        reach=0.6,
        regularity=room(system.q[:2], TRAVEL),
        stops=(crushed(system.q[:2], TRAVEL),),
        drawing=DRAWING,
    )


def cart_for(parameters: Parameters) -> Robot:
    """The instance for these parameters."""
    return cart(own_parameters(CartParameters, parameters).pendulum)


ROBOT = RobotEntry(
    name="cart_pendulum",
    label="Cart with a pendulum",
    text="Two motors move a pen on a cart, and none the pendulum, which hangs or stands on it.",
    picture="cart_pendulum.webp",
    parameters=CartParameters,
    make=cart_for,
)
