"""What is kept of each robot at every frame, for plots and for looking back."""

from __future__ import annotations

from functools import lru_cache

from models.layout import Layout
from models.robots import Robot


@lru_cache(maxsize=8)
def sample_layout(robot: Robot) -> Layout:
    """Fields of a sample; names and units as in the log of models/kernel.py."""
    p, m = robot.system.p, robot.system.m
    return Layout(
        (
            ("distance", 1),  # of the actual end-point, [m]
            ("speed", 1),  # along the path, [m/s]
            ("theta", 1),
            ("theta_rate", 1),
            ("theta_ref", 1),
            ("xi", p - 1),
            ("xi_rate", p - 1),
            ("u", m),
            ("force", p),
            ("y", p),
        )
    )
