"""What is recorded of a lab's runs: frames for the history, the current instant, samples."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from operator import is_

import numpy as np

from onpath.app.lab.advance_together import Ticks
from onpath.app.lab.closed_loop_run import ClosedLoopRun
from onpath.app.lab.loop_states import Slot
from onpath.app.lab.plot_samples import samples_of
from onpath.app.lab.segments import HistoryFrame, Inputs, Instant
from onpath.models.arrays import Array
from onpath.models.paths.curves import Curve
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot


class Recorder:
    """Records parts of a lab's frames for its history; a part has the same inputs throughout."""

    def __init__(self) -> None:
        self._inputs: Inputs | None = None

    def record(
        self, ticks: Ticks, runs: Sequence[ClosedLoopRun], begun: list[Slot]
    ) -> HistoryFrame:
        """The history's record of ticks that have been simulated.

        Args:
            begun: `ClosedLoopRun.slot` of the runs at their beginning.
        """
        inputs = tuple(run.input() for run in runs)
        if self._inputs is None or not self._inputs.are(ticks.curve, ticks.dt, inputs):
            self._inputs = Inputs(ticks.curve, ticks.dt, inputs)
        values = b"".join([run.values for run in runs])
        return HistoryFrame(
            time=ticks.time, ticks=ticks.count, inputs=self._inputs, slots=begun, values=values
        )


class CurrentInstant:
    """The instant of some runs, made again only when something has changed."""

    def __init__(self) -> None:
        self._now: Instant | None = None
        self._made_of: list[object] = []

    def of(
        self,
        time: float,
        robot: Robot,
        parameters: Parameters,
        curve: Curve,
        runs: Sequence[ClosedLoopRun],
    ) -> Instant:
        """The instant; the same object until something changes."""
        now, made_of = self._now, [curve, parameters, *[run.slot for run in runs]]
        if now is None or now.time != time or not all(map(is_, made_of, self._made_of)):
            laws = tuple(run.law for run in runs)
            now = self._now = Instant(
                time=time,
                laws=laws,
                states=[run.state for run in runs],
                max_distances=[run.max_distance for run in runs],
                sample=sample_of(robot, parameters, runs),
            )
            self._made_of = made_of
        return now


def sample_of(robot: Robot, parameters: Parameters, runs: Iterable[ClosedLoopRun]) -> Array:
    """The current sample of some runs, shape (runs, `sample_layout(robot).size`)."""
    rows, distances = zip(*[(run.row, run.distance) for run in runs], strict=True)
    return samples_of(robot, parameters, np.stack(rows), distances)
