"""A picture of a robot for the menu: an asset, or else a sketch of its bars and joints."""

from __future__ import annotations

import base64
from functools import lru_cache

import casadi as ca
import numpy as np

from onpath.app.common import palette
from onpath.assets import asset_path
from onpath.models.systems.robots import Robot, RobotEntry

SIZE = (640, 360)  # [px]
MARGIN = 50  # [px]


@lru_cache(maxsize=32)
def picture_of(entry: RobotEntry) -> str:
    """A data URI."""
    if entry.picture:
        return _data("image/png", asset_path(entry.picture).read_bytes())
    return _data("image/svg+xml", robot_sketch(entry.make(entry.lab)).encode())


def _data(kind: str, content: bytes) -> str:
    return f"data:{kind};base64,{base64.b64encode(content).decode()}"


def robot_sketch(robot: Robot) -> str:
    """An SVG of the robot from the front, its end-point in the middle of its paths."""
    q = ca.SX.sym("q", robot.system.n)
    drawn = ca.Function("drawn", [q], [ca.densify(x) for x in robot.skeleton(q, ca.SX(1))])
    home = robot.rest(robot.frame.lift(np.zeros(2)))
    bars, joints = (points.full()[[0, 2]].T for points in drawn.call([ca.DM(home)]))
    low, high = bars.min(axis=0), bars.max(axis=0)
    scale = (np.array(SIZE) - 2 * MARGIN).min() / max(float((high - low).max()), 1e-6)

    def seen(points: np.ndarray) -> np.ndarray:
        return np.array(SIZE) / 2 + scale * (points - (low + high) / 2) * [1, -1]

    lines = "".join(
        f'<line x1="{a:.1f}" y1="{b:.1f}" x2="{c:.1f}" y2="{d:.1f}"/>'
        for a, b, c, d in seen(bars).reshape(-1, 4)
    )
    circles = "".join(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="13"/>' for x, y in seen(joints))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {SIZE[0]} {SIZE[1]}">'
        f'<rect width="100%" height="100%" fill="{palette.FLOOR.hex}"/>'
        f'<g stroke="{palette.FOLLOWER.hex}" stroke-width="20" stroke-linecap="round">{lines}</g>'
        f'<g fill="{palette.STEEL.hex}">{circles}</g></svg>'
    )
