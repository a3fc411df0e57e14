"""Declarations of parameters: unit, range, options and help of each, and the check of a value."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field
from difflib import get_close_matches
from typing import Any

from onpath.models.errors import CodedError, Message

MINUS = "\N{MINUS SIGN}"  # typesetters and phones replace a hyphen by it
_WITH_COMMA = re.compile(r"[-+]?\d+,\d+")
LONGEST_NAME = 60  # [characters] of an unknown name in a message
NOTHING = 1e-9  # smaller values of any parameter are set to 0, so that inverses are finite
FORMER_NAMES = {"law": "output"}
"""Former name of a parameter -> its present one, which is suggested and read in stored set-ups."""


@dataclass(frozen=True, slots=True)
class Spec:
    """Declaration of a parameter.

    Attributes:
        group: "basic", "gains", "task", "path", "realism" or "robot".
        label: name on a widget.
        unit: "" for none.
        low, high, step: range of a number.
        options: of a choice; empty for a number.
        help: a description in one line.
        on: the value that switches the parameter on, if 0 means "off".
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
    low, high, step = bounds
    spec = Spec(
        group=group,
        label=label,
        unit=unit,
        low=low,
        high=high,
        step=step,
        options=(),
        help=text,
        on=on,
    )
    return field(default=default, metadata={"spec": spec})


def choice(
    default: Any,
    options: tuple[Any, ...],
    text: str,
    *,
    group: str,
    label: str,
) -> Any:
    """A dataclass field for one of `options`."""
    spec = Spec(
        group=group,
        label=label,
        unit="",
        low=0.0,
        high=0.0,
        step=0.0,
        options=options,
        help=text,
    )
    return field(default=default, metadata={"spec": spec})


def wanted_speed(default: float, bounds: tuple[float, float, float]) -> Any:
    """A dataclass field for the wanted speed along the path, [rad/s]."""
    text = (
        "wanted speed along the path; negative: backwards; with a speed profile, the mean of the"
        " sine, and otherwise the largest speed"
    )
    return number(default, "rad/s", bounds, text, group="task", label="Speed")


def model_error(label: str, text: str, on: float = 30.0) -> Any:
    """A dataclass field for the error of a number in the controller's model, [%]."""
    return number(0.0, "%", (-50, 50, 1), text, group="realism", label=label, on=on)


def unknown_payload(bounds: tuple[float, float, float], on: float) -> Any:
    """A dataclass field for a mass at the end-point that no controller knows, [kg]."""
    text = "mass at the end-point; the controller does not know it, and its integral lifts no more"
    text += " than what would otherwise hang 10 mm low"
    return number(0.0, "kg", bounds, text, group="realism", label="Payload", on=on)


def pivot_damping(default: float) -> Any:
    """A dataclass field for the damping of a pivot that no motor drives, [N m s]."""
    text = "damping of the pivot, which has no motor"
    bounds = (0, 0.02, 0.001)
    return number(default, "N m s", bounds, text, group="robot", label="Pivot damping")


def velocity_filter(default: float) -> Any:
    """A dataclass field for the filter that gives velocities from measured angles, [s]."""
    text = (
        "time constant of the velocity filter behind them, where there is no observer; no effect"
        " without steps or noise"
    )
    bounds = (0.0005, 0.05, 0.0005)
    return number(default, "s", bounds, text, group="realism", label="Velocity filter")


def path_rise() -> Any:
    """A dataclass field for the rise of the path of a robot that takes space curves, [m]."""
    text, bounds = "the path rises and falls by this, twice around: a saddle", (-0.05, 0.05, 0.001)
    return number(0.0, "m", bounds, text, group="path", label="Rise of the path")


def unknown_name(name: str, known: list[str], what: str = "parameter") -> CodedError:
    """The error for an unknown name, which suggests the nearest known ones; a long one is cut."""
    name = name if len(name) <= LONGEST_NAME else f"{name[:LONGEST_NAME]}…"
    near = (
        [each for each in known if each == FORMER_NAMES.get(name)]
        or get_close_matches(name, known, n=3, cutoff=0.4)
        or get_close_matches(name.lower(), known, n=3, cutoff=0.3)
    )
    names = ", ".join(near or known)
    hint = Message("error.did_you_mean" if near else "error.there_are", {"names": names})
    return CodedError("error.unknown_name", kind=what, name=repr(name), hint=hint)


def out_of_range(name: str, value: str, low: str, high: str) -> CodedError:
    """The error for a number that is too small or too large; arguments are formatted."""
    return CodedError("error.value_out_of_range", name=name, value=value, low=low, high=high)


def checked(spec: Spec, name: str, value: Any) -> Any:
    """The value in the form that the field takes.

    Raises:
        ValueError: not a finite number in range, or not one of the options.
    """
    if spec.options:
        for option in spec.options:
            if str(option) == str(value):
                return option
        options = ", ".join(str(option) for option in spec.options)
        raise CodedError("error.value_not_an_option", name=name, value=repr(value), options=options)
    result = number_of(name, value)
    if not math.isfinite(result) or not spec.low <= result <= spec.high:
        unit = f" {spec.unit}" if spec.unit else ""
        raise out_of_range(name, str(value), f"{spec.low:g}", f"{spec.high:g}{unit}")
    return result if abs(result) > NOTHING else 0.0


def number_of(name: str, value: Any) -> float:
    """A number, or a number that a user has typed; the typographic minus sign is accepted.

    Raises:
        CodedError: it is not a number; for a decimal comma, the message says how to write it.
    """
    plain = value.strip().replace(MINUS, "-") if isinstance(value, str) else value
    try:
        return float(plain)
    except (TypeError, ValueError, OverflowError):
        if isinstance(plain, str) and _WITH_COMMA.fullmatch(plain):
            point = plain.replace(",", ".")
            raise CodedError("error.decimal_comma", name=name, value=plain, point=point) from None
        raise CodedError("error.value_not_a_number", name=name, value=repr(value)) from None
