"""Plays a step of a lesson without a browser, and puts the result into numbers."""

from __future__ import annotations

from dataclasses import dataclass, field

from onpath.app.lab.dry_runs.course_check import lab_at, play
from onpath.app.lab.dry_runs.run_samples import Samples
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.lessons.action_schema import Script
from onpath.lessons.checks import Verdict
from onpath.lessons.schema import Lesson, Step
from onpath.lessons.step_numbers import ScriptPart, parts_of
from onpath.lessons.task_schema import Task


@dataclass(frozen=True, slots=True)
class PlayedScript:
    """A run of a script in a step.

    Attributes:
        title: "script", or the task's id and "solution" or "failure".
        parts: see `parts_of`.
        verdicts: verdicts on the task's checks at the end.
        passed: whether the task was passed at any time.
    """

    title: str
    script: Script
    parts: list[ScriptPart]
    verdicts: list[Verdict] = field(default_factory=list[Verdict])
    passed: bool = False


def play_script(
    lesson: Lesson,
    step: Step,
    title: str,
    script: Script,
    loop_cache: LoopCache,
    task: Task | None = None,
) -> PlayedScript:
    """Play a script in a lab that is set up for a step.

    Raises:
        ValueError: the lab refuses a command of the script; the message says why.
    """
    lab = lab_at(lesson, step, loop_cache)
    samples, last, passed = Samples(lab.simulation), list[Verdict](), False
    for last in play(lab, script, task):
        passed |= bool(last) and all(verdict.passed for verdict in last)
        samples.follow(lab.simulation)
    return PlayedScript(
        title=title,
        script=script,
        parts=parts_of(script, *samples.columns()),
        verdicts=last,
        passed=passed,
    )
