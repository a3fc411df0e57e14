"""Declarations of settings: unit, range, options and help of each, and the check of a value."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches
from typing import Any, Literal

from onpath.models.errors import CodedError, Message

MINUS = "\N{MINUS SIGN}"  # typesetters and phones replace a hyphen by it
_WITH_COMMA = re.compile(r"[-+]?\d+,\d+")
LONGEST_NAME = 60  # [characters] of an unknown name in a message
MM, DEGREES = ("mm", 1e3), ("°", 180 / math.pi)
"""`Spec.shown_in` of lengths and angles."""
_SWITCHED = {"true": True, "on": True, "false": False, "off": False}
NOTHING = 1e-9  # smaller values of any parameter are set to 0, so that inverses are finite
FORMER_NAMES = {"law": "output", "direction": "hold_direction", "exaggeration": "larger"}
"""Former name of a setting -> its present one, which is suggested and read in stored set-ups."""


Scale = Literal["linear", "log"]


@dataclass(frozen=True, slots=True)
class Need:
    """What a setting needs in order to act: another setting with a certain value.

    Attributes:
        name: of the other setting, or of a side, whose value is its law.
        of: values with which it suffices; empty: any but 0, "off" and False.
        instead: other conditions, any of which suffices in its place.
    """

    name: str
    of: tuple[Any, ...] = ()
    instead: tuple[Need, ...] = ()

    def met(self, values: Mapping[str, Any]) -> bool:
        """Whether the values of all settings fulfil it; one that is missing does not."""
        value = values.get(self.name, 0)
        suffices = value in self.of if self.of else value not in (0, "off")
        return suffices or any(other.met(values) for other in self.instead)


@dataclass(frozen=True, slots=True)
class Spec:
    """Declaration of a setting: a parameter, a gain, or one of the lab's own settings.

    Attributes:
        group: "basic", "gains", "task", "path", "realism" or "robot"; the lab's own settings have
            groups of their own.
        label: name on a page.
        unit: of its value everywhere, SI where there is one; "" for none.
        low, high, step: range of a number.
        options: of a choice, (False, True) of a switch; empty for a number.
        help: a description in one line: what one will see.
        on: the value that switches the parameter on, if 0 means "off".
        symbol: as in the paper, such as "K₁"; "" for none.
        scale: of a slider; a logarithmic one whose range begins at 0 has 0 at its end, and then
            goes on from `step`.
        needs: all that it needs in order to act.
        compiles: whether a change of it may need another loop, which may have to be compiled first.
        shown_in: if pages show another unit, that unit and how many of it make one `unit`, such as
            ("mm", 1000).
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
    symbol: str = ""
    scale: Scale = "linear"
    needs: tuple[Need, ...] = ()
    compiles: bool = False
    shown_in: tuple[str, float] | None = None

    @property
    def kind(self) -> Literal["number", "choice", "switch"]:
        """What kind of value it has."""
        if not self.options:
            return "number"
        return "switch" if self.options == (False, True) else "choice"


def number(
    default: float,
    unit: str,
    bounds: tuple[float, float, float],
    text: str,
    *,
    group: str,
    label: str,
    **more: Any,
) -> Any:
    """A dataclass field for a number.

    Args:
        bounds: (low, high, step).
        text: `Spec.help`.
        more: further attributes of `Spec`.
    """
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
        **more,
    )
    return field(default=default, metadata={"spec": spec})


def choice(
    default: Any,
    options: tuple[Any, ...],
    text: str,
    *,
    group: str,
    label: str,
    unit: str = "",
    **more: Any,
) -> Any:
    """A dataclass field for one of `options`; see `number`."""
    spec = Spec(
        group=group,
        label=label,
        unit=unit,
        low=0.0,
        high=0.0,
        step=0.0,
        options=options,
        help=text,
        **more,
    )
    return field(default=default, metadata={"spec": spec})


def switch(default: bool, text: str, *, group: str, label: str, **more: Any) -> Any:
    """A dataclass field for something that is on or off; see `number`."""
    return choice(default, (False, True), text, group=group, label=label, **more)


NOISY = Need("sensor_noise", instead=(Need("strain_noise"),))
INEXACT = Need("encoder_counts", instead=(NOISY,))


def wanted_speed(default: float, bounds: tuple[float, float, float]) -> Any:
    """A dataclass field for the wanted speed along the path, [rad/s]."""
    text = (
        "wanted speed along the path; negative: backwards; with a speed profile, the mean of the"
        " sine, and otherwise the largest speed"
    )
    return number(default, "rad/s", bounds, text, group="task", label="Speed")


def model_error(label: str, text: str, on: float = 30.0, symbol: str = "") -> Any:
    """A dataclass field for the error of a number in the controller's model, [%]."""
    bounds = (-50, 50, 1)
    return number(0.0, "%", bounds, text, group="realism", label=label, on=on, symbol=symbol)


def unknown_payload(bounds: tuple[float, float, float], on: float, **more: Any) -> Any:
    """A dataclass field for a mass at the end-point that no controller knows, [kg]."""
    text = "mass at the end-point; the controller does not know it, and its integral lifts no more"
    text += " than what would otherwise hang 10 mm low"
    return number(0.0, "kg", bounds, text, group="realism", label="Payload", on=on, **more)


def torque_steps(most: float, **more: Any) -> Any:
    """A dataclass field for the steps of the motors' torque, [N m]."""
    text, bounds = "the motors' torque is a multiple of this; 0: any torque", (0, most, 0.001)
    named = {"group": "realism", "label": "Torque steps", "on": 0.02}
    return number(0.0, "N m", bounds, text, **named, **more)


def dry_friction(most: float, **more: Any) -> Any:
    """A dataclass field for the dry friction of every motor, [N m]."""
    text, bounds = "dry friction in the joints; 0: none", (0, most, 0.005)
    named = {"group": "realism", "label": "Dry friction", "on": 0.05}
    return number(0.0, "N m", bounds, text, **named, **more)


def static_friction(most: float, **more: Any) -> Any:
    """A dataclass field for the static friction of every motor, [N m]."""
    text = (
        "a joint at rest stays there up to this torque, and slides with the dry friction; 0: none"
    )
    named = {"group": "realism", "label": "Static friction", "compiles": True, "on": 0.08}
    return number(0.0, "N m", (0, most, 0.005), text, **named, **more)


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
    return number(
        default,
        "s",
        bounds,
        text,
        group="realism",
        label="Velocity filter",
        needs=(INEXACT, Need("observer_time", (0.0,))),
        shown_in=("ms", 1e3),
    )


def path_rise() -> Any:
    """A dataclass field for the rise of the path of a robot that takes space curves, [m]."""
    text, bounds = "the path rises and falls by this, twice around: a saddle", (-0.05, 0.05, 0.001)
    return number(0.0, "m", bounds, text, group="path", label="Rise of the path", shown_in=MM)


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
        whole = isinstance(value, float) and value.is_integer()  # as a browser sends a whole number
        text = str(int(value) if whole else value)
        for option in spec.options:
            if str(option) == text or _SWITCHED.get(text) is option:
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
        if isinstance(plain, bool):
            raise TypeError
        return float(plain)
    except (TypeError, ValueError, OverflowError):
        if isinstance(plain, str) and _WITH_COMMA.fullmatch(plain):
            point = plain.replace(",", ".")
            raise CodedError("error.decimal_comma", name=name, value=plain, point=point) from None
        raise CodedError("error.value_not_a_number", name=name, value=repr(value)) from None
