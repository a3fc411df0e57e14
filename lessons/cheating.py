"""Attempts to pass a task without doing what it asks, for `onpath lessons check --cheat`.

A task asks for what its reference solution does. A cheat leaves that out and uses one other control
instead; a student can have any control shown in any step.
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
"""The shortest duration of a cheat, [s]."""
HOLD = (Action(at=1.5, hold=True), Action(at=5.0, hold=False))
"""The brake, held for longer than any task of the course requires."""
DONE = ("hold", "pull", "move", "path", "identify", "laws")
"""Actions, besides settings, without which a solution must not pass."""
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
        control: the control that it uses. It is no cheat if the solution uses that control, too, or
            if the author lists it in `Reference.fair`.
        words: a description.
        script: the actions.
    """

    control: str
    words: str
    script: Script


def cheats(lesson: Lesson, index: int, task: Task, reference: Reference) -> list[Cheat]:
    """The cheats to try at a task, without those that are fair or that an `Only` excludes."""
    setup = lesson.setup_at(index)
    entry = ROBOTS[setup.robot or lesson.front.robot]
    solution = reference.solution
    others = [each for each in _with_another_control(solution, entry) if _may_pass(each, task)]
    tried = [*others, *_otherwise(solution, entry)]
    return [cheat for cheat in tried if cheat.control not in reference.fair]


def _may_pass(cheat: Cheat, task: Task) -> bool:
    """Whether every `Only` of a task allows the control of a cheat."""
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
    """Use one control that the solution does not use, alone or with the rest of the solution."""
    until = max(solution.until, LEAST)
    settings = {name for action in solution.do for name in action.set or {}}
    used = {action.what for action in solution.do} | settings
    bare = tuple(action for action in solution.do if action.what != "set")
    companions: dict[str, tuple[Action, ...]] = {"nothing else": ()}
    if settings and bare:
        companions["the rest of the solution"] = bare
        yield Cheat("settings", "nothing set, and the rest of the solution", Script(bare, until))
    if "hold" not in used:
        companions["a hold"] = HOLD
    for control, words, action in _controls(entry):
        for companion, rest in companions.items() if control not in used else ():
            yield Cheat(control, f"{words} and {companion}", Script((action, *rest), until))


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
    """The options of a choice; the ends of the range of a number, and 0."""
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
    for i, action in enumerate(solution.do):
        before, after = solution.do[:i], solution.do[i + 1 :]
        for name, value in (action.set or {}).items():
            for other in known[name].options if name in known else ():
                if str(other) != str(value):
                    changed = replace(action, set={**(action.set or {}), name: other})
                    script = replace(solution, do=(*before, changed, *after))
                    words = f"{name} = {other} in place of {value} at {action.at:g} s"
                    yield Cheat(name, words, script)
