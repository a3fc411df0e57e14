"""`onpath.simulate` and its possible arguments: robots, control laws, paths, parameters."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from onpath.app.notebook.run import Run
from onpath.lessons.words import ENGLISH
from onpath.models.arrays import Array
from onpath.models.control.laws import NAMES
from onpath.models.paths import curves
from onpath.models.paths.curve_faults import curve_faults
from onpath.models.paths.curve_fit import closed_through, open_through
from onpath.models.paths.curves import Curve
from onpath.models.paths.path_design import presets
from onpath.models.studies import experiments
from onpath.models.studies.experiments import Experiment, Schedule
from onpath.models.systems.catalogue import ROBOTS, RobotEntry
from onpath.models.systems.parameters import Spec, specs, unknown_name
from onpath.models.systems.robots import Robot

POSITIVE = "positive finite numbers, [m]"


def simulate(
    robot: str = "five_bar",
    path: Curve | str = "circle",
    law: str = "path_following",
    *,
    duration: float = 8.0,
    start: ArrayLike | None = None,
    hold: tuple[float, float] | None = None,
    push: tuple[float, float, ArrayLike] | None = None,
    reverse_at: float = 0.0,
    **parameters: float | str,
) -> Run:
    """Simulate one robot under one control law, as `onpath experiment` does.

    Args:
        robot: one of `onpath.robots()`.
        path: a curve, such as `onpath.ellipse(...)`, or one of `onpath.paths()`. It lies in the
            robot's path plane, [m].
        law: one of `onpath.laws()`.
        duration: simulated time, [s].
        start: initial position of the end-point, at rest, shape (2,) in the path's plane or (p,)
            in the output space, [m]; None: the point of the path at theta = 0.
        hold: (from, to): interval in which a brake along the path's tangent acts, [s].
        push: (from, to, place): interval, [s], in which a hand, modelled as a spring and a damper,
            pulls the end-point towards a place in the path's plane, shape (2,), [m]; see
            models/systems/forces.py.
        reverse_at: time at which the desired speed changes sign, [s]; 0: never.
        parameters: any of `onpath.parameters(robot)` by name, such as K1=900; others keep their
            defaults. What `--set law=` sets for the flexible robot is called `output` here.

    Raises:
        ValueError: an unknown name (the message lists the nearest ones) or an invalid value (the
            message lists the valid ones).

    Held back for a second, the follower stays near its ellipse:

    >>> import onpath
    >>> run = onpath.simulate(path=onpath.ellipse(0.06, 0.04), hold=(1, 2), duration=3, K1=900)
    >>> run.t.shape, run.y.shape, run.held.sum()
    ((3000,), (3000, 2), np.int64(1000))
    >>> bool(run.distance.max() < 0.004)
    True

    Both laws, in one picture:

    >>> runs = [onpath.simulate(law=law, hold=(1, 2), duration=3) for law in onpath.laws()]
    >>> figure = runs[0].plot(*runs[1:])

    >>> onpath.simulate(law="path_folowing")
    Traceback (most recent call last):
    onpath.models.errors.CodedError: unknown law 'path_folowing': did you mean path_following?
    """
    entry = _entry(robot)
    _check_name(law, NAMES, "law")
    curve = _curve(path)
    first = _start(entry.make(entry.parameters()), curve, start)
    chosen = Experiment(
        name="simulate",
        title=entry.label,
        make=entry.make,
        parameters=entry.parameters(),
        schedule=Schedule(),
        start=lambda _: first,
        path=curve,
    ).with_values(
        {"duration": duration, "reverse_at": reverse_at}
        | _acts(hold, push)
        | _by_own_names(parameters, entry)
    )
    faults = curve_faults(chosen.robot().margin, curve)
    if faults:
        raise ValueError("; ".join(str(fault.reason) for fault in faults))
    return Run(chosen, experiments.run(chosen, law))


def robots() -> dict[str, str]:
    """Names of the robots with a one-sentence description of each.

    >>> import onpath
    >>> onpath.robots()["five_bar"]
    'Two motors, rigid links, a pen in a vertical plane.'
    """
    return {name: entry.text for name, entry in ROBOTS.items()}


def laws() -> dict[str, str]:
    """Names of the control laws with a description of each.

    >>> import onpath
    >>> onpath.laws()["path_following"]
    'stays on the curve'
    """
    return {name: ENGLISH(f"controller.{name}.does") for name in NAMES}


def paths() -> dict[str, str]:
    """Names of the preset paths with the length of each.

    >>> import onpath
    >>> onpath.paths()["circle"]
    'closed, 314 mm'
    """
    return {
        name: f"{'closed' if design.curve.closed else 'open'}, {design.curve.length() * 1e3:.0f} mm"
        for name, design in presets().items()
    }


def parameters(robot: str = "five_bar") -> dict[str, str]:
    """Names of a robot's parameters with default, range and unit, or options, and description.

    Raises:
        ValueError: an unknown robot, with the nearest names.

    >>> import onpath
    >>> onpath.parameters()["K1"]
    '400, 0 to 2500 1/s²: spring that pulls back onto the path'
    """
    entry = _entry(robot)
    defaults, own = entry.parameters(), specs(entry.parameters)
    return {
        public: _described(own[name], getattr(defaults, name))
        for public, name in _names(entry).items()
    }


def circle(radius: float, centre: Sequence[float] = (0.0, 0.0)) -> Curve:
    """A circle with its dimensions in [m]; theta is the angle. Source: eq. (15).

    Raises:
        ValueError: non-finite numbers, or a radius that is not positive.
    """
    (length,) = _lengths("radius", radius)
    return curves.circle(length, _point("centre", centre))


def ellipse(a: float, b: float, centre: Sequence[float] = (0.0, 0.0)) -> Curve:
    """An ellipse with half axes a along the first and b along the second coordinate, [m].

    theta is its eccentric anomaly. Source: eq. (15).

    Raises:
        ValueError: non-finite numbers, or a half axis that is not positive.

    >>> import numpy as np, onpath
    >>> (onpath.ellipse(0.07, 0.04).at(np.pi / 2) + 0.0).round(3)
    array([0.  , 0.04])
    """
    first, second = _lengths("half axes", a, b)
    return curves.ellipse((first, second), _point("centre", centre))


def segment(start: ArrayLike, end: ArrayLike) -> Curve:
    """A straight path from start (theta = -pi) to end (theta = pi), each shape (2,), [m].

    Raises:
        ValueError: non-finite numbers, or start and end coincide.
    """
    form = "a point of the plane, shape (2,), [m]"
    ends = _numbers("start", start, 2, form), _numbers("end", end, 2, form)
    return through(np.stack(ends), closed=False)


def through(points: ArrayLike, closed: bool = True) -> Curve:
    """A smooth path with 12 harmonics that fits points, shape (n, 2), [m].

    Raises:
        ValueError: too few points, non-finite numbers, or all points coincide.
    """
    given = _array("points", points, "points, shape (n, 2), [m]")
    return closed_through(given) if closed else open_through(given)


def _entry(robot: str) -> RobotEntry:
    _check_name(robot, ROBOTS, "robot")
    return ROBOTS[robot]


def _check_name(name: Any, known: Iterable[str], what: str) -> None:
    if not isinstance(name, str) or name not in known:
        raise unknown_name(str(name), list(known), what)


def _names(entry: RobotEntry) -> dict[str, str]:
    """Parameter names here -> declared names; they differ because `law` is the control law here."""
    return {"output" if name == "law" else name: name for name in specs(entry.parameters)}


def _by_own_names(parameters: Mapping[str, Any], entry: RobotEntry) -> dict[str, Any]:
    names = _names(entry)
    arguments = ("path", "duration", "start", "hold", "push", "reverse_at")
    for name in parameters:
        if name not in names:
            raise unknown_name(name, [*names, *arguments])
    return {names[name]: value for name, value in parameters.items()}


def _curve(path: Curve | str) -> Curve:
    if isinstance(path, Curve):
        return path
    _check_name(path, presets(), "path")
    return presets()[path].curve


def _acts(hold: Any, push: Any) -> dict[str, float]:
    """Schedule entries for the forces on the end-point."""
    values = dict[str, float]()
    if hold is not None:
        values["hold_from"], values["hold_to"] = _numbers("hold", hold, 2, "(from, to), [s]")
    if push is not None:
        form = "(from, to, (z1, z2)), [s] and [m]"
        try:
            begin, end, place = push
            flat = (begin, end, *place)
        except (TypeError, ValueError):
            raise ValueError(f"push: expected {form}, got {push!r}") from None
        names = ("push_from", "push_to", "push_z1", "push_z2")
        values |= zip(names, _numbers("push", flat, 4, form), strict=True)
    return values


def _start(robot: Robot, curve: Curve, start: ArrayLike | None) -> Array:
    """Initial position of the end-point, shape (p,)."""
    if start is None:
        return robot.frame.lift(curve.at(np.array(0.0)))
    p = robot.system.p
    form = f"a point, shape (2,) or ({p},), [m]" if p > 2 else "a point, shape (2,), [m]"
    y = _array("start", start, form)
    if y.shape not in ((2,), (p,)) or not np.isfinite(y).all():
        raise ValueError(f"start: expected {form}, got {start!r}")
    return y if y.shape == (p,) else robot.frame.lift(y)


def _lengths(name: str, *values: Any) -> tuple[float, ...]:
    lengths = _numbers(name, values, len(values), POSITIVE)
    if lengths.min() <= 0:
        raise ValueError(f"{name}: expected {POSITIVE}, got {values}")
    return tuple(lengths.tolist())


def _point(name: str, values: Any) -> tuple[float, float]:
    first, second = _numbers(name, values, 2, "a point of the plane, shape (2,), [m]").tolist()
    return first, second


def _numbers(name: str, values: Any, count: int, form: str) -> Array:
    numbers = _array(name, values, form)
    if numbers.shape != (count,) or not np.isfinite(numbers).all():
        raise ValueError(f"{name}: expected {form}, got {values!r}")
    return numbers


def _array(name: str, values: Any, form: str) -> Array:
    try:
        return np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        raise ValueError(f"{name}: expected {form}, got {values!r}") from None


def _described(spec: Spec, default: Any) -> str:
    if spec.options:
        return f"{default}, one of {', '.join(map(str, spec.options))}: {spec.help}"
    unit = f" {spec.unit}" if spec.unit else ""
    return f"{default:g}, {spec.low:g} to {spec.high:g}{unit}: {spec.help}"
