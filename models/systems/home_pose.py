"""Where a chain stands at home, and how large paths around it may be."""

from __future__ import annotations

import casadi as ca
import numpy as np

from onpath.models.arrays import Array
from onpath.models.paths.path_checks import LEAST_MARGIN
from onpath.models.systems.drawing import Point
from onpath.models.systems.rigid_chain import Chain, chain_frames, tip_of
from onpath.models.systems.robots import Robot
from onpath.models.systems.rows import Rows

TRIES = 4000
OVER_FLOOR = 0.02  # [m], least height of joints and tip over the lowest of the base
DOWN = 0.5  # weight of a tip that points downward, against one that points upward
RADII = 60
DIRECTIONS = 48
LARGEST_CIRCLE = 1.0  # [m]


def chosen_pose(chain: Chain, axes: tuple[Point, ...], pose: dict[str, float]) -> Array:
    """A configuration at which the end-point moves easily in all directions, shape (n,).

    Of `TRIES` random ones within the limits, and within half a turn from 0, it maximizes σ_min(J)
    times the least distance from a limit, as a share of its joint's travel. No joint is below the
    base, and the end-point is in front of it. A tip whose axis points downward is preferred.

    Args:
        axes: directions of the outputs.
        pose: coordinates that are given, by joint.

    Returns:
        NaN if all are below the base, or singular.
    """
    q = ca.SX.sym("q", chain.n)
    frames = chain_frames(chain, q)
    tip = tip_of(chain, frames)
    jacobian = ca.densify(ca.jacobian(ca.DM(axes) @ tip, q))
    heights = ca.vertcat(*[origin[2] for origin in frames.origins], tip[2])
    pointing = frames.rotations[-1] @ ca.DM(chain.facing)
    seen = ca.vertcat(ca.vec(jacobian), ca.mmin(ca.densify(heights)), tip[0], pointing[2])
    low, high = chain.limits
    low, high = np.maximum(low, -np.pi), np.minimum(high, np.pi)
    tried = low + (high - low) * np.random.default_rng(0).random((TRIES, chain.n))
    for i, joint in enumerate(chain.joints):
        if joint.name in pose:
            tried[:, i] = pose[joint.name]
    values = Rows([q], seen)(tried)
    p = len(axes)
    slopes = values[:, : p * chain.n].reshape(-1, chain.n, p).transpose(0, 2, 1)
    least = np.linalg.svd(slopes, compute_uv=False)[:, -1]
    room = np.minimum(tried - low, high - tried) / (high - low)
    free = [i for i, joint in enumerate(chain.joints) if joint.name not in pose]
    score = least * room[:, free].min(axis=1, initial=0.5)
    lowest, ahead, up = values[:, -3:].T
    score = score * (1 + DOWN * (1 - up) / 2)
    score[(lowest < OVER_FLOOR) | (ahead <= 0)] = 0.0
    best = int(score.argmax())
    return tried[best] if score[best] > 0 else np.full(chain.n, np.nan)


def reachable_circle(robot: Robot) -> float:
    """The largest radius of circles about home that the robot can follow, also smaller ones, [m].

    The margin is at least `LEAST_MARGIN` on all of the disc, up to `LARGEST_CIRCLE`.
    """
    radii = LARGEST_CIRCLE * (np.arange(RADII) + 1) / RADII
    turn = np.linspace(0, 2 * np.pi, DIRECTIONS, endpoint=False)
    ring = np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    good = (robot.margin(radii[:, None, None] * ring) >= LEAST_MARGIN).all(axis=1)
    count = RADII if good.all() else int(good.argmin())
    return float(radii[count - 1]) if count else 0.0
