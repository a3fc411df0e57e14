"""Motions that excite the parameters that a record does not.

The equations of motion give the regressor of any motion, even of one that no robot has made yet. A
motion identifies parameters if the columns of its regressor, together with those of the record, are
independent (see parameter_estimate.py).

The motion to record next is drawn at random, and the one with the best condition number of the
regressor is taken.

Source: exciting trajectories in Khalil and Dombre, Modeling, Identification and Control of Robots.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from onpath.models.arrays import Array
from onpath.models.errors import CodedError
from onpath.models.studies.linear_model import MotionRecord
from onpath.models.studies.parameter_estimate import conditioning, dependent_names
from onpath.models.systems.robots import Robot, RobotEntry
from onpath.models.systems.system import MechanicalSystem

SECONDS, STEP = 8.0, 5e-3  # of a motion, [s]
TURN, SLIDE = 0.6, 0.1  # amplitude of a coordinate, [rad] and [m]
SLOW = 0.4  # [Hz], frequency of the first coordinate; each further one is a third faster
DRAWN = 12  # motions of which the best is taken
WAVES = 5  # of each coordinate, of 0.2 to 1 Hz
BASE = 0.2  # [Hz]
RAMP = 1.0  # [s], in which a motion begins, and in which it ends
LEAST = 0.05  # least share of `TURN` or `SLIDE` that counts as a motion
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
        geometry: see `parameter_estimate.estimate`.
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


@dataclass(frozen=True, slots=True, eq=False)
class PlannedMotion:
    """A motion to record, from rest to rest at the same place.

    Attributes:
        t: times, (rows,), [s].
        q, v: coordinates and their rates, (rows, n).
        told: number of parameters, or sums of some, that it tells.
        condition: condition number of its regressor for these.
    """

    t: Array
    q: Array
    v: Array
    told: int
    condition: float


def planned_motion(entry: RobotEntry, centre: Array, fastest: Array) -> PlannedMotion:
    """The motion that tells the most parameters, and with the least condition number, of many.

    Each coordinate is a sum of waves with random amplitudes and phases that begins and ends
    smoothly. It stays where the robot is neither singular nor at a limit.

    Args:
        centre: about which the coordinates swing, (n,).
        fastest: rates, (n,); no coordinate exceeds the largest of those in its unit.

    Raises:
        CodedError: the robot cannot move there.
        ValueError: its model is not linear in its parameters.
    """
    robot, draw = entry.make(entry.parameters()), np.random.default_rng(0)
    plant = robot.plant(entry.parameters())
    slides = np.array([name.endswith("_m") for name in robot.system.coordinate_names])
    limits = np.array([fastest[slides == kind].max() for kind in slides])
    best: PlannedMotion | None = None
    for _ in range(DRAWN):
        motion = _within(robot, entry, centre, limits, draw)
        if motion is None:
            continue
        told, condition = conditioning(robot.system, [motion], plant)
        if best is None or (-told, condition) < (-best.told, best.condition):
            t: Array = STEP * np.arange(len(motion.q), dtype=float)
            best = PlannedMotion(t=t, q=motion.q, v=motion.v, told=told, condition=condition)
    if best is None:
        raise CodedError("error.no_motion_there", robot=entry.name)
    return best


def _within(
    robot: Robot, entry: RobotEntry, centre: Array, fastest: Array, draw: np.random.Generator
) -> MotionRecord | None:
    """A random motion, made smaller until the robot can make it; None if it would hardly move."""
    system, t = robot.system, np.arange(0.0, SECONDS + STEP / 2, STEP)
    slides = np.array([name.endswith("_m") for name in system.coordinate_names])
    size = np.where(slides, SLIDE, TURN)
    shares = draw.dirichlet(np.ones(WAVES), system.n)
    phases = draw.uniform(0, 2 * np.pi, (system.n, WAVES))
    omega = 2 * np.pi * BASE * np.arange(1, WAVES + 1)
    angles = omega * t[:, None, None] + phases
    away, rate = (shares * np.sin(angles)).sum(2), (shares * omega * np.cos(angles)).sum(2)
    ends = np.minimum(np.minimum(t, t[-1] - t) / RAMP, 1.0)
    sign = np.where(t < t[-1] / 2, 1.0, -1.0)
    rise = (ends**3 * (10 - 15 * ends + 6 * ends**2))[:, None]
    slope = (sign * 30 * ends**2 * (1 - ends) ** 2 / RAMP)[:, None]
    away, rate = size * rise * away, size * (rise * rate + slope * away)
    share = min(1.0, float(np.min(fastest / np.abs(rate).max(axis=0))))
    none = np.zeros((len(t), system.m)), np.zeros((len(t), system.p))
    while share > LEAST:
        q, v = centre + share * away, share * rate
        if robot.fault(q, v, entry.parameters()) is None:
            return MotionRecord(dt=STEP, q=q, v=v, u=none[0], force=none[1])
        share *= 0.8
    return None
