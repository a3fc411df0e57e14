"""A lab is put into a received state, from which it goes on as the original does."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from onpath.app.classroom.moment import (
    Moment,
    PathMoment,
    RobotMoment,
    curve_of,
    laws_of,
    parameters_of,
    wall_of,
)
from onpath.app.lab.closed_loop_run import ClosedLoopRun, Diverged
from onpath.app.lab.lab import Lab
from onpath.app.lab.loop_states import single
from onpath.app.lab.path_editor import Blend, PathEditor
from onpath.app.lab.plot_samples import places
from onpath.app.lab.session import Session
from onpath.models.closed_loop.loop_vectors import log_layout
from onpath.models.control.benches import BENCHES
from onpath.models.errors import Message
from onpath.models.paths.curve_faults import Fault
from onpath.models.paths.path_design import PathDesign
from onpath.models.systems.catalogue import ROBOTS, RobotEntry

INSTANT = 1e-6  # [s], shorter than any tick


def take_over(lab: Lab, new: Moment, old: Moment | None) -> None:
    """Put a lab into a received state. Call it on the simulation thread.

    Args:
        lab: whose state is replaced.
        new: the received state, from `read_moment`.
        old: the one adopted before; only differences are applied.
    """
    session = lab.session
    entry: RobotEntry = ROBOTS[new.robot]
    session.choose_robot(entry)
    other_path = old is None or (new.robot, new.path) != (old.robot, old.path)
    if old is None or (new.robot, new.parameters) != (old.robot, old.parameters):
        if other_path:  # the path of before may be out of reach in another plane
            _take_path(session.editor, new.path)
        session.set_parameters(parameters_of(new))
    if other_path:
        _take_path(session.editor, new.path)
    if old is None or new.run != old.run or new.time < session.time - INSTANT:
        session.history.clear()
    if new.language != lab.words.language:
        lab.lessons.set_language(new.language)
    session.time, session.running, session.rate = new.time, new.running, new.rate
    session.exaggeration, grips = new.exaggeration, session.grips
    grips.grabbed, grips.held = new.grabbed, {*new.held}
    session.set_wall(wall_of(new))
    lab.show_message(new.message, new.level)
    for bench, robot in zip(BENCHES, new.robots, strict=True):
        grips.pushes[bench] = replace(grips.pushes[bench], **_pull(robot))
        session.change_law(bench, laws_of(new)[bench])
        _take_robot(session, session.runs[bench], robot)


def _take_path(editor: PathEditor, path: PathMoment) -> None:
    target, before = curve_of(path.target), path.before and curve_of(path.before)
    points = np.array(path.points).reshape(-1, 2)
    marked = np.array(path.marks).reshape(-1, 2)
    marks = [Fault(Message("fault.outside"), marked)] if path.marks else []
    shown = PathDesign(path.name, target.plan, points)
    editor.show(shown, Blend(target, before, path.progress), marks)
    editor.select(path.selected)


def _pull(robot: RobotMoment) -> dict[str, Any]:
    """The fields of `Push` of a hand and a brake."""
    return {
        "hand": np.array(robot.hand) if robot.hand else None,
        "hold": (np.array(robot.anchor), np.array(robot.tangent)) if robot.anchor else None,
        "hold_normal": np.array(robot.normal) if robot.normal else None,
    }


def _take_robot(session: Session, run: ClosedLoopRun, robot: RobotMoment) -> None:
    fields, log = session.sample_layout.slices, log_layout(session.robot.system)
    row, most = np.zeros(log.size), robot.max_distance
    run.place = single(np.array(robot.state), row, 0.0, most)
    now = run.fields()
    sample, known = np.array(robot.sample), places(session.robot)
    row[known[known > 0]] = sample[known > 0]
    log.unpack(row)["q"][:], log.unpack(row)["v"][:] = now["q"], now["v"]
    run.place = single(run.state, row, float(sample[fields["distance"].start]), most)
    run.diverged = (
        None if robot.diverged is None else Diverged(robot.diverged.reason(), robot.diverged.time)
    )
