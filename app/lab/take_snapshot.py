"""From a session to what is shown of it."""

from __future__ import annotations

import numpy as np

from onpath.app.lab.lab import Lab
from onpath.app.lab.robot_geometry import robot_views
from onpath.app.lab.session import Session
from onpath.app.lab.snapshot import PathView, Snapshot
from onpath.lessons.words import Words
from onpath.models.arrays import Array
from onpath.models.paths.curves import Curve

TRACE = 1.6  # [s]
TRACE_POINTS = 120
CURVE_POINTS = 160


def take_snapshot(lab: Lab, achieved_speed: float, traces: bool = True) -> Snapshot:
    """The lab now, or at the past instant it looks at."""
    session = lab.session
    past = None if session.viewing is None else session.history.at(session.viewing)
    curve = session.editor.curve if past is None else past.curve
    time = session.time if session.viewing is None else session.viewing
    return Snapshot(
        time=time,
        running=session.running,
        achieved_speed=achieved_speed,
        robots=robot_views(
            session.robot,
            curve,
            session.instant() if past is None else past.instant(),
            _traces(session, time) if traces else None,
            session.exaggeration,
        ),
        path=_path_view(session, curve),
        held=bool(session.grips.held),
        grabbed=session.grips.grabbed,
        message=lab.message,
        message_level=lab.message_level,
        note=scale_note(session, lab.words),
    )


def scale_note(session: Session, words: Words) -> str:
    """A drawing that is not true to scale says so."""
    if session.exaggeration == 1.0 or not session.robot.extra_fields:
        return ""
    return words("scene.larger", factor=f"{session.exaggeration:g}")


def _traces(session: Session, time: float) -> Array:
    """End-points of both robots lately, shape (n, robots, p)."""
    y = session.sample_layout.slices["y"]
    _, samples = session.history.samples(time - TRACE, time, TRACE_POINTS, y)
    return samples if samples.size else np.zeros((0, len(session.runs), session.robot.system.p))


def _path_view(session: Session, curve: Curve) -> PathView:
    """The path as it is now, or without its control points as it was when it was `curve`."""
    editor, robot = session.editor, session.robot
    is_present = curve is editor.curve
    version = editor.version if is_present else curve
    if session.path_view is not None and session.path_view.version == version:
        return session.path_view

    def placed(z: Array) -> Array:
        return robot.place(robot.frame.lift(z))

    wrong = [fault.points for fault in editor.faults] if is_present else []
    session.path_view = PathView(
        version=version,
        points=placed(curve.at(np.linspace(-np.pi, np.pi, CURVE_POINTS))),
        control_points=placed(editor.points() if is_present else np.zeros((0, 2))),
        selected=editor.selected if is_present else None,
        refused=placed(np.concatenate(wrong) if wrong else np.zeros((0, 2))),
    )
    return session.path_view
