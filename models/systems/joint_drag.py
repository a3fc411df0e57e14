"""Where a joint goes when its link is dragged: its end comes as near to the hand as it can."""

from __future__ import annotations

from functools import lru_cache

import casadi as ca
import numpy as np

from onpath.models.arrays import Array
from onpath.models.systems.rigid_chain import ChainSource, chain_frames, tip_of

TRIED, ROUNDS = 181, 3
"""Values of a joint that are tried at once, and how often, each time about the best one."""
SLIDES = 1.0  # [m] to either side, of a joint without limits; one that turns makes half a turn


def dragged_joint(source: ChainSource, q: Array, joint: int, target: Array) -> Array:
    """The configuration in which one joint has brought its body's end nearest to a target, (n,).

    The end of a body is the origin of the next one; of a body whose end is at its own joint, and of
    the last one, it is the end-point.

    Args:
        q: configuration, shape (n,); the other joints stay.
        joint: number of the joint, from 0.
        target: in the coordinates of the output, shape (p,), [m].
    """
    at = source.chain.joints[joint]
    around = SLIDES if at.slides else np.pi
    low = at.low if np.isfinite(at.low) else q[joint] - around
    high = at.high if np.isfinite(at.high) else q[joint] + around
    best, ends = float(np.clip(q[joint], low, high)), _ends(source)
    for _ in range(ROUNDS):
        values = np.append(np.linspace(low, high, TRIED), best)
        tried = np.repeat(q[:, None], len(values), axis=1)
        tried[joint] = values
        reached = np.array(ends(tried)).reshape(source.chain.n, len(target), len(values))[joint]
        away = np.linalg.norm(reached - target[:, None], axis=0)
        width, best = (high - low) / (TRIED - 1), float(values[away.argmin()])
        low, high = max(low, best - width), min(high, best + width)
    result = q.copy()
    result[joint] = best
    return result


@lru_cache(maxsize=64)
def _ends(source: ChainSource) -> ca.Function:
    """q -> ends of the bodies in the output's coordinates, one below the other, (n p, 1)."""
    chain = source.chain
    q = ca.SX.sym("q", chain.n)
    home = tip_of(chain, chain_frames(chain, ca.SX(ca.DM(source.home))))
    frames = chain_frames(chain, q)
    tip = tip_of(chain, frames)
    nexts = [
        frames.origins[i + 1] if i + 1 < chain.n and chain.bodies[i + 1].translation.any() else tip
        for i in range(chain.n)
    ]
    points = [ca.DM(source.axes) @ (point - home) for point in nexts]
    return ca.Function("ends", [q], [ca.densify(ca.vertcat(*points))])
