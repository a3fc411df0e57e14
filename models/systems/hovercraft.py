"""A hovercraft with two fans, seen from above: two thrusts move three coordinates.

    q = (x, z, φ),   y = h = (x, z) + d e,   e = (cos φ, sin φ),   n = (-sin φ, cos φ),

with (x, z) the centre of mass, φ the heading from the right, and d the place of the pen: in front
of the centre of mass (d > 0), on it (d = 0) or behind it (d < 0). The fans push along e, on the
right and on the left of the middle by w:

    m (x, z)'' = (u1 + u2) e - c (x, z)',   J φ'' = w (u1 - u2).

So y'' = (u1 + u2) e / m + (d w / J) (u1 - u2) n + …, and |det D| = 2 w |d| / (m J). At the centre
of mass D has rank 1 in every configuration, as no fan pushes sideways, and condition (11) fails;
anywhere else on the axis it holds everywhere. Theorem 2.1 then says that the pen can be kept on its
path, and nothing of the heading, η₁. With the pen kept on a motion y(t),

    φ'' = (y'' + (c/m) y') · n / d - (c/m) φ'.

Without drag (c = 0) this is φ'' = (a/d) sin(ψ - φ), where a and ψ are size and direction of y'': a
pendulum that hangs in the direction of the acceleration. In front (d > 0) the nose hangs towards
it, behind (d < 0) the tail, and nothing damps the swinging. Drag damps it by the rate c/m, and
turns the direction from y'' towards the velocity, to y'' + (c/m) y'. At rest every heading is an
equilibrium: the exponents are 0 and -c/m. Illustrative values.

Source: eqs. (1)-(3), (10), (11); Newton's equations.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import casadi as ca

from onpath.models.arrays import Array
from onpath.models.systems.drawing import Angle, Depths, Drawing, Length
from onpath.models.systems.parameter_specs import (
    choice,
    number,
    unknown_payload,
    wanted_speed,
)
from onpath.models.systems.parameters import Parameters, own_parameters
from onpath.models.systems.robots import Robot, RobotEntry
from onpath.models.systems.system import mechanical_system

MASS, GYRATION = 0.5, 0.05  # m, [kg]; radius of gyration, J = m r², [m]
ASIDE = 0.05  # w, [m]
PLACES = {"front": 0.06, "centre": 0.0, "behind": -0.06}
"""d of the pen, [m]."""
AHEAD = 1.5707963267948966  # heading at the start, along the usual paths, [rad]
ROOM = 0.25  # the pen's travel to each side, [m]
HOME = (0.0, 0.0, 0.0)  # the pen at y = 0, [m]
NAMES = ("mass", "inertia", "drag")
BOW, STERN = 0.09, 0.07  # the hull in front of the centre of mass and behind it, [m]


@dataclass(frozen=True, slots=True)
class HovercraftParameters(Parameters):
    """Parameters of the hovercraft. `pen` selects the instance of the robot."""

    speed: float = wanted_speed(2.0, (-10, 10, 0.1))
    pen: str = choice(
        "front",
        tuple(PLACES),
        "where the pen sits on the hovercraft's axis",
        group="robot",
        label="Pen",
        compiles=True,
    )
    drag: float = number(
        0.5,
        "N s/m",
        (0, 2, 0.05),
        "drag of the air on the centre of mass",
        group="robot",
        label="Drag",
    )
    payload: float = unknown_payload((0, 0.3, 0.01), on=0.1)


@lru_cache(maxsize=len(PLACES))
def hovercraft(pen: str) -> Robot:
    """The only instance for the place of its pen."""
    d = PLACES[pen]
    q, v = ca.SX.sym("q", 3), ca.SX.sym("v", 3)
    mass, inertia, drag = ca.vertsplit(numbers := ca.SX.sym("numbers", len(NAMES)))
    e = ca.vertcat(ca.cos(q[2]), ca.sin(q[2]))
    system = mechanical_system(
        name="hovercraft",
        q=q,
        v=v,
        coordinate_names=("x_m", "z_m", "phi_rad"),
        parameters=numbers,
        parameter_names=NAMES,
        mass=ca.diag(ca.vertcat(mass, mass, inertia)),
        potential_energy=ca.SX(0),
        friction=ca.vertcat(drag * v[:2], 0),
        actuation=ca.vertcat(ca.horzcat(e, e), ca.horzcat(ASIDE, -ASIDE)),
        inputs=2,
        output=q[:2] + d * e,
    )

    def plant(parameters: Parameters) -> Array:
        own = own_parameters(HovercraftParameters, parameters)
        return system.parameter_vector(
            {
                "mass": MASS + own.payload,
                "inertia": MASS * GYRATION**2,
                "drag": own.drag,
            }
        )

    def model(parameters: Parameters) -> Array:
        return plant(replace(own_parameters(HovercraftParameters, parameters), payload=0.0))

    def skeleton(q: ca.SX, exaggeration: ca.SX) -> tuple[ca.SX, ca.SX]:
        """The hull, the line to the pen; joints: the fans."""
        middle = ca.vertcat(q[0], 0, q[1])
        along = ca.vertcat(ca.cos(q[2]), 0, ca.sin(q[2]))
        left = ca.vertcat(-ca.sin(q[2]), 0, ca.cos(q[2]))
        bow = middle + BOW * along
        stern = middle - STERN * along
        port, starboard = stern + ASIDE * left, stern - ASIDE * left
        pen = middle + d * along
        begin = middle if d else stern
        bars = (port, bow, bow, starboard, starboard, port, begin, pen)
        return ca.horzcat(*bars), ca.horzcat(port, starboard)

    return Robot(
        system=system,
        plant=plant,
        model=model,
        inverse=lambda y: ca.vertcat(y - d * ca.vertcat(0, 1), AHEAD),
        skeleton=skeleton,
        home=HOME,
        reach=0.36,
        regularity=ca.fmin(1, 4 * (1 - ca.mmax(ca.fabs(system.output)) / ROOM)),
        drawing=Drawing(
            base="none",
            depths=Depths(back=0.03, front=0.03, boss=0.03),
            angles=(Angle("φ", bar=3, near=AHEAD),),
            lengths=(Length("d", 6, 7, right=True),),
        ),
    )


def hovercraft_for(parameters: Parameters) -> Robot:
    """The instance for these parameters."""
    return hovercraft(own_parameters(HovercraftParameters, parameters).pen)


ROBOT = RobotEntry(
    name="hovercraft",
    label="Hovercraft",
    text="Two fans push three coordinates, seen from above: nothing pushes sideways.",
    parameters=HovercraftParameters,
    make=hovercraft_for,
)
