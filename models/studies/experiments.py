"""The paper's experiments without a display: task, schedule, both control laws, summary.

They run in the interpreted loop. The same input gives the same bytes on machines of the same kind.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import groupby
from typing import Any

import msgspec
import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.called_loop import CalledLoop, callable_loop
from onpath.models.closed_loop.faults import explained, fault_in
from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.loops import InterpretedLoop, Loop
from onpath.models.closed_loop.sensing import readings
from onpath.models.closed_loop.simulation import (
    FREE,
    check_level_set,
    kernel_of,
    kind_of,
    raised,
    settings_vector,
    time_step,
)
from onpath.models.closed_loop.trajectory import MEASURED, Trajectory, record
from onpath.models.control.forecast import SINGULAR, check_possible, forecasts
from onpath.models.control.laws.law import Law
from onpath.models.control.laws.registry import law_named
from onpath.models.control.settable import changed, specs
from onpath.models.errors import CodedError, Message
from onpath.models.paths.curve_data import curve_from
from onpath.models.paths.curve_faults import ambiguities, curve_faults
from onpath.models.paths.curves import Curve, circle
from onpath.models.studies import schedule as schedules
from onpath.models.studies.schedule import Schedule
from onpath.models.studies.scheduled_run import ScheduledRun
from onpath.models.systems.catalogue import FIVE_BAR, FLEXIBLE, ROBOTS
from onpath.models.systems.efforts import exceeded
from onpath.models.systems.flexible_parameters import FlexibleParameters
from onpath.models.systems.flexible_robot import flexible_five_bar_robot, start_of
from onpath.models.systems.guessed_numbers import told_guesses
from onpath.models.systems.law_parameters import LEVEL_SET
from onpath.models.systems.parameter_specs import unknown_name
from onpath.models.systems.parameters import Parameters, declared, rise_of
from onpath.models.systems.robots import Robot, RobotEntry

_CHECKED = set[tuple[Law, Robot]]()
"""Laws that are called, whose results have been checked for a robot."""
NEAR = 1e-9  # [m], distance that counts as on the path
OF_SPEED = ("speed", "ramp", "speed_profile", "profile_period")
"""Parameters that a profile of the schedule replaces."""


@dataclass(frozen=True, slots=True, eq=False)
class Experiment:
    """A named experiment, ready to run.

    Attributes:
        name: as on the command line.
        title: one line for the user.
        entry: the robot.
        parameters: of the robot, the control laws and the task.
        schedule: the events over time.
        start: (robot, r) -> the end-point at rest at the start, shape (p,), [m].
        path: the path to follow, with the rise of the parameters; None: the circle of the schedule.
        lifts: whether the start is lifted to the height of a path with a rise.
    """

    name: str
    title: str
    entry: RobotEntry
    parameters: Parameters
    schedule: Schedule
    start: Callable[[Robot, float], Array]
    path: Curve | None = None
    lifts: bool = True

    def __reduce__(self) -> tuple[Callable[..., Experiment], tuple[dict[str, Any]]]:
        return experiment_from, (self.data(),)

    def data(self) -> dict[str, Any]:
        """The experiment by names and values, so that it can be pickled."""
        settings = {
            name: getattr(self.parameters, name) for name in declared(type(self.parameters))
        }
        return {
            "name": self.name,
            "title": self.title,
            "robot": self.entry,
            "settings": settings,
            "own_gains": self.parameters.own_gains,
            "schedule": msgspec.to_builtins(self.schedule),
            "start": self.begin(),
            "path": None if self.path is None else self.path.data(),
        }

    def robot(self) -> Robot:
        """The robot for the parameters."""
        return self.entry.make(self.parameters)

    def curve(self) -> Curve:
        """The path to follow."""
        path = circle(self.schedule.r) if self.path is None else self.path
        return raised(path, self.parameters)

    def begin(self) -> Array:
        """The end-point at the start, shape (p,), [m]; see `lifts`."""
        y, curve = self.start(self.robot(), self.schedule.r), self.curve()
        if not self.lifts or not rise_of(self.parameters):
            return y
        frame = self.robot().frame
        theta, _ = curve.plan.nearest(frame.planar(y)[None])
        return frame.lift(np.append(frame.planar(y), curve.at(theta)[0, 2]))

    def along(self, path: Curve, name: str = "") -> Experiment:
        """The experiment on another path, with the name that the user gives it.

        The end-point starts at the same point, or where the path begins if it was on the former.

        Raises:
            ValueError: the robot cannot follow the path; the message says why.
        """
        check_path(self.robot(), path, name)
        robot = self.robot()
        first = robot.frame.planar(self.start(robot, self.schedule.r))
        if self.curve().plan.nearest(first[None])[1][0] >= NEAR:
            return dataclasses.replace(self, path=path)
        on_path = robot.frame.lift(path.at(np.array(path.begin)))
        return dataclasses.replace(self, path=path, start=partial(_always, on_path))

    def with_values(self, assignments: Mapping[str, Any]) -> Experiment:
        """The experiment with values set by name.

        Args:
            assignments: name -> value, or value as text, of the schedule or the parameters.

        Raises:
            ValueError: an unknown name, a bad value, or one that contradicts another; the message
                names it.
        """
        parameters, scheduled = self.parameters, dict[str, Any]()
        for name, text in assignments.items():
            if name in schedules.NAMES:
                scheduled[name] = text
            elif name in specs(parameters):
                parameters = changed(parameters, name, text)
            else:
                raise unknown_name(name, [*specs(parameters), *sorted(schedules.NAMES)])
        if "r" in scheduled and self.path is not None:
            raise ValueError("r: the path is given, so that it has no radius to set")
        schedule = schedules.with_values(self.schedule, scheduled)
        for speed in schedule.profile.speeds if schedule.profile else ():
            changed(parameters, "speed", speed)  # in range
        for name in OF_SPEED if schedule.profile else ():
            if name in assignments:
                raise ValueError(f"{name}: the profile says the speed already")
        whole = dataclasses.replace(self, parameters=parameters, schedule=schedule)
        if rise_of(parameters) != rise_of(self.parameters):
            check_path(whole.robot(), whole.curve())
        return whole


def experiment_from(data: Mapping[str, Any]) -> Experiment:
    """The inverse of `Experiment.data`.

    Raises:
        ValueError: a setting that this version of OnPath does not have, or a bad value.
    """
    entry: RobotEntry = data["robot"]
    for name in data["settings"]:
        if name not in declared(entry.parameters):
            raise ValueError(f"this version of OnPath has no setting {name} of {entry.label}")
    return Experiment(
        name=data["name"],
        title=data["title"],
        entry=entry,
        parameters=entry.parameters(**data["settings"], own_gains=data["own_gains"]),
        schedule=msgspec.convert(data["schedule"], Schedule),
        start=partial(_always, data["start"]),
        path=None if data["path"] is None else curve_from(data["path"]),
        lifts=False,
    )


def check_path(robot: Robot, path: Curve, name: str = "") -> None:
    """Check that a robot can follow a path.

    Args:
        name: the user's name of the path, for the message.

    Raises:
        ValueError: it cannot; the message says why.
    """
    faults = curve_faults(robot.margin, path)
    if faults:
        reasons = "; ".join(str(fault.reason) for fault in faults)
        raise ValueError(f"{name}: {reasons}" if name else reasons)


def path_remark(path: Curve) -> str:
    """A warning of the places where the closest point on a path is not unique; empty if there are
    none."""
    return "; ".join(str(each.reason) for each in ambiguities(path))


def forecast_text(experiment: Experiment, laws: Sequence[str]) -> str:
    """The foreseen problems under some of the laws; empty if there are none.

    `run` refuses a singular start.
    """
    robot = experiment.robot()
    begin, parameters = robot.rest(experiment.begin()), experiment.parameters
    messages = forecasts(robot, laws, parameters, begin, experiment.curve())
    return "; ".join(str(each) for each in messages if each != SINGULAR)


def never_held(experiment: Experiment, trajectory: Trajectory) -> str:
    """Why the scheduled brake never acted in a run; empty if it did or is not scheduled."""
    schedule = experiment.schedule
    stopped = trajectory.stopped_at is not None
    if schedule.hold_at is None or stopped or trajectory.held.any():
        return ""
    begin = f"{schedule.hold_from:g} s"
    return f"never held: the end-point did not pass θ = {schedule.hold_at:g} rad after {begin}"


def beyond_limits(trajectory: Trajectory, robot: Robot) -> str:
    """Which motor gave more than the robot's file states, most of all; empty if none did."""
    torques = trajectory.fields["u"]
    if not len(torques):
        return ""
    found = exceeded(robot, np.abs(torques).max(axis=0))
    return "" if found is None else str(found)


