"""Plays what a lesson's texts say that the lab does."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from typing import Any

from typing_extensions import override

from onpath.app.lab.commands.scripts import player_of
from onpath.app.lab.dry_runs.run_samples import Samples
from onpath.app.lab.dry_runs.stated_check import measured, run_of, why
from onpath.app.lab.lab import Lab
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.plot_rows import motor_row
from onpath.app.lab.setups.setup import Setup
from onpath.app.lab.setups.step_setup import setup_of
from onpath.lessons.action_schema import Script, StepSetup
from onpath.lessons.behaviour.marks import Behaviour
from onpath.lessons.behaviour.sentences import named_controls
from onpath.lessons.labels import parameter_label
from onpath.lessons.problems import near
from onpath.lessons.record import Record
from onpath.lessons.schema import Lesson
from onpath.lessons.sides import ROLES, law_label
from onpath.lessons.vocabulary.names import DRAWINGS
from onpath.lessons.words import Words
from onpath.models.closed_loop.lab_settings import step_specs
from onpath.models.control.laws.registry import LAWS
from onpath.models.errors import Coded, Message
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameter_specs import Spec
from onpath.models.systems.parameters import Parameters

FRAME = 1 / 60  # [s] of simulated time per frame
REFUSALS = {"say.refused", "say.no_further"}
"""Keys of the messages with which a path is refused."""
CONTROLS = {
    "hold": "run.hold_both",
    "editor": "form.section_points",
    "gains": "form.group_gains",
    "flexible": "form.group_robot",
    "identify": "gains.identify",
    "start": "start.title",
    "wall": "wall.title",
    "plots": "plots.menu",
    "laws": "laws.left",
    "sign": "export.lines",
}
"""Control of a step -> key of its name on the page."""
BUTTONS = (
    *("run.run", "run.pause", "run.step", "run.reset", "run.let_both_go"),
    *("gains.pulse", "design.undo", "past.go_on", "controls.help", "lesson.lessons", "laws.about"),
    *("form.group_setup", "form.group_hand", "form.group_gains"),
    *("form.group_view", "setup.draw"),
)
"""Keys of other names on the page that a text may tell its reader to press or open."""
OF_PAGE = ("plot", "drawing", "control", "label")
"""What a mark says of the page, and not of a run."""


class _Listening(Words):
    """Words that remember which message each text is."""

    def __init__(self, language: str = "en") -> None:
        super().__init__(language)
        self.codes = dict[str, str]()

    @override
    def __call__(self, key: str, **values: Any) -> str:
        text = super().__call__(key, **values)
        self.codes[text] = key
        return text

    @override
    def sentence(self, source: Message | Exception) -> str:
        message = source.message if isinstance(source, Coded) else source
        if isinstance(message, Message):
            self._remember(message)
        return super().sentence(source)

    def _remember(self, message: Message) -> None:
        self.codes[message.text(self.language)] = message.code
        for argument in message.arguments.values():
            for each in argument if isinstance(argument, tuple) else (argument,):
                if isinstance(each, Message):
                    self._remember(each)

    def said(self, text: str) -> set[str]:
        """The codes of the messages that a text contains."""
        return {code for known, code in self.codes.items() if known and known in text}


@dataclass(slots=True, eq=False)
class Played:
    """What was seen and heard while a script was played.

    Attributes:
        record: everything measured.
        said: codes of the messages that were shown.
        refused: codes of the messages that came with a refusal.
        path: name of the path at the end.
    """

    record: Record
    said: set[str] = field(default_factory=set[str])
    refused: set[str] = field(default_factory=set[str])
    path: str = ""


def played(setup: Setup, script: Script, loop_cache: LoopCache) -> Played:
    """Play a script in a lab set up like this, also if the lab refuses some of it."""
    lab, words = Lab(loop_cache), _Listening()
    lab.lessons.words = words
    lab.set_up(setup)
    simulation, player = lab.simulation, player_of(script)
    samples = Samples(simulation)
    said, refused = set[str](), set[str]()
    lab.script, simulation.running = player, True
    while lab.script is not None:
        lab.drain()
        lab.advance(simulation.settings.rate * FRAME)
        samples.follow(simulation)
        heard = words.said(lab.message)
        said |= heard
        if heard & REFUSALS or (lab.script is None and not player.finished):
            refused |= heard
    record = samples.record(simulation)
    return Played(record=record, said=said, refused=refused, path=simulation.editor.design.name)


def behaviour_faults(
    lesson: Lesson, plays: Mapping[str, Script], loop_cache: LoopCache
) -> Iterator[tuple[int, str]]:
    """Lines and faults of what a lesson's texts say of runs.

    Args:
        plays: scripts, by name.
    """
    seen = dict[tuple[int, str], Played]()
    for index, said in _behaviours(lesson):
        if said.verb in OF_PAGE:
            continue
        at = index if said.after else run_of(lesson, index)
        script = lesson.steps[at].script if at is not None else None
        script = plays.get(said.after) if said.after else script
        if at is None or script is None:
            missing = f"there is no play {said.after!r}" if said.after else "no step has a script"
            yield said.line, f"{said.text!r}: {missing}"
            continue
        if (at, said.after) not in seen:
            seen[at, said.after] = played(setup_of(lesson, at), script, loop_cache)
        if fault := played_fault(said, seen[at, said.after]):
            yield said.line, f"{said.text!r}: {fault}"
    for unused in plays.keys() - {said.after for _, said in _behaviours(lesson)}:
        yield 1, f"no mark names the play {unused!r} of reference.toml"


def page_faults(lesson: Lesson, text: str) -> Iterator[tuple[int, str]]:
    """Lines and faults of what a lesson's texts say of the page, in the lesson's language.

    Args:
        text: of the lesson's file.
    """
    words, robot = Words(lesson.language), lesson.front.robot
    for index, said in _behaviours(lesson):
        if said.verb not in OF_PAGE:
            continue
        if fault := page_fault(said, lesson.setup_at(index), words, robot):
            yield said.line, f"{said.text!r}: {fault}"
    yield from name_faults(text, lesson.language)


def name_faults(text: str, language: str) -> Iterator[tuple[int, str]]:
    """Lines and faults of the controls that a text tells its reader to use: whether they exist."""
    words = Words(language)
    known = frozenset[str]().union(*(labels_of(name, words) for name in _names()))
    for line, name in named_controls(text, language):
        if not any(label == name or label.startswith(f"{name} ") for label in known):
            yield line, f"no control is called {name!r}{near(name, known)}"


def _behaviours(lesson: Lesson) -> Iterator[tuple[int, Behaviour]]:
    """What the texts say, with the index of the step."""
    for index, step in enumerate(lesson.steps):
        for said in step.behaviours:
            yield index, said


def played_fault(said: Behaviour, seen: Played) -> str:
    """What was played instead of what is said; empty if that is so."""
    heard = f"heard: {', '.join(sorted(seen.said)) or 'nothing'}"
    if said.measure is not None:
        found = measured(said.measure, seen.record)
        if found is None:
            return f"{said.measure.words} was not measured: {why(said.measure, seen.record)}"
        holds = found > said.limit if said.above else found < said.limit
        return "" if holds else f"{said.measure.words} is {found:.4g}"
    if said.verb == "says":
        return "" if (said.name in seen.said) != said.absent else heard
    if said.verb == "refuses":
        return "" if said.name in seen.refused else f"it is not refused; {heard}"
    if said.verb == "follows":
        return "" if said.name == seen.path else f"the path is {seen.path!r}; {heard}"
    stopped = any(seen.record.stopped(robot) for robot in ROLES.values() if robot == said.name)
    if stopped != (said.verb == "stops"):
        return f"the {said.name} {'is' if stopped else 'is not'} stopped; {heard}"
    return f"the reason is another one; {heard}" if said.reason not in {"", *seen.said} else ""


def page_fault(said: Behaviour, setup: StepSetup, words: Words, robot: str) -> str:
    """How the page differs from what is said; empty if it does not.

    Args:
        robot: if the step names none.
    """
    written = re.sub(r"[*_“”„\"]", "", said.text).strip(" .,:")
    if said.verb == "label":
        labels = labels_of(said.name, words)
        return "" if written in labels else f"on the page it is {_listed(labels)}"
    shown = {"plot": setup.plots, "drawing": setup.show, "control": setup.controls}[said.verb]
    if (said.name in shown) == said.absent:
        return f"the {said.verb}s of the step are {_listed(shown)}"
    if said.verb == "plot" and not said.absent:
        name = said.name
        if name == "torques":
            entry = ROBOTS[setup.robot or robot]
            name = motor_row(entry.make(entry.parameters()).system.motor_units)
        label = words("plot.phase" if name == "phase" else f"axis.{name}")
        if not any(word in written.lower() for word in _stems(label)):
            return f"the plot is called {label!r}"
    if said.verb == "control" and not any(
        label in written for label in labels_of(said.name, words)
    ):
        return f"the control is called {_listed(labels_of(said.name, words))}"
    return ""


def _stems(label: str) -> list[str]:
    """The beginnings of a label's words, which inflections keep; articles and the like are none."""
    words = (word.strip("=(),") for word in label.lower().split())
    return [word[:5] for word in words if len(word) > 3 or (word and not word.isascii())]


def _listed(names: Iterable[str]) -> str:
    return ", ".join(sorted(names)) or "none"


def labels_of(name: str, words: Words) -> set[str]:
    """The names on the page of a control, a parameter, a law or a text of the catalogue."""
    found = {
        parameter_label(name, known[name], words) for known in map(_specs, ROBOTS) if name in known
    }
    found |= {law_label(name, words)} if name in LAWS else set()
    found |= {words(f"show.{each}") for each in DRAWINGS} if name == "show" else set()
    text = words.get(CONTROLS.get(name, name), "")
    return found | ({re.sub(r" \[.*\]$", "", text)} if text else set())


def _names() -> set[str]:
    """The controls, parameters, laws and buttons of the page."""
    return {*CONTROLS, *BUTTONS, *LAWS, *(name for robot in ROBOTS for name in _specs(robot))}


def _specs(robot: str) -> Mapping[str, Spec]:
    return _specs_of(ROBOTS[robot].parameters)


@cache
def _specs_of(kind: type[Parameters]) -> Mapping[str, Spec]:
    """What a step can set; asked for each name of each text."""
    return step_specs(kind)
