"""One side, a robot under a control law, as simulated in a lab."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from onpath.app.lab.loop_states import Slot, single
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.segments import Drive, Input
from onpath.models.arrays import Array
from onpath.models.closed_loop.faults import explained
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loop_vectors import loop_layouts, state_layout
from onpath.models.closed_loop.loops import Loop
from onpath.models.closed_loop.simulation import (
    MOST_STARTS,
    Push,
    first_state,
    kind_of,
    paced,
    primed,
    pushed,
    settings_vector,
)
from onpath.models.closed_loop.speed_profile import Leg
from onpath.models.closed_loop.start import ON_PATH, Start, start_state
from onpath.models.control.laws.registry import law_named
from onpath.models.control.sides import DEFAULT_LAWS
from onpath.models.errors import Message
from onpath.models.layout import Layout
from onpath.models.paths.curves import Curve
from onpath.models.paths.distance import closest_parameters, near_distance
from onpath.models.paths.spline_curves import SplineCurve
from onpath.models.systems.efforts import exceeded
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot


@dataclass(frozen=True, slots=True)
class Diverged:
    """Why and when a robot stopped, [s]."""

    reason: Message
    time: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MeasuredRobot:
    """What is known of a robot that is not simulated.

    Attributes:
        q, v: coordinates and velocities, shape (n,).
        u: torques of its motors, shape (m,), [N m].
        theta, theta_ref: of the closest point of the path, and of the reference point, [rad].
    """

    q: Array
    v: Array
    u: Array
    theta: float
    theta_ref: float


class ClosedLoopRun:
    """State and inputs of one closed loop; only the simulation thread touches it.

    Args:
        loop_cache: provides its loops.
        tell: is given what a user should know: why a law cannot be used with the robot and the
            inputs, so that the side gets a new lab's law; and once in a run, which motor gives more
            than the robot's file states.
        measured: whether its robot is not simulated, but shown as `follow` tells.

    Attributes:
        side: name of the side.
        law: name of its control law.
        slot: its state, log row and distances; another object as soon as anything changes.
        values: the settings that the last `input` leaves out, as float64.
    """

    slot: Slot

    def __init__(
        self,
        loop_cache: LoopCache,
        robot: Robot,
        side: str,
        law: str,
        parameters: Parameters,
        curve: Curve,
        start: Start = ON_PATH,
        tell: Callable[[ValueError | Message], None] = lambda _: None,
        measured: bool = False,
    ) -> None:
        self._loop_cache, self.robot, self._made_with = loop_cache, robot, parameters
        self._tell, self._measured = tell, measured
        self.side, self.law = side, law
        self.diverged: Diverged | None = None
        self._unfilled: Curve | None = None  # the path of a log row that its loop has to complete
        self._inputs: tuple[Parameters, Curve, Push] | None = None
        self._leg: Leg | None = None
        self.configure(parameters, curve, Push())
        self._input, self.values = self._made_input(frozen=False), b""
        self.reset(curve, start)

    def reset(self, curve: Curve, start: Start) -> None:
        """Restart at a start, which must be within reach."""
        assert self._inputs is not None
        layouts = self._layouts
        state = start_state(self.robot, layouts, curve, self._inputs[0], start)
        self.slot = single(state, np.zeros(layouts.log.size), 0.0, 0.0)
        self._fill_row(curve)
        self.diverged = None
        self._beyond = False
        self._change(largest=self.distance)

    def place(self, q: Array, v: Array, curve: Curve) -> None:
        """Restart at coordinates and velocities, each shape (n,)."""
        state = first_state(self.robot, self._layouts, curve, q, v)
        self.slot = single(state, np.zeros(self._layouts.log.size), 0.0, 0.0)
        self._fill_row(curve)
        self._change(largest=self.distance)

    def follow(self, now: MeasuredRobot, curve: Curve) -> None:
        """Show what has been measured of a robot that is not simulated.

        How it stands to the path, a tick of the loop tells; until there is one, it is as before.
        """
        robot, loop = self.robot, self.loop()
        state = first_state(robot, self._layouts, curve, now.q, now.v)
        fields, row = self._layouts.state.unpack(state), self.row.copy()
        fields["u"][:], fields["theta"][:], fields["theta_ref"][:] = now.u, now.theta, now.theta_ref
        if loop is not None and self._suits(curve):
            _, rows = loop.run(state.copy(), self.settings, curve.table(), 1)
            row = np.nan_to_num(rows[0], posinf=0.0, neginf=0.0)
        shown, y = self.log.unpack(row), robot.endpoint(now.q)
        for name in ("q", "v", "u", "theta", "theta_ref"):
            shown[name][:] = fields[name]
        shown["y"][:], shown["force"][:] = y, 0.0
        distance = float(near_distance(robot.frame, curve, y[None], shown["theta"])[0])
        self._change(state, row, distance, max(self.max_distance, distance))

    @property
    def moves(self) -> bool:
        """Whether it is simulated, and has not stopped."""
        return not self._measured and self.diverged is None

    def restore(self, drive: Drive, curve: Curve) -> None:
        """Restore the state and path of a checkpoint; the law stays the present one."""
        self._go_on_from(drive.state, drive.kind)
        self._change(largest=drive.max_distance)
        if not drive.frozen:
            self.diverged = None
        self._fill_row(curve)

    def lacks(self, parameters: Parameters, curve: Curve, push: Push) -> Kind | None:
        """The kind of loop that these inputs need; None if the run has it."""
        has_loop = self._loop is not None
        if has_loop and self._inputs is not None:
            before = self._inputs
            if before[0] is parameters and before[1] is curve and before[2] is push:
                return None
        kind = kind_of(self.law, parameters, curve, push)
        return None if has_loop and kind == self.kind else kind

    def change_law(self, law: str, parameters: Parameters, curve: Curve, push: Push) -> None:
        """Change the control law; the robot moves on from where it is, with these inputs."""
        state, kind = self.state, self.kind
        self.law, self._inputs = law, None
        self.configure(parameters, curve, push)
        self._go_on_from(state, kind)
        self._change()
        self.shown()["theta_ref"][:] = self.fields()["theta_ref"]

    def change_robot(self, robot: Robot, parameters: Parameters, curve: Curve, push: Push) -> None:
        """Go on from the present state as another robot with the same states and these inputs."""
        before = self.kind
        self.robot, self._made_with, self._inputs = robot, parameters, None
        self.configure(parameters, curve, push)
        if self.law != before.law:
            self._go_on_from(self.state, before)

    def _go_on_from(self, state: Array, kind: Kind) -> None:
        """Go on from the state of a loop of some kind.

        If it was under another law, the reference point starts at the closest point, and the
        present law's integral and memory start at 0.
        """
        self._change(state if kind.law == self.law else self._under_law(state, kind))
        self._prime(kind)

    def _under_law(self, state: Array, kind: Kind) -> Array:
        """Convert a state under another law to an initial state under the present one."""
        memory, layout = law_named(kind.law).memory, self._layouts.state
        before = state_layout(self.robot.system, memory)
        values = {name: np.zeros(size) for name, size in layout.fields}
        remembered = {name for name, _ in law_named(self.law).memory}
        kept = values.keys() - remembered
        values |= {name: value for name, value in before.unpack(state).items() if name in kept}
        values |= {"theta_ref": values["theta"], "integral": np.zeros_like(values["integral"])}
        return layout.pack(values)

    def change_path(self, curve: Curve) -> None:
        """Switch to another path: keep the reference point, search the closest point globally."""
        reference = self.fields()["theta_ref"].copy()
        project([self], curve)
        self.fields()["theta_ref"][:] = reference
        self._fill_row(curve)

    def measure(self, curve: Curve) -> None:
        """Measure the distance from a path that has changed while the robot stands still."""
        shown = self.shown()
        distance = near_distance(self.robot.frame, curve, shown["y"][None], shown["theta"])
        self._change(distance=float(distance[0]))

    def restart_at(self, theta: float, curve: Curve) -> None:
        """Restart at a parameter of the path, [rad]: reference there, integral zero."""
        self._change()
        fields = self.fields()
        fields["theta"][:] = fields["theta_ref"][:] = theta
        fields["theta_rate"][:] = 0.0
        fields["integral"][:] = 0.0
        self._fill_row(curve)

    @property
    def state(self) -> Array:
        """State of the loop."""
        states, i = self.slot
        return states.states[i]

    @property
    def row(self) -> Array:
        """Last log row."""
        states, i = self.slot
        return states.rows[i]

    @property
    def distance(self) -> float:
        """Distance of the actual end-point from the path, [m]."""
        states, i = self.slot
        return float(states.distances[i])

    @property
    def max_distance(self) -> float:
        """Largest distance since reset, [m]."""
        states, i = self.slot
        return float(states.largest[i])

    def _change(
        self,
        state: Array | None = None,
        row: Array | None = None,
        distance: float | None = None,
        largest: float | None = None,
    ) -> None:
        """Replace some values and copy the others; the copies may then be modified."""
        self.slot = single(
            self.state if state is None else state,
            self.row if row is None else row,
            self.distance if distance is None else distance,
            self.max_distance if largest is None else largest,
        )

    def unshare(self) -> None:
        """Copy the state out of the arrays that hold those of all loops simulated with it."""
        self._change()

    def fields(self) -> dict[str, np.ndarray]:
        """Views of the state by name."""
        return self._layouts.state.unpack(self.state)

    def shown(self) -> dict[str, np.ndarray]:
        """The last log row by name."""
        return self.log.unpack(self.row)

    def input(self) -> Input:
        """Current input, for the history; the same object until more than `values` changes."""
        frozen = not self.moves
        if self._recorded is not self.settings or self._input.frozen != frozen:
            self._input = self._made_input(frozen).like(self._input)
            self.values = self.settings.take(self._input.varying).tobytes()
        return self._input

    def _made_input(self, frozen: bool) -> Input:
        self._recorded = self.settings  # the settings of the input
        size, rest = self._layouts.changed, self._layouts.state.size - self._layouts.changed
        return Input(
            side=self.side,
            kind=self.kind,
            base=self.settings,
            frozen=frozen,
            size=size,
            rest=rest,
            parameters=self._made_with,
        )

    def loop(self) -> Loop | None:
        """The loop that computes it; None while that is being made."""
        if self._loop is None:
            self._loop = self._loop_cache.find(self.robot, self.kind)
            if self._loop is not None and self._unfilled is not None:
                self._fill_row(self._unfilled)
        return self._loop

    def stop(self, fault: tuple[int, Message], rows: Array, curve: Curve, time: float) -> None:
        """Stop at the last good state, and show the last good row before the fault.

        Args:
            fault: tick and reason.
            rows: log rows of the ticks.
            curve: the path.
            time: of the fault, [s].
        """
        assert self._inputs is not None
        before, parameters = rows[: fault[0]], self._inputs[0]
        why = explained(fault[1], self.robot, self.log, self.law, before, parameters, curve)
        self.diverged = Diverged(why, time)
        good = np.flatnonzero(np.isfinite(rows[: fault[0]]).all(axis=1))
        if good.size:
            row = rows[good[-1]]
            y, theta = (self.log.unpack(row)[name] for name in ("y", "theta"))
            distance = float(near_distance(self.robot.frame, curve, y[None], theta)[0])
            self._change(row=row, distance=distance, largest=max(self.max_distance, distance))

    def check_torques(self, largest: Array) -> None:
        """Tell once in a run if a motor gives more than the robot's file states.

        Args:
            largest: size of the torque of each motor, shape (m,).
        """
        if not self._beyond and (found := exceeded(self.robot, largest)) is not None:
            self._beyond = True
            self._tell(found)

    def configure(
        self,
        parameters: Parameters,
        curve: Curve,
        push: Push,
        leg: Leg | None = None,
        tick: int = 0,
    ) -> None:
        """Set the inputs; packs a new settings vector if one has changed.

        The run keeps its loop as long as it needs one of this kind, whatever the cache keeps.

        Args:
            leg: a part of a speed profile; it replaces the speed and ramp of the parameters.
            tick: the lab's present tick, in this part.
        """
        before, earlier = self._inputs, self._leg
        self._inputs, self._leg = (parameters, curve, push), leg
        same = before is not None and before[0] is parameters and before[1] is curve
        same = same and (leg is not None or earlier is None)  # the user's speed counts again
        if before is None or not same or before[2] is not push:
            self._pack(self._inputs, None if before is None else self.kind, same)
        elif leg == earlier:
            return
        if leg is not None:
            self.settings = paced(self._layouts, self.settings, leg)
            if leg != earlier:
                self._change()
                self.fields()["speed_ref"][:] = leg.at(tick)

    def _pack(
        self, inputs: tuple[Parameters, Curve, Push], before: Kind | None, same: bool
    ) -> None:
        """Take the kind of loop that these inputs need, and pack its settings.

        Args:
            before: the kind until now, or None at first.
            same: whether only the push has changed.
        """
        parameters, curve, push = inputs
        if (new := kind_of(self.law, parameters, curve, push)) != before:
            self.kind: Kind = self._possible(new, inputs)
            self._loop: Loop | None = None
            self._layouts = loop_layouts(self.robot.system, self.kind)
            self.log: Layout = self._layouts.log
        if same:
            self.settings = pushed(self._layouts, self.settings, push)
        else:
            self.settings = settings_vector(self.robot, self._layouts, parameters, curve, push)
        if before is not None and before.law != self.law:
            self._go_on_from(self.state, before)
        elif before is not None:
            self._prime(before)

    def _possible(self, kind: Kind, inputs: tuple[Parameters, Curve, Push]) -> Kind:
        """The kind of loop, or that under a new lab's law if the law has an error there."""
        try:
            self._loop_cache.find(self.robot, kind)
        except ValueError as error:
            self._tell(error)
            self.law = DEFAULT_LAWS[self.side]
            return kind_of(self.law, *inputs)
        return kind

    def _prime(self, before: Kind) -> None:
        """Fill the queue of delayed torques if the loop of this kind did not keep it."""
        if self.kind.delay and not before.delay:
            self._change(primed(self._layouts, self.state))

    def _fill_row(self, curve: Curve) -> None:
        """Fill the log row of a robot that has not moved yet, and on which nothing has acted.

        What the loop has to compute follows as soon as there is one.
        """
        self._unfilled = curve
        loop = self.loop()
        if self._unfilled is None:  # the loop has just come
            return
        self._change()
        row, state = self.shown(), self.fields()
        for name in ("xi", "xi_rate"):
            row[name][:] = 0.0
        if loop is not None and self._suits(curve):
            self._unfilled = None
            _, rows = loop.run(self.state.copy(), self.settings, curve.table(), 1)
            first = self.log.unpack(rows[0])
            for name in ("xi", "xi_rate"):
                row[name][:] = np.nan_to_num(first[name], posinf=0.0, neginf=0.0)
        for name in ("q", "v", "theta", "theta_rate", "theta_ref", "speed_ref", "u"):
            row[name][:] = state[name]
        row["y"][:], distance = _place(self.robot, curve, state["q"].tobytes(), *state["theta"])
        row["force"][:] = 0.0
        row["speed"][:] = state["theta_rate"] * np.linalg.norm(curve.at(state["theta"], 1), axis=1)
        self.slot[0].distances[:] = distance

    def _suits(self, curve: Curve) -> bool:
        """Whether the loop is one for curves of this kind; after a jump it may still be another."""
        kind, spline = self.kind, isinstance(curve, SplineCurve)
        same = kind.closed, kind.space, kind.spline
        return same == (curve.closed, curve.dimension == 3, spline)


@lru_cache(maxsize=MOST_STARTS)
def _place(robot: Robot, curve: Curve, q: bytes, theta: float) -> tuple[Array, float]:
    """End-point at a configuration, shape (p,), [m], and its distance from the path near θ, [m];
    computed once for the labs of a class, which begin at the same place."""
    y = robot.endpoint(np.frombuffer(q))
    return y, float(near_distance(robot.frame, curve, y[None], np.array([theta]))[0])


def project(runs: Sequence[ClosedLoopRun], curve: Curve) -> None:
    """Restart runs of one robot at their globally closest points, after a jump of the path."""
    robot = runs[0].robot
    y = np.stack([robot.endpoint(run.fields()["q"]) for run in runs])
    for run, theta in zip(runs, closest_parameters(robot.frame, curve, y), strict=True):
        run.restart_at(float(theta), curve)