def _always(point: Array, _robot: Robot, _r: float) -> Array:
    return point


def on_path(entry: RobotEntry, parameters: Parameters, path: Curve) -> Experiment:
    """A robot that starts at rest at the beginning of a path, without obstructions."""
    return Experiment(
        name="on_path",
        title=entry.label,
        entry=entry,
        parameters=parameters,
        schedule=Schedule(),
        start=lambda robot, _: robot.frame.lift(raised(path, parameters).at(np.array(path.begin))),
        path=path,
        lifts=False,
    )


def experiments(robot: str = "") -> dict[str, Experiment]:
    """All experiments by name, with their defaults.

    Args:
        robot: name of the robot in the catalogue; empty: the robots of the paper. The experiment
            "flexible" exists for the flexible five-bar only, "saddle" for robots with a `rise`.

    Raises:
        ValueError: an unknown robot.
    """
    if robot and robot not in ROBOTS:
        raise unknown_name(robot, list(ROBOTS), "robot")
    entry = ROBOTS[robot or FIVE_BAR.name]
    known = [_position(entry), _obstruction(entry)]
    if robot in ("", FLEXIBLE.name):
        known.append(_there_and_back())
    if "rise" in specs(entry.parameters):
        known.append(_saddle(entry))
    return {e.name: e for e in known}


