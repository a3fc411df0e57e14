"""One robot under one controller, as it runs in a session."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

import numpy as np

from onpath.app.lab.loop_cache import LoopCache
from onpath.app.lab.segments import Drive, Input
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.simulation import (
    Push,
    first_state,
    kernel_of,
    kind_of,
    pushed,
    settings_vector,
)
from onpath.models.errors import Message
from onpath.models.layout import Layout
from onpath.models.paths.curves import Curve
from onpath.models.paths.distance import near_distance
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import NOT_FINITE, Robot

DISTANCE_INTERVAL = 4  # rows between looks at the distance, where the loop does not log it


@dataclass(frozen=True, slots=True)
class Diverged:
    """Why a robot stands still, and since when, [s]."""

    reason: Message
    time: float


class ClosedLoopRun:
    """State and inputs of one closed loop; only the simulation thread touches it."""

    def __init__(
        self, robot: Robot, controller: str, parameters: Parameters, curve: Curve, start: np.ndarray
    ) -> None:
        self.robot = robot
        self.controller = controller
        self.diverged: Diverged | None = None
        self.distance = self.max_distance = 0.0
        self._inputs: tuple[object, object, object] = (None, None, None)
        self._configure(parameters, curve, Push())
        self._input = Input(self.kind, self.settings, frozen=False)
        self.reset(curve, start)

    def reset(self, curve: Curve, start: np.ndarray) -> None:
        """At rest with the end-point at `start`, (p,), closest and reference point on `curve`."""
        kernel = kernel_of(self.robot, self.kind)
        self.state = first_state(self.robot, kernel, curve, self.robot.rest(start))
        self.row = np.zeros(kernel.log.size)
        self._fill_row(curve)
        self.diverged = None
        self.max_distance = self.distance

    def restore(self, drive: Drive, curve: Curve) -> None:
        """The state of a checkpoint, with the path of then."""
        self.state = drive.state.copy()
        self.max_distance = drive.max_distance
        if not drive.frozen:
            self.diverged = None
        self._fill_row(curve)

    def change_path(self, curve: Curve) -> None:
        """Another path than the state was made with: only the reference point stays."""
        reference = self.fields()["theta_ref"].copy()
        self.project(curve)
        self.fields()["theta_ref"][:] = reference
        self._fill_row(curve)

    def project(self, curve: Curve) -> None:
        """Search the closest point globally, put the reference there: after a jump of the path."""
        self.state = self.state.copy()  # history may hold it
        fields = self.fields()
        z = self.robot.frame.planar(self.robot.endpoint(fields["q"]))
        fields["theta"][:] = curve.nearest(z[None])[0]
        fields["theta_rate"][:] = 0.0
        fields["theta_ref"][:] = fields["theta"]
        fields["integral"][:] = 0.0
        self._fill_row(curve)

    def fields(self) -> dict[str, np.ndarray]:
        """The state by name, as views."""
        return kernel_of(self.robot, self.kind).state.unpack(self.state)

    def shown(self) -> dict[str, np.ndarray]:
        """The last log row by name."""
        return self.log.unpack(self.row)

    def input(self) -> Input:
        """What drives it, for the history; the same object while nothing changes."""
        frozen = self.diverged is not None
        if self._input.settings is not self.settings or self._input.frozen != frozen:
            self._input = Input(self.kind, self.settings, frozen)
        return self._input

    def advance(
        self,
        store: LoopCache,
        parameters: Parameters,
        curve: Curve,
        table: np.ndarray,
        push: Push,
        ticks: int,
        time: float,
        dt: float,
    ) -> None:
        """Simulate some ticks; on a fault stay at the last good state and say why."""
        self._configure(parameters, curve, push)
        if self.diverged is not None:
            return
        state, rows = store.get(self.robot, self.kind).run(self.state, self.settings, table, ticks)
        slices = self.log.slices
        fault = self.robot.fault(rows[:, slices["q"]], rows[:, slices["v"]], parameters)
        if fault is None and not isfinite(sum(state.tolist())):
            fault = (len(rows), NOT_FINITE)
        if fault is not None:
            self.diverged = Diverged(fault[1], time + fault[0] * dt)
            good = np.flatnonzero(np.isfinite(rows[: fault[0]]).all(axis=1))
            if good.size:
                self.row = rows[good[-1]].copy()
            return
        self.state, self.row = state, rows[-1].copy()
        distances = self._distances(curve, rows)
        self.distance = distances[-1]
        self.max_distance = max(self.max_distance, *distances)

    def _distances(self, curve: Curve, rows: np.ndarray) -> list[float]:
        """Of the actual end-point to the path, of the last row at least, [m]."""
        system, slices = self.robot.system, self.log.slices
        seen = system.controlled_output is system.output and not self.kind.encoder
        if seen and not self.kind.level_set and system.p == 2:
            return [abs(xi) for xi in rows[:, slices["xi"].start].tolist()]
        some = rows[(len(rows) - 1) % DISTANCE_INTERVAL :: DISTANCE_INTERVAL]
        return near_distance(
            self.robot.frame, curve, some[:, slices["y"]], some[:, slices["theta"].start]
        ).tolist()

    def _configure(self, parameters: Parameters, curve: Curve, push: Push) -> None:
        """New settings vector only when an input changed."""
        before, self._inputs = self._inputs, (parameters, curve, push)
        same = before[0] is parameters and before[1] is curve
        if same and before[2] is push:
            return
        self.kind: Kind = kind_of(self.controller, parameters, curve, push)
        kernel = kernel_of(self.robot, self.kind)
        self.log: Layout = kernel.log
        if same:
            self.settings = pushed(kernel, self.settings, push)
        else:
            self.settings = settings_vector(self.robot, kernel, parameters, curve, push)

    def _fill_row(self, curve: Curve) -> None:
        """The log row of a robot that has not moved yet."""
        self.row = self.row.copy()  # the session looks whether it is another
        row, state = self.shown(), self.fields()
        for name in ("q", "v", "theta", "theta_rate", "theta_ref", "u"):
            row[name][:] = state[name]
        row["y"][:] = self.robot.endpoint(state["q"])
        row["force"][:] = 0.0
        row["speed"][:] = state["theta_rate"] * np.linalg.norm(curve.at(state["theta"], 1), axis=1)
        self.distance = float(
            near_distance(self.robot.frame, curve, row["y"][None], row["theta"])[0]
        )
