"""Where a chain stands at home, and how large paths around it may be."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from onpath.models.arrays import Array
from onpath.models.paths.path_checks import LEAST_MARGIN
from onpath.models.robot_files.chain import Chain
from onpath.models.systems.drawing import Point
from onpath.models.systems.rigid_chain import chain_frames, chain_inertias, potential_energy, tip_of
from onpath.models.systems.robots import Robot
from onpath.models.systems.rows import Rows

TRIES = 4000
OVER_FLOOR = 0.02  # [m], least height of joints and tip over the floor
DOWN = 0.5  # weight of a tip that points downward, against one that points upward
WORTH = 0.3  # a rule holds if the best pose within it has this share of the best score of all
HANGS = 0.5  # share of its length by which the tip of a hanging limb is below its base
LEAST_EASE = 0.05  # weight of a pose that the motors cannot hold
CANDIDATES, APART = 6, 0.15
MOST_SEEN = 400  # of the best configurations, among which candidates are chosen
RADII = 60
DIRECTIONS = 48
LEAST_RADIUS, LARGEST_CIRCLE = 0.003, 1.0  # [m]
LEAST_SLOPE = 1e-4  # of σ_min(J) to the length, below which the tip cannot move everywhere
RULES = ("floor", "ahead")
"""What a chosen pose keeps to, the more important rule first: nothing is below the floor, and the
tip is in front of the base."""


@dataclass(frozen=True, slots=True, eq=False)
class ChosenPose:
    """A configuration from `chosen_poses`.

    Attributes:
        q: shape (n,), [rad] or [m].
        kept: the rules of `RULES` that it keeps to.
    """

    q: Array
    kept: tuple[str, ...]


def chosen_poses(chain: Chain, axes: tuple[Point, ...], pose: dict[str, float]) -> list[ChosenPose]:
    """Configurations at which the end-point moves easily in all directions, best first.

    Of `TRIES` random ones within the limits, and within half a turn from 0, they maximize σ_min(J)
    times the least distance from a limit, as a share of its joint's travel. A tip whose axis points
    downward is preferred, and what the motors hold with half of the torques that the file states
    for them. They keep to rules: joints and end-point are over the floor, which is at
    the root's origin, or at the first joint if that is lower, and the end-point is in front of the
    first joint. What no joint moves does not count. For a limb that hangs from its base, such as a
    leg, the first rule is that the end-point is below it. A rule that costs too much is given up.

    Args:
        axes: directions of the outputs.
        pose: coordinates that are given, by joint.

    Returns:
        At most `CANDIDATES`; none if the end-point can nowhere move in the directions of all
        outputs.
    """
    values = _seen(chain, axes, np.concatenate([tried := _tried(chain, pose), _zero(chain, pose)]))
    p, base, length = len(axes), chain.bodies[0].translation, length_of(chain)
    slopes = values[:-1, : p * chain.n].reshape(-1, chain.n, p).transpose(0, 2, 1)
    least = np.linalg.svd(slopes, compute_uv=False)[:, -1]
    low, height, ahead, up = values[:-1, -4:].T
    score = least * _room(chain, tried, pose) * (1 + DOWN * (1 - up) / 2) * _ease(chain, tried)
    if not least.max() > LEAST_SLOPE * length:
        return []
    hangs = bool(values[-1, -3] < base[2] - HANGS * length)
    floor = min(0.0, float(base[2])) + OVER_FLOOR
    rules = {"floor": height < base[2] if hangs else low >= floor, "ahead": ahead > base[0]}
    kept, allowed = list[str](), np.ones(len(tried), bool)
    for name in RULES:
        within = allowed & rules[name]
        if score[within].max(initial=0.0) > WORTH * score[allowed].max():
            kept, allowed = [*kept, name], within
    order = np.flatnonzero(allowed)[np.argsort(-score[allowed], kind="stable")]
    return [ChosenPose(tried[i], tuple(kept)) for i in _apart(chain, tried, order)]


def _seen(chain: Chain, axes: tuple[Point, ...], rows: Array) -> Array:
    """J by columns, least height of joints and tip, the tip's height and x, and its axis' z."""
    q = ca.SX.sym("q", chain.n)
    frames = chain_frames(chain, q)
    tip = tip_of(chain, frames)
    jacobian = ca.densify(ca.jacobian(ca.DM(axes) @ tip, q))
    moved = [origin[2] for origin in frames.origins if ca.depends_on(origin, q)]
    lowest = ca.mmin(ca.densify(ca.vertcat(*moved, tip[2])))
    pointing = frames.rotations[-1] @ ca.DM(chain.facing)
    return Rows([q], ca.vertcat(ca.vec(jacobian), lowest, tip[2], tip[0], pointing[2]))(rows)


def _apart(chain: Chain, tried: Array, order: NDArray[np.intp]) -> list[int]:
    """The first ones of which each differs from those before by `APART` of a joint's travel."""
    low, high = _ends(chain)
    places, left = (tried - low) / (high - low), order[:MOST_SEEN]
    found = list[int]()
    while len(left) and len(found) < CANDIDATES:
        found.append(int(left[0]))
        left = left[np.abs(places[left] - places[left[0]]).max(axis=1) > APART]
    return found


