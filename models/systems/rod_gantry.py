"""A gantry in a vertical plane: a carriage moves right and up, and a rod hangs from it.

    q = (x, z, φ),   B u = (u1, u2, 0),
    y_α = (x + α L sin φ, z + α L (1 - cos φ)),   L = 2 l / 3,

with φ the rod's angle from the vertical, no motor at its pivot, and l its length. The end-point
h = y_1 is a pen at the rod's centre of percussion, at L from the pivot, and the controller sees the
share α of its swing. With A and B the masses that move right and up, the rod's S = m l / 2 and
J = m l² / 3, to which a payload m' at the pen adds m' L and m' L²,

    T = ½ A x'² + ½ B z'² + ½ J φ'² + S φ' (x' cos φ + z' sin φ),   V = g (B z - S cos φ).

S L = J, with any payload. So, held at y_α and without damping, the rod swings with
φ'' = -g sin φ / ((1 - α) L): the critical α is 1. There the decoupling matrix loses rank, as forces
at the pivot do not accelerate the centre of percussion across the rod. Beyond it the rod falls
over, at the rate sqrt(g / ((α - 1) L)). Illustrative values.

Source: eqs. (1)-(3), (10); for the centre of percussion, any textbook of mechanics.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import casadi as ca

from onpath.models.arrays import Array
from onpath.models.systems.drawing import Angle, Drawing, Length
from onpath.models.systems.forces import Grip, SpringLimits
from onpath.models.systems.parameter_specs import (
    number,
    pivot_damping,
    unknown_payload,
    wanted_speed,
)
from onpath.models.systems.parameters import Parameters, own_parameters
from onpath.models.systems.robots import Robot, RobotEntry
from onpath.models.systems.slides import buffers, crushed, room
from onpath.models.systems.system import GRAVITY, mechanical_system

BRIDGE, CARRIAGE = 0.4, 0.15  # [kg]; the bridge only moves right
FRICTION = 0.5  # of both slides, [N s/m]
ROD = 0.2  # l, [m]
PERCUSSION = 2 * ROD / 3  # L, [m]
RAIL, TRAVEL = 0.42, 0.15  # [m]; length, and travel of the carriage to either side
HOME = (0.21, 0.0, -0.32)  # the pen at y = 0; the origin is the rail's left end, [m]
_SOFT = SpringLimits(stiffness=500.0, damping=10.0, largest=3.0)
GRIP = Grip(hand=SpringLimits(stiffness=100.0, damping=2.0, largest=1.0), hold=_SOFT, wall=_SOFT)
"""The rod weighs 3 N: a hand of 15 N would throw it around its pivot."""
NAMES = ("right", "up", "moment", "inertia", "pivot", "alpha")


@dataclass(frozen=True, slots=True)
class RodGantryParameters(Parameters):
    """Parameters of the gantry. The default speed swings the rod less than that of other robots."""

    speed: float = wanted_speed(2.0, (-10, 10, 0.1))
    alpha: float = number(
        0.9,
        "",
        (-1, 1.5, 0.01),
        "share of the swing that the controller sees: 1 the pen, 0 the carriage",
        group="basic",
        label="α",
        symbol="α",
    )
    rod: float = number(
        0.3, "kg", (0.05, 0.5, 0.01), "mass of the hanging rod", group="robot", label="Rod"
    )
    pivot: float = pivot_damping(0.005)
    payload: float = unknown_payload((0, 0.3, 0.01), on=0.1)


def rod_gantry() -> Robot:
    """The gantry, of which there is one instance."""
    q, v = ca.SX.sym("q", 3), ca.SX.sym("v", 3)
    numbers = ca.SX.sym("numbers", len(NAMES))
    right, up, moment, inertia, pivot, alpha = ca.vertsplit(numbers)
    sin, cos = ca.sin(q[2]), ca.cos(q[2])

    def point(share: ca.SX | float) -> ca.SX:
        return q[:2] + share * PERCUSSION * ca.vertcat(sin, 1 - cos)

    system = mechanical_system(
        name="rod_gantry",
        q=q,
        v=v,
        coordinate_names=("x_m", "z_m", "phi_rad"),
        parameters=numbers,
        parameter_names=NAMES,
        mass=ca.blockcat(
            [[right, 0, moment * cos], [0, up, moment * sin], [moment * cos, moment * sin, inertia]]
        ),
        potential_energy=GRAVITY * (up * q[1] - moment * cos),
        friction=ca.vertcat(FRICTION * v[:2], pivot * v[2]),
        inputs=2,
        ends=ca.vertcat(buffers(q[:2], v[:2], TRAVEL), 0),
        output=point(1.0),
        controlled_output=point(alpha),
    )

    def plant(parameters: Parameters) -> Array:
        own = own_parameters(RodGantryParameters, parameters)
        up = CARRIAGE + own.rod + own.payload
        values = {"right": BRIDGE + up, "up": up, "pivot": own.pivot, "alpha": own.alpha}
        values["moment"] = own.rod * ROD / 2 + own.payload * PERCUSSION
        values["inertia"] = values["moment"] * PERCUSSION  # J = S L
        return system.parameter_vector(values)

    def model(parameters: Parameters) -> Array:
        return plant(replace(own_parameters(RodGantryParameters, parameters), payload=0.0))

    def skeleton(q: ca.SX, exaggeration: ca.SX) -> tuple[ca.SX, ca.SX]:
        """Rail, end of the rod, slide, and rod; joints: the slide on the rail, and the pivot."""
        slide = ca.vertcat(HOME[0] + q[0], 0, 0)
        pivot = slide + ca.vertcat(0, 0, HOME[2] + PERCUSSION + q[1])
        down = ca.vertcat(ca.sin(q[2]), 0, -ca.cos(q[2]))
        pen, end = pivot + PERCUSSION * down, pivot + ROD * down
        rail = ca.horzcat(ca.SX.zeros(3), ca.vertcat(RAIL, 0, 0))
        return ca.horzcat(rail, end, pen, slide, pivot, pivot, pen), ca.horzcat(slide, pivot)

    return Robot(
        system=system,
        plant=plant,
        model=model,
        inverse=lambda y: ca.vertcat(y, 0),
        skeleton=skeleton,
        home=HOME,
        reach=0.62,
        regularity=room(q[:2], TRAVEL),
        stops=(crushed(q[:2], TRAVEL),),
        grip=GRIP,
        drawing=Drawing(
            motors=(0,),
            box=((-0.07, -0.03, -0.56), (RAIL + 0.05, 0.03, 0.15)),
            angles=(Angle("φ", bar=3, after=2, near=0.0),),
            lengths=(Length("L", 6, 7, right=True),),
        ),
    )


ROD_GANTRY = rod_gantry()
ROBOT = RobotEntry(
    name="rod_gantry",
    label="Gantry with a rod",
    text="Two motors move a carriage, and none the rod that hangs from it with the pen.",
    picture="rod_gantry.webp",
    parameters=RodGantryParameters,
    make=lambda _: ROD_GANTRY,
)
