"""The start of a run, which is computed once for all labs that begin at the same place."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from onpath.models.closed_loop.loop_vectors import loop_layouts
from onpath.models.closed_loop.simulation import FREE, Push, kind_of, settings_vector
from onpath.models.closed_loop.start import Start, start_state
from onpath.models.paths.path_design import presets
from onpath.models.systems.catalogue import FIVE_BAR

LAWS = st.sampled_from(["path_following", "trajectory_tracking"])
CURVE = presets(FIVE_BAR.radius)["circle"].curve


@given(st.floats(-1, 1), st.floats(0.5, 2), LAWS)
def test_who_changes_a_start_changes_nobody_elses(theta: float, K1: float, law: str) -> None:
    parameters = FIVE_BAR.parameters(K1=K1)
    robot, kind = FIVE_BAR.make(parameters), kind_of(law, parameters, CURVE)
    layouts = loop_layouts(robot.system, kind)
    wall = np.zeros(2), np.array([1.0, 0.0])
    for push in (FREE, Push(wall=wall)):
        for make in (
            lambda: start_state(robot, layouts, CURVE, parameters, Start(theta)),
            lambda push=push: settings_vector(robot, layouts, parameters, CURVE, push),
        ):
            first = make()
            kept = first.copy()
            first += 1.0
            np.testing.assert_array_equal(make(), kept)
    free = settings_vector(robot, layouts, parameters, CURVE, FREE)
    walled = settings_vector(robot, layouts, parameters, CURVE, Push(wall=wall))
    before, after = layouts.settings.unpack(free), layouts.settings.unpack(walled)
    changed = {name for name in before if not np.array_equal(before[name], after[name])}
    assert changed == {"wall_active", "wall_normal"}
