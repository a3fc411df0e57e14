"""How robots are seen before their picture is there."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from onpath.app.scene.projection import seen_at_first
from onpath.app.scene.stage_catalogue import stage_of
from onpath.app.server.first_projection import FirstProjection
from onpath.models.systems.catalogue import ROBOTS


def test_a_view_is_found_in_another_thread_and_only_the_last_one_counts() -> None:
    waiting = list[Callable[[], None]]()
    view = FirstProjection(waiting.append)
    robots = [kind.make(kind.parameters()) for kind in ROBOTS.values()]
    assert view.of(robots[0]) is None and view.of(robots[0]) is None
    assert len(waiting) == 1
    waiting.pop()()
    for before, late, robot in zip(robots, robots[1:], robots[2:], strict=False):
        shown = view.of(before)
        while waiting:
            waiting.pop(0)()
        shown = view.of(before)
        assert view.of(late) is shown and view.of(robot) is shown
        waiting.pop(0)()
        assert view.of(robot) is shown  # what is no longer asked for does not count
        waiting.pop(0)()
        seen, expected = view.of(robot), seen_at_first(stage_of(robot), robot)
        assert seen is not None and np.array_equal(seen.cameras, expected.cameras)
