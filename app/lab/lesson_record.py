"""Converts a simulation to the record that the lessons' checks evaluate."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from onpath.app.lab.events import LabEvent
from onpath.app.lab.simulation import Simulation
from onpath.lessons.action_schema import RobotName
from onpath.lessons.given import MOST_POINTS
from onpath.lessons.measures.thinning import peaks
from onpath.lessons.progress import Truth
from onpath.lessons.record import ROBOTS, Happening, Record
from onpath.lessons.sides import ROLES
from onpath.lessons.task_schema import Better, Once
from onpath.models.arrays import Array
from onpath.models.control.settable import values_of
from onpath.models.control.sides import LEFT
from onpath.models.layout import Layout
from onpath.models.paths.curves import Curve
from onpath.models.systems.law_parameters import LEVEL_SET

MOST_SAMPLES = 3600


@dataclass(frozen=True, slots=True)
class Beginning:
    """The beginning of a step.

    Attributes:
        run, time: the run, and its simulated time, [s].
        given: the lab's settings, see `settings_of`; empty if they are not compared.
    """

    run: int
    time: float
    given: Mapping[str, object] = field(default_factory=dict[str, object])

    @staticmethod
    def now(simulation: Simulation) -> Beginning:
        """The current instant; earlier events are ignored."""
        simulation.events.clear()
        return Beginning(simulation.run_number, simulation.time, settings_of(simulation))


def settings_of(simulation: Simulation) -> dict[str, object]:
    """Everything that a task may ask to be left as it is, by the names of `Only`."""
    return {
        **values_of(simulation.parameters),
        **simulation.chosen_laws,
        "path": simulation.editor.design.name,
        "robot": simulation.entry.name,
        "start": simulation.start,
        "wall": simulation.wall,
    }


def record_of(
    simulation: Simulation, since: Beginning, before: Mapping[Better | Once, float] | None = None
) -> Record:
    """Record since the beginning of a step or, if later, since the last reset.

    Args:
        before: see `Record.before`.
    """
    begin = since.time if since.run == simulation.run_number else 0.0
    times, samples = simulation.history.samples(begin, simulation.time, MOST_SAMPLES)
    return Record(
        times=times,
        values=_values(simulation, samples.astype(float)) if len(times) else _nothing(simulation),
        happenings=tuple(map(_happening, simulation.events)),
        run=simulation.run_number,
        parameters=simulation.parameters,
        end=simulation.time,
        path=simulation.editor.design.name,
        robot=simulation.entry.name,
        laws=simulation.laws,
        changed=lambda: _changed(simulation, since.given),
        length=lambda: 1e3 * _length(simulation.editor.design.curve),
        before={} if before is None else before,
    )


@lru_cache(maxsize=256)  # a task asks for it several times a second, in each lab of a class
def _length(curve: Curve) -> float:
    return curve.length()


class Trace:
    """A quantity of both robots since the beginning of a step, at every frame.

    The lab's history is thinned out after some seconds and loses its peaks.

    Args:
        quantity: one of lessons.record.QUANTITIES.
        begin: beginning of the step.
    """

    def __init__(self, quantity: str, begin: Beginning) -> None:
        self._quantity, self._until = quantity, begin
        self._rows = np.zeros((0, 1 + len(ROBOTS)))

    def follow(self, simulation: Simulation) -> None:
        """Add what has happened since the last call; a reset restarts the trace."""
        until = self._until
        if until.run != simulation.run_number:
            until, self._rows = Beginning(simulation.run_number, 0.0), self._rows[:0]
        begin = min(until.time, simulation.time)  # the last frame may have been incomplete
        record = record_of(simulation, Beginning(until.run, begin))
        nothing = np.zeros(len(record.times))
        curves = [record.values[robot].get(self._quantity, nothing) for robot in ROBOTS]
        new = np.nan_to_num(np.column_stack([record.times, *curves]), posinf=0.0, neginf=0.0)
        self._rows = np.concatenate([self._rows[self._rows[:, 0] < begin], new])
        self._until = Beginning(until.run, float(self._rows[-1, 0]) if len(self._rows) else begin)

    def truth(self) -> Truth:
        """The recorded curves so far."""
        times, *curves = self._rows.T
        kept = peaks(curves, MOST_POINTS)
        points = {
            robot: tuple(np.round(curve[kept], 4).tolist())
            for robot, curve in zip(ROBOTS, curves, strict=True)
        }
        return Truth(
            quantity=self._quantity,
            times=tuple(np.round(times[kept], 4).tolist()),
            tracker=points["tracker"],
            follower=points["follower"],
        )


def _changed(simulation: Simulation, given: Mapping[str, object]) -> tuple[str, ...]:
    """Names of the settings that differ from the given ones; another robot may have others."""
    now = settings_of(simulation)
    return tuple(name for name, value in given.items() if name in now and now[name] != value)


def _happening(event: LabEvent) -> Happening:
    """Convert an event to the form used by the checks."""
    robots = tuple[RobotName, ...](ROLES[name] for name in event.sides)
    return Happening(
        run=event.run, time=event.time, name=event.name, detail=event.detail, robots=robots
    )


def _nothing(simulation: Simulation) -> dict[RobotName, dict[str, Array]]:
    return {ROLES[name]: {} for name in simulation.runs}


def _values(simulation: Simulation, samples: Array) -> dict[RobotName, dict[str, Array]]:
    """Quantities of samples, shape (n, robots, fields); see lessons.record.QUANTITIES."""
    layout, names = simulation.sample_layout, list(simulation.runs)
    timetable = names.index(LEFT)
    running = layout.unpack(samples[:, timetable])["theta_ref"][:, 0]
    point = simulation.robot.frame.lift(simulation.editor.curve.at(running))
    values: dict[RobotName, dict[str, Array]]
    values = {ROLES[name]: _of(layout, samples[:, i], point) for i, name in enumerate(names)}
    if (
        simulation.parameters.across == LEVEL_SET or simulation.across_since > 0
    ):  # not in mm throughout
        for quantities in values.values():
            del quantities["across"], quantities["across_rate"]
    return values


def _of(layout: Layout, samples: Array, point: Array) -> dict[str, Array]:
    fields = layout.unpack(samples)
    values = {
        "distance": fields["distance"][:, 0] * 1e3,
        "lag": np.linalg.norm(fields["y"] - point, axis=1) * 1e3,
        "speed": fields["speed"][:, 0] * 1e3,
        "rate": fields["theta_rate"][:, 0],
        "place": fields["theta"][:, 0],
        "across": fields["xi"][:, 0] * 1e3,
        "across_rate": fields["xi_rate"][:, 0] * 1e3,
        "torque": np.abs(fields["u"]).max(axis=1),
        "force": np.linalg.norm(fields["force"], axis=1),
    }
    if "deflection" in fields:
        values["deflection"] = fields["deflection"][:, 0] * 1e3
        values["energy"] = fields["internal_energy"][:, 0] * 1e3
    return values
