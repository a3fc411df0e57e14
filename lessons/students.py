"""Students who do not think, for `onpath lessons check --cheat`.

They do what a task's solution does, except that they turn the controls that the step shows without
a reason: to their ends, at random, by the step's links, or as the hints say. A task that they pass
measures how far a slider reaches, not what was understood.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from itertools import combinations, product
from zlib import crc32

import numpy as np
from msgspec.structs import replace

from onpath.lessons.action_schema import Action, Script, Value
from onpath.lessons.cheating import LEAST
from onpath.lessons.labels import setting_label
from onpath.lessons.safe_html import safe
from onpath.lessons.schema import Lesson, Text
from onpath.lessons.task_schema import Only, Setting, Task
from onpath.lessons.words import Words
from onpath.models.control.settable import specs
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameter_specs import MINUS, Spec

STUDENTS = 100
"""Students of a task who draw at random."""
MOST_PASS = 10
"""How many of them may pass."""
GROUPS = {"flexible": ("output", "alpha")}
"""Parameters that a step shows under one name."""
POINTS = 8
"""Control points of a preset path, of which a student moves any."""
REACH = 60.0
"""Largest displacement of a control point or of a hand, [mm]."""
HELD = (0.3, 4.0)
"""Shortest and longest hold or pull, [s]."""


class Controls:
    """The parameters that a student can turn at a task.

    Attributes:
        fixed: those to which a check of the task gives a value, which the student reads.
        free: the others, as far as an `Only` allows them.
    """

    def __init__(self, lesson: Lesson, index: int, task: Task) -> None:
        setup = lesson.setup_at(index)
        known = specs(ROBOTS[setup.robot or lesson.front.robot].parameters)
        only = [check.names for check in task.check if isinstance(check, Only)]
        shown = [each for name in setup.controls for each in GROUPS.get(name, (name,))]
        names = [name for name in shown if name in known and all(name in each for each in only)]
        settings = [check for check in task.check if isinstance(check, Setting)]
        wanted = {check.name: check.equals for check in settings if check.equals is not None}
        self.fixed: dict[str, Value] = {name: wanted[name] for name in names if name in wanted}
        self.free: dict[str, Spec] = {name: known[name] for name in names if name not in wanted}


def thoughtless(
    lesson: Lesson, index: int, task: Task, solution: Script
) -> Iterator[tuple[str, Script]]:
    """What nobody passes a task with who has understood nothing, each in words."""
    controls = Controls(lesson, index, task)
    if any(action.what == "set" for action in solution.do):
        for words, values in (*_turned(controls), *_hinted(lesson, index, task)):
            yield words, _with_settings(solution, {**controls.fixed, **values})
    yield from _pressed(lesson, index, solution)


def random_students(
    lesson: Lesson, index: int, task: Task, solution: Script, count: int = STUDENTS
) -> Iterator[Script]:
    """Students who draw what they do, always the same for a task.

    Where the solution sets something, all controls are drawn uniformly; where it moves a control
    point, any one goes anywhere. If it does neither, its holds and pulls are drawn.
    """
    controls = Controls(lesson, index, task)
    random = np.random.default_rng(crc32(f"{lesson.name}/{task.id}".encode()))
    turns = any(action.what in ("set", "move") for action in solution.do)
    for _ in range(count):
        yield _turns(controls, solution, random) if turns else _handles(solution, random)


def _with_settings(solution: Script, values: Mapping[str, Value]) -> Script:
    """A solution with other settings in place of its own, from its first one on."""
    at = min(action.at for action in solution.do if action.what == "set")
    others = tuple(action for action in solution.do if action.what != "set")
    return replace(solution, do=(Action(at=at, set=dict(values)), *others))


def _turned(controls: Controls) -> Iterator[tuple[str, dict[str, Value]]]:
    """All sliders at one end, and one or two of them at any end."""
    ends = {n: (float(s.low), float(s.high)) for n, s in controls.free.items() if not s.options}
    for end, words in enumerate(("least", "largest")):
        yield f"all sliders at their {words}", {name: both[end] for name, both in ends.items()}
    for count in (1, 2):
        for names in combinations(ends, count):
            for chosen in product(*(ends[name] for name in names)):
                values = dict[str, Value](zip(names, chosen, strict=True))
                yield " and ".join(f"{name} = {value:g}" for name, value in values.items()), values


def _hinted(lesson: Lesson, index: int, task: Task) -> Iterator[tuple[str, dict[str, Value]]]:
    """The settings that each hint names, and those of all hints together."""
    setup = lesson.setup_at(index)
    parameters = ROBOTS[setup.robot or lesson.front.robot].parameters()
    words, every = Words(lesson.language), dict[str, Value]()
    for number, hint in enumerate(task.hints, 1):
        text = safe(hint).striptags().replace(MINUS, "-")
        values = dict[str, Value]()
        for name, spec in specs(parameters).items():
            labels = {name, setting_label(name, parameters, words)}
            label = "|".join(map(re.escape, labels))
            value = rf"(?<!\w)(?:{label})\s*(?:=|to|auf)?\s*(-?\d+(?:[.,]\d+)?)"
            if not spec.options and (found := re.search(value, text)):
                values[name] = float(found[1].replace(",", "."))
        if values:
            yield f"hint {number}", values
        every |= values
    if every:
        yield "all hints", every


def _pressed(lesson: Lesson, index: int, solution: Script) -> Iterator[tuple[str, Script]]:
    """One or two links of the step, with what the solution does besides its settings, or not."""
    blocks = lesson.steps[index].blocks
    links = [link for block in blocks if isinstance(block, Text) for link in block.links]
    bare = tuple(action for action in solution.do if action.what not in ("set", "move"))
    for pressed in (pair for count in (1, 2) for pair in combinations(links, count)):
        acts = [replace(act, at=0.1 * i) for i, link in enumerate(pressed) for act in link.actions]
        words = " and ".join(f"link {link.label!r}" for link in pressed)
        until = max(solution.until, LEAST)
        yield f"{words} and nothing else", Script(tuple(acts), until)
        if bare:
            yield f"{words} and the rest of the solution", Script((*acts, *bare), until)


def _turns(controls: Controls, solution: Script, random: np.random.Generator) -> Script:
    """A solution with drawn settings and moves; a control that it sets again is drawn again."""
    drawn, names = list[Action](), list(controls.free)
    for action in solution.do:
        if action.what == "set":
            values = {name: _any(controls.free[name], random) for name in names}
            drawn.append(replace(action, set={**controls.fixed, **values}))
            names = [name for name in action.set or {} if name in controls.free]
        elif action.what == "move":
            point = int(random.integers(POINTS))
            drawn.append(replace(action, move=(point, *_displacement(random))))
        else:
            drawn.append(action)
    return replace(solution, do=tuple(drawn))


def _handles(solution: Script, random: np.random.Generator) -> Script:
    """A solution whose holds and pulls last as long as they happen to, and pull anywhere."""
    drawn, now, before = list[Action](), 0.0, 0.0
    for action in solution.do:
        ends = action.what == "release" or action.hold is False
        now += float(random.uniform(*HELD)) if ends else action.at - before
        before = action.at
        pull = None if action.pull is None else _displacement(random)
        drawn.append(replace(action, at=now, pull=pull))
    return Script(tuple(drawn), now + solution.until - before)


def _displacement(random: np.random.Generator) -> tuple[float, float]:
    length, angle = random.uniform(0, REACH), random.uniform(-np.pi, np.pi)
    return float(length * np.cos(angle)), float(length * np.sin(angle))


def _any(spec: Spec, random: np.random.Generator) -> Value:
    """Any value at which a slider or a menu can stand."""
    if spec.options:
        return spec.options[int(random.integers(len(spec.options)))]
    steps = round((spec.high - spec.low) / spec.step)
    return min(spec.low + spec.step * int(random.integers(steps + 1)), float(spec.high))
