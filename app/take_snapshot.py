"""From a session to what is shown of it."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from functools import lru_cache

import casadi as ca
import numpy as np

from app.history import Instant
from app.samples import sample_layout
from app.session import Session
from app.snapshot import FollowerName, PathView, RobotView, Snapshot, TrackerName
from models.buffered import Buffered
from models.controllers import NAMES
from models.curves import Curve
from models.robots import Robot
from models.system import Array

TRACE = 1.6  # [s]
TRACE_POINTS = 120
CURVE_POINTS = 160
AIMS = {TrackerName: "theta_ref", FollowerName: "theta"}
"""Where on the path each controller aims."""


def take_snapshot(session: Session, achieved_speed: float, traces: bool = True) -> Snapshot:
    """The session now, or at the past instant it looks at."""
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
        held=bool(session.held),
        grabbed=session.grabbed,
        message=session.message,
        message_level=session.message_level,
        note=scale_note(session),
    )


def scale_note(session: Session) -> str:
    """A drawing that is not true to scale says so."""
    if session.exaggeration == 1.0 or not session.robot.extra_fields:
        return ""
    return session.lessons.words("scene.larger", factor=f"{session.exaggeration:g}")


def _traces(session: Session, time: float) -> Array:
    """End-points of both robots lately, shape (n, robots, p)."""
    _, samples = session.history.samples(time - TRACE, time, TRACE_POINTS)
    if not samples.size:
        return np.zeros((0, len(session.runs), session.robot.system.p))
    return samples[..., session.sample_layout.slices["y"]]


def robot_views(
    robot: Robot,
    curve: Curve,
    instant: Instant,
    traces: Array | None = None,
    exaggeration: float = 1.0,
) -> dict[str, RobotView]:
    """Both robots at one instant.

    Args:
        traces: their end-points lately, shape (n, robots, p), [m].
        exaggeration: of a deflection, in the bars and the drawn end-point.
    """
    fields = sample_layout(robot).unpack(instant.sample)
    aims = [fields[AIMS[name]][i, 0] for i, name in enumerate(NAMES)]
    markers = robot.frame.lift(curve.at(np.array(aims)))
    none = np.zeros_like(markers)
    tips, markers, forces, origins = robot.place(
        np.array([fields["y"], markers, fields["force"], none])
    )
    bars, joints, marks = _drawn(robot, instant.states, exaggeration)
    trails = tips[None] if traces is None else np.concatenate([robot.place(traces), tips[None]])
    bent, (speeds, distances) = fields.get("deflection"), (fields["speed"], fields["distance"])
    return {
        name: RobotView(
            bars=bars[i],
            joints=joints[i],
            tip=tips[i] if exaggeration == 1.0 else bars[i, -1, 1],
            marker=markers[i],
            force=forces[i] - origins[i],
            trace=trails[:, i],
            distance=float(distances[i, 0]),
            max_distance=instant.max_distances[i],
            speed=float(speeds[i, 0]),
            torque=fields["u"][i],
            extra_points=marks[i],
            deflection=np.nan if bent is None else float(bent[i, 0]),
        )
        for i, name in enumerate(NAMES)
    }


class _Figures(threading.local):
    """Each thread's own."""

    def __init__(self) -> None:
        self.of: dict[Robot, Buffered] = {}


_figures = _Figures()


@lru_cache(maxsize=16)
def _figure(robot: Robot) -> ca.Function:
    """(q of both robots as columns, exaggeration) -> bars, joints and marks of both."""
    q, exaggeration = ca.SX.sym("q", robot.system.n, len(NAMES)), ca.SX.sym("exaggeration")
    each = ca.horzsplit(q)
    skeletons = [robot.skeleton(one, exaggeration) for one in each]
    bars, joints = (ca.horzcat(*parts) for parts in zip(*skeletons, strict=True))
    marks = ca.horzcat(*map(robot.marks, each))
    results = [ca.densify(points) for points in (bars, joints, marks)]
    return ca.Function("figure", [q, exaggeration], ca.cse(results))


def _drawn(robot: Robot, states: Sequence[Array], exaggeration: float) -> tuple[Array, ...]:
    """Bars (robots, n, 2, 3), joints (robots, m, 3) and marks (robots, k, 3), [m]."""
    figure = _figures.of.get(robot)
    if figure is None:
        figure = _figures.of[robot] = Buffered(_figure(robot))
    q = np.concatenate([state[: robot.system.n] for state in states])
    bars, joints, marks = figure(q, np.array([exaggeration]))
    both = len(states)
    shaped = bars.reshape(both, -1, 2, 3), joints.reshape(both, -1, 3), marks.reshape(both, -1, 3)
    return tuple(array.copy() for array in shaped)


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
