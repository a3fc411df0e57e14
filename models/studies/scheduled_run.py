"""Runs a closed loop through a schedule: start, brake, hand, wall, and wanted speed over time."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator

import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.loops import Loop
from onpath.models.closed_loop.obstacles import brake_in
from onpath.models.closed_loop.profile_shapes import profile_of
from onpath.models.closed_loop.simulation import (
    Push,
    first_state,
    pushed,
    settings_vector,
    time_step,
)
from onpath.models.closed_loop.speed_profile import SpeedProfile
from onpath.models.closed_loop.start import lead, velocity_at
from onpath.models.paths.curves import PERIOD, Curve
from onpath.models.studies.schedule import Schedule
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot

CHUNK = 200  # ticks between checks for divergence
FAR_AWAY = 1e3  # [m], of a hand that pulls
STEP = 0.01  # [s] between movements of a hand that goes along with the end-point
JUMP = 0.02  # [m] along the path in one tick; a closest point that moves farther has jumped
LEFT = np.array([[0.0, -1.0], [1.0, 0.0]])  # turns a tangent to the left


class ScheduledRun:
    """One robot under one control law, from the start to the end of a schedule.

    Args:
        robot: its system, frame and springs.
        loop: that of the robot under the law; it must allow external forces.
        curve: the path.
        parameters: of the robot, the law and the task.
        schedule: the events over time.
        start: the end-point at the start, shape (p,), [m].

    Raises:
        ValueError: the start is out of reach, or the end-point cannot have that velocity there.
    """

    def __init__(
        self,
        robot: Robot,
        loop: Loop,
        curve: Curve,
        parameters: Parameters,
        schedule: Schedule,
        start: Array,
    ) -> None:
        self._robot, self._layouts, self._curve = robot, loop.layouts, curve
        self._parameters, self._schedule = parameters, schedule
        self._loop, self._dt = loop, time_step(parameters)
        self._hold = schedule.ticks("hold", self._dt)
        self._waits = schedule.hold_at is not None and len(self._hold) > 0
        self._theta = np.empty(0)  # of the row before, while it waits
        self._profile: SpeedProfile | None = None
        self._brake: tuple[tuple[Array, Array], Array | None] | None = None
        self._moves, self._inputs = False, np.empty(0)  # of the last part
        self._tick, self._state = 0, self._first(start)

    def inputs(self) -> tuple[Array, Array, Array]:
        """State, settings and table of the loop at the start."""
        settings = self._settings()
        return self._state, settings, self._curve.table()

    def parts(self) -> Iterator[tuple[Array, bool]]:
        """(log rows, held) of consecutive parts of the run, each of at most `CHUNK` rows."""
        table, last = self._curve.table(), round(self._schedule.duration / self._dt)
        while self._tick < last:
            settings, end = self._settings(), min(self._next_event(), last)
            while self._tick < end:
                ticks = min(CHUNK, end - self._tick)
                state, rows = self._loop.run(self._state, settings, table, ticks)
                passed = self._passage(rows)
                if passed is not None:
                    state, rows = self._loop.run(self._state, settings, table, passed)
                    begin = self._tick + passed
                    self._hold = range(begin, begin + len(self._hold))
                    self._waits, end = False, begin
                held = self._held()
                self._state, self._tick = state, self._tick + len(rows)
                if len(rows):
                    yield rows, held

    def _held(self) -> bool:
        return self._tick in self._hold and not self._waits

    def _next_event(self) -> int:
        """The next tick at which the inputs change."""
        schedule, dt = self._schedule, self._dt
        others = [schedule.ticks(name, dt) for name in ("push", "pull", "wall")]
        windows = [self._hold, *others]
        times = [tick for window in windows for tick in (window.start, window.stop)]
        times.append(round(schedule.reverse_at / dt))
        if self._profile is not None:
            times.append(self._profile.leg(self._tick, dt).end or 0)
        event = min((tick for tick in times if tick > self._tick), default=self._tick + CHUNK)
        pulls, step = self._tick in schedule.ticks("pull", dt), self._tick + round(STEP / dt)
        self._moves = pulls and step < event
        return step if self._moves else event

    def _passage(self, rows: Array) -> int | None:
        """The first of these rows at which the end-point has passed the place of the hold, or None.

        It may have passed between the last row before these and the first of them.
        """
        place = self._schedule.hold_at
        if not self._waits or place is None or self._tick < self._hold.start:
            return None
        before, new = self._theta, self._layouts.log.unpack(rows)["theta"][:, 0]
        theta, self._theta = np.concatenate([before, new]), new[-1:].copy()
        turns = np.floor((theta - place) / PERIOD) if self._curve.closed else np.sign(theta - place)
        passed = (np.diff(turns) != 0) & (np.abs(np.diff(self._curve.arc(theta))) < JUMP)
        return int(passed.argmax()) + 1 - len(before) if passed.any() else None

    def _settings(self) -> Array:
        """The inputs of the loop from now on; a profile also sets the present speed reference."""
        if self._moves:  # the hand alone has moved
            return pushed(self._layouts, self._inputs, self._push())
        schedule, dt, tick = self._schedule, self._dt, self._tick
        wanted = self._parameters
        if 0 < round(schedule.reverse_at / dt) <= tick:
            wanted = dataclasses.replace(wanted, speed=-wanted.speed)
        self._profile = schedule.profile or profile_of(wanted)
        if self._profile is not None:
            leg = self._profile.leg(tick, dt)
            wanted = dataclasses.replace(wanted, speed=leg.last, ramp=leg.rate)
            self._fields()["speed_ref"][:] = leg.at(tick)
        push = self._push()
        self._inputs = settings_vector(self._robot, self._layouts, wanted, self._curve, push)
        return self._inputs

    def _push(self) -> Push:
        """The external action on the end-point from now on."""
        schedule, dt, frame = self._schedule, self._dt, self._robot.frame
        hand, share, wall = None, 1.0, None
        if self._tick in schedule.ticks("push", dt):
            hand = frame.lift(np.array(schedule.hand()))
        if self._tick in schedule.ticks("pull", dt):
            hand, share = self._pulling()
        if self._tick in schedule.ticks("wall", dt):
            wall = schedule.wall().lifted(frame)
        if not self._held():
            return Push(hand=hand, share=share, wall=wall)
        if self._brake is None:
            self._brake = self._braked()
        hold, hold_normal = self._brake
        return Push(hand=hand, share=share, hold=hold, hold_normal=hold_normal, wall=wall)

    def _pulling(self) -> tuple[Array, float]:
        """Position of the hand that pulls across, shape (p,), [m], and the share of its force.

        It is far away along the normal, so that its force has the normal's direction and the
        largest size. Normal and share are those in the middle of the next `STEP`.
        """
        fields, frame, schedule = self._fields(), self._robot.frame, self._schedule
        theta = fields["theta"][0] + STEP / 2 * fields["theta_rate"][0]
        first = self._curve.plan.at(theta, 1)
        left = frame.lift(LEFT @ first / np.linalg.norm(first)) - frame.lift(np.zeros(2))
        passed = self._tick * self._dt + STEP / 2 - schedule.pull_from
        share = schedule.pull_rate * passed / self._robot.grip.hand.largest
        away = np.sign(share) * FAR_AWAY * left
        return self._robot.endpoint(fields["q"]) + away, min(abs(share), 1.0)

    def _braked(self) -> tuple[tuple[Array, Array], Array | None]:
        """A brake that is applied now, see `brake_in`."""
        fields = self._fields()
        theta, y = float(fields["theta"][0]), self._robot.endpoint(fields["q"])
        return brake_in(self._robot, self._curve, y, theta, self._schedule.hold_direction)

    def _fields(self) -> dict[str, Array]:
        return self._layouts.state.unpack(self._state)

    def _first(self, start: Array) -> Array:
        """The state at the start."""
        schedule, frame = self._schedule, self._robot.frame
        z = frame.planar(start).copy()
        places = schedule.start_z1, schedule.start_z2
        given = [z[i] if place is None else place for i, place in enumerate(places)]
        if self._curve.dimension == 3:
            given.append(start[-1] - frame.lift(z)[-1])  # its height without a given start
        y = start if places == (None, None) else frame.lift(np.array(given))
        q, along, across = self._robot.rest(y), schedule.start_along, schedule.start_across
        v = velocity_at(self._robot, self._parameters, self._curve, q, along, across)
        state = first_state(self._robot, self._layouts, self._curve, q, v)
        return lead(state, self._layouts, self._curve, schedule.clock_offset)
