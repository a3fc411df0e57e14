"""Reads the arguments of the functions of `import onpath`; each error names the argument."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from onpath.models.arrays import Array
from onpath.models.paths.curves import Curve
from onpath.models.studies.path_text import curve_from_text
from onpath.models.systems.robots import Robot

POSITIVE = "positive finite numbers, [m]"


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
        return robot.frame.lift(curve.at(np.array(0.0)))
    p = robot.system.p
    form = f"a point, shape (2,) or ({p},), [m]" if p > 2 else "a point, shape (2,), [m]"
    y = array_of("start", start, form)
    if y.shape not in ((2,), (p,)) or not np.isfinite(y).all():
        raise ValueError(f"start: expected {form}, got {start!r}")
    return y if y.shape == (p,) else robot.frame.lift(y)


def curve_of(name: str, path: Any) -> Curve:
    """A path, given as a curve or as a text that describes one.

    Raises:
        ValueError: it is neither, or the text does not describe a path.
    """
    if isinstance(path, Curve):
        return path
    if not isinstance(path, str):
        ways = "onpath.through(points) makes a path of points, onpath.path_from(file) of a file"
        raise ValueError(f"{name}: {ways}")
    return curve_from_text(path)


def lengths(name: str, *values: Any) -> tuple[float, ...]:
    """Positive lengths, [m].

    Raises:
        ValueError: one is not positive and finite.
    """
    array = numbers(name, values, len(values), POSITIVE)
    if array.min() <= 0:
        raise ValueError(f"{name}: expected {POSITIVE}, got {values}")
    return tuple(array.tolist())


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


def array_of(name: str, values: Any, form: str) -> Array:
    """Numbers as an array of any shape.

    Raises:
        ValueError: they are not numbers; the message states the form.
    """
    try:
        return np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        raise ValueError(f"{name}: expected {form}, got {values!r}") from None
