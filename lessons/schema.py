"""The data that a lesson consists of. lessons/parse.py reads a lesson file into them.

Questions, answers, tasks and hints are Markdown in the file and Markup here.
"""

from __future__ import annotations

from typing import Literal

import msgspec
from markupsafe import Markup

StepKind = Literal["play", "predict", "run", "explain", "task", "quiz"]
RobotName = Literal["follower", "tracker"]
Stat = Literal["max", "min", "mean", "rms", "final"]
During = Literal["always", "held", "pulled", "free"]
EventName = Literal[
    "hold",
    "let_go",
    "pull",
    "release",
    "set",
    "path",
    "reset",
    "identify",
    "diverged",
    "robot",
    "law",
]
Value = float | int | str


class Data(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Base of everything that is read from TOML; unknown names are errors."""


class Laws(Data, frozen=True):
    """Control laws of the benches; empty: that of a new lab, or no change."""

    left: str = ""
    right: str = ""

    @property
    def named(self) -> dict[str, str]:
        """Those that are named, by bench."""
        return {bench: law for bench, law in msgspec.structs.asdict(self).items() if law}


class StepSetup(Data, frozen=True):
    """The state of the lab at the beginning of a step.

    Attributes:
        robot: name of the robot; empty: that of the lesson.
        path: name of a preset; empty: the circle.
        laws: control laws of the benches.
        set: parameters that differ from the lab's defaults; all others are reset to them.
        controls: controls that are shown: names of parameters, or of CONTROLS.
        plot: a plot to show besides the distance, one of PLOTS; empty for none.
        running: whether time runs.
        keep: whether robot, path, laws and parameters of the step before are kept, except those
            named here.
    """

    robot: str = ""
    path: str = ""
    laws: Laws = Laws()
    set: dict[str, Value] = {}
    controls: tuple[str, ...] = ()
    plot: str = ""
    running: bool = True
    keep: bool = False

    def after(self, before: StepSetup) -> StepSetup:
        """The complete setup, given that of the step before."""
        if not self.keep:
            return self
        kept = {**before.set, **self.set}
        robot, path = self.robot or before.robot, self.path or before.path
        laws = Laws(**{**before.laws.named, **self.laws.named})
        return msgspec.structs.replace(self, robot=robot, path=path, laws=laws, set=kept)


class Action(Data, frozen=True):
    """One action on the lab. Exactly one of the fields other than `at` and `only` is given.

    Attributes:
        at: time since the script began, [s].
        hold: put the brake on, or off.
        pull: pull the end-points from where they are by (right, up), [mm], in the path's plane.
        release: end a pull.
        set: parameters.
        path: name of a preset.
        move: move a control point (index, right, up), by [mm].
        robot: change the robot.
        laws: change the control laws of the benches.
        reset: put both robots back to the start.
        run: run or pause.
        identify: fit the controller's model to the measured motion.
        only: the robot that hold and pull act on; empty for both.
    """

    at: float = 0.0
    hold: bool | None = None
    pull: tuple[float, float] | None = None
    release: bool | None = None
    set: dict[str, Value] | None = None
    path: str | None = None
    move: tuple[int, float, float] | None = None
    robot: str | None = None
    laws: Laws | None = None
    reset: bool | None = None
    run: bool | None = None
    identify: bool | None = None
    only: RobotName | Literal[""] = ""

    @property
    def what(self) -> str:
        """Name of the field that is given.

        Raises:
            ValueError: none is given, or more than one.
        """
        given = [n for n in ACTIONS if getattr(self, n) is not None]
        if len(given) != 1:
            raise ValueError(f"an action does exactly one of {', '.join(ACTIONS)}")
        return given[0]


ACTIONS = (
    *("hold", "pull", "release", "set", "path", "move", "robot", "laws", "reset", "run"),
    "identify",
)


class Script(Data, frozen=True):
    """A sequence of actions that the lab performs by itself.

    Attributes:
        do: in any order.
        until: end of the script, [s].
    """

    do: tuple[Action, ...] = ()
    until: float = 5.0


class Option(Data, frozen=True):
    """One option of a question.

    Attributes:
        text: as shown.
        answer: the response to a student who chooses it.
        right: whether it is correct.
    """

    text: str
    answer: str
    right: bool = False


class Choice(Data, frozen=True, tag="choice", tag_field="kind"):
    """A prediction: one of several options."""

    question: str
    options: tuple[Option, ...]


class Sketch(Data, frozen=True, tag="sketch", tag_field="kind"):
    """A prediction: a curve over time, drawn by hand.

    Attributes:
        quantity: one of lessons.record.QUANTITIES.
        seconds: length of the time axis, [s].
        top, bottom: limits of the other axis, in the quantity's unit.
        robot: the robot that is predicted; the true curves of both are shown afterwards.
    """

    question: str
    quantity: str
    seconds: float
    top: float
    bottom: float = 0.0
    robot: RobotName = "tracker"


Prediction = Choice | Sketch


class Window(Data, frozen=True):
    """The instants of a run that a check evaluates.

    Attributes:
        during: "always", "held", "pulled", or "free" (neither held nor pulled).
        last: only the latest of those, [s]; 0 for all.
        least: least total duration, [s].
    """

    during: During = "always"
    last: float = 0.0
    least: float = 1.0


class Bound(Window, frozen=True, tag="bound", tag_field="kind"):
    """A statistic of a quantity lies between bounds."""

    quantity: str = ""
    robot: RobotName = "follower"
    stat: Stat = "max"
    below: float | None = None
    above: float | None = None


class Compare(Window, frozen=True, tag="compare", tag_field="kind"):
    """A statistic of `larger` is at least `ratio` times that of the other robot."""

    quantity: str = ""
    larger: RobotName = "tracker"
    stat: Stat = "max"
    ratio: float = 1.0


class Event(Data, frozen=True, tag="event", tag_field="kind"):
    """An event has happened.

    Attributes:
        name: of a parameter for "set", a path for "path", a robot for "robot", a law for "law";
            empty for any.
        times: least number of times.
    """

    event: EventName
    name: str = ""
    times: int = 1


class Order(Data, frozen=True, tag="order", tag_field="kind"):
    """Events have happened in this order, possibly with others in between. `set:K1` names one."""

    events: tuple[str, ...]


class Setting(Data, frozen=True, tag="setting", tag_field="kind"):
    """A parameter has a value or lies in a range.

    Attributes:
        name: of a parameter; or "path" or "robot"; or "left" or "right" for the law of a bench.
    """

    name: str
    equals: Value | None = None
    below: float | None = None
    above: float | None = None


Check = Bound | Compare | Event | Order | Setting


class Task(Data, frozen=True):
    """What the student has to do, and how the lab checks it.

    Attributes:
        id: unique in the lesson, the same in all languages.
        check: all of them must be satisfied at the same time.
        hints: shown one at a time.
        best: a quantity of the follower to minimise; the student's best value is kept.
        passed: why it worked, shown once the task is passed.
    """

    id: str
    text: str
    check: tuple[Check, ...]
    hints: tuple[str, ...] = ()
    best: str = ""
    passed: str = ""


class Quiz(Data, frozen=True):
    """A question at the end of a lesson."""

    question: str
    options: tuple[Option, ...]


class LabLink(msgspec.Struct, frozen=True):
    """Words in the text that act on the lab when they are clicked."""

    label: str
    actions: tuple[Action, ...]


class Text(msgspec.Struct, frozen=True):
    """Part of a step's text, as safe HTML, and its lab links, which follow it as buttons."""

    html: Markup
    links: tuple[LabLink, ...] = ()


Block = Text | Choice | Sketch | Task | Quiz


class Step(msgspec.Struct, frozen=True):
    """One page of a lesson.

    Attributes:
        line: of the file at which it begins.
        scene: state of the lab at the beginning, or None for that of the step before.
        script: actions that the lab performs by itself, or None.
    """

    kind: StepKind
    title: str
    line: int
    blocks: tuple[Block, ...]
    scene: StepSetup | None = None
    script: Script | None = None

    def predictions(self) -> list[Prediction]:
        """The predictions of this step."""
        return [block for block in self.blocks if isinstance(block, Choice | Sketch)]

    def tasks(self) -> list[Task]:
        """The tasks of this step."""
        return [block for block in self.blocks if isinstance(block, Task)]


class Front(Data, frozen=True):
    """The front matter of a lesson, between two lines +++."""

    title: str
    summary: str
    minutes: int
    robot: str = "five_bar"


class Lesson(msgspec.Struct, frozen=True):
    """A lesson in one language.

    Attributes:
        name: of its folder.
        language: two letters.
    """

    name: str
    language: str
    front: Front
    steps: tuple[Step, ...]

    def scene_at(self, index: int) -> StepSetup:
        """The complete setup of a step, independent of how the student got there."""
        scene = StepSetup()
        for step in self.steps[: index + 1]:
            scene = step.scene.after(scene) if step.scene is not None else scene
        return scene

    def laws_shown(self, index: int) -> dict[str, str]:
        """Control laws, as in `Laws.named`, under which a prediction of a step is put to the test.

        That is in the step after it if that one lets it happen, else in the step itself.
        """
        after = self.steps[index + 1 : index + 2]
        return self.scene_at(index + (bool(after) and after[0].kind == "run")).laws.named

    def tasks(self) -> list[Task]:
        """The tasks of all steps."""
        return [task for step in self.steps for task in step.tasks()]


class Reference(Data, frozen=True):
    """Scripts for one task: one that solves it, and one that does not."""

    solution: Script
    failure: Script
