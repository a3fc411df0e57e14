"""All loops of a kernel are the same loop, to the last bit."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loops import BLOCK, SHORT, InterpretedLoop, Loop
from onpath.models.control.laws.registry import NAMES
from onpath.models.paths.curves import Curve, chebyshev_curve, circle
from tests.support.rig import FOLLOWING, Rig

KINDS = [
    Kind(law, closed, level_set, encoder, free)
    for law in NAMES
    for closed, level_set in ((True, False), (True, True), (False, False))
    for encoder in (False, True)
    for free in (False, True)
]
KINDS += [
    Kind(law, encoder=True, delay=True, noise=True, observer=True)
    for law in ("path_following", "trajectory_tracking")
]


@pytest.mark.parametrize("kind", KINDS, ids=repr)
def test_loops_agree(rig: Rig, random_curve: Callable[[int], Curve], kind: Kind) -> None:
    bent = chebyshev_curve(np.array([[0.0, 0.0], [0.05, 0.0], [0.0, 0.02], [0.0, 0.01]]))
    curve = (circle(0.05) if kind.level_set else random_curve(4)) if kind.closed else bent
    start = rig.on_path(kind, curve, -1.0, 2.0)
    changes = {"K3": 20, "hand_active": 1, "hand_target": (0.03, 0.03), "coulomb": 0.01}
    settings = rig.settings(kind, plant=rig.spoiled, speed=2.0, hold_ticks=2, **changes)
    loops = InterpretedLoop(rig.kernel(kind)), rig.loop(kind)
    results = [loop.run(start, settings, curve.table(), 1000) for loop in loops]
    for interpreted, compiled in zip(*results, strict=True):
        assert np.array_equal(interpreted, compiled)
    assert np.ptp(results[0][1], axis=0).max() > 0.1


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind.free], ids=repr)
def test_the_lean_loop_computes_the_same_while_nothing_acts(
    rig: Rig, random_curve: Callable[[int], Curve], kind: Kind
) -> None:
    bent = chebyshev_curve(np.array([[0.0, 0.0], [0.05, 0.0], [0.0, 0.02], [0.0, 0.01]]))
    curve = (circle(0.05) if kind.level_set else random_curve(4)) if kind.closed else bent
    start = rig.on_path(kind, curve, -1.0, 2.0)
    settings = rig.settings(kind, plant=rig.spoiled, speed=2.0, K3=20)
    lean, whole = (
        InterpretedLoop(rig.kernel(k)).run(start, settings, curve.table(), 1000)
        for k in (kind, replace(kind, free=False))
    )
    for one, other in zip(lean, whole, strict=True):
        assert np.abs(one - other).max() < 1e-11
    pushed = rig.settings(kind, hand_active=1, hand_target=(0.03, 0.03))
    moved = InterpretedLoop(rig.kernel(replace(kind, free=False)))
    assert np.abs(moved.run(start, pushed, curve.table(), 1000)[0] - whole[0]).max() > 1e-3


def every_loop(rig: Rig) -> tuple[Loop, ...]:
    return InterpretedLoop(rig.kernel(FOLLOWING)), rig.loop(FOLLOWING)


@pytest.mark.parametrize("ticks", [0, 1, BLOCK - 1, BLOCK, 2 * BLOCK + 3])
def test_any_number_of_ticks(rig: Rig, ticks: int) -> None:
    start, settings = rig.state(FOLLOWING, np.array([0.06, 0.0])), rig.settings(FOLLOWING)
    given = start.copy()
    for loop in every_loop(rig):
        state, rows = loop.run(start, settings, circle(0.05).table(), ticks)
        assert rows.shape == (ticks, loop.layouts.log.size) and state.shape == start.shape
        assert np.array_equal(start, given)
        q = loop.layouts.log.unpack(rows)["q"]
        assert ticks < 2 or not np.array_equal(q[0], q[-1])
        assert ticks > 0 or np.array_equal(state, start)


def test_results_are_not_overwritten_by_the_next_call(rig: Rig) -> None:
    start, settings = rig.state(FOLLOWING, np.array([0.06, 0.0])), rig.settings(FOLLOWING)
    for loop in every_loop(rig):
        state, rows = loop.run(start, settings, circle(0.05).table(), BLOCK)
        kept = state.copy(), rows.copy()
        loop.run(state, settings, circle(0.05).table(), BLOCK)
        assert np.array_equal(state, kept[0]) and np.array_equal(rows, kept[1])


def test_many_robots_are_each_as_alone(rig: Rig, random_curve: Callable[[int], Curve]) -> None:
    starts = [rig.state(FOLLOWING, np.array([0.01 * k, 0.0])) for k in range(1, 6)]
    settings = [rig.settings(FOLLOWING, K1=100.0 * k, speed=0.5 * k) for k in range(1, 6)]
    tables = [random_curve(k).table() for k in range(1, 6)]
    given = [start.copy() for start in starts]
    for loop in every_loop(rig):
        for ticks in (BLOCK + 1, SHORT):  # the second releases the interpreter's lock
            states, rows = loop.run_many(starts, settings, tables, ticks)
            assert rows.shape == (5, ticks, loop.layouts.log.size)
            for i, inputs in enumerate(zip(starts, settings, tables, strict=True)):
                state, own = loop.run(*inputs, ticks)
                assert np.array_equal(states[i], state) and np.array_equal(rows[i], own)
        assert np.array_equal(starts, given)


def test_a_vector_of_another_size_is_refused(rig: Rig) -> None:
    start, settings = rig.state(FOLLOWING, np.array([0.06, 0.0])), rig.settings(FOLLOWING)
    with pytest.raises(ValueError, match="reshape"):
        rig.loop(FOLLOWING).run(start, settings[:-1], circle(0.05).table(), 1)
