"""Reads the arguments of the functions of `import onpath`; each error names the argument."""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from onpath.app.common.user_files import user_file
from onpath.models.arrays import Array
from onpath.models.errors import CodedError, Message
from onpath.models.path_files.reading import path_in, read_reference
from onpath.models.paths.curve_faults import curve_faults
from onpath.models.paths.curve_fit import deviation_remark
from onpath.models.paths.curves import Curve
from onpath.models.paths.nearest_path import nearest_path
from onpath.models.paths.path_design import USUAL_RADIUS
from onpath.models.studies.path_text import curve_from_text
from onpath.models.systems.robots import Robot

POSITIVE = "positive finite numbers, [m]"
FAR = 10  # times a robot's reach, or metres: millimetres may have been meant
NEAREST = "nearest"
SEVERAL = list, tuple, set, frozenset, range, np.ndarray


def schedule_of(velocity: Any, hold: Any, push: Any, wall: Any) -> dict[str, float]:
    """Schedule entries for the initial velocity and the forces on the end-point.

    Args:
        velocity, hold, push, wall: as for `onpath.simulate`.

    Raises:
        ValueError: one of them has another form.
    """
    form = "(along, across), [m/s]"
    values = dict[str, float]()
    values["start_along"], values["start_across"] = numbers("velocity", velocity, 2, form)
    if hold is not None:
        values["hold_from"], values["hold_to"] = numbers("hold", hold, 2, "(from, to), [s]")
        if values["hold_from"] == values["hold_to"]:
            raise ValueError("hold: it begins and ends at the same time")
    if push is not None:
        values |= _at_place("push", push, (), "(from, to, (z1, z2)), [s] and [m]")
    if wall is not None:
        form = "(from, to, (z1, z2), angle), [s], [m] and [rad]"
        values |= _at_place("wall", wall, ("angle",), form)
    return values


def _at_place(what: str, value: Any, others: tuple[str, ...], form: str) -> dict[str, float]:
    """Schedule entries of a force that acts at a place for an interval of time."""
    try:
        begin, end, place, *rest = value
        flat = (begin, end, *place, *rest)
    except (TypeError, ValueError):
        raise ValueError(f"{what}: expected {form}, got {value!r}") from None
    names = [f"{what}_{name}" for name in ("from", "to", "z1", "z2", *others)]
    return dict(zip(names, numbers(what, flat, len(names), form).tolist(), strict=True))


def start_point(robot: Robot, curve: Curve, start: ArrayLike | None) -> Array:
    """Initial position of the end-point, shape (p,), [m].

    Args:
        start: as for `onpath.simulate`.

    Raises:
        ValueError: it has another form.
    """
    if start is None:
        return robot.frame.lift(curve.at(np.array(curve.begin)))
    p = robot.system.p
    form = f"a point, shape (2,) or ({p},), [m]" if p > 2 else "a point, shape (2,), [m]"
    y = array_of("start", start, form)
    check_near("start", y, robot.reach)
    if y.shape not in ((2,), (p,)) or not np.isfinite(y).all():
        raise ValueError(f"start: expected {form}, got {start!r}")
    return y if y.shape == (p,) else robot.frame.lift(y)


@contextmanager
def looked_up(call: str) -> Iterator[None]:
    """Add to the error for an unknown name which call lists all names.

    Raises:
        ValueError: this error.
    """
    try:
        yield
    except CodedError as error:
        if error.message.code != "error.unknown_name":
            raise
        raise ValueError(f"{error} ({call} lists all)") from None


@contextmanager
def named_by_command() -> Iterator[None]:
    """Raise errors for unknown names as they are without `looked_up`, for the command line.

    Raises:
        CodedError: this error.
    """
    try:
        yield
    except ValueError as error:
        plain = error.__context__
        if isinstance(plain, CodedError) and str(error).startswith(f"{plain} ("):
            raise plain from None
        raise


def check_one(name: str, value: Any) -> None:
    """Check that an argument is not several.

    Raises:
        ValueError: it is; the message names the function that takes several.
    """
    if isinstance(value, SEVERAL):
        raise ValueError(f"{name}: expected one, got several, which onpath.sweep takes")


def check_near(name: str, lengths: Any, reach: float) -> None:
    """Check that lengths may be in metres: that they are not far beyond a robot's reach, [m].

    Raises:
        ValueError: one is; the message asks whether millimetres were meant.
    """
    largest = float(np.max(np.abs(lengths), initial=0.0))
    if FAR * reach < largest <= 1000 * FAR * reach:
        units = f"lengths are in metres, and the robot reaches {reach:.2g} m"
        raise ValueError(f"{name}: {units}. {_asked(largest)}")


def _asked(length: float) -> str:
    return f"{length:g} m: did you mean {length / 1000:g}?"


