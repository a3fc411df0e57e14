"""What really happens in a step that asks for a prediction, computed without a student's lab."""

from __future__ import annotations

from onpath.app.lab.dry_runs.course_check import lab_at, play
from onpath.app.lab.lesson_record import Beginning, Trace
from onpath.app.lab.lesson_run import quantity_of
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.lessons.progress import Truth
from onpath.lessons.schema import Lesson, Step
from onpath.models.closed_loop.loops import InterpretedLoop


def computed_truth(lesson: Lesson, index: int) -> Truth | None:
    """Play the demonstration that answers the prediction of step `index`, and record it.

    Returns None if the lesson has no such demonstration, or it cannot be played.
    """
    predictions, shown = lesson.steps[index].predictions(), _shown(lesson, index)
    if not predictions or shown is None or shown.script is None:
        return None
    loop_cache = LoopCache(at_once=True, translate=InterpretedLoop)  # compiling is not worth it
    lab = lab_at(lesson, shown, loop_cache)
    trace = Trace(quantity_of(predictions[0]), Beginning.now(lab.simulation))
    try:
        for _ in play(lab, shown.script):
            trace.follow(lab.simulation)
    except ValueError:
        return None
    return trace.truth()


def _shown(lesson: Lesson, index: int) -> Step | None:
    """The step that shows the outcome: the one that asks, or the next if it is a demonstration."""
    candidates = [lesson.steps[index], *lesson.steps[index + 1 : index + 2]]
    for step in candidates:
        if step.script is not None and (step is candidates[0] or step.kind == "run"):
            return step
    return None
