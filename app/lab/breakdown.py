"""Help when a robot has stopped: a slow replay of its last moments, and the last good settings."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onpath.app.lab.plot_samples import samples_of
from onpath.app.lab.segments import Instant, Segment
from onpath.app.lab.simulation import Simulation
from onpath.models.control.settable import values_of
from onpath.models.errors import CodedError
from onpath.models.paths.curves import Curve
from onpath.models.systems.parameters import Parameters

SPAN, LASTS = 0.3, 6.0
"""Maximum simulated time that is replayed, and duration of the replay, [s]."""
RESTS = 1.5
"""How long the end of the replay is shown, [s]."""
LARGER = 5.0
"""Minimum magnification of the deflection of a flexible robot during a replay."""
WELL = 1.0
"""Simulated time without a stop after which settings count as good, [s]."""


@dataclass
class _Replay:
    """A replay from `begin` to `end`, [s].

    Attributes:
        larger: the magnification of the drawn bending to restore afterwards.
        elapsed: how long the replay has been shown, [s].
    """

    begin: float
    end: float
    larger: float
    elapsed: float = 0.0

    @property
    def time(self) -> float:
        share = min(self.elapsed / LASTS, 1.0)
        return self.begin + share * (self.end - self.begin)


class Breakdown:
    """Follows a simulation, and helps when one of its robots has stopped."""

    def __init__(self) -> None:
        self._replay: _Replay | None = None
        self._under: tuple[int, Parameters] | None = None
        self._since = 0.0
        self._well: tuple[str, Parameters] | None = None

    @property
    def replaying(self) -> bool:
        """Whether the last moments are being shown."""
        return self._replay is not None

    def follow(self, simulation: Simulation, seconds: float) -> bool:
        """Called once per frame, of this duration; returns whether a replay has just ended."""
        if self._replay is not None:
            return self._go_on(simulation, self._replay, seconds)
        now, before = simulation.parameters, self._under
        same = before is not None and before[0] == simulation.run_number and before[1] is now
        if not same or _stopped(simulation):
            self._under, self._since = (simulation.run_number, now), simulation.time
        elif simulation.time > self._since + WELL:
            self._well = simulation.entry.name, now
        return False

    def remedy(self, simulation: Simulation) -> dict[str, float | int | str]:
        """Parameters changed since the last good settings, with their earlier values, if any."""
        if self._well is None or self._well[0] != simulation.entry.name or not _stopped(simulation):
            return {}
        well, now = self._well[1], simulation.parameters
        before, present = values_of(well), values_of(now)
        return {name: value for name, value in before.items() if value != present[name]}

    def use_earlier_settings(self, simulation: Simulation) -> None:
        """Reset with the last good settings.

        Raises:
            CodedError: there are none, or nothing has changed since.
        """
        if not self.remedy(simulation):
            raise CodedError("error.no_earlier_settings")
        assert self._well is not None
        simulation.set_parameters(self._well[1])
        simulation.reset()
        simulation.running = True

    def begin(self, simulation: Simulation) -> bool:
        """Begin to show the last moments before a robot stopped.

        Returns:
            Whether there is something to show: a robot has stopped, and its history is kept.
        """
        stopped = _stopped(simulation)
        if not stopped or not len(simulation.history):
            return False
        self.interrupt(simulation)
        end = max(stopped)
        begin = max(end - SPAN, simulation.time - simulation.history.span())
        self._replay = _Replay(begin, end, simulation.settings.larger)
        simulation.look_at(begin)
        if simulation.entry.flexible_link is not None:
            simulation.set(larger=max(simulation.settings.larger, LARGER))
        return True

    def interrupt(self, simulation: Simulation) -> bool:
        """End a replay, and let time go on as before; returns whether there was one."""
        if self._replay is None:
            return False
        simulation.return_to_present()
        self._end(simulation, self._replay)
        return True

    def _go_on(self, simulation: Simulation, replay: _Replay, seconds: float) -> bool:
        left = (
            simulation.viewing != replay.time or simulation.running
        )  # the user looks at another time
        replay.elapsed += seconds
        simulation.viewing = simulation.viewing if left else replay.time
        if left:
            self._end(simulation, replay)
        elif replay.elapsed > LASTS + RESTS:
            self.interrupt(simulation)
        return self._replay is None

    def _end(self, simulation: Simulation, replay: _Replay) -> None:
        self._replay = None
        simulation.set(larger=replay.larger)

    def instant(self, simulation: Simulation) -> tuple[Instant, Curve] | None:
        """The instant shown in a replay, exact to the tick, and its path; None without a replay."""
        if self._replay is None or (segment := simulation.history.at(self._replay.time)) is None:
            return None
        ticks = round((self._replay.time - segment.time) / segment.dt)
        return _after(simulation, segment, min(ticks, segment.ticks)), segment.curve


def _stopped(simulation: Simulation) -> list[float]:
    return [run.diverged.time for run in simulation.runs.values() if run.diverged is not None]


def _after(simulation: Simulation, segment: Segment, ticks: int) -> Instant:
    """The instant some ticks after the beginning of a segment, as far as it is finite."""
    first = segment.instant()
    states, samples = list(first.states), first.sample.copy()
    for i, (side, drive) in enumerate(segment.drives.items()):
        run = simulation.runs[side]
        loop = run.loop()
        if ticks <= 0 or drive.frozen or run.kind != drive.kind or loop is None:
            continue
        with np.errstate(all="ignore"):
            table = segment.curve.table()
            state, rows = loop.run(drive.state, drive.settings, table, ticks)
        if np.isfinite(state).all() and np.isfinite(rows[-1]).all():
            distance = samples[i, simulation.sample_layout.slices["distance"].start]
            states[i] = state
            samples[i] = samples_of(simulation.robot, simulation.parameters, rows[-1:], [distance])[
                0
            ]
    return Instant(
        time=first.time + ticks * segment.dt,
        laws=first.laws,
        states=states,
        max_distances=first.max_distances,
        sample=samples,
    )
