"""A robot as HTML for a notebook: a sketch at home, and the limits of its joints."""

from __future__ import annotations

import math
from collections.abc import Iterable
from html import escape

import numpy as np

from onpath.models.arrays import Array
from onpath.models.robot_files.chain import Joint
from onpath.models.robot_files.xml_elements import shown

WIDTH, HEIGHT = 320.0, 240.0
MARGIN = 16.0
LIGHT = "fill:#e8f0e8"


def sketch(bars: Array, joints: Array, cells: Array, size: float) -> str:
    """A drawing of a robot, seen from the front, as SVG.

    Args:
        bars: their ends, begin and end as rows, shape (2 k, 2), [m]; the last one is the end-point.
        joints: shape (j, 2), [m].
        cells: centres of square cells that the end-point can reach, shape (n, 2), [m].
        size: side of the cells, [m].
    """
    corners = np.concatenate([bars, joints, cells - size / 2, cells + size / 2])
    low, high = corners.min(0), corners.max(0)
    scale = min((np.array([WIDTH, HEIGHT]) - 2 * MARGIN) / np.maximum(high - low, 1e-6))

    def at(points: Array) -> Array:
        across, up = scale * (points - low).T
        return np.round(MARGIN + np.column_stack([across, scale * (high - low)[1] - up]), 1)

    side = f"{scale * size + 0.2:.1f}"
    tiles = "".join(
        f'<rect x="{x:g}" y="{y:g}" width="{side}" height="{side}"/>'
        for x, y in at(cells + (-size / 2, size / 2))
    )
    lines = "".join(
        f'<line x1="{a:g}" y1="{b:g}" x2="{c:g}" y2="{d:g}"/>'
        for (a, b), (c, d) in at(bars).reshape(-1, 2, 2)
    )
    pins = "".join(f'<circle cx="{x:g}" cy="{y:g}" r="4"/>' for x, y in at(joints))
    x, y = at(bars[-1:])[0]
    width, height = 2 * MARGIN + scale * (high - low)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.0f}" height="{height:.0f}">'
        f'<g style="{LIGHT}">{tiles}</g>'
        f'<g stroke="#0072b2" stroke-width="6" stroke-linecap="round">{lines}</g>'
        f'<g fill="#5f5f5f">{pins}</g><circle cx="{x:g}" cy="{y:g}" r="6" fill="#d55e00"/></svg>'
    )


def described(label: str, name: str, text: str, drawing: str, joints: Iterable[Joint]) -> str:
    """A robot's sketch with its words and the limits of its joints, as HTML."""
    limits = "".join(f"<li>{escape(_limits(each))}</li>" for each in joints)
    words = f"<b>{escape(label)}</b> ({escape(name)})<br>{escape(text)}"
    shade = "<br>Shaded: where the end-point can be in the path's plane. It is drawn at home."
    return f"<div>{drawing}<p>{words}{shade}</p>{f'<ul>{limits}</ul>' if limits else ''}</div>"


def _limits(joint: Joint) -> str:
    """What a joint can do, such as "joint1: -90° to 90°, at most 12 N m"."""
    most = "" if math.isinf(joint.effort) else f", at most {joint.effort:g} {joint.unit}"
    return f"{shown(joint.name)}: {_range(joint)}{most}"


def _range(joint: Joint) -> str:
    """Of a joint's coordinate, in degrees or millimetres."""
    factor, unit = (1e3, " mm") if joint.slides else (180 / math.pi, "°")
    ends = [f"{factor * end:.0f}{unit}" for end in (joint.low, joint.high) if math.isfinite(end)]
    return " to ".join(ends) if len(ends) == 2 else "no limits" if not ends else ends[0]
