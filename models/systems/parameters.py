"""All numbers and choices that a user can set, each declared once with unit, range and help.

Widgets, the command line and files are generated from these declarations.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from types import MappingProxyType
from typing import Any, TypeVar

from onpath.models.systems.parameter_specs import Spec, checked, choice, number, unknown_name

TICK = 1e-3  # [s], length of a tick at control rates up to 1 kHz
DISTANCE, LEVEL_SET = "distance", "level_set"  # what ξ measures across the path, [m] or [m²]

P = TypeVar("P", bound="Parameters")


@dataclass(frozen=True, slots=True)
class Parameters:
    """Parameters of every robot: gains, task, realism. The defaults suit the rigid five-bar."""

    K1: float = number(
        400.0,
        "1/s²",
        (0, 2500, 5),
        "spring that pulls back onto the path",
        group="gains",
        label="K1 across",
    )
    K2: float = number(
        40.0,
        "1/s",
        (0, 200, 1),
        "damps motion across the path",
        group="gains",
        label="K2 across",
    )
    K3: float = number(
        1000.0,
        "1/s³",
        (0, 8000, 50),
        "removes a lasting offset (integral)",
        group="gains",
        label="K3 across",
    )
    tracker_integral: str = choice(
        "off",
        ("off", "on"),
        "whether K3 acts in a law that follows the clock: held back, its integral winds up",
        group="gains",
        label="Tracker's integral",
    )
    K4: float = number(
        25.0,
        "1/s²",
        (0, 400, 1),
        "spring towards the target position",
        group="gains",
        label="K4 along",
    )
    K5: float = number(
        10.0,
        "1/s",
        (0, 100, 0.5),
        "how hard the speed along the path is held",
        group="gains",
        label="K5 along",
    )
    task: str = choice(
        "speed",
        ("speed", "position"),
        "go along the path at a speed, or to a place on it",
        group="task",
        label="Task",
    )
    speed: float = number(
        2 * math.pi,
        "rad/s",
        (-20, 20, 0.1),
        "wanted speed along the path; negative: backwards; with a speed profile, the mean of the"
        " sine, and otherwise the largest speed",
        group="task",
        label="Speed",
    )
    ramp: float = number(
        0.0,
        "rad/s²",
        (0, 100, 0.5),
        "how quickly the wanted speed changes; 0: at once",
        group="task",
        label="Speed ramp",
    )
    speed_profile: str = choice(
        "constant",
        ("constant", "ramp_up", "sine", "stop_and_go"),
        "how the wanted speed varies from the start of a run: up from rest, as a sine about the"
        " speed, or stop and go at the speed; it is fed forward as in (19), instead of the ramp",
        group="task",
        label="Speed profile",
    )
    profile_period: float = number(
        2.0,
        "s",
        (0.5, 20, 0.1),
        "period of the sine and of stop and go; of ramp up, the time until the speed is reached",
        group="task",
        label="Profile period",
    )
    target: float = number(
        math.pi / 2,
        "rad",
        (-math.pi, math.pi, 0.01),
        "where to stop, with task = position",
        group="task",
        label="Target",
    )
    across: str = choice(
        DISTANCE,
        (DISTANCE, LEVEL_SET),
        "what to measure across the path: the distance, or the paper's s(y) in m² (ellipses only)",
        group="gains",
        label="Across is",
    )
    clock_gain: float = number(
        50.0,
        "1/s",
        (0, 200, 1),
        "how strongly the waiting clock feels the error along the path; 0: an ordinary clock",
        group="gains",
        label="Clock waits",
    )
    contour_ratio: float = number(
        0.1,
        "",
        (0.01, 1, 0.01),
        "contouring: how stiff it is along the path, as a share of across",
        group="gains",
        label="Along / across",
    )
    field_gain: float = number(
        10.0,
        "1/s",
        (0, 40, 0.5),
        "velocity field: how quickly it leads back to the path",
        group="gains",
        label="Field to path",
    )
    field_circulation: float = number(
        30.0,
        "1/(J s)",
        (0, 100, 1),
        "velocity field: how quickly the velocity turns into the field",
        group="gains",
        label="Field turns",
    )
    field_energy: float = number(
        0.2,
        "J",
        (0.02, 2, 0.01),
        "velocity field: energy of the robot and the flywheel together",
        group="gains",
        label="Field energy",
    )
    torque_limit: float = number(
        0.0,
        "N m",
        (0, 5, 0.05),
        "motors give no more than this; 0: no limit",
        group="realism",
        label="Torque limit",
        on=0.5,
    )
    at_limit: str = choice(
        "across_first",
        ("across_first", "slow_down", "cut"),
        "when a torque limit is reached, path following gives up speed along the path before the"
        " path; slow_down: and asks only for a speed that the whole path allows; cut: neither",
        group="realism",
        label="At the limit",
    )
    torque_step: float = number(
        0.0,
        "N m",
        (0, 0.2, 0.001),
        "the motors' torque is a multiple of this; 0: any torque",
        group="realism",
        label="Torque steps",
        on=0.02,
    )
    encoder_counts: float = number(
        0.0,
        "per turn",
        (0, 20000, 100),
        "steps of the joint encoders; 0: exact sensing",
        group="realism",
        label="Encoder",
        on=2000.0,
    )
    encoder_filter: float = number(
        0.005,
        "s",
        (0.0005, 0.05, 0.0005),
        "time constant of the velocity filter behind them",
        group="realism",
        label="Velocity filter",
    )
    sensor_noise: float = number(
        0.0,
        "rad",
        (0, 0.002, 0.00001),
        "standard deviation of the measured joint angles; their filter gives the velocities",
        group="realism",
        label="Sensor noise",
        on=0.0001,
    )
    seed: float = number(
        0.0,
        "",
        (0, 9999, 1),
        "chooses the random numbers of the noise: the same seed, the same run",
        group="realism",
        label="Noise seed",
    )
    coulomb: float = number(
        0.0,
        "N m",
        (0, 0.3, 0.005),
        "dry friction in the joints; 0: none",
        group="realism",
        label="Dry friction",
        on=0.05,
    )
    stiction: float = number(
        0.0,
        "N m",
        (0, 0.3, 0.005),
        "a joint at rest stays there up to this torque, and slides with the dry friction; 0: none",
        group="realism",
        label="Static friction",
        on=0.08,
    )
    control_rate: int = choice(
        1000,
        (50, 100, 200, 250, 500, 1000, 2000),
        "how often the controller acts, Hz",
        group="realism",
        label="Control rate",
    )
    look_ahead: str = choice(
        "half_tick",
        ("half_tick", "half_interval"),
        "how far the controller predicts: half a millisecond, or half of its interval, which keeps"
        " the speed right at low control rates, but halves the largest K2",
        group="realism",
        label="Look-ahead",
    )
    delay: float = number(
        0.0,
        "control intervals",
        (0, 8, 0.05),
        "time from a measurement to the torque computed from it; 0: at once",
        group="realism",
        label="Computing delay",
        on=1.0,
    )


def specs(kind: type[Parameters] | Parameters) -> Mapping[str, Spec]:
    """Name -> declaration of all parameters, in the order of declaration."""
    return _specs(kind if isinstance(kind, type) else type(kind))


@cache
def _specs(kind: type[Parameters]) -> Mapping[str, Spec]:
    return MappingProxyType({f.name: f.metadata["spec"] for f in dataclasses.fields(kind)})


def changed(parameters: Parameters, name: str, value: Any) -> Parameters:
    """The parameters with one value changed; the same object if it has that value already.

    Raises:
        ValueError: unknown name or bad value.
    """
    known = specs(parameters)
    if name not in known:
        raise unknown_name(name, list(known))
    value = checked(known[name], name, value)
    if getattr(parameters, name) == value:
        return parameters
    return dataclasses.replace(parameters, **{name: value})


def own_parameters(kind: type[P], parameters: Parameters) -> P:
    """The parameters as those of a robot.

    Raises:
        TypeError: they are another robot's.
    """
    if not isinstance(parameters, kind):
        raise TypeError(f"expected {kind.__name__}, got {type(parameters).__name__}")
    return parameters


def time_step(parameters: Parameters) -> float:
    """Length of a tick, [s]: 1 ms, or one control interval if that is shorter."""
    return min(TICK, 1 / parameters.control_rate)


def look_ahead_time(parameters: Parameters) -> float:
    """How far the controller looks ahead, [s]: see `look_ahead` in models/closed_loop/sensing.py.

    Composite control looks half a tick ahead, whatever is chosen, as its filters move in every
    tick; with half an interval of 5 ms it is unstable.
    """
    composite = getattr(parameters, "law", "") == "composite"
    if parameters.look_ahead == "half_interval" and not composite:
        return 1 / parameters.control_rate / 2
    return time_step(parameters) / 2


def rise_of(parameters: Parameters) -> float:
    """The rise of the path among a robot's parameters, [m]; 0 if it has none."""
    return getattr(parameters, "rise", 0.0)
