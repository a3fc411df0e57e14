"""A lab's set-up as plain data, to be stored, shared and restored.

It holds the differences from a new lab, so a new lab is `Setup()`. Its data name the version of the
defaults that they differ from, so that data of an earlier version keep their meaning. Lengths of a
path are whole micrometres and numbers have six digits, so that capturing a restored set-up gives
the same one.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Annotated, Any

import msgspec
import numpy as np

from onpath.app.lab.path_editor import BLEND
from onpath.app.lab.session import Belongings, Session
from onpath.models.closed_loop.obstacles import ALONG, Wall, check_direction
from onpath.models.closed_loop.simulation import raised
from onpath.models.closed_loop.start import ON_PATH, Start, check_start
from onpath.models.control.benches import BENCHES, DEFAULT_LAWS, checked_laws
from onpath.models.control.laws.expressions import LONGEST
from onpath.models.errors import CodedError, Message
from onpath.models.paths.curve_faults import curve_faults
from onpath.models.paths.curve_fit import closed_through, control_points, open_through
from onpath.models.paths.curves import TERMS, from_terms, terms_of
from onpath.models.paths.path_design import MOST_POINTS, REACH, PathDesign, presets
from onpath.models.systems.catalogue import FIVE_BAR, ROBOTS, RobotEntry
from onpath.models.systems.parameter_specs import NOTHING, Spec, out_of_range, unknown_name
from onpath.models.systems.parameters import Parameters, changed, rise_of, specs

EXAGGERATIONS = (1.0, 20.0)  # minimum and maximum
RATES = (0.125, 0.25, 0.5, 1.0, 2.0, 4.0)  # simulated seconds per second
UNIT = 1e-6  # [m]
DIGITS = 6
EDITED, DRAWN = "edited", "drawn"  # names of paths that are not presets
DRAWN_POINTS = {True: 10, False: 6}  # control points of closed and open strokes, as in `drawn`

DEFAULTS = 2  # version of a new lab's parameters; data that name none are of version 1
FORMER_DEFAULTS = {"five_bar": {"K3": 0.0}, "two_link_arm": {"K3": 0.0}, "flexible": {}}
"""Robots of version 1, and their defaults that have changed. K3 acted in the tracker, too."""

Word = Annotated[str, msgspec.Meta(max_length=40, pattern=r"^[A-Za-z0-9_ -]*$")]
LawName = Annotated[str, msgspec.Meta(max_length=LONGEST)]
"""The name of a control law, or a typed law; `checked_laws` reads it."""
Length = Annotated[int, msgspec.Meta(ge=-1_000_000, le=1_000_000)]
Lengths = Annotated[tuple[Length, ...], msgspec.Meta(max_length=2 * max(TERMS, MOST_POINTS))]


class Path(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Path of a set-up.

    Attributes:
        name: of a preset, or "edited" or "drawn".
        closed: whether an edited or drawn path is closed.
        numbers: alternating x and y, [UNIT]: control points of an edited path, coefficients of a
            drawn path in the order of `Curve.series`; empty for a preset.
    """

    name: Word = "circle"
    closed: bool = True
    numbers: Lengths = ()


