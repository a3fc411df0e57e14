"""A sketch of a robot's bars and joints, for robots without a picture."""

from __future__ import annotations

import casadi as ca
import numpy as np

from onpath.app.common.templates import render
from onpath.models.systems.robots import AXES, Robot

SIZE = (640, 360)  # [px], width and height of a sketch
MARGIN = 50  # [px] around a sketch


def robot_sketch(robot: Robot) -> str:
    """An SVG of the robot with its end-point in the centre of the path region.

    A robot with two outputs is seen across their plane, and others from the front.
    """
    q = ca.SX.sym("q", robot.system.n)
    skeleton = ca.Function("skeleton", [q], [ca.densify(x) for x in robot.skeleton(q, ca.SX(1))])
    home = robot.rest(robot.frame.lift(np.zeros(2)))
    seen_along = robot.axes if robot.system.p == 2 else np.array(AXES[2])
    bars, joints = ((seen_along @ points.full()).T for points in skeleton.call([ca.DM(home)]))
    low, high = bars.min(axis=0), bars.max(axis=0)
    scale = (np.array(SIZE) - 2 * MARGIN).min() / max(float((high - low).max()), 1e-6)

    def seen(points: np.ndarray) -> np.ndarray:
        return np.array(SIZE) / 2 + scale * (points - (low + high) / 2) * [1, -1]

    lines, circles = seen(bars).reshape(-1, 4), seen(joints)
    return render("web/robot_sketch.svg", size=SIZE, lines=lines.tolist(), circles=circles.tolist())
