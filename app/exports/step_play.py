"""Plays a step of a lesson without a browser, and puts what happened into numbers."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from onpath.app.lab.course_check import lab_at, play
from onpath.app.lab.lesson_record import Beginning, record_of
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.session import Session
from onpath.lessons.action_schema import RobotName, Script
from onpath.lessons.checks import Verdict
from onpath.lessons.record import ROBOTS
from onpath.lessons.schema import Lesson, Step
from onpath.lessons.step_numbers import ScriptPart, parts_of
from onpath.lessons.task_schema import Task
from onpath.models.arrays import Array


@dataclass(frozen=True, slots=True)
class PlayedScript:
    """A run of a script in a step.

    Attributes:
        title: "script", or the task's id and "solution" or "failure".
        parts: see `parts_of`.
        verdicts: on the task's checks at the end.
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
    store: LoopCache,
    task: Task | None = None,
) -> PlayedScript:
    """Play a script in a lab that is set up for a step.

    Raises:
        ValueError: the lab refuses a command of the script; the message says why.
    """
    lab = lab_at(lesson, step, store)
    samples, last, passed = Samples(lab.session), list[Verdict](), False
    for last in play(lab, script, task):
        passed |= bool(last) and all(verdict.passed for verdict in last)
        samples.follow(lab.session)
    return PlayedScript(title, script, parts_of(script, *samples.columns()), last, passed)


class Samples:
    """All quantities of both robots at every frame of a script, as the checks of a task read them.

    Times go on through resets.
    """

    def __init__(self, session: Session) -> None:
        self._run, self._before, self._until = session.run_number, 0.0, session.time
        self._times = list[Array]()
        self._values = list[dict[RobotName, dict[str, Array]]]()

    def follow(self, session: Session) -> None:
        """Add what has happened since the last call."""
        if session.run_number != self._run:
            self._before += self._until
            self._run, self._until = session.run_number, 0.0
        record = record_of(session, Beginning(self._run, self._until))
        new = slice(int(np.searchsorted(record.times, self._until - 1e-9)), None)
        if len(record.times[new]):
            self._times.append(record.times[new] + self._before)
            self._values.append(
                {r: {q: c[new] for q, c in own.items()} for r, own in record.values.items()}
            )
        self._until = session.time

    def columns(self) -> tuple[Array, dict[RobotName, dict[str, Array]]]:
        """Times, shape (n,), and values by robot and quantity, NaN where there was none."""
        times = np.concatenate([*self._times, np.zeros(0)])
        values: dict[RobotName, dict[str, Array]] = {robot: {} for robot in ROBOTS}
        for robot in ROBOTS:
            names = dict.fromkeys(name for piece in self._values for name in piece[robot])
            for name in names:
                columns = [
                    piece[robot].get(name, np.full(len(own), np.nan))
                    for own, piece in zip(self._times, self._values, strict=True)
                ]
                values[robot][name] = np.concatenate(columns)
        return times, values