class RobotSetup(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One robot's path, and its parameters where they differ from the initial ones.

    Attributes:
        start: where and how its runs start: the numbers of `Start` that are not 0, by name.
        wall: z1, z2 and angle of a wall in its way; empty if there is none.
    """

    parameters: Annotated[dict[Word, int | float | Word], msgspec.Meta(max_length=100)] = {}
    path: Path = Path()
    start: Annotated[dict[Word, float], msgspec.Meta(max_length=10)] = {}
    wall: Annotated[tuple[float, ...], msgspec.Meta(max_length=3)] = ()


class Setup(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A whole lab: the current robot, the set-up of each robot, and the lab's switches.

    Attributes:
        robots: the set-up of each robot, by name; stored as "benches".
        laws: control laws that differ from a new lab's, by bench.
        hold: direction in which brakes act.
    """

    robot: Word = FIVE_BAR.name
    robots: Annotated[dict[Word, RobotSetup], msgspec.Meta(max_length=100)] = msgspec.field(
        default_factory=dict[str, RobotSetup], name="benches"
    )
    rate: float = 1.0
    copy: bool = True
    exaggeration: float = 1.0
    laws: Annotated[dict[Word, LawName], msgspec.Meta(max_length=len(BENCHES))] = {}
    hold: Word = ALONG


class StoredSetup(Setup, frozen=True, forbid_unknown_fields=True):
    """A set-up as data: `defaults` is the version of the defaults that it differs from."""

    defaults: Annotated[int, msgspec.Meta(ge=1, le=DEFAULTS)] = 1


@dataclass(frozen=True, slots=True, eq=False)
class Wanted:
    """A robot's set-up in the form that a session uses."""

    entry: RobotEntry
    parameters: Parameters
    design: PathDesign
    start: Start = ON_PATH
    wall: Wall | None = None


def to_data(setup: Setup) -> dict[str, Any]:
    """Convert a set-up to JSON data, without default values."""
    return {"defaults": DEFAULTS, **_plain(setup)}


def _plain(value: Any) -> Any:
    if isinstance(value, msgspec.Struct):
        new = type(value)()
        names = zip(value.__struct_encode_fields__, value.__struct_fields__, strict=True)
        own = {stored: (getattr(value, name), getattr(new, name)) for stored, name in names}
        return {stored: _plain(now) for stored, (now, before) in own.items() if now != before}
    if isinstance(value, Mapping):
        return {name: _plain(item) for name, item in value.items()}
    return list(value) if isinstance(value, tuple) else value


def from_data(data: Any) -> Setup:
    """Inverse of `to_data`, for untrusted data.

    Raises:
        ValueError: it is not a valid set-up.
    """
    stored = msgspec.convert(data, StoredSetup)
    robots = stored.robots if stored.defaults == DEFAULTS else _brought_up(stored.robots)
    own: dict[str, Any] = {name: getattr(stored, name) for name in Setup.__struct_fields__}
    setup = Setup(**{**own, "robots": robots})
    entry = planned(setup, presets())[setup.robot].entry
    return msgspec.structs.replace(setup, laws=checked_laws(setup.laws, entry))


def _brought_up(robots: Mapping[str, RobotSetup]) -> dict[str, RobotSetup]:
    """The same set-ups of robots, as differences from the present defaults."""
    found = dict(robots)
    for name, former in FORMER_DEFAULTS.items():
        robot = robots.get(name, RobotSetup())
        own = {**former, **robot.parameters}
        if own.get("K3", 0.0) != 0.0:
            own["tracker_integral"] = "on"
        if own:
            found[name] = msgspec.structs.replace(robot, parameters=own)
    return found


def capture(session: Session) -> Setup:
    """The current set-up of a session; a path being dragged counts only after the drag."""
    robots = {**session.earlier, session.entry.name: session.belongings()}
    found = {name: _captured(name, own, session.presets) for name, own in sorted(robots.items())}
    return Setup(
        robot=session.entry.name,
        robots={name: robot for name, robot in found.items() if robot != RobotSetup()},
        rate=_rounded(session.rate),
        copy=session.copy,
        exaggeration=_rounded(session.exaggeration),
        laws={b: law for b, law in session.chosen_laws.items() if law != DEFAULT_LAWS[b]},
        hold=session.hold_direction,
    )


def _captured(name: str, own: Belongings, paths: Mapping[str, PathDesign]) -> RobotSetup:
    """The set-up of one robot."""
    start = {n: _rounded(value) for n, value in asdict(own.start).items()}
    wall = own.wall
    return RobotSetup(
        _differences(ROBOTS[name].lab, own.parameters),
        capture_path(own.editor.design, paths) if own.editor else Path(),
        {n: value for n, value in start.items() if value},
        () if wall is None else (_rounded(wall.z1), _rounded(wall.z2), _rounded(wall.angle)),
    )


def with_paths_of_today(setup: Setup) -> tuple[Setup, tuple[Message, ...]]:
    """A kept set-up with the circle in place of every path that is refused today, and why it is.

    A path that was accepted when it was kept may be refused now. A start that is not possible, too,
    is replaced by that of a new lab.

    Raises:
        ValueError: the set-up is impossible for another reason.
    """
    robots, told = dict(setup.robots), tuple[Message, ...]()
    for name, wanted in planned(setup, presets()).items():
        if reasons := _path_faults(wanted):
            kept = robots.get(name, RobotSetup())
            robots[name] = msgspec.structs.replace(kept, path=Path(), start={})
            told = (*told, *reasons)
        elif wanted.start != ON_PATH:
            try:
                _check_start(wanted)
            except ValueError:
                robots[name] = msgspec.structs.replace(robots[name], start={})
    return msgspec.structs.replace(setup, robots=robots), told


def _path_faults(wanted: Wanted) -> tuple[Message, ...]:
    """Why a robot cannot follow its path; empty if it can."""
    robot = wanted.entry.make(wanted.parameters)
    path = raised(wanted.design.curve, wanted.parameters)
    return tuple(fault.reason for fault in curve_faults(robot.margin, path))


def _check_start(wanted: Wanted) -> None:
    """Refuse a start that is not possible; see `check_start`."""
    if wanted.start != ON_PATH:
        path = raised(wanted.design.curve, wanted.parameters)
        check_start(wanted.entry.make(wanted.parameters), path, wanted.parameters, wanted.start)


def restore(session: Session, setup: Setup) -> None:
    """Apply a set-up, with both robots at the start of the path. The old path is one undo away.

    Raises:
        ValueError: the set-up is impossible; the session is unchanged.
    """
    wanted = planned(setup, session.presets)
    for name in (session.entry.name, *session.earlier):
        wanted.setdefault(name, _wanted(name, RobotSetup(), session.presets))
    for robot in wanted.values():
        if reasons := _path_faults(robot):
            raise CodedError("error.cannot_follow", robot=robot.entry.label, reasons=reasons)
        _check_start(robot)
    laws = checked_laws(setup.laws, wanted[setup.robot].entry)
    session.rate, session.copy = setup.rate, setup.copy
    session.exaggeration, session.hold_direction = setup.exaggeration, setup.hold
    for name in sorted(wanted, key=lambda name: name == setup.robot):
        robot = wanted[name]
        session.choose_robot(robot.entry)
        session.editor.robot = robot.entry.make(robot.parameters)
        if (rise := rise_of(robot.parameters)) != session.editor.rise:
            session.editor.raise_to(rise, robot.design)
        session.editor.commit(robot.design)
        session.editor.advance(BLEND)
        session.set_parameters(robot.parameters)
        session.start, session.wall = robot.start, robot.wall
    session.reset(laws)


def planned(setup: Setup, paths: Mapping[str, PathDesign]) -> dict[str, Wanted]:
    """The robots of a set-up, by name; does not check whether a robot can follow its path.

    Args:
        paths: the presets.

    Raises:
        ValueError: an unknown name, a number out of range, points that do not form a path, or a
            law that does not suit the robot.
    """
    msgspec.convert(to_data(setup), StoredSetup)  # one made in Python has not been validated
    _within("speed", setup.rate, RATES)
    _within("exaggeration", setup.exaggeration, EXAGGERATIONS)
    names = dict.fromkeys((*setup.robots, setup.robot))
    wanted = {name: _wanted(name, setup.robots.get(name, RobotSetup()), paths) for name in names}
    checked_laws(setup.laws, wanted[setup.robot].entry)
    check_direction(setup.hold)
    return wanted


def _wanted(name: str, robot: RobotSetup, paths: Mapping[str, PathDesign]) -> Wanted:
    if name not in ROBOTS:
        raise unknown_name(name, list(ROBOTS), "robot")
    parameters = ROBOTS[name].lab
    for field, value in robot.parameters.items():
        tiny = isinstance(value, float) and abs(value) <= NOTHING
        parameters = changed(parameters, field, 0.0 if tiny else value)
    if unknown := set(robot.start) - set(asdict(ON_PATH)):
        raise unknown_name(min(unknown), list(asdict(ON_PATH)), "start")
    if len(robot.wall) not in (0, 3):
        raise CodedError("error.half_a_wall")
    start, wall = Start(**robot.start), Wall(*robot.wall) if robot.wall else None
    return Wanted(ROBOTS[name], parameters, _design(robot.path, paths), start, wall)


def _within(what: str, value: float, bounds: tuple[float, ...]) -> None:
    if not bounds[0] <= value <= bounds[-1]:
        raise out_of_range(what, f"{value:g}", f"{bounds[0]:g}", f"{bounds[-1]:g}")


def _differences(lab: Parameters, own: Parameters) -> dict[str, int | float | str]:
    found: dict[str, int | float | str] = {}
    for name, spec in specs(own).items():
        value, default = getattr(own, name), getattr(lab, name)
        if value != default and kept(spec, value) != default:
            found[name] = kept(spec, value)
    return found


def kept(spec: Spec, value: Any) -> int | float | str:
    """A parameter's value in the form stored in a set-up."""
    return value if spec.options else min(max(_rounded(value), spec.low), spec.high)


def _rounded(value: float) -> float:
    return 0.0 if abs(value) <= NOTHING else float(f"{value:.{DIGITS}g}")


def capture_path(design: PathDesign, paths: Mapping[str, PathDesign]) -> Path:
    """Convert a path to data, given the presets."""
    if design.name in paths:
        return Path(design.name)
    closed = design.curve.closed
    if design.name == EDITED:
        return Path(EDITED, closed, _lengths(design.points))
    return Path(DRAWN, closed, _lengths(design.curve.terms()))


def _design(path: Path, paths: Mapping[str, PathDesign]) -> PathDesign:
    if path.name not in (EDITED, DRAWN):
        if path.name not in paths:
            raise unknown_name(path.name, [*paths, EDITED, DRAWN], "path")
        if path.numbers:
            raise CodedError("error.path_takes_no_numbers", name=repr(path.name))
        return paths[path.name]
    if len(path.numbers) % 2:
        raise CodedError("error.half_a_point")
    z = UNIT * np.array(path.numbers, dtype=float).reshape(-1, 2)
    if path.name == EDITED:
        if not 2 <= len(z) <= MOST_POINTS or np.abs(z).max(initial=0.0) > REACH + UNIT / 2:
            raise CodedError("error.points_out_of_bounds", most=MOST_POINTS, reach=f"{REACH:g}")
        return PathDesign(EDITED, (closed_through if path.closed else open_through)(z), z)
    if len(z) != terms_of(path.closed):
        raise CodedError("error.coefficients", wanted=terms_of(path.closed), count=len(z))
    curve = from_terms(path.closed, z)
    return PathDesign(DRAWN, curve, control_points(curve, DRAWN_POINTS[path.closed]))


def _lengths(z: np.ndarray) -> tuple[int, ...]:
    return tuple(int(n) for n in np.rint(z / UNIT).ravel())
