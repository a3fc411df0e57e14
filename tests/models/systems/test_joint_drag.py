"""A dragged joint brings the end of its link to the hand, and moves nothing else."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.lab.commands import DragJoint
from onpath.app.lab.lab import Lab
from onpath.models.errors import CodedError
from onpath.models.systems.catalogue import ROBOTS, robot_named
from onpath.models.systems.joint_drag import _ends, dragged_joint
from tests.support.lab import loop_cache

CHAINS = [name for name, entry in ROBOTS.items() if entry.source is not None]


@settings(deadline=None, max_examples=60)
@given(st.sampled_from(CHAINS), st.randoms(use_true_random=False))
def test_the_end_of_the_link_comes_to_the_hand(name: str, draw: object) -> None:
    source = robot_named(name).source
    assert source is not None
    rng = np.random.default_rng(draw.getrandbits(32))  # type: ignore[attr-defined]
    n, p = source.chain.n, len(source.axes)
    low, high = (np.clip(ends, -np.pi, np.pi) for ends in source.chain.limits)
    q, there = rng.uniform(low, high), rng.uniform(low, high)
    joint = int(rng.integers(n))
    wanted = np.where(np.arange(n) == joint, there, q)

    def end(at: np.ndarray) -> np.ndarray:
        return np.array(_ends(source)(at)).reshape(n, p)[joint]

    found = dragged_joint(source, q, joint, end(wanted))
    assert np.linalg.norm(end(found) - end(wanted)) < 1e-4
    assert (np.delete(found, joint) == np.delete(q, joint)).all()
    assert (found >= source.chain.limits[0]).all() and (found <= source.chain.limits[1]).all()


def test_a_joint_that_is_dragged_moves_the_start_and_a_wrong_one_is_refused() -> None:
    lab = Lab(loop_cache(), robot_named("planar_arm"))
    before = lab.simulation.start
    DragJoint(2, np.array([0.06, 0.03])).apply(lab)
    assert lab.simulation.start != before
    for joint in (-1, 3, 10**9):
        with pytest.raises(CodedError):
            DragJoint(joint, np.zeros(2)).apply(lab)
    for target in (np.full(2, np.nan), np.zeros(3)):
        with pytest.raises(ValueError):
            DragJoint(0, target).apply(lab)
    with pytest.raises(CodedError):
        DragJoint(0, np.zeros(2)).apply(Lab(loop_cache()))
