"""What is recorded of a lab's runs: frames for the history, the current instant, samples."""

from __future__ import annotations

from collections.abc import Generator, Iterable, Mapping, Sequence
from operator import is_

from msgspec import Struct

from onpath.app.lab.advance_together import Ticks
from onpath.app.lab.closed_loop_run import ClosedLoopRun
from onpath.app.lab.plot_samples import samples_of
from onpath.app.lab.segments import HistoryFrame, Inputs, Instant
from onpath.models.arrays import Array
from onpath.models.closed_loop.simulation import Push
from onpath.models.closed_loop.speed_profile import Leg
from onpath.models.paths.curves import Curve
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot


class FramePart(Struct, frozen=True, eq=False):
    """Some ticks with the same inputs.

    Attributes:
        time, dt: at the beginning, and length of a tick, [s].
        ticks: number of ticks.
        parameters: of the robots.
        curve, table: the path, and its coefficients for the loops.
        leg: the part of the speed profile, or None if there is none.
    """

    time: float
    ticks: int
    dt: float
    parameters: Parameters
    curve: Curve
    table: Array
    leg: Leg | None


class Recorder:
    """Simulates parts of a lab's frames and records them for its history."""

    def __init__(self) -> None:
        self._inputs: Inputs | None = None

    def simulate(
        self, part: FramePart, runs: Sequence[ClosedLoopRun], pushes: Mapping[str, Push]
    ) -> Generator[Ticks, None, tuple[HistoryFrame, list[ClosedLoopRun]]]:
        """Simulate a part; see `advance_together`.

        Args:
            pushes: external forces, by bench.

        Returns:
            What the history keeps of it, and the runs that have diverged in it.
        """
        time, curve, dt = part.time, part.curve, part.dt
        for run in runs:
            push = pushes[run.bench]
            run.configure(part.parameters, curve, push, part.leg, round(time / dt))
        states, most = [run.recorded for run in runs], [run.max_distance for run in runs]
        rows, distances = [run.row for run in runs], [run.distance for run in runs]
        moving = [(run, run.loop()) for run in runs if run.diverged is None]
        yield Ticks(moving, part.ticks, time, dt, part.parameters, curve, part.table)
        inputs = {run.bench: run.input() for run in runs}
        if self._inputs is None or not self._inputs.are(curve, dt, inputs.values()):
            self._inputs = Inputs(curve, dt, inputs)
        frame = HistoryFrame(time, part.ticks, self._inputs, states, most, rows, distances)
        return frame, [run for run, _ in moving if run.diverged is not None]


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
