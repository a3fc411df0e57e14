"""Comparison of the numbers in a lesson's text with the simulated motion, every millisecond.

The numbers are read from the text, so that text and physics cannot diverge: `said` finds a
sentence in which each # stands for a number; `agrees` compares the digits that are written.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from onpath.app.lab.commands.scripts import player_of
from onpath.app.lab.lab import Lab
from onpath.app.lab.setups.setup import Path, RobotSetup, Setup
from onpath.app.lab.setups.step_setup import setup_of
from onpath.lessons.action_schema import Action, RobotName, Script, Value
from onpath.lessons.behaviour.marks import take_behaviours
from onpath.lessons.course import BUILT_IN
from onpath.lessons.measures.stated import take_stated
from onpath.lessons.parse import read_lesson
from onpath.lessons.schema import Lesson
from onpath.lessons.sides import ROLES
from onpath.models.arrays import Array
from onpath.models.closed_loop.trajectory import Trajectory
from tests.support.checkout import ROOT
from tests.support.lab import loop_cache, replayed, run

READMES = (ROOT / "README.md", ROOT / "models" / "studies" / "README.md")
NUMBER = r"([−-]?\d+(?:[.,]\d+)?)"


def text(lesson: str, language: str = "en") -> str:
    """Full text of a lesson, by its number, such as "01", with plain numbers."""
    (home,) = BUILT_IN.glob(f"{lesson}-*")
    marked = (home / f"{language}.md").read_text(encoding="utf-8")
    return take_behaviours(take_stated(marked, print)[0], print)[0]


def numbers(part: str) -> list[float]:
    """All numbers in a text, in order."""
    return [value(found) for found in re.findall(NUMBER, part.replace("{,}", ","))]


def said(lesson: str, sentence: str) -> list[str]:
    """The numbers of a sentence as they are written; spaces also match line breaks.

    Args:
        lesson: number of the lesson, such as "01".
        sentence: the text, with # for each number.
    """
    pattern = NUMBER.join(map(re.escape, sentence.split("#")))
    found = re.findall(pattern, " ".join(text(lesson).split()))
    assert len(found) == 1, f"{len(found)} times in lesson {lesson}: {sentence}"
    return [found[0]] if isinstance(found[0], str) else list(found[0])


def stated_in_readme(sentence: str) -> list[str]:
    """As `said`, of the README and of that of the studies."""
    text = " ".join(" ".join(file.read_text(encoding="utf-8") for file in READMES).split())
    found = re.findall(NUMBER.join(map(re.escape, sentence.split("#"))), text)
    assert len(found) == 1, f"{len(found)} times: {sentence}"
    return [found[0]] if isinstance(found[0], str) else list(found[0])


def value(text: str) -> float:
    """Value of a number as it is written."""
    return float(text.replace("−", "-").replace(",", "."))


def agrees(text: str, measured: float) -> bool:
    """Whether a measured value equals the written one when rounded to the same digits."""
    digits = len(re.split("[.,]", text)[1]) if re.search("[.,]", text) else 0
    return abs(measured - value(text)) <= 0.5 * 10.0**-digits + 1e-9


def assert_stated(texts: list[str], measured: list[float]) -> None:
    """Assert that all numbers agree with the measured ones, in order."""
    wrong = [(t, m) for t, m in zip(texts, measured, strict=True) if not agrees(t, m)]
    assert not wrong, wrong


@dataclass(frozen=True, slots=True, eq=False)
class Motion:
    """The motion of one robot, every millisecond, in mm, N m, N, rad and s."""

    t: Array
    distance: Array
    across: Array
    place: Array
    reference: Array
    rate: Array
    speed: Array
    torques: Array
    force: Array
    y: Array

    @property
    def torque(self) -> Array:
        """The larger one of the motors' torques, without sign."""
        return self.torques.max(axis=1)

    def during(self, begin: float, end: float) -> slice:
        """The rows between two instants, [s]."""
        return slice(*np.searchsorted(self.t, (begin - 1e-9, end - 1e-9)))

    def largest(self, begin: float, end: float) -> float:
        """Largest distance between two instants, [mm]."""
        return float(self.distance[self.during(begin, end)].max())

    def at(self, time: float, quantity: str = "distance") -> float:
        """Value of a quantity at an instant, [s]."""
        return float(getattr(self, quantity)[self.during(time, time + 1)][0])


Run = dict[RobotName, Motion]
WORST = 3 + 25 / 36  # [s], the brake then catches the follower at 214 degrees


def play(until: float, do: list[Action], path: str = "", left: str = "", **settings: Value) -> Run:
    """Simulate both robots with the lab's defaults except for some settings, and a law."""
    lab = Lab(loop_cache())
    own = RobotSetup(settings, Path(path or Path().name))
    lab.set_up(Setup("five_bar", {"five_bar": own}, laws={"left": left} if left else {}))
    return _played(lab, Script(tuple(do), until))


def held(at: float, seconds: float = 2.0, robot: RobotName = "follower", **gains: Any) -> Motion:
    """Motion of a robot that follows the circle and is held back from `at` to the end."""
    return play(at + seconds, [Action(at=at, hold=True)], **gains)[robot]


def pulled(right: float, up: float = 0.0, robot: RobotName = "follower", **gains: Any) -> Motion:
    """Motion of a robot that rests at the right-hand end and is pulled from 1 s on."""
    return play(4.0, [Action(at=1.0, pull=(right, up))], speed=0.0, **gains)[robot]


@cache
def shown(lesson: str, title: str) -> Run:
    """Motion in a step of a lesson that has a script."""
    (home,) = BUILT_IN.glob(f"{lesson}-*")
    parsed: Lesson = read_lesson(home / "en.md")
    for index, step in enumerate(parsed.steps):
        if step.title == title and step.script is not None:
            lab = Lab(loop_cache())
            lab.set_up(setup_of(parsed, index))
            return _played(lab, step.script)
    raise AssertionError(f"lesson {lesson} shows no {title!r}")


def _played(lab: Lab, script: Script) -> Run:
    lab.script, lab.simulation.running = player_of(script), True
    while lab.script is not None:
        run(lab, 0.1)
    return {ROLES[side]: _motion(each) for side, each in replayed(lab.simulation).items()}


def _motion(run: Trajectory) -> Motion:
    fields = run.fields
    return Motion(
        t=run.t,
        distance=run.distance * 1e3,
        across=fields["xi"][:, 0] * 1e3,
        place=fields["theta"][:, 0],
        reference=fields["theta_ref"][:, 0],
        rate=fields["theta_rate"][:, 0],
        speed=run.speed * 1e3,
        torques=np.abs(fields["u"]),
        force=np.linalg.norm(fields["force"], axis=1),
        y=fields["y"] * 1e3,
    )
