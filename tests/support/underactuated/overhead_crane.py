"""An overhead crane: a carriage that moves right and up, and a rod with a load that hangs from it.

    q = (x, z, φ),   B u = (u1, u2, 0),
    y_α = (x + α l sin φ, z + α l (1 - cos φ)),

with φ the rod's angle from the vertical. The end-point h = y_1 is the load at the end of the rod,
and the controller sees the share α of its swing. With r = l / 2, the rod's mass m_r and the load m,

    T = ½ (m1 + m2) x'² + ½ m2 z'² + ½ m_r (|c'|² + l² φ'² / 12) + ½ m |h'|²,
    V = g (m2 z + m_r c_z + m h_z),   c = (x + r sin φ, z - r cos φ).

Held at y_α, and without damping, the rod swings with φ'' = -g sin φ / (L - α l), where L is the
distance from the pivot to the rod's centre of percussion,

    L = (m_r l² / 3 + m l²) / (m_r l / 2 + m l),

so that α = L / l is critical: 1 without a mass of the rod, 2/3 without a load. There the decoupling
matrix has rank 1, and beyond it the rod falls over with the rate sqrt(g / (α l - L)).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import casadi as ca

from onpath.models.arrays import Array
from onpath.models.systems.parameter_specs import model_error, number
from onpath.models.systems.parameters import Parameters, own_parameters
from onpath.models.systems.robots import Robot, RobotEntry
from onpath.models.systems.system import (
    GRAVITY,
    MechanicalSystem,
    mechanical_system,
)

NAMES = ("bridge", "carriage", "rod", "load", "length", "alpha", "friction", "pivot")
BRIDGE, CARRIAGE = 1.0, 0.2  # m1 and m2, [kg]
FRICTION = 0.5  # of the slides, [N s/m]
HOME = (0.2, 0.0, 0.1)  # the load at y = 0, in the robot's frame, [m]
HALF = 0.15  # half of the width and height of the workspace, [m]


@dataclass(frozen=True, slots=True)
class CraneParameters(Parameters):
    """Parameters of the crane. Its length selects the instance of the robot."""

    speed: float = number(
        2.0,
        "rad/s",
        (-10, 10, 0.1),
        "wanted speed along the path; negative: backwards; with a speed profile, the mean of the"
        " sine, and otherwise the largest speed",
        group="task",
        label="Speed",
    )
    alpha: float = number(
        0.9,
        "",
        (-1, 1.5, 0.01),
        "share of the swing that the controller sees: 1 the load, 0 the carriage",
        group="basic",
        label="α",
    )
    length: float = number(
        0.2, "m", (0.05, 0.4, 0.01), "length of the rod", group="robot", label="Length"
    )
    rod: float = number(0.0, "kg", (0, 1, 0.01), "mass of the rod", group="robot", label="Rod")
    load: float = number(
        0.2, "kg", (0.01, 1, 0.01), "mass of the load", group="robot", label="Load"
    )
    pivot: float = number(
        0.002,
        "N m s",
        (0, 0.02, 0.001),
        "damping of the rod's pivot",
        group="robot",
        label="Pivot damping",
    )
    error_load: float = model_error("Error in load", "the controller's load is off by this")


def percussion(own: CraneParameters) -> float:
    """L, the distance from the pivot to the rod's centre of percussion, [m]."""
    first, second = own.rod / 2 + own.load, own.rod / 3 + own.load
    return own.length * second / first


@lru_cache(maxsize=1)
def equations() -> MechanicalSystem:
    """The equations of motion, with parameters named as in `NAMES`."""
    q, v, numbers = ca.SX.sym("q", 3), ca.SX.sym("v", 3), ca.SX.sym("p", len(NAMES))
    p = dict(zip(NAMES, ca.vertsplit(numbers), strict=True))

    def point(share: ca.SX | float) -> ca.SX:
        """A place on the rod, 0 at rest, [m]."""
        arm = share * p["length"]
        return ca.vertcat(q[0] + arm * ca.sin(q[2]), q[1] + arm * (1 - ca.cos(q[2])))

    def kinetic(mass: ca.SX, place: ca.SX) -> ca.SX:
        rate = ca.jtimes(place, q, v)
        return mass / 2 * ca.dot(rate, rate)

    middle, end = point(0.5), point(1.0)
    moving = (p["bridge"] * v[0] ** 2 + p["rod"] * p["length"] ** 2 / 12 * v[2] ** 2) / 2
    moving += kinetic(p["carriage"], q[:2]) + kinetic(p["rod"], middle) + kinetic(p["load"], end)
    potential = GRAVITY * (p["carriage"] * q[1] + p["rod"] * middle[1] + p["load"] * end[1])
    friction = ca.vertcat(p["friction"] * v[:2], p["pivot"] * v[2])
    return mechanical_system(
        name="overhead_crane",
        q=q,
        v=v,
        parameters=numbers,
        parameter_names=NAMES,
        mass=ca.jacobian(ca.gradient(moving, v), v),
        friction=friction,
        inputs=2,
        output=end,
        controlled_output=point(p["alpha"]),
        potential_energy=potential,
        coordinate_names=("x_m", "z_m", "phi_rad"),
    )


def plant(own: CraneParameters) -> Array:
    """The numbers of `NAMES`."""
    values: dict[str, float] = {"bridge": BRIDGE, "carriage": CARRIAGE, "friction": FRICTION}
    values |= {"rod": own.rod, "load": own.load, "length": own.length}
    values |= {"alpha": own.alpha, "pivot": own.pivot}
    return equations().parameter_vector(values)


def model(own: CraneParameters) -> Array:
    """The plant with the chosen error of the load."""
    return plant(replace(own, load=own.load * (1 + own.error_load / 100)))


@lru_cache(maxsize=16)
def crane(length: float = 0.2) -> Robot:
    """The only instance for its length."""
    system = equations()

    def skeleton(q: ca.SX, exaggeration: ca.SX) -> tuple[ca.SX, ca.SX]:
        """Bridge, carriage and rod; joints: base, bridge, pivot."""
        x, z = q[0] + HOME[0], q[1] + HOME[2] + length
        base, bridge, pivot = ca.SX.zeros(3, 1), ca.vertcat(x, 0, 0), ca.vertcat(x, 0, z)
        tip = pivot + length * ca.vertcat(ca.sin(q[2]), 0, -ca.cos(q[2]))
        bars = ca.horzcat(base, bridge, bridge, pivot, pivot, tip)
        return bars, ca.horzcat(base, bridge, pivot)

    return Robot(
        system=system,
        plant=lambda parameters: plant(own_parameters(CraneParameters, parameters)),
        model=lambda parameters: model(own_parameters(CraneParameters, parameters)),
        inverse=lambda y: ca.vertcat(y, 0),
        skeleton=skeleton,
        home=HOME,
        reach=0.6,
        regularity=1 - ca.mmax(ca.fabs(system.q[:2])) / HALF,
        stops=(),
    )


def crane_for(parameters: Parameters) -> Robot:
    """The instance for these parameters."""
    return crane(own_parameters(CraneParameters, parameters).length)


ROBOT = RobotEntry(
    name="overhead_crane",
    label="Overhead crane",
    text="Two motors move the carriage, and none the rod that hangs from it with a load.",
    parameters=CraneParameters,
    make=crane_for,
)
