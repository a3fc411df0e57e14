"""From a session to what is shown of it."""

from __future__ import annotations

import numpy as np

from app.session import Session
from app.snapshot import FollowerName, PathView, RobotView, Snapshot
from models.curves import Curve
from models.robots import Robot
from models.system import Array

TRACE = 1.6  # [s]
TRACE_POINTS = 120
CURVE_POINTS = 160


def take_snapshot(session: Session, achieved_speed: float, traces: bool = True) -> Snapshot:
    """The session now, or at the past instant it looks at."""
    time = session.time if session.viewing is None else session.viewing
    samples = _samples(session, time) if traces else None
    return Snapshot(
        time=time,
        running=session.running,
        achieved_speed=achieved_speed,
        robots={
            name: _robot_view(session, index, name, samples)
            for index, name in enumerate(session.runs)
        },
        path=_path_view(session),
        held=bool(session.held),
        grabbed=session.grabbed,
        message=session.message,
        message_level=session.message_level,
        note=scale_note(session.robot, session.exaggeration),
    )


def scale_note(robot: Robot, exaggeration: float) -> str:
    """A drawing that is not true to scale says so."""
    if exaggeration == 1.0 or not robot.extra_fields:
        return ""
    return f"deflection drawn {exaggeration:g}×"


def _samples(session: Session, time: float) -> Array:
    """End-points of both robots lately, shape (n, robots, p)."""
    _, samples = session.history.samples(time - TRACE, time, TRACE_POINTS)
    if not samples.size:
        return np.zeros((0, len(session.runs), session.robot.system.p))
    return session.sample_layout.unpack(samples)["y"]


def _robot_view(session: Session, index: int, name: str, samples: Array | None) -> RobotView:
    robot, run, curve = session.robot, session.runs[name], session.editor.curve
    past = None if session.viewing is None else session.history.at(session.viewing)
    trace = np.zeros((0, 3)) if samples is None else robot.place(samples[:, index])
    if past is not None:
        row = session.sample_layout.unpack(past.sample[index].astype(float))
        q = past.drives[name].state[: robot.system.n]
        most = past.drives[name].max_distance
        return robot_view(robot, name, curve, q, row, most, trace, session.exaggeration)
    row = run.shown() | session.sample_layout.unpack(session.sample()[index])
    q, most = row["q"], run.max_distance
    return robot_view(robot, name, curve, q, row, most, trace, session.exaggeration)


def robot_view(
    robot: Robot,
    name: str,
    curve: Curve,
    q: Array,
    row: dict[str, Array],
    max_distance: float,
    trace: Array,
    exaggeration: float = 1.0,
) -> RobotView:
    """One robot at one instant.

    Args:
        q: configuration, shape (n,).
        row: fields of a sample, see `Session.sample_layout`.
        trace: end-points lately, in the robot's frame, shape (k, 3), [m].
        exaggeration: of a deflection, in the bars and the drawn end-point.
    """
    tip = robot.place(row["y"])
    target = row["theta" if name == FollowerName else "theta_ref"][0]
    bars, joints = robot.skeleton(q, exaggeration)
    drawn = tip if exaggeration == 1.0 else bars[-1, 1]
    return RobotView(
        bars=bars,
        joints=joints,
        tip=drawn,
        marker=robot.place(robot.frame.lift(curve.at(np.array(target)))),
        force=robot.place(row["force"]) - robot.place(np.zeros_like(row["force"])),
        trace=np.concatenate([trace, tip[None]]),
        distance=float(row["distance"][0]),
        max_distance=max_distance,
        speed=float(row["speed"][0]),
        torque=row["u"],
        extra_points=robot.marks(q),
        deflection=float(row["deflection"][0]) if "deflection" in row else float("nan"),
    )


def _path_view(session: Session) -> PathView:
    editor, robot = session.editor, session.robot
    if session.path_view is not None and session.path_view.version == editor.version:
        return session.path_view

    def placed(z: Array) -> Array:
        return robot.place(robot.frame.lift(z))

    wrong = [fault.points for fault in editor.faults]
    session.path_view = PathView(
        version=editor.version,
        points=placed(editor.curve.at(np.linspace(-np.pi, np.pi, CURVE_POINTS))),
        control_points=placed(editor.points()),
        selected=editor.selected,
        refused=placed(np.concatenate(wrong) if wrong else np.zeros((0, 2))),
    )
    return session.path_view
