"""Everything measured while a script is played, frame by frame."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from onpath.app.lab.lesson_record import Beginning, record_of
from onpath.app.lab.simulation import Simulation
from onpath.lessons.action_schema import RobotName
from onpath.lessons.record import ROBOTS, Record
from onpath.models.arrays import Array


class Samples:
    """All quantities of both robots at every frame of a script, as the checks of a task read them.

    Times continue across resets.
    """

    def __init__(self, simulation: Simulation) -> None:
        self._run, self._before, self._until = simulation.run_number, 0.0, simulation.time
        self._before_run = {self._run: 0.0}
        self._times = list[Array]()
        self._values = list[dict[RobotName, dict[str, Array]]]()

    def follow(self, simulation: Simulation) -> None:
        """Add what has happened since the last call."""
        if simulation.run_number != self._run:
            self._before += self._until
            self._run, self._until = simulation.run_number, 0.0
            self._before_run[self._run] = self._before
        record = record_of(simulation, Beginning(self._run, self._until))
        new = slice(int(np.searchsorted(record.times, self._until - 1e-9)), None)
        if len(record.times[new]):
            self._times.append(record.times[new] + self._before)
            self._values.append(
                {
                    robot: {name: column[new] for name, column in columns.items()}
                    for robot, columns in record.values.items()
                }
            )
        self._until = simulation.time

    def columns(self) -> tuple[Array, dict[RobotName, dict[str, Array]]]:
        """Times, shape (n,), and values by robot and quantity, NaN where there was none."""
        times = np.concatenate([*self._times, np.zeros(0)])
        values: dict[RobotName, dict[str, Array]] = {robot: {} for robot in ROBOTS}
        for robot in ROBOTS:
            names = dict.fromkeys(name for piece in self._values for name in piece[robot])
            for name in names:
                columns = [
                    piece[robot].get(name, np.full(len(instants), np.nan))
                    for instants, piece in zip(self._times, self._values, strict=True)
                ]
                values[robot][name] = np.concatenate(columns)
        return times, values

    def record(self, simulation: Simulation) -> Record:
        """All samples, as the record of one run."""
        last = record_of(simulation, Beginning(self._run, self._until))
        times, values = self.columns()
        happenings = tuple(
            replace(each, run=0, time=each.time + self._before_run[each.run])
            for each in last.happenings
            if each.run in self._before_run
        )
        end = self._before + self._until
        return replace(
            last, times=times, values=values, happenings=happenings, run=0, end=end, _masks={}
        )
