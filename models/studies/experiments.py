"""The paper's experiments without a display: task, schedule, both control laws, summary.

They run in the interpreted loop. The same input gives the same bytes on machines of the same kind.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.loops import InterpretedLoop
from onpath.models.closed_loop.simulation import (
    Push,
    brake_at,
    first_state,
    kernel_of,
    kind_of,
    settings_vector,
    time_step,
)
from onpath.models.closed_loop.trajectory import Trajectory, record
from onpath.models.control.laws import NAMES
from onpath.models.errors import Message
from onpath.models.paths.curves import Curve, circle
from onpath.models.systems.catalogue import FIVE_BAR, FLEXIBLE, ROBOTS
from onpath.models.systems.flexible_parameters import FlexibleParameters
from onpath.models.systems.flexible_robot import flexible_five_bar_robot
from onpath.models.systems.parameters import Parameters, changed, specs, unknown_name
from onpath.models.systems.robots import Robot, RobotEntry

CHUNK = 200  # ticks between checks for divergence
FARTHEST_HAND = 0.4  # [m], from the middle of the path's plane, along each axis


@dataclass(frozen=True, slots=True)
class Schedule:
    """The settings of an experiment besides the robot's parameters.

    Attributes:
        r: radius of the path, [m].
        duration: [s].
        hold_from, hold_to: interval in which a brake holds the end-point, [s]; equal: never.
        push_from, push_to: interval in which a hand pulls at the end-point, [s]; equal: never.
        push_z1, push_z2: where the hand is, in the path's plane, [m].
        reverse_at: time at which the wanted speed changes its sign, [s]; 0: never.

    Raises:
        ValueError: a value is out of range, or an interval ends before it begins.
    """

    r: float = 0.05
    duration: float = 4.0
    hold_from: float = 0.0
    hold_to: float = 0.0
    reverse_at: float = 0.0
    push_from: float = 0.0
    push_to: float = 0.0
    push_z1: float = 0.0
    push_z2: float = 0.0

    def __post_init__(self) -> None:
        _within("r", self.r, 0.005, 0.12, "m")
        _within("duration", self.duration, 0.01, 600.0, "s")
        _within("reverse_at", self.reverse_at, 0.0, 600.0, "s")
        _window("hold", self.hold_from, self.hold_to)
        _window("push", self.push_from, self.push_to)
        _within("push_z1", self.push_z1, -FARTHEST_HAND, FARTHEST_HAND, "m")
        _within("push_z2", self.push_z2, -FARTHEST_HAND, FARTHEST_HAND, "m")


def _window(what: str, begin: float, end: float) -> None:
    _within(f"{what}_from", begin, 0.0, 600.0, "s")
    _within(f"{what}_to", end, 0.0, 600.0, "s")
    if end < begin:
        raise ValueError(f"{what}_to ({end:g} s) lies before {what}_from ({begin:g} s)")


def _within(name: str, value: float, low: float, high: float, unit: str) -> None:
    if not low <= value <= high:  # NaN fails too
        raise ValueError(f"{name}: {value} is not between {low:g} and {high:g} {unit}")


@dataclass(frozen=True, slots=True, eq=False)
class Experiment:
    """A named experiment, ready to run.

    Attributes:
        name: as on the command line.
        title: one line for the user.
        make: the robot for given parameters.
        parameters: of the robot, the control laws and the task.
        schedule: what happens when.
        start: r -> the end-point at rest at the start, shape (p,), [m].
        path: the path to follow; None: the circle of the schedule.
    """

    name: str
    title: str
    make: Callable[[Parameters], Robot]
    parameters: Parameters
    schedule: Schedule
    start: Callable[[float], Array]
    path: Curve | None = None

    def robot(self) -> Robot:
        """The robot for the parameters."""
        return self.make(self.parameters)

    def curve(self) -> Curve:
        """The path to follow."""
        return circle(self.schedule.r) if self.path is None else self.path

    def with_values(self, assignments: Mapping[str, Any]) -> Experiment:
        """The experiment with values set by name.

        Args:
            assignments: name -> value, or value as text, of the schedule or the parameters.

        Raises:
            ValueError: an unknown name or a bad value; the message names it.
        """
        parameters, times = self.parameters, dict[str, float]()
        own = {f.name for f in dataclasses.fields(Schedule)}
        for name, text in assignments.items():
            if name in own:
                times[name] = _float(name, text)
            elif name in specs(parameters):
                parameters = changed(parameters, name, text)
            else:
                raise unknown_name(name, [*specs(parameters), *sorted(own)])
        schedule = dataclasses.replace(self.schedule, **times)  # at once: hold_from <= hold_to
        return dataclasses.replace(self, parameters=parameters, schedule=schedule)


def _float(name: str, text: Any) -> float:
    try:
        return float(text)
    except (TypeError, ValueError):
        raise ValueError(f"{name}: {text!r} is not a number") from None


def experiments(robot: str = "") -> dict[str, Experiment]:
    """All experiments by name, with their defaults.

    Args:
        robot: name of the robot in the catalogue; empty: the robots of the paper. The experiment
            "flexible" exists for the flexible five-bar only.

    Raises:
        ValueError: an unknown robot.
    """
    if robot and robot not in ROBOTS:
        raise unknown_name(robot, list(ROBOTS), "robot")
    entry = ROBOTS[robot or FIVE_BAR.name]
    known = [_position(entry), _obstruction(entry)]
    if robot in ("", FLEXIBLE.name):
        known.append(_there_and_back())
    return {e.name: e for e in known}


def _position(entry: RobotEntry) -> Experiment:
    off = np.array([np.cos(-np.pi / 3), np.sin(-np.pi / 3)])
    return Experiment(
        name="position",
        title="Experiment 1: to a place on the circle",
        make=entry.make,
        parameters=entry.parameters(task="position"),
        schedule=Schedule(duration=4.0),
        start=lambda r: _lifted(entry, 0.6 * r * off),
    )


def _obstruction(entry: RobotEntry) -> Experiment:
    return Experiment(
        name="obstruction",
        title="Experiment 2: the end-point is held back for a while",
        make=entry.make,
        parameters=entry.parameters(),
        schedule=Schedule(duration=8.0, hold_from=3.0, hold_to=5.0),
        start=lambda r: _lifted(entry, np.array([r, 0.0])),
    )


def _there_and_back() -> Experiment:
    return Experiment(
        name="flexible",
        title="Flexible link: there and back along the ellipse",
        make=FLEXIBLE.make,
        parameters=FlexibleParameters(),
        schedule=Schedule(duration=6.0, reverse_at=3.0),
        start=lambda _: _off_the_ellipse(),
    )


def _lifted(entry: RobotEntry, z: Array) -> Array:
    """A point of the path's plane in the output space, (p,), [m]."""
    return entry.make(entry.parameters()).frame.lift(z)


