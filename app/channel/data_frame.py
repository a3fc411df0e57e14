"""Frames of a page's data channel: what both robots did since the last frame.

The simulation thread collects references only, which takes a few microseconds; the network thread
makes numbers and text of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from itertools import compress
from math import inf
from operator import is_
from typing import Any

import numpy as np
from msgspec import Struct

from onpath.app.channel.motion_messages import FrameMessage, PathMessage
from onpath.app.lab.events import LabEvent
from onpath.app.lab.lab import Lab
from onpath.app.lab.loop_states import Slot
from onpath.app.lab.plot_rows import ASKED, MOST_LINES, XI, rounding
from onpath.app.lab.plot_samples import sample_layout, samples_of
from onpath.app.lab.simulation import Simulation
from onpath.app.lab.snapshots.robot_geometry import straight_tip
from onpath.app.lab.snapshots.snapshot import PathSnapshot
from onpath.models.arrays import Array
from onpath.models.closed_loop.loop_vectors import log_layout
from onpath.models.control.sides import SIDES
from onpath.models.paths.spline_curves import SplineCurve
from onpath.models.systems.law_parameters import LEVEL_SET
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot

MOST = 30  # samples kept for a page that reads slowly; older ones come from the history
EARLIER = 4000  # samples of the last minute, at most
TIME, LENGTH, ANGLE, FORCE = 1e4, 1e5, 1e4, 1e2  # units per second, metre, radian, newton
FIELDS = "theta", "theta_ref", "y", "force"  # of each robot in a row, after its distance
PULLED = len(SIDES)  # bit number of the first pulled side


class Sample(Struct, frozen=True, eq=False):
    """Both robots at one time.

    Attributes:
        time: [s].
        flags: bits of the sides that are held, then of those that are pulled.
        slots: of the closed loops.
    """

    time: float
    flags: int
    slots: tuple[Slot, ...]


class Earlier(Struct, frozen=True, eq=False):
    """Samples of the history, for a page that does not have them.

    Attributes:
        times: [s].
        values: see `sample_layout`.
        events: of the lab.
        across_since: time since which ξ has had its present unit, [s].
    """

    times: Array
    values: Array
    events: Sequence[LabEvent]
    across_since: float


class DataFrame(Struct, frozen=True, eq=False):
    """What a page is told at once.

    Attributes:
        robot, parameters: of the samples.
        fields: that the page plots, besides those of every frame.
        anew: whether the page must forget its earlier samples.
        earlier: samples that come before the latest, or None.
        latest: samples since the last frame, the last of which is the present.
        running: whether time runs.
        past: the past instant that is shown, [s], or None.
    """

    robot: Robot
    parameters: Parameters
    fields: tuple[str, ...]
    anew: bool
    earlier: Earlier | None
    latest: list[Sample]
    running: bool
    past: float | None


class FrameSource:
    """Collects what one page is to be told of the lab that it shows.

    Args:
        tells_past: whether it is to know what happened before it looked on.
    """

    def __init__(self, *, tells_past: bool = True) -> None:
        self._tells_past = tells_past
        self._latest = list[Sample]()  # the last one sent, and all since then
        self.fields: tuple[str, ...] = ()
        self.forget()

    def ask(self, fields: Sequence[str]) -> None:
        """Tell these fields, too, also of the past; unknown ones are left out."""
        known = tuple([name for name in ASKED if name in fields])
        if known != self.fields:
            self.fields = known
            self.forget()

    def forget(self) -> None:
        """Tell the page everything again."""
        self._latest.clear()
        self._simulation: Simulation | None = None
        self._run, self._history, self._is_area = 0, None, False
        self._anew, self._behind = True, False
        self._sent: tuple[bool, float | None] = False, None

    def note(self, simulation: Simulation) -> None:
        """Note the present sample, if it is new. Call it in every frame of the simulation."""
        latest, slots = self._latest, tuple([run.slot for run in simulation.runs.values()])
        if (
            simulation is not self._simulation
            or simulation.run_number != self._run
            or simulation.history is not self._history
            or (simulation.parameters.across == LEVEL_SET) is not self._is_area
        ):
            self.forget()
            self._simulation, self._run = simulation, simulation.run_number
            self._history = simulation.history
            self._is_area = simulation.parameters.across == LEVEL_SET  # another unit of ξ
        flags = _flags(simulation)
        if latest:
            last = latest[-1]
            if last.flags == flags and all(map(is_, slots, last.slots)):
                return
            if len(latest) > 1 and last.time == simulation.time:  # a path was bent in a pause
                latest.pop()
            elif len(latest) >= MOST:
                del latest[1:]
                self._behind = True
        latest.append(Sample(simulation.time, flags, slots))

    def take(self, lab: Lab) -> DataFrame | None:
        """What has happened since the last frame, None if nothing; after `note`."""
        simulation, latest = lab.simulation, self._latest
        state = simulation.running and not lab.frozen, simulation.viewing
        if not self._anew and len(latest) == 1 and state == self._sent:
            return None
        new, earlier = latest if len(latest) == 1 else latest[1:], None
        if self._tells_past and (self._anew or self._behind):
            since = -inf if self._anew else latest[0].time
            earlier = _earlier(simulation, since)
        frame = DataFrame(
            robot=simulation.robot,
            parameters=simulation.parameters,
            fields=_plotted(simulation.robot, self.fields),
            anew=self._anew,
            earlier=earlier,
            latest=new if earlier is None else [latest[-1]],
            running=state[0],
            past=state[1],
        )
        self._latest, self._sent = [latest[-1]], state
        self._anew = self._behind = False
        return frame


def frame_message(frame: DataFrame) -> FrameMessage:
    """The message of a frame."""
    robot, latest = frame.robot, frame.latest
    slots = [(states, states.records[i]) for sample in latest for states, i in sample.slots]
    numbers = [record.take(_columns(robot, states.size, len(record))) for states, record in slots]
    rows = _units(robot) * np.concatenate(numbers).reshape(len(latest), -1)
    heads = [[round(TIME * sample.time), sample.flags] for sample in latest]
    more = _more(frame, slots) if frame.fields else [()] * len(latest)
    lines: list[list[int | None]] = [
        [*head, *row, *others] for head, row, others in zip(heads, _whole(rows), more, strict=True)
    ]
    if frame.earlier is not None:
        is_before = np.rint(TIME * frame.earlier.times) < heads[0][0]
        lines = [*compress(_earlier_lines(frame, frame.earlier), is_before), *lines]
    message = FrameMessage(lines, frame.running, frame.past, frame.anew)
    if frame.anew:
        message.fields = _field_units(frame)
    if (straight := straight_tip(robot)) is not None:
        q = log_layout(robot.system).slices["q"]
        tips = np.concatenate([straight(record[states.size :][q]) for states, record in slots])
        message.straight = _whole(LENGTH * tips.reshape(len(latest), -1))
    return message


def _plotted(robot: Robot, fields: Sequence[str]) -> tuple[str, ...]:
    """The fields that the robot has."""
    return tuple([name for name in fields if name in sample_layout(robot).slices])


def _field_units(frame: DataFrame) -> list[tuple[str, int, float]]:
    """For each field that is plotted, how many of its numbers are told, and units per SI unit."""
    is_area, sizes = frame.parameters.across == LEVEL_SET, dict(sample_layout(frame.robot).fields)
    return [(name, min(sizes[name], MOST_LINES), rounding(name, is_area)) for name in frame.fields]


def _more(frame: DataFrame, slots: Sequence[tuple[Any, Array]]) -> list[list[int]]:
    """The plotted numbers of the latest samples: a line for each, with all robots."""
    rows = np.array([record[states.size : -2] for states, record in slots])
    distances = np.array([record[-2] for _, record in slots])
    values = samples_of(frame.robot, frame.parameters, rows, distances)
    return _whole(_chosen(frame, values).reshape(len(frame.latest), -1))


def _chosen(frame: DataFrame, values: Array) -> Array:
    """The plotted numbers of samples, (..., fields), in units of the channel."""
    slices = sample_layout(frame.robot).slices
    parts = [
        unit * values[..., slices[name]][..., :size] for name, size, unit in _field_units(frame)
    ]
    return np.concatenate(parts, axis=-1)


def _whole(numbers: Array) -> list[list[int]]:
    """Rounded numbers; 0 where one is not finite."""
    finite = numbers if np.isfinite(numbers).all() else np.nan_to_num(numbers, posinf=0, neginf=0)
    return np.rint(finite).astype(np.int64).tolist()


def path_message(robot: Robot, path: PathSnapshot) -> PathMessage:
    """The message of a path: its points in the output space, at evenly spaced θ from -π to π."""
    origin, first, second = robot.frame.lift(np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]))
    right = (first - origin) / np.linalg.norm(first - origin)
    up = second - origin
    up -= up @ right * right
    return PathMessage(
        points=_whole(LENGTH * robot.output_at(path.points)),
        closed=path.curve.closed,
        raised=path.curve.raised if isinstance(path.curve, SplineCurve) else (),
        right=right.tolist(),
        up=(up / np.linalg.norm(up)).tolist(),
    )


def _flags(simulation: Simulation) -> int:
    """`Sample.flags` of the present."""
    held, hands = simulation.forces.held, simulation.forces.hands
    if not held and not hands:
        return 0
    return sum(
        (side in held) << i | (side in hands) << (PULLED + i) for i, side in enumerate(SIDES)
    )


def _earlier(simulation: Simulation, since: float) -> Earlier | None:
    times, values = simulation.history.samples(since, simulation.time, EARLIER)
    if not len(times):
        return None
    run = simulation.run_number
    return Earlier(
        times=times,
        values=values,
        events=[event for event in simulation.events if event.run == run],
        across_since=simulation.across_since,
    )


def _flags_at(times: Array, events: Sequence[LabEvent]) -> Array:
    """`Sample.flags` at some times, from what was noted when they changed."""
    flags = np.zeros(len(times), dtype=int)
    for event in events:
        if event.name not in _FLAGS:
            continue
        first, on = _FLAGS[event.name]
        bits = sum(1 << (first + SIDES.index(side)) for side in event.sides)
        since = times >= event.time
        flags[since] = flags[since] | bits if on else flags[since] & ~bits
    return flags


_FLAGS = {"hold": (0, True), "let_go": (0, False), "pull": (PULLED, True)}
_FLAGS |= {"release": (PULLED, False)}


def _earlier_lines(frame: DataFrame, earlier: Earlier) -> list[list[int | None]]:
    slices, robot = sample_layout(frame.robot).slices, frame.robot
    columns = np.concatenate([np.r_[slices[name]] for name in ("distance", *FIELDS)])
    rows = _units(robot) * earlier.values[..., columns].reshape(len(earlier.times), -1)
    heads = np.column_stack([TIME * earlier.times, _flags_at(earlier.times, earlier.events)])
    told = _whole(np.column_stack([heads, rows]))
    more = [()] * len(told)
    if frame.fields:
        more = _whole(_chosen(frame, earlier.values).reshape(len(told), -1))
    sizes = [(name in XI, size) for name, size, _ in _field_units(frame)]
    is_across = [across for across, size in sizes for _ in range(size)] * len(SIDES)
    lines = list[list[int | None]]()
    for time, line, others in zip(earlier.times, told, more, strict=True):
        if time < earlier.across_since:  # in another unit
            others = [None if each else x for each, x in zip(is_across, others, strict=True)]
        lines.append([*line, *others])
    return lines


@lru_cache(maxsize=64)
def _columns(robot: Robot, state: int, length: int) -> Array:
    """Indices of a row's numbers in the record of a closed loop; see `LoopStates`.

    Args:
        state: size of the state.
        length: of the record.
    """
    slices = log_layout(robot.system).slices
    return np.concatenate([[length - 2], *[state + np.r_[slices[name]] for name in FIELDS]])


@lru_cache(maxsize=16)
def _units(robot: Robot) -> Array:
    """Factors of a row's numbers."""
    p = robot.system.p
    return np.array([LENGTH, ANGLE, ANGLE, *[LENGTH] * p, *[FORCE] * p] * len(SIDES))
