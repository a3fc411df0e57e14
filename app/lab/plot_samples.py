"""The values stored for each robot at every frame, for plots and for viewing the past."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.loop_vectors import log_layout
from onpath.models.layout import Layout
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot


@lru_cache(maxsize=8)
def sample_layout(robot: Robot) -> Layout:
    """Fields of a sample; names and units as in the log of models/closed_loop/kernel.py."""
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
            ("far", 1),
            ("integral_used", 1),
            *((name, each.numel()) for name, each in robot.extras.items()),
        )
    )


@lru_cache(maxsize=8)
def log_indices(robot: Robot) -> np.ndarray:
    """Indices of a sample's entries in a log row; 0 for those that are not in it."""
    log, indices = log_layout(robot.system), list[int]()
    for name, size in sample_layout(robot).fields:
        columns = log.slices.get(name)
        indices.extend([0] * size if columns is None else range(columns.start, columns.stop))
    return np.array(indices)


def samples_of(
    robot: Robot, parameters: Parameters, rows: Array, distances: Sequence[float] | Array
) -> Array:
    """Samples of log rows, (n, row size), and their distances, (n,): shape (n, fields)."""
    layout = sample_layout(robot)
    samples = rows.take(log_indices(robot), axis=1)
    samples[:, layout.slices["distance"].start] = distances
    log = log_layout(robot.system).unpack(rows)
    for name, values in robot.measured(log["q"], log["v"], parameters).items():
        samples[:, layout.slices[name]] = values
    return samples
