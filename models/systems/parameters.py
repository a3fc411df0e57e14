"""The numbers and choices of every robot, each declared once with unit, range and help.

Forms, the command line and files are generated from these declarations. Gains and task are in
law_parameters.py; parameters of a single robot or law are in its module.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from types import MappingProxyType
from typing import TypeVar

from onpath.models.systems.law_parameters import LawParameters
from onpath.models.systems.parameter_specs import (
    INEXACT,
    NOISY,
    Need,
    Spec,
    choice,
    dry_friction,
    number,
    static_friction,
    torque_steps,
    velocity_filter,
)

TICK = 1e-3  # [s], length of a tick at control rates up to 1 kHz

P = TypeVar("P", bound="Parameters")


@dataclass(frozen=True, slots=True)
class Parameters(LawParameters):
    """Parameters of every robot: gains, task, realism. The defaults suit the rigid five-bar."""

    torque_limit: float = number(
        0.0,
        "N m",
        (0, 5, 0.05),
        "motors give no more than this; 0: no limit",
        group="realism",
        label="Torque limit",
        compiles=True,
        on=0.5,
    )
    at_limit: str = choice(
        "across_first",
        ("across_first", "slow_down", "cut"),
        "when a torque limit is reached, laws that command an acceleration give up speed along the"
        " path before the path; slow_down: and path following and typed laws ask only for a speed"
        " that the whole path allows; cut: neither",
        group="realism",
        label="At the torque limit",
        needs=(Need("torque_limit"),),
        compiles=True,
    )
    at_limit_for: str = choice(
        "all",
        ("all", "path_following"),
        "which laws give up speed along the path at a torque limit: all that command an"
        " acceleration, or path following and typed laws alone",
        group="realism",
        label="Laws that give way",
        needs=(Need("torque_limit"), Need("at_limit", ("across_first", "slow_down"))),
        compiles=True,
    )
    torque_step: float = torque_steps(0.2)
    encoder_counts: float = number(
        0.0,
        "per turn",
        (0, 20000, 100),
        "steps of the joint encoders; 0: exact sensing",
        group="realism",
        label="Encoder",
        compiles=True,
        scale="log",
        on=2000.0,
    )
    encoder_filter: float = velocity_filter(0.005)
    observer_time: float = number(
        0.008,
        "s",
        (0, 0.05, 0.0005),
        "an observer with the controller's model estimates the velocities, and forgets its errors"
        " in this time. 0: the filter gives them; no effect without steps or noise",
        group="realism",
        label="Observer",
        needs=(INEXACT,),
        compiles=True,
        shown_in=("ms", 1e3),
        on=0.008,
    )
    sensor_noise: float = number(
        0.0,
        "rad",
        (0, 0.002, 0.00001),
        "standard deviation of the measured joint angles",
        group="realism",
        label="Sensor noise",
        compiles=True,
        on=0.0001,
    )
    seed: float = number(
        0.0,
        "",
        (0, 9999, 1),
        "chooses the random numbers of the noise: the same seed, the same run",
        group="realism",
        label="Noise seed",
        needs=(NOISY,),
    )
    coulomb: float = dry_friction(0.3)
    stiction: float = static_friction(0.3)
    control_rate: int = choice(
        1000,
        (50, 100, 200, 250, 500, 1000, 2000),
        "how often the controller acts. The poles beside the gains are those of an acceleration"
        " that is held in between; torque is held, so that at 50 and 100 Hz the largest K2 is 1 to"
        " 3 % above theirs",
        group="realism",
        label="Control rate",
        unit="Hz",
    )
    look_ahead: str = choice(
        "half_tick",
        ("half_tick", "half_interval"),
        "how far the controller predicts: half a millisecond, or half of its interval, which keeps"
        " the speed right at low control rates, but halves the largest K2",
        group="realism",
        label="Look-ahead",
        needs=(Need("control_rate", (50, 100, 200, 250, 500)),),
    )
    delay: float = number(
        0.0,
        "control intervals",
        (0, 8, 0.05),
        "time from a measurement to the torque computed from it; 0: at once",
        group="realism",
        label="Computing delay",
        compiles=True,
        on=1.0,
    )


@cache
def declared(kind: type[Parameters]) -> Mapping[str, Spec]:
    """Name -> declaration of the parameters of a robot, in the order of declaration.

    The gains of single laws are not included; `specs` in models/control/settable.py has everything.
    """
    fields = dataclasses.fields(kind)
    return MappingProxyType({f.name: f.metadata["spec"] for f in fields if "spec" in f.metadata})


def own_parameters(kind: type[P], parameters: Parameters) -> P:
    """The parameters with the type of a robot's parameters.

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
    """Time by which the controller looks ahead, [s]; see models/closed_loop/sensing.py.

    Composite control always looks half a tick ahead, because its filters advance in every tick;
    with half an interval of 5 ms it would be unstable.
    """
    composite = getattr(parameters, "output", "") == "composite"
    if parameters.look_ahead == "half_interval" and not composite:
        return 1 / parameters.control_rate / 2
    return time_step(parameters) / 2


def rise_of(parameters: Parameters) -> float:
    """The rise of the path among a robot's parameters, [m]; 0 if it has none."""
    return getattr(parameters, "rise", 0.0)
