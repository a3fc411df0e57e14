"""A step that is prepared has its loops before a class is taken there."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from onpath.app.lab.commands import TakeStep
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.built_in_course import built_in_course
from onpath.app.server.lab_registry import LabRegistry
from onpath.app.server.new_lab import new_lab
from onpath.app.server.step_loops import StepLoops
from onpath.app.simulation.simulation_thread import SimulationThread
from tests.support.waiting import wait_for

COURSE = built_in_course()


class Translated:
    """Stands for a compiled loop."""


@pytest.mark.parametrize("lesson", [*COURSE.lessons][:2])
def test_no_student_waits_for_the_loops_of_a_step_that_the_teacher_has_looked_at(
    lesson: str,
) -> None:
    translated: Any = Translated()
    cache = LoopCache(translate=lambda _: translated)
    registry = LabRegistry(SimulationThread(), lambda: new_lab(cache, COURSE))
    loops, step = StepLoops(registry), TakeStep(lesson, 1)
    lab = registry.unowned_lab().lab
    step.apply(lab)
    keys = [
        (run.robot, replace(run.kind, free=free))
        for run in lab.simulation.runs.values()
        for free in (True, False)
    ]
    assert all(cache.find(*key) is None for key in keys)
    loops.prepare(step)
    wait_for(lambda: all(cache.find(*key) is translated for key in keys), 60.0)
    loops.close()
    cache.close()