def _position(entry: RobotEntry) -> Experiment:
    off = np.array([np.cos(-np.pi / 3), np.sin(-np.pi / 3)])
    return Experiment(
        name="position",
        title="Experiment 1: to a place on the path",
        entry=entry,
        parameters=entry.parameters(task="position"),
        schedule=Schedule(r=entry.radius, duration=4.0),
        start=lambda robot, r: robot.frame.lift(0.6 * r * off),
    )


def _obstruction(entry: RobotEntry) -> Experiment:
    return Experiment(
        name="obstruction",
        title="Experiment 2: the end-point is held back for a while",
        entry=entry,
        parameters=entry.parameters(),
        schedule=Schedule(r=entry.radius, duration=8.0, hold_from=3.0, hold_to=5.0),
        start=lambda robot, r: robot.frame.lift(np.array([r, 0.0])),
    )


def _saddle(entry: RobotEntry) -> Experiment:
    known = _obstruction(entry)
    return dataclasses.replace(
        known,
        name="saddle",
        title="Held back on a space curve: a circle whose height is 30 mm cos 2θ",
        parameters=changed(known.parameters, "rise", 0.03),
    )


def _there_and_back() -> Experiment:
    return Experiment(
        name="flexible",
        title="Flexible link: there and back along the path",
        entry=FLEXIBLE,
        parameters=FlexibleParameters(output="redefined"),
        schedule=Schedule(duration=6.0, reverse_at=3.0),
        start=lambda robot, _: _off_the_ellipse(robot),
    )


def _off_the_ellipse(robot: Robot) -> Array:
    """The start of the flexible robot, [m]: with the default plane, 10 mm off its path.

    With another plane, it has the same offset from it at the same planar coordinates.
    """
    usual = flexible_five_bar_robot()
    y = usual.endpoint(start_of())
    if robot.frame == usual.frame:
        return y
    z = usual.frame.planar(y)
    return robot.frame.lift(z) + y - usual.frame.lift(z)


def run(
    experiment: Experiment,
    law: str,
    loop: Callable[[Kernel], Loop] = InterpretedLoop,
) -> Trajectory:
    """Simulate an experiment under one control law.

    Args:
        loop: makes the closed loop.

    Returns:
        One row per millisecond; shorter than the schedule, with `stopped_at`, if the run diverged.

    Raises:
        ValueError: the law is unknown, the path is out of the robot's reach, or no run is
            possible from the start.
    """
    kernel, running, scheduled = _begun(experiment, law, loop)
    robot, curve = experiment.robot(), experiment.curve()
    segments: list[tuple[Array, Curve, bool]] = []
    fault: tuple[int, Message] | None = None
    done = 0
    for rows, held in scheduled.parts():
        fault = fault_in(robot, kernel.log, law, rows, experiment.parameters)
        if fault is not None:
            tick, reason = fault
            rows = rows[:tick]
            message = explained(reason, robot, kernel.log, law, rows, experiment.parameters, curve)
            failed = running.failure if isinstance(running, CalledLoop) else None
            fault = tick, failed or message
        segments.append((rows, curve, held))
        done += len(rows)
        if fault is not None:
            break
    return _finished(robot, kernel, law, _joined(segments), experiment, fault)


def check_own_law(experiment: Experiment, law: str) -> None:
    """Check that the code of a custom law gives a command at the start of an experiment.

    Raises:
        CodedError: it fails, or it returns no command, with file and line.
    """
    known = law_named(law)
    if known.origin is None or (known, experiment.robot().core) in _CHECKED:
        return
    try:
        _begun(experiment, law, InterpretedLoop)
    except ValueError as error:  # others say that no run is possible here
        if isinstance(error, CodedError) and error.message.code == "error.law_fails":
            raise


