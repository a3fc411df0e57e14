"""One bench, a robot under a control law, as simulated in a session."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.segments import Drive, Input
from onpath.models.arrays import Array
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loop_vectors import state_layout
from onpath.models.closed_loop.loops import CompiledLoop, Loop
from onpath.models.closed_loop.simulation import (
    Push,
    kind_of,
    paced,
    primed,
    pushed,
    settings_vector,
)
from onpath.models.closed_loop.speed_profile import Leg
from onpath.models.closed_loop.start import ON_PATH, Start, start_state
from onpath.models.control.laws.registry import law_named
from onpath.models.errors import Message
from onpath.models.layout import Layout
from onpath.models.paths.curves import Curve
from onpath.models.paths.distance import closest_parameter, near_distance
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot


@dataclass(frozen=True, slots=True)
class Diverged:
    """Why and when a robot stopped, [s]."""

    reason: Message
    time: float


class ClosedLoopRun:
    """State and inputs of one closed loop; only the simulation thread touches it.

    Args:
        store: provides its loops.

    Attributes:
        bench: name of the bench.
        law: name of its control law.
    """

    def __init__(
        self,
        store: LoopCache,
        robot: Robot,
        bench: str,
        law: str,
        parameters: Parameters,
        curve: Curve,
        start: Start = ON_PATH,
    ) -> None:
        self._store, self.robot = store, robot
        self.bench, self.law = bench, law
        self.diverged: Diverged | None = None
        self.distance = self.max_distance = 0.0
        self._inputs: tuple[Parameters, Curve, Push] | None = None
        self._leg: Leg | None = None
        self.configure(parameters, curve, Push())
        self._input = self._made_input(frozen=False)
        self.reset(curve, start)

    def reset(self, curve: Curve, start: Start) -> None:
        """Begin anew at a start, which must be within reach."""
        assert self._inputs is not None
        kernel = self._kernel
        self.state = start_state(self.robot, kernel, curve, self._inputs[0], start)
        self.row = np.zeros(kernel.log.size)
        self._fill_row(curve)
        self.diverged = None
        self.max_distance = self.distance

    def restore(self, drive: Drive, curve: Curve) -> None:
        """Restore the state of a checkpoint, with the path of that time and the law of now."""
        self._go_on_from(drive.state, drive.kind)
        self.max_distance = drive.max_distance
        if not drive.frozen:
            self.diverged = None
        self._fill_row(curve)

    def lacks(self, parameters: Parameters, curve: Curve, push: Push) -> Kind | None:
        """The kind of loop that these inputs need, if it is another one or not compiled."""
        kind = kind_of(self.law, parameters, curve, push)
        return None if kind == self.kind and isinstance(self._loop, CompiledLoop) else kind

    def change_law(self, law: str, parameters: Parameters, curve: Curve, push: Push) -> None:
        """Change the control law; the robot moves on from where it is, with these inputs."""
        state, kind = self.state, self.kind
        self.law, self._inputs = law, None
        self.configure(parameters, curve, push)
        self._go_on_from(state, kind)
        self.row = self.row.copy()  # the session detects a new row by identity
        self.shown()["theta_ref"][:] = self.fields()["theta_ref"]

    def change_robot(self, robot: Robot, parameters: Parameters, curve: Curve, push: Push) -> None:
        """Go on as another robot with the same states, from the present one, with these inputs."""
        self.robot, self._inputs = robot, None
        self.configure(parameters, curve, push)

    def _go_on_from(self, state: Array, kind: Kind) -> None:
        """Go on from the state of a loop of some kind.

        If that was under another law, the reference point starts at the closest point, and the
        integral and the memory of the present law at 0.
        """
        self.state = state.copy() if kind.controller == self.law else self._under_law(state, kind)
        self._prime(kind)

    def _under_law(self, state: Array, kind: Kind) -> Array:
        """The state of a loop under another law, as the loop of the present one begins with it."""
        memory, layout = law_named(kind.controller).memory, self._kernel.state
        before = state_layout(self.robot.system, memory)
        values = {name: np.zeros(size) for name, size in layout.fields}
        own = {name for name, _ in law_named(self.law).memory}
        values |= {n: v for n, v in before.unpack(state).items() if n in values and n not in own}
        values |= {"theta_ref": values["theta"], "integral": np.zeros_like(values["integral"])}
        return layout.pack(values)

    def change_path(self, curve: Curve) -> None:
        """Switch to another path: keep the reference point, search the closest point globally."""
        reference = self.fields()["theta_ref"].copy()
        self.project(curve)
        self.fields()["theta_ref"][:] = reference
        self._fill_row(curve)

    def project(self, curve: Curve) -> None:
        """Restart at the globally closest point, after a jump: reference there, integral zero."""
        self.state = self.state.copy()  # the history may share it
        fields = self.fields()
        y = self.robot.endpoint(fields["q"])
        fields["theta"][:] = closest_parameter(self.robot.frame, curve, y)
        fields["theta_rate"][:] = 0.0
        fields["theta_ref"][:] = fields["theta"]
        fields["integral"][:] = 0.0
        self._fill_row(curve)

    def fields(self) -> dict[str, np.ndarray]:
        """Views of the state by name."""
        return self._kernel.state.unpack(self.state)

    def shown(self) -> dict[str, np.ndarray]:
        """The last log row by name."""
        return self.log.unpack(self.row)

    def input(self) -> Input:
        """Current input, for the history; the same object until something changes."""
        frozen = self.diverged is not None
        if self._input.settings is not self.settings or self._input.frozen != frozen:
            self._input = self._made_input(frozen)
        return self._input

    def _made_input(self, frozen: bool) -> Input:
        assert self._inputs is not None
        size, rest = self._kernel.changed, self._kernel.state.size - self._kernel.changed
        return Input(self.kind, self.settings, frozen, size, rest, self._inputs[0])

    @property
    def recorded(self) -> Array:
        """The part of the state that the loop changes."""
        return self.state[: self._kernel.changed]

    def loop(self) -> Loop:
        """The fastest loop of its kind available now."""
        if not isinstance(self._loop, CompiledLoop):
            self._loop = self._store.get(self.robot, self.kind, self._loop)
        return self._loop

    def take(self, state: Array, row: Array, distance: float, largest: float) -> None:
        """Take over the results of some ticks.

        Args:
            state, row: at the end; copied, because they may be parts of large arrays.
            distance, largest: at the end, and the largest during these ticks, [m].
        """
        self.state, self.row, self.distance = state.copy(), row.copy(), distance
        self.max_distance = max(self.max_distance, largest)

    def stop(self, fault: tuple[int, Message], rows: Array, time: float) -> None:
        """Stop at the last good state, and show the last good row before the fault.

        Args:
            fault: tick and reason.
            rows: log rows of the ticks.
            time: of the fault, [s].
        """
        self.diverged = Diverged(fault[1], time)
        good = np.flatnonzero(np.isfinite(rows[: fault[0]]).all(axis=1))
        if good.size:
            self.row = rows[good[-1]].copy()

    def configure(
        self,
        parameters: Parameters,
        curve: Curve,
        push: Push,
        leg: Leg | None = None,
        tick: int = 0,
    ) -> None:
        """Set the inputs; packs a new settings vector if one has changed.

        The run keeps its loop as long as it needs one of this kind, whatever the store keeps.

        Args:
            leg: a part of a speed profile, which replaces speed and ramp of the parameters.
            tick: of the lab, in this part.
        """
        before, self._inputs = self._inputs, (parameters, curve, push)
        ended, self._leg = self._leg, leg
        same = before is not None and before[0] is parameters and before[1] is curve
        same = same and (ended is None or leg is not None)
        if before is None or not same or before[2] is not push:
            self._pack(self._inputs, None if before is None else self.kind, same)
        elif leg == ended:
            return
        if leg is not None:
            self.settings = paced(self._kernel, self.settings, leg)
        if leg is not None and leg != ended:
            self.state = self.state.copy()  # the history may share it
            self.fields()["speed_ref"][:] = leg.at(tick)

    def _pack(
        self, inputs: tuple[Parameters, Curve, Push], before: Kind | None, same: bool
    ) -> None:
        """Take the kind of loop that these inputs need, and pack its settings.

        Args:
            before: kind until now, or None at first.
            same: whether only the push has changed.
        """
        parameters, curve, push = inputs
        if (new := kind_of(self.law, parameters, curve, push)) != before:
            self.kind: Kind = new
            self._loop: Loop | None = None
            self._kernel = self._store.kernel(self.robot, new)
            self.log: Layout = self._kernel.log
        if same:
            self.settings = pushed(self._kernel, self.settings, push)
        else:
            self.settings = settings_vector(self.robot, self._kernel, parameters, curve, push)
        if before is not None:
            self._prime(before)

    def _prime(self, before: Kind) -> None:
        """Fill the queue of delayed torques if the loop of this kind did not keep it."""
        if self.kind.delay and not before.delay:
            self.state = primed(self._kernel, self.state)

    def _fill_row(self, curve: Curve) -> None:
        """Fill the log row of a robot that has not moved yet."""
        self.row = self.row.copy()  # the session detects a new row by identity
        row, state = self.shown(), self.fields()
        for name in ("q", "v", "theta", "theta_rate", "theta_ref", "speed_ref", "u"):
            row[name][:] = state[name]
        row["y"][:] = self.robot.endpoint(state["q"])
        row["force"][:] = 0.0
        row["speed"][:] = state["theta_rate"] * np.linalg.norm(curve.at(state["theta"], 1), axis=1)
        self.distance = float(
            near_distance(self.robot.frame, curve, row["y"][None], row["theta"])[0]
        )
