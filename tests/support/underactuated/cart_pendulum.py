"""A cart on a rail with a pen, and a pendulum that hangs from the cart or stands on it.

    q = (x, z, φ),   B u = (u1, u2, 0),   y = h = (x, z),

with φ the pendulum's angle from rest, hanging (s = 1) or upright (s = -1). It is a rod of length l
and mass m, and the slide that lifts the pen has no part in its motion:

    T = ½ (m1 + m2) x'² + ½ m2 z'² + ½ m |c'|² + ½ m l² φ'² / 12,
    c = (x, 0) + s l/2 (sin φ, -cos φ).

Held at y, it swings with φ'' = -s g sin φ / (2 l / 3): upright it falls over with the rate
sqrt(3 g / (2 l)), wherever the pen is.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import casadi as ca

from onpath.models.arrays import Array
from onpath.models.systems.parameter_specs import choice, number
from onpath.models.systems.parameters import Parameters, own_parameters
from onpath.models.systems.robots import Robot, RobotEntry
from onpath.models.systems.system import (
    GRAVITY,
    MechanicalSystem,
    mechanical_system,
)

NAMES = ("cart", "pen", "pendulum", "length", "side", "friction", "pivot")
CART, PEN, FRICTION = 1.0, 0.3, 0.5  # m1 and m2, [kg]; friction of the slides, [N s/m]
LENGTH = 0.2  # l, [m]
HOME = (0.2, 0.0, 0.15)  # the pen at y = 0, in the robot's frame, [m]
HALF = 0.15  # half of the width and height of the workspace, [m]
SIDES = {"hanging": 1.0, "upright": -1.0}


@dataclass(frozen=True, slots=True)
class CartParameters(Parameters):
    """Parameters of the cart. `pendulum` selects the instance of the robot."""

    pendulum: str = choice(
        "hanging",
        tuple(SIDES),
        "whether the pendulum hangs from the cart or stands on it",
        group="robot",
        label="Pendulum",
    )
    mass: float = number(
        0.2, "kg", (0.01, 1, 0.01), "mass of the pendulum", group="robot", label="Mass"
    )
    pivot: float = number(
        0.002,
        "N m s",
        (0, 0.02, 0.001),
        "damping of the pendulum's pivot",
        group="robot",
        label="Pivot damping",
    )


@lru_cache(maxsize=1)
def equations() -> MechanicalSystem:
    """The equations of motion, with parameters named as in `NAMES`."""
    q, v, numbers = ca.SX.sym("q", 3), ca.SX.sym("v", 3), ca.SX.sym("p", len(NAMES))
    p = dict(zip(NAMES, ca.vertsplit(numbers), strict=True))
    arm = p["side"] * p["length"] / 2
    centre = ca.vertcat(q[0] + arm * ca.sin(q[2]), -arm * ca.cos(q[2]))
    rate = ca.jtimes(centre, q, v)
    moving = p["cart"] * v[0] ** 2 + p["pen"] * ca.dot(v[:2], v[:2])
    moving += p["pendulum"] * (ca.dot(rate, rate) + p["length"] ** 2 / 12 * v[2] ** 2)
    potential = GRAVITY * (p["pen"] * q[1] + p["pendulum"] * centre[1])
    friction = ca.vertcat(p["friction"] * v[:2], p["pivot"] * v[2])
    return mechanical_system(
        name="cart_pendulum",
        q=q,
        v=v,
        parameters=numbers,
        parameter_names=NAMES,
        mass=ca.jacobian(ca.gradient(moving / 2, v), v),
        friction=friction,
        inputs=2,
        output=q[:2],
        potential_energy=potential,
        coordinate_names=("x_m", "z_m", "phi_rad"),
    )


@lru_cache(maxsize=len(SIDES))
def cart(pendulum: str) -> Robot:
    """The only instance for its pendulum."""
    side, system = SIDES[pendulum], equations()

    def plant(parameters: Parameters) -> Array:
        own = own_parameters(CartParameters, parameters)
        values = {"cart": CART, "pen": PEN, "friction": FRICTION, "length": LENGTH}
        values |= {"pendulum": own.mass, "side": side, "pivot": own.pivot}
        return system.parameter_vector(values)

    def skeleton(q: ca.SX, exaggeration: ca.SX) -> tuple[ca.SX, ca.SX]:
        """Pendulum, rail and pen; joints: base and pivot."""
        x, z = q[0] + HOME[0], q[1] + HOME[2]
        base, pivot = ca.SX.zeros(3, 1), ca.vertcat(x, 0, 0)
        swing = side * ca.vertcat(ca.sin(q[2]), 0, -ca.cos(q[2]))
        end, pen = pivot + LENGTH * swing, ca.vertcat(x, 0, z)
        bars = ca.horzcat(pivot, end, base, pivot, pivot, pen)
        return bars, ca.horzcat(base, pivot)

    return Robot(
        system=system,
        plant=plant,
        model=plant,
        inverse=lambda y: ca.vertcat(y, 0),
        skeleton=skeleton,
        home=HOME,
        reach=0.6,
        regularity=1 - ca.mmax(ca.fabs(system.q[:2])) / HALF,
        stops=(),
    )


def cart_for(parameters: Parameters) -> Robot:
    """The instance for these parameters."""
    return cart(own_parameters(CartParameters, parameters).pendulum)


ROBOT = RobotEntry(
    name="cart_pendulum",
    label="Cart with a pendulum",
    text="Two motors move a pen, and none the pendulum on its cart.",
    parameters=CartParameters,
    make=cart_for,
)
