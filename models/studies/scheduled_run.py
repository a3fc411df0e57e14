"""A closed loop run through a schedule: start, brake, hand, wall, and wanted speed over time."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator

import casadi as ca
import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.loops import InterpretedLoop
from onpath.models.closed_loop.simulation import (
    Push,
    brake_at,
    first_state,
    settings_vector,
    time_step,
)
from onpath.models.paths.curves import PERIOD, Curve
from onpath.models.paths.distance import closest_parameter
from onpath.models.studies.schedule import Schedule
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot

CHUNK = 200  # ticks between checks for divergence
JUMP = 0.5  # [rad] in one tick; a closest point that moves further has jumped, not passed


class ScheduledRun:
    """One robot under one control law, from the start to the end of a schedule.

    Args:
        robot: its system, frame and springs.
        kernel: of the robot under the law; it admits external forces.
        curve: the path.
        parameters: of the robot, the law and the task.
        schedule: what happens when.
        start: the end-point at the start, shape (p,), [m].

    Raises:
        ValueError: the start is out of reach, or the end-point cannot have that velocity there.
    """

    def __init__(
        self,
        robot: Robot,
        kernel: Kernel,
        curve: Curve,
        parameters: Parameters,
        schedule: Schedule,
        start: Array,
    ) -> None:
        self._robot, self._kernel, self._curve = robot, kernel, curve
        self._parameters, self._schedule = parameters, schedule
        self._loop, self._dt = InterpretedLoop(kernel), time_step(parameters)
        self._hold = schedule.ticks("hold", self._dt)
        self._waits = schedule.hold_at is not None and len(self._hold) > 0
        self._brake: tuple[Array, Array, Array] | None = None
        self._tick, self._state = 0, self._first(start)

    def parts(self) -> Iterator[tuple[Array, bool]]:
        """(log rows, held) of consecutive parts of the run, which are not longer than `CHUNK`."""
        table, last = self._curve.table(), round(self._schedule.duration / self._dt)
        while self._tick < last:
            settings, end = self._settings(), min(self._next_event(), last)
            while self._tick < end:
                ticks = min(CHUNK, end - self._tick)
                state, rows = self._loop.run(self._state, settings, table, ticks)
                passed = self._passage(rows)
                if passed:
                    state, rows = self._loop.run(self._state, settings, table, passed)
                    begin = self._tick + passed
                    self._hold = range(begin, begin + len(self._hold))
                    self._waits, end = False, begin
                held = self._held()
                self._state, self._tick = state, self._tick + len(rows)
                yield rows, held

    def _held(self) -> bool:
        return self._tick in self._hold and not self._waits

    def _next_event(self) -> int:
        """The next tick at which the inputs change."""
        schedule, dt = self._schedule, self._dt
        windows = [self._hold, schedule.ticks("push", dt), schedule.ticks("wall", dt)]
        times = [tick for window in windows for tick in (window.start, window.stop)]
        times.append(round(schedule.reverse_at / dt))
        if schedule.profile is not None:
            times += [tick for tick, _ in schedule.profile.on_grid(dt)]
        return min((tick for tick in times if tick > self._tick), default=self._tick + CHUNK)

    def _passage(self, rows: Array) -> int:
        """The first of these rows at which the end-point has passed the place of the hold, or 0."""
        place = self._schedule.hold_at
        if not self._waits or place is None or self._tick < self._hold.start:
            return 0
        theta = self._kernel.log.unpack(rows)["theta"][:, 0]
        turns = np.floor((theta - place) / PERIOD) if self._curve.closed else np.sign(theta - place)
        passed = (np.diff(turns) != 0) & (np.abs(np.diff(theta)) < JUMP)
        return int(passed.argmax()) + 1 if passed.any() else 0

    def _settings(self) -> Array:
        """The inputs of the loop from now on; a profile also sets the speed reference now."""
        schedule, dt, tick = self._schedule, self._dt, self._tick
        wanted = self._parameters
        if schedule.profile is not None:
            now, speed, rate = schedule.profile.after(tick, dt)
            wanted = dataclasses.replace(wanted, speed=speed, ramp=rate)
            self._fields()["speed_ref"][:] = now
        elif 0 < round(schedule.reverse_at / dt) <= tick:
            wanted = dataclasses.replace(wanted, speed=-wanted.speed)
        return settings_vector(self._robot, self._kernel, wanted, self._curve, self._push())

    def _push(self) -> Push:
        """What acts on the end-point from now on."""
        schedule, dt, frame = self._schedule, self._dt, self._robot.frame
        hand = wall = None
        if self._tick in schedule.ticks("push", dt):
            hand = frame.lift(np.array(schedule.hand()))
        if self._tick in schedule.ticks("wall", dt):
            place = frame.lift(np.array([schedule.wall_z1, schedule.wall_z2]))
            angle = schedule.wall_angle
            wall = place, _direction(self._robot, np.array([np.cos(angle), np.sin(angle)]))
        if not self._held():
            return Push(hand, wall=wall)
        if self._brake is None:
            self._brake = self._braked()
        anchor, tangent, normal = self._brake
        along = {"along": (tangent, None), "across": (normal, None), "both": (tangent, normal)}
        first, second = along[schedule.hold_direction]
        return Push(hand, (anchor, first), second, wall)

    def _braked(self) -> tuple[Array, Array, Array]:
        """Anchor, tangent and normal, in the path's plane, of a brake that is applied now."""
        fields = self._fields()
        theta, y = float(fields["theta"][0]), self._robot.endpoint(fields["q"])
        first = self._curve.at(np.array(theta), 1)
        normal = _direction(self._robot, np.array([-first[1], first[0]]))
        return *brake_at(self._robot, self._curve, y, theta), normal

    def _fields(self) -> dict[str, Array]:
        return self._kernel.state.unpack(self._state)

    def _first(self, start: Array) -> Array:
        """The state at the start."""
        schedule, frame = self._schedule, self._robot.frame
        z = frame.planar(start).copy()
        places = schedule.start_z1, schedule.start_z2
        given = [z[i] if place is None else place for i, place in enumerate(places)]
        if self._curve.dimension == 3:
            given.append(start[-1] - frame.lift(z)[-1])  # the height at which it starts anyway
        y = start if places == (None, None) else frame.lift(np.array(given))
        q = self._robot.rest(y)
        v = self._velocity(q, y)
        state = first_state(self._robot, self._kernel, self._curve, q, v)
        theta_ref = self._kernel.state.unpack(state)["theta_ref"]
        theta_ref += schedule.clock_offset
        if not self._curve.closed:
            np.clip(theta_ref, -np.pi, np.pi, out=theta_ref)
        return state

    def _velocity(self, q: Array, y: Array) -> Array:
        """Joint velocities for the end-point's velocity at the start, shape (n,).

        Coordinates without a motor are at rest.
        """
        along, across = self._schedule.start_along, self._schedule.start_across
        v = np.zeros_like(q)
        if along == 0 == across:
            return v
        frame, system = self._robot.frame, self._robot.system
        first = self._curve.at(np.array(closest_parameter(frame, self._curve, y)), 1)
        plan = first[:2] / np.linalg.norm(first[:2])
        left = np.array([-plan[1], plan[0], 0.0])[: len(first)]
        rate = along * (first / np.linalg.norm(first)) + across * left
        y_rate = frame.lift(rate) - frame.lift(np.zeros(2))
        jacobian = ca.Function(
            "jacobian",
            [system.q, system.parameters],
            [ca.densify(ca.jacobian(system.output, system.q))],
        )
        gain = np.array(jacobian(q, self._robot.plant(self._parameters)))[:, : system.m]
        v[: system.m] = np.linalg.lstsq(gain, y_rate, rcond=None)[0]
        return v


def _direction(robot: Robot, z: Array) -> Array:
    """A vector of the path's plane, (2,), as a unit vector of the output space, (p,)."""
    vector = robot.frame.lift(z) - robot.frame.lift(np.zeros(2))
    return vector / np.linalg.norm(vector)
