"""Motions that excite the parameters that a record does not.

The equations of motion give the regressor of any motion, even of one that no robot has made yet. A
motion identifies parameters if the columns of its regressor, together with those of the record, are
independent (see linear_model.py).

Source: exciting trajectories in Khalil and Dombre, Modeling, Identification and Control of Robots.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from onpath.models.arrays import Array
from onpath.models.studies.linear_model import MotionRecord, dependent_names
from onpath.models.systems.system import MechanicalSystem

SECONDS, STEP = 8.0, 5e-3  # of a motion, [s]
TURN, SLIDE = 0.6, 0.1  # amplitude of a coordinate, [rad] and [m]
SLOW = 0.4  # [Hz], frequency of the first coordinate; each further one is a third faster
QUICK, SMALL = 4.3, 0.15  # frequency and amplitude of the second wave, relative to the first


@dataclass(frozen=True, slots=True)
class ExcitingMotion:
    """A motion in which some coordinates swing about their mean in the record.

    Attributes:
        moving: names of these coordinates; the others rest.
        identified: the parameters that it identifies and the record does not.
        left: those that it does not identify either, such as those that no motion can.
    """

    moving: tuple[str, ...]
    identified: tuple[str, ...]
    left: tuple[str, ...]


def exciting_motion(
    system: MechanicalSystem, records: list[MotionRecord], geometry: Array, names: tuple[str, ...]
) -> ExcitingMotion | None:
    """The motion of the fewest coordinates that identifies the most of what the records do not.

    Args:
        geometry: see `linear_model.estimate`.
        names: of the parameters that matter.

    Returns:
        None if the records identify all of them, or no motion identifies more.
    """
    before = dependent_names(system, records, geometry, names)
    best: ExcitingMotion | None = None
    centre = np.mean(np.concatenate([each.q for each in records]), axis=0)
    for moving in _choices(system.n) if before else ():
        motion = _swinging(system, centre, moving)
        left = dependent_names(system, [*records, motion], geometry, names)
        if len(left) < len(before if best is None else best.left):
            coordinates = tuple(system.coordinate_names[i].rpartition("_")[0] for i in moving)
            identified = tuple(name for name in before if name not in left)
            best = ExcitingMotion(coordinates, identified, left)
    return best


def _choices(n: int) -> Iterator[tuple[int, ...]]:
    """Each coordinate, each pair, and all of them."""
    for size in dict.fromkeys((1, 2, n)):
        if size <= n:
            yield from combinations(range(n), size)


def _swinging(system: MechanicalSystem, centre: Array, moving: tuple[int, ...]) -> MotionRecord:
    """A slow and a quick wave of each moving coordinate, with frequencies of its own."""
    t = np.arange(0.0, SECONDS, STEP)
    q, v = np.tile(centre, (len(t), 1)), np.zeros((len(t), system.n))
    for k, i in enumerate(moving):
        size = SLIDE if system.coordinate_names[i].endswith("_m") else TURN
        for share, frequency in ((1.0, SLOW), (SMALL, QUICK * SLOW)):
            omega = 2 * np.pi * frequency * (1 + k / 3)
            q[:, i] += share * size * np.sin(omega * t + k)
            v[:, i] += share * size * omega * np.cos(omega * t + k)
    u, force = np.zeros((len(t), system.m)), np.zeros((len(t), system.p))
    return MotionRecord(dt=STEP, q=q, v=v, u=u, force=force)