def _ends(chain: Chain) -> tuple[Array, Array]:
    """The limits, or half a turn if they are farther, (n,) each."""
    low, high = chain.limits
    return np.maximum(low, np.minimum(high, 0) - np.pi), np.minimum(
        high, np.maximum(low, 0) + np.pi
    )


def _tried(chain: Chain, pose: dict[str, float]) -> Array:
    """Random configurations, (TRIES, n)."""
    low, high = _ends(chain)
    tried = low + (high - low) * np.random.default_rng(0).random((TRIES, chain.n))
    for i, joint in enumerate(chain.joints):
        if joint.name in pose:
            tried[:, i] = pose[joint.name]
    return tried


def _room(chain: Chain, tried: Array, pose: dict[str, float]) -> Array:
    """The least distance from a limit, as a share of the travel, of joints that may be chosen."""
    low, high = _ends(chain)
    room = np.minimum(tried - low, high - tried) / (high - low)
    free = [i for i, joint in enumerate(chain.joints) if joint.name not in pose]
    return room[:, free].min(axis=1, initial=0.5)


def _ease(chain: Chain, tried: Array) -> Array:
    """1 where no motor needs more than half of its effort to hold the chain, least where all."""
    efforts = np.array([joint.effort for joint in chain.joints])
    if not np.isfinite(efforts).any():
        return np.ones(len(tried))
    q, one = ca.SX.sym("q", chain.n), ca.SX(1)
    inertias = chain_inertias(chain, one, ca.SX(0))
    weights = ca.gradient(potential_energy(chain_frames(chain, q), inertias), q)
    loads = np.abs(Rows([q], ca.densify(weights))(tried)) / efforts
    return np.clip(2 * (1 - loads.max(axis=1)), LEAST_EASE, 1.0)


def _zero(chain: Chain, pose: dict[str, float]) -> Array:
    """The configuration nearest to 0 within the limits, (1, n)."""
    joints = chain.joints
    zero = [pose.get(each.name, min(max(0.0, each.low), each.high)) for each in joints]
    return np.array([zero])


def length_of(chain: Chain) -> float:
    """A distance from the first joint that the tip cannot exceed, [m]."""
    steps = sum(float(np.linalg.norm(body.translation)) for body in chain.bodies[1:])
    slides = [max(abs(j.low), abs(j.high)) for j in chain.joints if j.slides]
    return steps + float(np.linalg.norm(chain.tip)) + sum(slides)


def reachable_circle(robot: Robot) -> float:
    """The radius up to which the robot can follow circles about home, [m]; 0: none.

    The margin is at least `LEAST_MARGIN` on all of the disc, up to `LARGEST_CIRCLE`.
    """
    radii = np.geomspace(LEAST_RADIUS, LARGEST_CIRCLE, RADII)
    turn = np.linspace(0, 2 * np.pi, DIRECTIONS, endpoint=False)
    ring = np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    good = (robot.margin(radii[:, None, None] * ring) >= LEAST_MARGIN).all(axis=1)
    count = RADII if good.all() else int(good.argmin())
    return float(radii[count - 1]) if count else 0.0