def _off_the_ellipse() -> Array:
    robot = flexible_five_bar_robot()
    return robot.endpoint(robot.start)


def run(experiment: Experiment, controller: str) -> Trajectory:
    """Simulate an experiment under one control law.

    Returns:
        One row per millisecond; shorter than the schedule, with `diverged_at`, if the run diverged.

    Raises:
        ValueError: the controller is unknown, or the path is out of the robot's reach.
    """
    if controller not in NAMES:
        raise ValueError(f"controller {controller!r}: expected one of {', '.join(NAMES)}")
    robot, curve = experiment.robot(), experiment.curve()
    kernel = kernel_of(robot, kind_of(controller, experiment.parameters, curve))
    start = robot.rest(experiment.start(experiment.schedule.r))
    state = first_state(robot, kernel, curve, start)
    segments: list[tuple[Array, Curve, bool]] = []
    fault: tuple[int, Message] | None = None
    done = 0
    for rows, held in _segments(experiment, kernel, curve, state):
        fields = kernel.log.unpack(rows)
        fault = robot.fault(fields["q"], fields["v"], experiment.parameters)
        if fault is not None:
            rows = rows[: fault[0]]
        segments.append((rows, curve, held))
        done += len(rows)
        if fault is not None:
            break
    return _finished(robot, kernel, controller, segments, experiment, fault)


def _segments(
    experiment: Experiment, kernel: Kernel, curve: Curve, state: Array
) -> Iterator[tuple[Array, bool]]:
    """(log rows, held) of consecutive parts of the run."""
    robot, parameters, schedule = experiment.robot(), experiment.parameters, experiment.schedule
    loop, table, dt = InterpretedLoop(kernel), curve.table(), time_step(parameters)
    hold = range(round(schedule.hold_from / dt), round(schedule.hold_to / dt))
    push = range(round(schedule.push_from / dt), round(schedule.push_to / dt))
    last, turn = round(schedule.duration / dt), round(schedule.reverse_at / dt)
    hand = robot.frame.lift(np.array([schedule.push_z1, schedule.push_z2]))
    brake, back = None, dataclasses.replace(parameters, speed=-parameters.speed)
    events = (hold.start, hold.stop, push.start, push.stop, turn)
    times = sorted({0, last, *(t for t in events if 0 < t < last)})
    for begin, end in pairwise(times):
        held = begin in hold
        if held and brake is None:
            fields = kernel.state.unpack(state)
            end_point = robot.endpoint(fields["q"])
            brake = brake_at(robot, curve, end_point, float(fields["theta"][0]))
        acting = Push(hand if begin in push else None, brake if held else None)
        wanted = back if 0 < turn <= begin else parameters
        settings = settings_vector(robot, kernel, wanted, curve, acting)
        for first in range(begin, end, CHUNK):
            state, rows = loop.run(state, settings, table, min(CHUNK, end - first))
            yield rows, held


def _finished(
    robot: Robot,
    kernel: Kernel,
    controller: str,
    segments: list[tuple[Array, Curve, bool]],
    experiment: Experiment,
    fault: tuple[int, Message] | None,
) -> Trajectory:
    """The trajectory of a run, cut off at the fault if there was one."""
    dt = time_step(experiment.parameters)
    whole = record(robot, kernel.log, controller, segments, dt)
    if fault is None:
        return whole.thinned()
    end = len(whole.t) * dt
    return dataclasses.replace(whole.thinned(), diverged_at=end, reason=str(fault[1]))


def summary(experiment: Experiment, runs: list[Trajectory]) -> dict[str, Any]:
    """The content of `--json`; numbers have nine significant digits."""
    return {
        "experiment": experiment.name,
        "controllers": {run.controller: _summary(run) for run in runs},
    }


def _summary(run: Trajectory) -> dict[str, Any]:
    def largest(values: Array) -> float | None:
        return float(f"{np.abs(values).max():.9g}") if values.size else None

    empty = run.t.size == 0
    return {
        "max_distance_m": largest(run.distance),
        "max_distance_while_held_m": largest(run.distance[run.held]),
        "rms_distance_m": None if empty else float(f"{np.sqrt(np.mean(run.distance**2)):.9g}"),
        "final_speed_rad_s": None if empty else float(f"{run.fields['theta_rate'][-1, 0]:.9g}"),
        "max_torque_Nm": largest(run.fields["u"]),
        "diverged": run.diverged_at is not None,
        "diverged_at_s": None if run.diverged_at is None else float(f"{run.diverged_at:.9g}"),
    }
