"""Runs of the lab that a controller's C replays."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.faults import fault_in
from onpath.models.closed_loop.sensing import readings
from onpath.models.closed_loop.simulation import kernel_of, kind_of
from onpath.models.closed_loop.translated_loop import fastest_loop
from onpath.models.controller.design import Design
from onpath.models.controller.steps import Steps
from onpath.models.studies.schedule import Schedule
from onpath.models.studies.scheduled_run import ScheduledRun
from onpath.models.systems.parameters import Parameters

DURATION, HOLD = 0.3, (0.1, 0.2)  # [s]
SEGMENT = 30  # steps
COUNTS = 2000.0  # steps of encoders, if the settings have none


@dataclass(frozen=True, slots=True, eq=False)
class RecordedRun:
    """What a controller measured in the lab, and the torques that it gave.

    Attributes:
        title: what it shows, in English.
        rows: t [s], q, v and torque [N m] of each step, (1 + steps, 1 + 2 n + m); those of the
            first row are at the start.
        states: of the controller after every `SEGMENT` steps, under composite control, whose
            filters are stable only together with the link: alone, they would amplify rounding.
        has_v: whether v is measured.
        theta: of the closest point at the start, [rad].
    """

    title: str
    rows: Array
    states: list[Array]
    has_v: bool
    theta: float


def recorded_runs(design: Design) -> list[RecordedRun]:
    """A run with exact measurements, and one in which encoders read positions alone.

    The robot starts on the first path, and is held back for a while. A flexible link has the first
    run only. Under a computing delay the torques are those of the controller in Python, since the
    lab's act later.
    """
    exact = replace(design.parameters, encoder_counts=0.0, sensor_noise=0.0)
    runs = [_recorded(design, exact, "positions and velocities")]
    if not design.robot.system.modes:
        counts = design.parameters.encoder_counts or COUNTS
        read = replace(exact, encoder_counts=counts)
        runs.append(_recorded(design, read, "positions alone"))
    return runs


def _recorded(design: Design, parameters: Parameters, title: str) -> RecordedRun:
    robot, curve = design.robot, next(iter(design.paths.values()))
    kind = kind_of(design.law, parameters, curve)
    kernel = kernel_of(robot, kind)
    running = ScheduledRun(
        robot=robot,
        loop=fastest_loop(kernel),
        curve=curve,
        parameters=parameters,
        schedule=Schedule(duration=DURATION, hold_from=HOLD[0], hold_to=HOLD[1]),
        start=robot.frame.lift(curve.at(np.array(curve.begin))),
    )
    state, settings, _ = running.inputs()
    rows = np.concatenate([part for part, _ in running.parts()])
    if (fault := fault_in(robot, kernel.log, design.law, rows, parameters)) is not None:
        rows = rows[: fault[0]]
    theta = float(kernel.state.unpack(state)["theta"][0])
    fields = kernel.log.unpack(rows)
    q, v, torque = (fields[name] for name in ("q", "v", "u"))
    given = kernel.settings.unpack(settings)
    dt, every = float(given["dt"][0]), round(float(given["hold_ticks"][0]))
    seen = slice(None, None, every if kind.encoder else 1)
    start = np.concatenate([[0.0], q[0], v[0], np.zeros(robot.system.m)])
    if kind.encoder:
        q = readings(robot.system, kind, kernel.settings, settings, q)
    t = dt * np.arange(len(rows), dtype=float)
    measured = np.hstack([t[:, None], q, v, torque])[seen]
    known, states = kernel.state.unpack(state), list[Array]()
    steps = Steps(design.functions, design.settings(curve), curve.table())
    steps.start(0.0, known["q"], known["v"], theta)
    for i, (row, place, rate) in enumerate(zip(measured, q[seen], v[seen], strict=True), 1):
        given_torque = steps.step(row[0], place, None if kind.encoder else rate)
        if kind.delay:
            row[-robot.system.m :] = given_torque
        if design.kind.output == "composite" and i % SEGMENT == 0:
            states.append(steps.state)
    rows = np.vstack([start, measured])
    return RecordedRun(title, rows, states, not kind.encoder, theta)
