"""The user's settings of a control law: gains, and the wanted motion along the path."""

from __future__ import annotations

import math
from dataclasses import dataclass

from onpath.models.systems.parameter_specs import DEGREES, Need, choice, number, wanted_speed

PLACE = Need("task", ("position",))
ALONG = (Need("task", ("speed",)),)
AT_REST = tuple(Need(side, ("set_point",)) for side in ("left", "right"))
DISTANCE, LEVEL_SET = "distance", "level_set"  # meanings of ξ across the path, [m] or [m²]


@dataclass(frozen=True, slots=True)
class LawParameters:
    """Shared gains of the laws, and the task; `Parameters` adds the realism.

    The defaults suit the rigid five-bar. The other gains are declared in the modules of their laws.
    """

    K1: float = number(
        400.0,
        "1/s²",
        (0, 2500, 5),
        "spring that pulls back onto the path",
        group="gains",
        label="K1 across",
        symbol="K₁",
        scale="log",
    )
    K2: float = number(
        40.0,
        "1/s",
        (0, 200, 1),
        "damps motion across the path",
        group="gains",
        label="K2 across",
        symbol="K₂",
        scale="log",
    )
    K3: float = number(
        1000.0,
        "1/s³",
        (0, 8000, 50),
        "removes a lasting offset (integral)",
        group="gains",
        label="K3 across",
        symbol="K₃",
        scale="log",
    )
    tracker_integral: str = choice(
        "off",
        ("off", "on"),
        "whether K3 acts in a law that follows the clock: held back, its integral winds up",
        group="gains",
        label="Tracker's integral",
        needs=(Need("K3"),),
    )
    K4: float = number(
        25.0,
        "1/s²",
        (0, 400, 1),
        "spring towards the target position",
        group="gains",
        label="K4 along",
        symbol="K₄",
        scale="log",
        needs=(PLACE,),
    )
    K5: float = number(
        10.0,
        "1/s",
        (0, 100, 0.5),
        "how hard the speed along the path is held",
        group="gains",
        label="K5 along",
        symbol="K₅",
        scale="log",
    )
    task: str = choice(
        "speed",
        ("speed", "position"),
        "go along the path at a speed, or to a place on it",
        group="task",
        label="Task",
    )
    speed: float = wanted_speed(2 * math.pi, (-20, 20, 0.1))
    ramp: float = number(
        0.0,
        "rad/s²",
        (0, 100, 0.5),
        "how quickly the wanted speed changes; 0: at once",
        group="task",
        label="Speed ramp",
        needs=(Need("speed_profile", ("constant",), instead=(PLACE,)),),
    )
    speed_profile: str = choice(
        "constant",
        ("constant", "ramp_up", "sine", "stop_and_go"),
        "how the wanted speed varies from the start of a run: up from rest, as a sine about the"
        " speed, or stop and go at the speed; it is fed forward as in (19), instead of the ramp",
        group="task",
        label="Speed profile",
        needs=ALONG,
    )
    profile_period: float = number(
        2.0,
        "s",
        (0.5, 20, 0.1),
        "period of the sine and of stop and go; of ramp up, the time until the speed is reached",
        group="task",
        label="Profile period",
        scale="log",
        needs=(*ALONG, Need("speed_profile", ("ramp_up", "sine", "stop_and_go"))),
    )
    target: float = number(
        math.pi / 2,
        "rad",
        (-math.pi, math.pi, 0.01),
        "where to stop, with task = position",
        group="task",
        label="Target",
        symbol="θ",
        needs=(Need("task", ("position",), instead=AT_REST),),
        shown_in=DEGREES,
    )
    across: str = choice(
        DISTANCE,
        (DISTANCE, LEVEL_SET),
        "what to measure across the path: the distance, or the paper's s(y) in m² (ellipses; on the"
        " command line also polynomials, in m)",
        group="gains",
        label="Measured across",
        compiles=True,
    )
    own_gains: tuple[tuple[str, float], ...] = ()
    """Gains of single laws by name, where they differ from the laws' defaults: see `changed` in
    models/control/settable.py."""
