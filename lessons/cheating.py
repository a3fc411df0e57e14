"""Ways to pass a task without what it asks, which `onpath lessons check --cheat` tries.

A task asks for what its reference solution does. A cheat leaves that out, and uses one other
control instead: on request, the lab shows all of them in any step.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from msgspec.structs import replace

from onpath.lessons.action_schema import Action, Laws, RunStart, Script, Value
from onpath.lessons.schema import Lesson
from onpath.lessons.task_schema import Only, Reference, Task
from onpath.lessons.vocabulary.names import one_of
from onpath.models.control.laws.registry import LAWS
from onpath.models.control.settable import specs
from onpath.models.control.sides import SIDES
from onpath.models.paths.path_design import presets
from onpath.models.systems.catalogue import ROBOTS, RobotEntry
from onpath.models.systems.parameter_specs import Spec

LEAST = 8.0
"""Shortest time that a cheat is given, [s]."""
HOLD = (Action(at=1.5, hold=True), Action(at=5.0, hold=False))
"""The brake, for longer than any task of the course asks."""
DONE = ("hold", "pull", "move", "path", "identify", "laws")
"""What a solution does, besides settings, and without which it must not pass."""
OTHERS = ("path", "laws", "start", "settings")
"""Names of controls other than parameters; "settings": a solution without them."""
STARTS = {
    "start across": RunStart(across=10.0),
    "start lead": RunStart(lead=3.14),
    "start place": RunStart(place=3.14),
    "start speed": RunStart(speed=500.0),
}


@dataclass(frozen=True, slots=True)
class Cheat:
    """One attempt.

    Attributes:
        control: what it uses; a solution that uses it, or an author who declares it in
            `Reference.fair`, makes it no cheat.
        words: what it does.
        script: the same, for the lab.
    """

    control: str
    words: str
    script: Script


def cheats(lesson: Lesson, index: int, task: Task, reference: Reference) -> list[Cheat]:
    """All cheats at a task of a step but those that are declared fair, or cannot pass an `Only`."""
    scene = lesson.scene_at(index)
    entry = ROBOTS[scene.robot or lesson.front.robot]
    solution = reference.solution
    others = [each for each in _with_another_control(solution, entry) if _may_pass(each, task)]
    tried = [*others, *_otherwise(solution, entry)]
    return [cheat for cheat in tried if cheat.control not in reference.fair]


def _may_pass(cheat: Cheat, task: Task) -> bool:
    """Whether no check forbids the control of a cheat."""
    if cheat.control == "settings":
        return True
    names = SIDES if cheat.control == "laws" else (cheat.control,)
    only = [check.names for check in task.check if isinstance(check, Only)]
    return all(set(names) & set(allowed) for allowed in only)


def fair_faults(reference: Reference, entry: RobotEntry) -> Iterator[str]:
    """The names in `Reference.fair` that no cheat has."""
    for name in reference.fair:
        yield from one_of(name, [*specs(entry.parameters), *OTHERS, *DONE], "control")


def _with_another_control(solution: Script, entry: RobotEntry) -> Iterator[Cheat]:
    """Another control than those of a solution, with and without what it does besides settings."""
    until = max(solution.until, LEAST)
    settings = {name for action in solution.do for name in action.set or {}}
    used = {action.what for action in solution.do} | settings
    bare = tuple(action for action in solution.do if action.what != "set")
    ways: dict[str, tuple[Action, ...]] = {"nothing else": ()}
    if settings and bare:
        ways["the rest of the solution"] = bare
        yield Cheat("settings", "nothing set, and the rest of the solution", Script(bare, until))
    if "hold" not in used:
        ways["a hold"] = HOLD
    for control, words, action in _controls(entry):
        for way, rest in ways.items() if control not in used else ():
            yield Cheat(control, f"{words} and {way}", Script((action, *rest), until))


def _controls(entry: RobotEntry) -> Iterator[tuple[str, str, Action]]:
    """Every control at its extremes: its name, what is done with it, and the action."""
    for name, spec in specs(entry.parameters).items():
        for value in _extremes(spec):
            yield name, f"{name} = {value}", Action(set={name: value})
    for name in presets():
        yield "path", f"path = {name}", Action(path=name)
    for name in LAWS:
        for side in SIDES:
            yield "laws", f"{side} = {name}", Action(laws=Laws(**{side: name}))
    for words, start in STARTS.items():
        yield "start", words, Action(start=start)


def _extremes(spec: Spec) -> tuple[Value, ...]:
    """The options of a choice; of a number the ends of its range, and 0."""
    if spec.options:
        return spec.options
    zero = (0.0,) if spec.low < 0.0 < spec.high else ()
    return (float(spec.low), *zero, float(spec.high))


def _otherwise(solution: Script, entry: RobotEntry) -> Iterator[Cheat]:
    """A solution without one kind of action, with a preset path, or with another option."""
    for what in dict.fromkeys(action.what for action in solution.do if action.what in DONE):
        others = tuple(action for action in solution.do if action.what != what)
        yield Cheat(what, f"the solution without {what}", replace(solution, do=others))
        for name in presets() if what == "move" else ():
            path = Action(path=name)
            script = replace(solution, do=(path, *others))
            yield Cheat("path", f"path = {name} in place of {what}", script)
    known = specs(entry.parameters)
    for place, action in enumerate(solution.do):
        before, after = solution.do[:place], solution.do[place + 1 :]
        for name, value in (action.set or {}).items():
            for other in known[name].options if name in known else ():
                if str(other) != str(value):
                    own = replace(action, set={**(action.set or {}), name: other})
                    script = replace(solution, do=(*before, own, *after))
                    words = f"{name} = {other} in place of {value} at {action.at:g} s"
                    yield Cheat(name, words, script)