def curve_of(name: str, path: Any, robot: Robot | None = None) -> Curve:
    """A path: a curve, a text that describes one, or a file as `Path` or "@FILE options".

    Args:
        robot: if given, the path's size is checked; and it follows the nearest path that it can
            follow if a file is followed by the word "nearest", as in "@logo.svg fit=0.1 nearest".

    Raises:
        ValueError: it is none of these, or does not describe a path.
        OSError: the file cannot be read.

    Warns:
        UserWarning: remarks about the path.
    """
    if isinstance(path, Path):
        path = f"@{path}"
    if isinstance(path, str):
        curve = _path_in(path[1:], robot) if path.startswith("@") else _typed(path, robot)
    elif isinstance(path, Curve):
        curve = path
    else:
        if isinstance(path, SEVERAL) and all(isinstance(each, str | Path | Curve) for each in path):
            check_one(name, path)
        ways = "onpath.through(points) makes a path of points, onpath.path_from(file) of a file"
        raise ValueError(f"{name}: {ways}")
    if robot is not None:
        check_near(name, curve.at(np.linspace(-np.pi, np.pi, 181)), robot.reach)
    return curve


def path_name(text: str) -> str:
    """The name of a path in a list: that of its file, or the text itself."""
    return read_reference(_without_nearest(text[1:])[0])[0].stem if text.startswith("@") else text


def _typed(text: str, robot: Robot | None) -> Curve:
    radius = USUAL_RADIUS if robot is None else robot.radius
    try:
        curve = curve_from_text(text, radius)
    except ValueError:
        if re.search(r"\.[a-zA-Z]\w*( |$)", text):
            raise ValueError(f"path {text!r}: a file is given as '@{text}'") from None
        raise
    if remark := deviation_remark(curve):
        warnings.warn(str(remark), stacklevel=4)
    return curve


def _path_in(text: str, robot: Robot | None) -> Curve:
    reference, wants_nearest = _without_nearest(text)
    named, placing = read_reference(reference)
    file = user_file(named)
    try:
        read = path_in(file, placing)
    except ValueError as error:
        raise ValueError(f"@{file}: {error}") from None
    curve, remarks = read.curve, [*read.remarks]
    faults = curve_faults(robot.margin, curve) if robot else ()
    if robot and faults:
        check_near(f"@{file}", curve.at(np.linspace(-np.pi, np.pi, 181)), robot.reach)
        reasons = tuple(fault.reason for fault in faults)
        found = nearest_path(robot.margin, curve)
        if found is None or not wants_nearest:
            raise ValueError(f"@{file}: {_with_hint(reasons, found)}")
        apart = f"{1e3 * found.deviation:.1f}"
        remarks.append(Message("say.nearest", {"reasons": reasons, "apart": apart}))
        curve = found
    for remark in remarks:
        warnings.warn(f"{file}: {remark}", stacklevel=4)
    return curve


def _with_hint(reasons: tuple[Message, ...], found: Curve | None) -> str:
    """Why a path cannot be followed, and how one near it can."""
    text = "; ".join(map(str, reasons))
    if found is None:
        return text
    apart = f"up to {1e3 * found.deviation:.1f} mm away"
    return f"{text}; add the word nearest after the file to follow a path {apart}"


def _without_nearest(text: str) -> tuple[str, bool]:
    """A reference to a file without the word "nearest", and whether it had it."""
    file, *options = text.split(" ")
    kept = [word for word in options if word != NEAREST]
    return " ".join([file, *kept]), len(kept) < len(options)


def lengths(name: str, *values: Any) -> tuple[float, ...]:
    """Positive lengths, [m].

    Raises:
        ValueError: one is not positive and finite.
    """
    array = numbers(name, values, len(values), POSITIVE)
    if array.min() <= 0:
        raise ValueError(f"{name}: expected {POSITIVE}, got {values}")
    ask_unit(name, array)
    return tuple(array.tolist())


def ask_unit(name: str, lengths: Array) -> None:
    """Warn of lengths that seem to be in millimetres, [m]."""
    if np.abs(lengths).max(initial=0.0) > FAR:
        warnings.warn(f"{name}: {_asked(float(np.abs(lengths).max()))}", stacklevel=4)


def plane_point(name: str, values: Any) -> tuple[float, float]:
    """A point of the path's plane, [m].

    Raises:
        ValueError: the values are not a point.
    """
    first, second = numbers(name, values, 2, "a point of the plane, shape (2,), [m]").tolist()
    return first, second


def numbers(name: str, values: Any, count: int, form: str) -> Array:
    """Finite numbers, shape (count,).

    Raises:
        ValueError: they are not finite, or of another number; the message states the form.
    """
    array = array_of(name, values, form)
    if array.shape != (count,) or not np.isfinite(array).all():
        raise ValueError(f"{name}: expected {form}, got {values!r}")
    return array


def check_number(name: str, value: Any, unit: str) -> None:
    """Check that an argument is a number.

    Raises:
        ValueError: it is not; a text, such as "8", is none.
    """
    if isinstance(value, str) or not np.isscalar(value):
        raise ValueError(f"{name}: {value!r} is not a number, [{unit}]")


def array_of(name: str, values: Any, form: str) -> Array:
    """Numbers as an array of any shape.

    Raises:
        ValueError: they are not numbers; the message states the form.
    """
    try:
        array = np.asarray(values)
        if array.dtype.kind not in "biuf":  # a text, such as "8", is none
            raise TypeError
        return array.astype(float)
    except (TypeError, ValueError):
        raise ValueError(f"{name}: expected {form}, got {values!r}") from None
