"""Runs of the lab tick by tick, as what a controller measures in them, and their torques."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from onpath.app.notebook.controller import Controller
from onpath.app.notebook.simulate import planned
from onpath.models.arrays import Array
from onpath.models.closed_loop.sensing import readings
from onpath.models.closed_loop.simulation import kernel_of, kind_of
from onpath.models.closed_loop.translated_loop import fastest_loop
from onpath.models.studies.scheduled_run import ScheduledRun


@dataclass(frozen=True)
class LabLog:
    """A run, a row for each tick.

    Attributes:
        t: [s].
        q, v: true coordinates and velocities.
        read: angles of the joints that the encoders read.
        torque: [N m], in effect in the tick.
        first: ticks of which the law is evaluated are those with tick % first == 0.
    """

    t: Array
    q: Array
    v: Array
    read: Array
    torque: Array
    first: int


def lab_log(robot: Any, path: Any, law: Any, **given: Any) -> LabLog:
    """A run of `onpath.simulate` with these arguments, which must not stop."""
    chosen, name, _ = planned(robot, path, law, **given)
    made, curve, parameters = chosen.robot(), chosen.curve(), chosen.parameters
    kind = kind_of(name, parameters, curve)
    kernel = kernel_of(made, kind)
    running = ScheduledRun(
        robot=made,
        loop=fastest_loop(kernel),
        curve=curve,
        parameters=parameters,
        schedule=chosen.schedule,
        start=chosen.begin(),
    )
    _, settings, _ = running.inputs()
    rows = np.concatenate([part for part, _ in running.parts()])
    fields, inputs = kernel.log.unpack(rows), kernel.settings.unpack(settings)
    assert made.fault(fields["q"], fields["v"], parameters) is None
    return LabLog(
        t=float(inputs["dt"][0]) * np.arange(len(rows), dtype=float),
        q=fields["q"],
        v=fields["v"],
        read=readings(made.system, kind, kernel.settings, settings, fields["q"]),
        torque=fields["u"],
        first=round(float(inputs["hold_ticks"][0])),
    )


def replayed(controller: Controller, log: LabLog, exact: bool) -> Array:
    """The torques that a controller gives for what was measured, (ticks, m).

    Args:
        exact: whether it measures positions and velocities in each tick, or what the encoders read
            in those ticks alone in which the law is evaluated; the others repeat the last torque.
    """
    controller.start(0.0, log.q[0], log.v[0])
    torques = list[Array]()
    for k, t in enumerate(log.t):
        if exact:
            torques.append(controller.step(t, log.q[k], log.v[k]))
        else:
            torques.append(torques[-1] if k % log.first else controller.step(t, log.read[k]))
        assert controller.code == 0, controller.reason
    return np.array(torques)
