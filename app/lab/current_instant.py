"""What is plotted and drawn of the runs now: their current instant, and samples of past frames."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from operator import is_

from onpath.app.lab.closed_loop_run import ClosedLoopRun
from onpath.app.lab.plot_samples import samples_of
from onpath.app.lab.segments import HistoryFrame, Instant
from onpath.models.arrays import Array
from onpath.models.paths.curves import Curve
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot


class CurrentInstant:
    """The instant of some runs, made anew only when something has changed."""

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
        now, made_of = self._now, [curve, parameters, *[run.row for run in runs]]
        if now is None or now.time != time or not all(map(is_, made_of, self._made_of)):
            laws = tuple(run.law for run in runs)
            states, most = [run.state for run in runs], [run.max_distance for run in runs]
            sample = sample_of(robot, parameters, runs)
            now = self._now = Instant(time, laws, states, most, sample)
            self._made_of = made_of
        return now


def sample_of(robot: Robot, parameters: Parameters, runs: Iterable[ClosedLoopRun]) -> Array:
    """The current sample of some runs, shape (runs, `sample_layout(robot).size`)."""
    rows, distances = zip(*[(run.row, run.distance) for run in runs], strict=True)
    return samples_of(robot, parameters, rows, distances)


def samples_of_frames(
    robot: Robot, parameters: Parameters, frames: Sequence[HistoryFrame]
) -> Array:
    """Plotted values of some frames, shape (frames, robots, `sample_layout(robot).size`)."""
    rows = [row for frame in frames for row in frame.rows]
    distances = [distance for frame in frames for distance in frame.distances]
    samples = samples_of(robot, parameters, rows, distances)
    return samples.reshape(len(frames), len(frames[0].rows), -1)
