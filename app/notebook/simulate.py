"""`onpath.simulate` and its possible arguments: robots, control laws, paths, parameters."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from inspect import Parameter, signature
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from onpath.app.common.newcomer import NEWCOMER as NEWCOMER
from onpath.app.common.own_laws import law_given
from onpath.app.common.robot_places import is_from_file
from onpath.app.notebook.arguments import (
    array_of,
    ask_unit,
    check_number,
    check_one,
    curve_of,
    lengths,
    looked_up,
    numbers,
    plane_point,
    schedule_of,
    start_point,
)
from onpath.app.notebook.display import LawText, NamesTable
from onpath.app.notebook.robot import robot as robot_from
from onpath.app.notebook.run import Run
from onpath.models.control.laws.registry import LAWS
from onpath.models.control.settable import specs, values_of, with_values
from onpath.models.errors import CodedError
from onpath.models.path_files.placing import RADIUS, SMOOTH, Placing
from onpath.models.path_files.reading import path_through
from onpath.models.paths import curves
from onpath.models.paths.curve_fit import open_through
from onpath.models.paths.curves import Curve
from onpath.models.paths.path_design import PathDesign, presets
from onpath.models.studies import experiments
from onpath.models.studies.experiments import Experiment, Schedule
from onpath.models.studies.unused import unused_text
from onpath.models.systems.catalogue import ROBOTS, RobotEntry, robot_named
from onpath.models.systems.parameter_specs import Spec, unknown_name

VARIABLE = Parameter.VAR_KEYWORD


def simulate(
    robot: str | Path | RobotEntry = "five_bar",
    path: str | Path | Curve = "circle",
    law: Any = "path_following",
    *,
    duration: float = 8.0,
    start: ArrayLike | None = None,
    velocity: tuple[float, float] = (0.0, 0.0),
    clock_offset: float = 0.0,
    hold: tuple[float, float] | None = None,
    hold_at: float | None = None,
    hold_direction: str | None = None,
    push: tuple[float, float, ArrayLike] | None = None,
    wall: tuple[float, float, ArrayLike, float] | None = None,
    reverse_at: float = 0.0,
    profile: str | Iterable[tuple[float, float]] | None = None,
    **settings: float | str,
) -> Run:
    """Simulate one robot under one control law, as `onpath experiment` does.

    `onpath.sweep` takes several robots, paths, laws and settings.

    Args:
        robot: one of `onpath.robots()`; a URDF or MJCF file, such as "arm.urdf"; or what
            `onpath.robot` returns, which takes options for a file.
        path: one of `onpath.paths()`; a text, such as "ellipse 0.07 0.04", see
            models/studies/path_text.py; a curve, such as `onpath.ellipse(...)`; or a file with
            options, such as "@logo.svg fit=0.1 nearest", see `onpath.path_from`. It lies in the
            robot's path plane, [m].
        law: one of `onpath.laws()`; or a custom law: a text in two lines, such as
            "across = -K1*xi - K2*dxi; along = -K5*(dtheta - speed)"; an object with `command(view)`
            in CasADi, see `onpath.View`, a class of such objects, or a function that is called in
            every control interval, and once before the run, to check what it returns, see
            `onpath.Now`; or one of these in a file, as "my_law.py:Name".
        duration: simulated time, [s].
        start: initial position of the end-point, shape (2,) in the path's plane or (p,)
            in the output space, [m]; None: the point of the path at theta = 0, or the
            beginning of a drawing.
        velocity: initial velocity of the end-point (along, across) the path at its closest point,
            [m/s].
        clock_offset: how far the reference point of a law with a clock is initially ahead of the
            closest point, [rad].
        hold: (from, to): interval in which a brake acts, [s].
        hold_at: theta at which the brake begins to act, for to - from seconds, when the end-point
            first passes there after from, [rad]; None: at once, wherever the end-point is.
        hold_direction: "along" the path's tangent, the default, "across" it, or "both".
        push: (from, to, place): interval, [s], in which a hand, modelled as a spring and a damper,
            pulls the end-point towards a place in the path's plane, shape (2,), [m]; see
            models/systems/forces.py.
        wall: (from, to, place, angle): interval in which there is a wall, [s], a stiff spring with
            a limited force, see models/systems/forces.py; a point of its surface in the path's
            plane, shape (2,), [m]; angle of its normal, which points to the free side, with the
            first axis, [rad].
        reverse_at: time at which the desired speed changes sign, [s]; 0: never.
        profile: desired speed over time, linear between (time, speed) pairs, [s] and [rad/s],
            instead of `speed` and `ramp`; it is fed forward, as in (19).
        settings: any of `onpath.parameters(robot)` by name, such as K1=900; others keep the
            robot's defaults, which are those of the lab, the command line and figures, too. A new
            lab begins more slowly, as with **onpath.NEWCOMER.

    Raises:
        ValueError: an unknown name (the message lists the nearest ones), an invalid value (the
            message lists the valid ones), or one that contradicts another, such as `hold_at`
            without `hold`; or no run is possible, because the decoupling matrix is singular at the
            start.
        OSError: a file cannot be read.

    Warns:
        UserWarning: a path that crosses itself; a parameter that is given, but has no effect in
            this run, such as K4 with task="speed"; what is foreseen for a robot with fewer
            motors than coordinates, such as unstable zero dynamics; or a motor that, without
            `torque_limit`, gave more than the robot's file states.

    Held back for a second, the follower stays near its ellipse:

    >>> import onpath
    >>> run = onpath.simulate(path=onpath.ellipse(0.06, 0.04), hold=(1, 2), duration=3, K1=900)
    >>> run.t.shape, run.y.shape, run.held.sum()
    ((3000,), (3000, 2), np.int64(1000))
    >>> bool(run.distance.max() < 0.004)
    True

    Both laws, in one picture:

    >>> laws = "trajectory_tracking", "path_following"
    >>> runs = [onpath.simulate(law=law, hold=(1, 2), duration=3) for law in laws]
    >>> figure = runs[0].plot(*runs[1:])

    A custom law, which pulls twice as hard as path following:

    >>> run = onpath.simulate(law="across = -2*K1*xi - K2*dxi; along = 9*(5 - dtheta)", duration=1)
    >>> bool(abs(run.theta_rate[-1] - 5) < 0.1)
    True

    The same as a class, which is compiled:

    >>> class Twice:
    ...     def command(self, view):
    ...         gains, output = view.gains, view.output
    ...         pulled = -2 * gains.k1 * output.xi - gains.k2 * output.xi_rate
    ...         return onpath.followed(view, onpath.tangential(view), pulled)
    >>> run = onpath.simulate(law=Twice, hold=(0.1, 0.3), duration=0.5)
    >>> bool(run.max_distance < 0.001)
    True

    A function, which is called in every control interval, returns θ'' and λ'':

    >>> def pulled(now):
    ...     return -now.K5 * (now.theta_rate - now.speed), -900 * now.xi[0] - 60 * now.xi_rate[0]
    >>> run = onpath.simulate(law=pulled, duration=1)
    >>> run.law, bool(run.max_distance < 1e-4)
    ('pulled', True)

    >>> onpath.simulate(path="elips")
    Traceback (most recent call last):
    ValueError: unknown path 'elips': did you mean ellipse? (onpath.paths() lists all)
    """
    chosen, name, given = planned(
        robot,
        path,
        law,
        duration=duration,
        start=start,
        velocity=velocity,
        clock_offset=clock_offset,
        hold=hold,
        hold_at=hold_at,
        hold_direction=hold_direction,
        push=push,
        wall=wall,
        reverse_at=reverse_at,
        profile=profile,
        **settings,
    )
    experiments.check_path(chosen.robot(), chosen.curve(), path if isinstance(path, str) else "")
    run = Run(chosen, experiments.run(chosen, name))
    remarks = (
        experiments.path_remark(chosen.curve()),
        unused_text(chosen, [name], given),
        experiments.forecast_text(chosen, [name]),
        experiments.never_held(chosen, run.trajectory),
        experiments.beyond_limits(run.trajectory, chosen.robot()),
    )
    for text in remarks:
        if text:
            warnings.warn(text, UserWarning, stacklevel=2)
    return run


def planned(
    robot: str | Path | RobotEntry,
    path: str | Path | Curve,
    law: Any,
    *,
    duration: float = 8.0,
    start: ArrayLike | None = None,
    velocity: tuple[float, float] = (0.0, 0.0),
    clock_offset: float = 0.0,
    hold: tuple[float, float] | None = None,
    hold_at: float | None = None,
    hold_direction: str | None = None,
    push: tuple[float, float, ArrayLike] | None = None,
    wall: tuple[float, float, ArrayLike, float] | None = None,
    reverse_at: float = 0.0,
    profile: str | Iterable[tuple[float, float]] | None = None,
    **settings: float | str,
) -> tuple[Experiment, str, dict[str, Any]]:
    """What the arguments of `simulate` mean: the experiment, the law's name, the settings given.

    Whether the robot can follow the path is not checked.

    Raises:
        ValueError: see `simulate`.
    """
    entry, name = entry_named(robot), law_of(law)
    check_names(settings, entry, simulate)
    check_number("duration", duration, "s")
    check_number("reverse_at", reverse_at, "s")
    check_number("clock_offset", clock_offset, "rad")
    check_number("hold_at", hold_at or 0.0, "rad")
    with looked_up("onpath.paths()"):
        curve = curve_of("path", path, entry.make(with_values(entry.parameters(), settings)))
    given = settings | _without_none({"profile": profile, "clock_offset": clock_offset or None})
    given |= {} if reverse_at == 0 else {"reverse_at": reverse_at}
    given |= _without_none({"hold_at": hold_at, "hold_direction": hold_direction})
    chosen = Experiment(
        name="simulate",
        title=entry.label,
        entry=entry,
        parameters=entry.parameters(),
        schedule=Schedule(),
        start=lambda robot, _: start_point(robot, chosen.curve(), start),
        path=curve,
        lifts=False,
    ).with_values({"duration": duration} | {**schedule_of(velocity, hold, push, wall), **given})
    return chosen, name, given


def robots() -> dict[str, str]:
    """Names of the robots with a one-sentence description of each.

    >>> import onpath
    >>> onpath.robots()["five_bar"]
    'Two motors, rigid links, a pen in a vertical plane.'
    """
    texts = {name: entry.text for name, entry in ROBOTS.items()}
    return NamesTable(texts, ("robot", "what it is"), texts.items())


def laws() -> dict[str, str]:
    """Names of the control laws with a description of each.

    >>> import onpath
    >>> onpath.laws()["virtual_constraint"]
    'Holds the end-point on the curve by a virtual constraint, and leaves it alone along it.'
    """
    texts = {name: LawText(name) for name in LAWS}
    return NamesTable(texts, ("law", "what it does"), texts.items())


def paths() -> dict[str, str]:
    """Names of the preset paths with the length of each, and what to know about it.

    >>> import onpath
    >>> onpath.paths()["circle"]
    'closed, 314 mm'
    >>> onpath.paths()["figure of eight"]
    'closed, 429 mm; the path crosses itself: at the crossing, the closest point is not unique'
    """
    texts = {name: _measured(design) for name, design in presets().items()}
    return NamesTable(texts, ("path", "what it is"), texts.items())


def _measured(design: PathDesign) -> str:
    shape = "closed" if design.curve.closed else "open"
    remark = experiments.path_remark(design.curve)
    length = f"{shape}, {design.curve.length() * 1e3:.0f} mm"
    return f"{length}; {remark}" if remark else length


def parameters(robot: str | Path | RobotEntry = "five_bar") -> dict[str, str]:
    """Names of a robot's parameters with default, range and unit, or options, and description.

    Raises:
        ValueError: an unknown robot, with the nearest names.

    >>> import onpath
    >>> onpath.parameters()["K1"]
    '400, 0 to 2500 1/s²: spring that pulls back onto the path'
    """
    entry = entry_named(robot)
    defaults, known = values_of(entry.parameters()), specs(entry.parameters)
    texts = {name: described(spec, defaults[name]) for name, spec in known.items()}
    rows = [(name, *_columns(spec, defaults[name]), spec.help) for name, spec in known.items()]
    return NamesTable(texts, ("setting", "default", "range", "unit", "what it does"), rows)


def circle(radius: float, centre: Sequence[float] = (0.0, 0.0)) -> Curve:
    """A circle with its dimensions in [m]; theta is the angle. Source: eq. (15).

    Raises:
        ValueError: non-finite numbers, or a radius that is not positive.
    """
    (length,) = lengths("radius", radius)
    return curves.circle(length, plane_point("centre", centre))


def ellipse(a: float, b: float, centre: Sequence[float] = (0.0, 0.0), angle: float = 0.0) -> Curve:
    """An ellipse with half axes a along the first and b along the second coordinate, [m].

    It is then turned by an angle about its centre, [rad]. theta is its eccentric anomaly. Like a
    circle, it has a level set, across="level_set". Source: eqs. (15), (23).

    Raises:
        ValueError: non-finite numbers, or a half axis that is not positive.

    >>> import numpy as np, onpath
    >>> (onpath.ellipse(0.07, 0.04).at(np.pi / 2) + 0.0).round(3)
    array([0.  , 0.04])
    """
    first, second = lengths("half axes", a, b)
    (turn,) = numbers("angle", (angle,), 1, "a finite number, [rad]")
    return curves.ellipse((first, second), plane_point("centre", centre), float(turn))


def segment(start: ArrayLike, end: ArrayLike) -> Curve:
    """A straight path from start (theta = -pi) to end (theta = pi), each shape (2,), [m].

    Raises:
        ValueError: non-finite numbers, or start and end coincide.
    """
    form = "a point of the plane, shape (2,), [m]"
    ends = np.stack([numbers("start", start, 2, form), numbers("end", end, 2, form)])
    ask_unit("points", ends)
    return open_through(ends)


def through(
    points: ArrayLike, closed: bool = True, *, corners: str = SMOOTH, radius: float = RADIUS
) -> Curve:
    """A smooth path through points, shape (n, 2), [m].

    It swings out between points that are far apart: its `deviation` is its largest distance from
    the straight lines between the points, [m]; beyond 4 mm there is a warning. It slows for bends.

    Args:
        points: shape (n, 2), [m].
        closed: whether the last point is joined to the first.
        corners: "smooth" for a spline through the points, or "round" for straight lines between
            them, with arcs in the place of corners.
        radius: of these arcs, [m].

    Raises:
        ValueError: too few points, non-finite numbers, or all points coincide.

    Warns:
        UserWarning: a large deviation; and the smallest radius of a path with rounded corners.

    >>> import onpath
    >>> onpath.through([[0.05, 0], [0, 0.05], [-0.05, 0], [0, -0.05]], corners="round", radius=0.03)
    <closed path, 231 mm long, 75 x 75 mm>
    """
    given = array_of("points", points, "points, shape (n, 2), [m]")
    ask_unit("points", given)
    read = path_through(given, Placing(corners=corners, radius=radius, closed=closed))
    for remark in read.remarks:
        warnings.warn(str(remark), stacklevel=2)
    return read.curve


def entry_named(robot: str | Path | RobotEntry) -> RobotEntry:
    """The robot of this name or file, or the robot itself.

    Raises:
        ValueError: there is none, with the nearest names; or the file is refused.
        OSError: the file cannot be read.

    Warns:
        UserWarning: what is left out of the file.
    """
    if isinstance(robot, RobotEntry):
        return robot
    check_one("robot", robot)
    if is_from_file(robot):
        return robot_from(robot)
    with looked_up("onpath.robots()"):
        return robot_named(str(robot))


def _without_none(values: Mapping[str, Any]) -> dict[str, Any]:
    """The values that are not None."""
    return {name: value for name, value in values.items() if value is not None}


def law_of(law: Any) -> str:
    """The name of a law, which is added to the laws if it is one's own: see `law_given`."""
    check_one("law", law)
    with looked_up("onpath.laws()"):
        return law_given(law)


