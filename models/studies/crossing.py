"""A path that crosses itself, followed in three ways, with noise on the joint angles.

1. Path following that starts each search for the closest point (7) at the last one, as in the lab.
2. Trajectory tracking, whose clock says which strand comes next.
3. Path following that searches the whole path in each tick. Near the crossing, what it measures is
   now and then nearer to the other strand, to which the closest point then jumps.

A robot that passes the crossing is carried on by its motion, so that such a jump is only a kick. In
this study the robots begin at rest at the crossing: the third one may leave it on the other strand.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

import casadi as ca
import numpy as np
from typing_extensions import override

from onpath.models.arrays import Array
from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.loops import InterpretedLoop
from onpath.models.closed_loop.sensing import measure
from onpath.models.closed_loop.simulation import kind_of
from onpath.models.closed_loop.trajectory import Trajectory
from onpath.models.paths.curves import PERIOD, Curve
from onpath.models.paths.distance import closest_parameters
from onpath.models.paths.path_design import presets
from onpath.models.studies.experiments import Experiment, on_path, run
from onpath.models.systems.catalogue import FIVE_BAR
from onpath.models.systems.robots import Robot

FOLLOWING, TRACKING = "path_following", "trajectory_tracking"
NOISE = 1e-3  # [rad], of the joint angles; about 0.3 mm at the end-point
JUMP = 0.02  # [m] along the path in one tick, which no motion reaches
WAYS: Mapping[str, str] = {
    "continued": "path following; each search begins at the last closest point",
    "clock": "trajectory tracking; a clock says which strand comes next",
    "global": "path following; each search is of the whole path",
}
"""The three runs, with a description of each."""


class GlobalSearch(InterpretedLoop):
    """A closed loop whose closest point is found on the whole path, from what is measured.

    Args:
        kernel: of the loop.
        robot: under control.
        curve: a closed plane path.
        experiment: with the sensors.
    """

    def __init__(self, kernel: Kernel, robot: Robot, curve: Curve, experiment: Experiment) -> None:
        super().__init__(kernel)
        self._kernel, self._robot, self._curve = kernel, robot, curve
        kind = kind_of(FOLLOWING, experiment.parameters, curve)
        (flat, state), (numbers, settings) = (
            layout.symbols(name)
            for name, layout in (("state", kernel.state), ("settings", kernel.settings))
        )
        q = measure(robot.system, kind, state, settings)[0]
        self._measured = ca.Function("measured", [flat, numbers], [q])

    @override
    def run(self, state: Array, settings: Array, table: Array, ticks: int) -> tuple[Array, Array]:
        rows = np.empty((ticks, self._kernel.log.size))
        for tick in range(ticks):
            state = state.copy()
            theta = self._kernel.state.unpack(state)["theta"]
            q = np.asarray(self._measured(state, settings), dtype=float)[:, 0]
            y = self._robot.endpoint(q)
            found = closest_parameters(self._robot.frame, self._curve, y[None])[0]
            theta += (found - theta + PERIOD / 2) % PERIOD - PERIOD / 2
            state, rows[tick : tick + 1] = super().run(state, settings, table, 1)
        return state, rows


def _path() -> Curve:
    return presets()["figure of eight"].curve


def planned(seed: int = 1) -> Experiment:
    """The figure of eight, at 2 rad/s from rest at the crossing, until shortly before it again.

    Args:
        seed: of the noise.
    """
    parameters = FIVE_BAR.parameters(speed=2.0, K3=0.0, sensor_noise=NOISE, seed=seed)
    values = {"duration": 1.5, "start_z1": 0.0, "start_z2": 0.0}
    return on_path(FIVE_BAR, parameters, _path()).with_values(values)


def crossing_runs(experiment: Experiment) -> dict[str, Trajectory]:
    """The three runs, by the keys of `WAYS`."""
    search = partial(
        GlobalSearch, robot=experiment.robot(), curve=experiment.curve(), experiment=experiment
    )
    return {
        "continued": run(experiment, FOLLOWING),
        "clock": run(experiment, TRACKING),
        "global": run(experiment, FOLLOWING, search),
    }


def jumps(trajectory: Trajectory) -> Array:
    """Times at which the closest point has jumped to another strand, (k,), [s]."""
    steps = np.abs(np.diff(_path().arc(trajectory.fields["theta"][:, 0])))
    return trajectory.t[1:][steps > JUMP]
