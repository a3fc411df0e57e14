"""The preset paths: their names for a robot, and their outlines."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from onpath.lessons.labels import path_label
from onpath.lessons.words import Words
from onpath.models.paths.curve_faults import ambiguities, curve_faults
from onpath.models.paths.frames import SlantedPlane
from onpath.models.paths.path_design import presets
from onpath.models.systems.robots import Robot

POINTS = 60  # number of points of an outline
HALF = 46.0  # half the size of an outline, in a picture whose half-width is 50


def preset_label(preset: str, robot: Robot, words: Words) -> str:
    """The name of a path, with a remark if a robot cannot follow it or if it crosses itself."""
    label = path_label(preset, words)
    if preset == "circle" and isinstance(robot.frame, SlantedPlane):
        label = words("design.slanted_circle")
    key = remark_on(preset, robot)
    return words(key, path=label) if key else label


@lru_cache(maxsize=64)
def remark_on(preset: str, robot: Robot) -> str:
    """Key of the words for a preset that is refused or crosses itself; empty for others."""
    curve = presets(robot.radius)[preset].curve
    if curve_faults(robot.margin, curve):
        return "design.refused"
    return "design.ambiguous" if ambiguities(curve) else ""


@lru_cache(maxsize=32)
def outline(preset: str) -> str:
    """A preset as a path of SVG in a square from -50 to 50, up is negative."""
    curve = presets()[preset].curve
    points = curve.at(np.linspace(-np.pi, np.pi, POINTS)) * [1.0, -1.0]
    low, high = points.min(axis=0), points.max(axis=0)
    scaled = (points - (low + high) / 2) * (2 * HALF / max(float((high - low).max()), 1e-9))
    return "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in scaled) + ("Z" if curve.closed else "")
