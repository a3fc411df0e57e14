"""All numbers and choices that a user can set, each declared once with unit, range and help.

Widgets, the command line and files are generated from these declarations.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches
from functools import cache
from types import MappingProxyType
from typing import Any

from onpath.models.errors import CodedError, Message

TICK = 1e-3  # [s], length of a tick at control rates up to 1 kHz
NOTHING = 1e-9  # smaller values of any parameter are set to 0, so that inverses are finite


@dataclass(frozen=True, slots=True)
class Spec:
    """Declaration of a parameter.

    Attributes:
        group: "basic", "gains", "task", "realism" or "robot".
        label: name on a widget.
        unit: "" for none.
        low, high, step: range of a number.
        options: of a choice; empty for a number.
        help: one line.
        on: for a parameter of which 0 means "off": the value that switches it on.
        former: former names of options, which are still accepted.
    """

    group: str
    label: str
    unit: str
    low: float
    high: float
    step: float
    options: tuple[Any, ...]
    help: str
    on: float | None = None
    former: Mapping[str, str] | None = None

    def present(self, value: Any) -> Any:
        """The present name of an option; any other value unchanged."""
        return self.former.get(str(value), value) if self.former else value


def number(
    default: float,
    unit: str,
    bounds: tuple[float, float, float],
    text: str,
    *,
    group: str,
    label: str,
    on: float | None = None,
) -> Any:
    """A dataclass field for a number; `bounds` are (low, high, step)."""
    spec = Spec(group, label, unit, *bounds, (), text, on)
    return field(default=default, metadata={"spec": spec})


def choice(
    default: Any,
    options: tuple[Any, ...],
    text: str,
    *,
    group: str,
    label: str,
    former: Mapping[str, str] | None = None,
) -> Any:
    """A dataclass field for one of `options`; former names are accepted."""
    spec = Spec(group, label, "", 0.0, 0.0, 0.0, options, text, former=former)
    return field(default=default, metadata={"spec": spec})


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
        0.0,
        "1/s³",
        (0, 8000, 50),
        "removes a lasting offset (integral)",
        group="gains",
        label="K3 across",
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
        "wanted speed along the path; negative: backwards",
        group="task",
        label="Speed",
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
        "distance",
        ("distance", "level_set"),
        "what to measure across the path: the distance, or the paper's s(y) (circle, ellipse)",
        group="gains",
        label="Across is",
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
    coulomb: float = number(
        0.0,
        "N m",
        (0, 0.3, 0.005),
        "dry friction in the joints; 0: none",
        group="realism",
        label="Dry friction",
        on=0.05,
    )
    control_rate: int = choice(
        1000,
        (50, 100, 200, 250, 500, 1000, 2000),
        "how often the controller acts, Hz",
        group="realism",
        label="Control rate",
    )


@dataclass(frozen=True, slots=True)
class FiveBarParameters(Parameters):
    """Parameters of the rigid five-bar: model errors, removed counterweights, payload."""

    error_M11: float = number(
        0.0,
        "%",
        (-50, 50, 1),
        "the controller's M11 is off by this",
        group="realism",
        label="M11 wrong",
        on=30.0,
    )
    error_M22: float = number(
        0.0,
        "%",
        (-50, 50, 1),
        "the controller's M22 is off by this",
        group="realism",
        label="M22 wrong",
        on=30.0,
    )
    error_b1: float = number(
        0.0,
        "%",
        (-50, 50, 1),
        "the controller's b1 is off by this",
        group="realism",
        label="b1 wrong",
        on=50.0,
    )
    error_b2: float = number(
        0.0,
        "%",
        (-50, 50, 1),
        "the controller's b2 is off by this",
        group="realism",
        label="b2 wrong",
        on=50.0,
    )
    counterweights_removed: float = number(
        0.0,
        "%",
        (0, 100, 5),
        "counterweights taken off; the controller does not know",
        group="realism",
        label="Counterweights off",
        on=50.0,
    )
    payload: float = number(
        0.0,
        "kg",
        (0, 0.3, 0.01),
        "mass at the end-point; the controller does not know",
        group="realism",
        label="Payload",
        on=0.1,
    )


def specs(kind: type[Parameters] | Parameters) -> Mapping[str, Spec]:
    """Name -> declaration of all parameters, in the order of declaration."""
    return _specs(kind if isinstance(kind, type) else type(kind))


@cache
def _specs(kind: type[Parameters]) -> Mapping[str, Spec]:
    return MappingProxyType({f.name: f.metadata["spec"] for f in dataclasses.fields(kind)})


def unknown_name(name: str, known: list[str], what: str = "parameter") -> CodedError:
    """The error for an unknown name, which suggests the nearest known ones."""
    near = get_close_matches(name, known, n=3, cutoff=0.4) or get_close_matches(
        name.lower(), known, n=3, cutoff=0.3
    )
    names = ", ".join(near or known)
    hint = Message("error.did_you_mean" if near else "error.there_are", {"names": names})
    return CodedError("error.unknown_name", kind=what, name=repr(name), hint=hint)


def out_of_range(name: str, value: str, low: str, high: str) -> CodedError:
    """The error for a number that is too small or too large; arguments are formatted."""
    return CodedError("error.value_out_of_range", name=name, value=value, low=low, high=high)


def checked(spec: Spec, name: str, value: Any) -> Any:
    """`value` as the field takes it.

    Raises:
        ValueError: not a finite number in range, or not one of the options.
    """
    if spec.options:
        present = str(spec.present(value))
        for option in spec.options:
            if str(option) == present:
                return option
        options = ", ".join(str(option) for option in spec.options)
        raise CodedError("error.value_not_an_option", name=name, value=repr(value), options=options)
    try:
        result = float(value)
    except (TypeError, ValueError, OverflowError):
        raise CodedError("error.value_not_a_number", name=name, value=repr(value)) from None
    if not math.isfinite(result) or not spec.low <= result <= spec.high:
        unit = f" {spec.unit}" if spec.unit else ""
        raise out_of_range(name, str(value), f"{spec.low:g}", f"{spec.high:g}{unit}")
    return result if abs(result) > NOTHING else 0.0


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


def time_step(parameters: Parameters) -> float:
    """Length of a tick, [s]: 1 ms, or one control interval if that is shorter."""
    return min(TICK, 1 / parameters.control_rate)