def _begun(
    experiment: Experiment, law: str, loop: Callable[[Kernel], Loop]
) -> tuple[Kernel, Loop, ScheduledRun]:
    """What `run` runs, after all checks: the kernel, its loop, and the run at its start.

    Raises:
        ValueError: see `run`.
    """
    law_named(law)
    robot, curve = experiment.robot(), experiment.curve()
    check_level_set(experiment.parameters, curve)
    kind = kind_of(law, experiment.parameters, curve)
    kernel, start = kernel_of(robot, kind), experiment.begin()
    check_possible(robot, law, experiment.parameters, robot.rest(start))
    running = callable_loop(robot, kind, kernel, loop(kernel))
    scheduled = ScheduledRun(
        robot=robot,
        loop=running,
        curve=curve,
        parameters=experiment.parameters,
        schedule=experiment.schedule,
        start=start,
    )
    own = law_named(law), robot.core
    if own[0].origin is not None and own not in _CHECKED:
        if isinstance(running, CalledLoop):
            running.check(*scheduled.inputs())
        _CHECKED.add(own)
    return kernel, running, scheduled


def _joined(segments: list[tuple[Array, Curve, bool]]) -> list[tuple[Array, Curve, bool]]:
    """The segments, with consecutive ones that are alike as one."""
    joined = list[tuple[Array, Curve, bool]]()
    for (_, held), alike in groupby(segments, key=lambda each: (id(each[1]), each[2])):
        parts = list(alike)
        joined.append((np.concatenate([rows for rows, _, _ in parts]), parts[0][1], held))
    return joined


def _finished(
    robot: Robot,
    kernel: Kernel,
    law: str,
    segments: list[tuple[Array, Curve, bool]],
    experiment: Experiment,
    fault: tuple[int, Message] | None,
) -> Trajectory:
    """The trajectory of a run, cut off at the fault if there was one."""
    dt = time_step(experiment.parameters)
    level_set = experiment.parameters.across == LEVEL_SET and experiment.curve().equation is None
    whole = record(robot, kernel.log, law, segments, dt)
    whole = dataclasses.replace(whole, level_set=level_set)
    kind = kind_of(law, experiment.parameters, experiment.curve())
    if kind.encoder or kind.noise:
        settings = settings_vector(robot, kernel, experiment.parameters, experiment.curve(), FREE)
        angles = readings(robot.system, kind, kernel.settings, settings, whole.fields["q"])
        whole = dataclasses.replace(whole, fields=whole.fields | {MEASURED: angles})
    if fault is None:
        return whole.thinned()
    end = len(whole.t) * dt
    return dataclasses.replace(whole.thinned(), stopped_at=end, reason=str(fault[1]))


def summary(experiment: Experiment, runs: list[Trajectory]) -> dict[str, Any]:
    """The content of `--json`; numbers have nine significant digits.

    For a run that was stopped, maxima and means are infinity, which ranks last, and the final speed
    is None.
    """
    held = experiment.schedule.hold_from < experiment.schedule.hold_to
    laws = {
        run.law: {
            **(_summary(run) if run.stopped_at is None else of_stopped(run.stopped_at, held)),
            "never_held": bool(never_held(experiment, run)),
        }
        for run in runs
    }
    guesses = told_guesses(experiment.entry.guesses)
    return {"experiment": experiment.name, "laws": laws} | ({"guesses": guesses} if guesses else {})


def _summary(run: Trajectory) -> dict[str, Any]:
    def largest(values: Array) -> float | None:
        return float(f"{np.abs(values).max():.9g}") if values.size else None

    return {
        "max_distance_m": largest(run.distance),
        "max_distance_while_held_m": largest(run.distance[run.held]),
        "rms_distance_m": float(f"{np.sqrt(np.mean(run.distance**2)):.9g}"),
        "final_speed_rad_s": float(f"{run.fields['theta_rate'][-1, 0]:.9g}"),
        "max_torque_Nm": largest(run.fields["u"]),
        "stopped_at_s": None,
    }


def of_stopped(time: float, held: bool) -> dict[str, Any]:
    """The summary of a run that was stopped at a time, [s].

    Args:
        held: whether a hold was scheduled.
    """
    return {
        "max_distance_m": np.inf,
        "max_distance_while_held_m": np.inf if held else None,
        "rms_distance_m": np.inf,
        "final_speed_rad_s": None,
        "max_torque_Nm": np.inf,
        "stopped_at_s": float(f"{time:.9g}"),
    }