def check_names(
    parameters: Mapping[str, Any], entry: RobotEntry, function: Callable[..., Any]
) -> None:
    """Refuse parameters that a robot does not have, and texts and lists in place of numbers.

    Args:
        function: the function whose arguments they are.

    Raises:
        ValueError: an unknown name, with the nearest ones; or a value that is no single number
            where one is expected.
    """
    names = specs(entry.parameters)
    arguments = [each for each in signature(function).parameters.values() if each.kind != VARIABLE]
    for name, value in parameters.items():
        if name not in names:
            with looked_up(f"onpath.parameters({entry.name!r})"):
                raise unknown_name(name, [*names, *(each.name for each in arguments)])
        check_one(name, value)
        if isinstance(value, str) and not names[name].options:
            raise CodedError("error.value_not_a_number", name=name, value=repr(value))


def described(spec: Spec, default: Any) -> str:
    """Default, range and meaning of a setting, in one line."""
    value, allowed, unit = _columns(spec, default)
    choice = "one of " if spec.options else ""
    return f"{value}, {choice}{allowed}{unit and ' ' + unit}: {spec.help}"


def _columns(spec: Spec, default: Any) -> tuple[str, str, str]:
    """Default, range or options, and unit."""
    if spec.options:
        return str(default), ", ".join(map(str, spec.options)), spec.unit
    return f"{default:g}", f"{spec.low:g} to {spec.high:g}", spec.unit
