"""Simulated mouse drags in a scene, without a browser."""

from __future__ import annotations

import asyncio
from types import SimpleNamespace
from typing import Any

import numpy as np


def play(lab: Any, node: str, phase: str, instance: int, start: np.ndarray, end: np.ndarray):
    """Call a node's drag callbacks as viser does, with a realistic ray of the pointer."""
    camera = np.array([0.1, -3.0, 0.5])
    pointer = camera + 0.97 * (end - camera)
    event = SimpleNamespace(
        instance_index=instance,
        phase=phase,
        start_position=tuple(start),
        end_position=tuple(pointer),
        client=SimpleNamespace(camera=SimpleNamespace(position=camera)),
    )
    for entry in lab.api.get_handle_by_name(node)._impl.drag_cb:
        asyncio.run(entry.callback(event))
