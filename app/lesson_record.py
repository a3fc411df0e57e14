"""From a session to the record that the lessons' checks look at."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from lessons.record import ROLES, Record
from lessons.schema import RobotName
from models.layout import Layout
from models.system import Array

if TYPE_CHECKING:
    from app.session import Session

MOST_SAMPLES = 3600


@dataclass(frozen=True, slots=True)
class Beginning:
    """When a step began: the run, and the simulated time in it, [s]."""

    run: int
    time: float

    @staticmethod
    def now(session: Session) -> Beginning:
        """At this instant; what has happened before is forgotten."""
        session.happenings.clear()
        return Beginning(session.run_number, session.time)


def record_of(session: Session, since: Beginning) -> Record:
    """What has happened since a step began or, if later, since the last reset."""
    begin = since.time if since.run == session.run_number else 0.0
    times, samples = session.history.samples(begin, session.time, MOST_SAMPLES)
    return Record(
        times=times,
        values=_values(session, samples.astype(float)) if len(times) else _nothing(session),
        happenings=tuple(session.happenings),
        run=session.run_number,
        parameters=session.parameters,
        path=session.editor.design.name,
        robot=session.entry.name,
    )


def _nothing(session: Session) -> dict[RobotName, dict[str, Array]]:
    return {ROLES[name]: {} for name in session.runs}


def _values(session: Session, samples: Array) -> dict[RobotName, dict[str, Array]]:
    """Of samples, shape (n, robots, fields): see lessons.record.QUANTITIES."""
    layout, names = session.sample_layout, list(session.runs)
    timetable = names.index(next(name for name in names if ROLES[name] == "tracker"))
    running = layout.unpack(samples[:, timetable])["theta_ref"][:, 0]
    point = session.robot.frame.lift(session.editor.curve.at(running))
    return {ROLES[name]: _of(layout, samples[:, i], point) for i, name in enumerate(names)}


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
