"""What a lesson is made of. A lesson file is read into these by lessons/parse.py.

There the words of questions, answers, tasks and hints, markdown in the file, become Markup.
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
    "hold", "let_go", "pull", "release", "set", "path", "reset", "identify", "diverged", "robot"
]
Value = float | int | str


class Data(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Read from TOML; an unknown name is an error."""


class StepSetup(Data, frozen=True):
    """How the lab is set up when a step begins.

    Attributes:
        robot: name of the robot; empty: the lesson's.
        path: name of a preset; empty: the circle.
        set: parameters that differ from the lab's defaults; all others go back to them.
        controls: what is shown on the right: names of parameters, or of CONTROLS.
        plot: a plot to show besides the distance, one of PLOTS; empty for none.
        running: whether time runs.
        keep: robot, path and parameters are those of the step before, but for what is named here.
    """

    robot: str = ""
    path: str = ""
    set: dict[str, Value] = {}
    controls: tuple[str, ...] = ()
    plot: str = ""
    running: bool = True
    keep: bool = False

    def after(self, before: StepSetup) -> StepSetup:
        """Itself, with what it keeps of the scene before it."""
        if not self.keep:
            return self
        kept = {**before.set, **self.set}
        robot, path = self.robot or before.robot, self.path or before.path
        return msgspec.structs.replace(self, robot=robot, path=path, set=kept)


class Action(Data, frozen=True):
    """One thing that is done to the lab at a time; exactly one of the others is given.

    Attributes:
        at: since the script began, [s].
        hold: hold back, or let go.
        pull: pull the end-points from where they are by (right, up), [mm], in the path's plane.
        release: end a pull.
        set: parameters.
        path: name of a preset.
        move: a control point (index, right, up), by [mm].
        robot: another robot.
        reset: both robots to the start.
        run: run or pause.
        identify: fit the controller's model to what was measured.
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
    reset: bool | None = None
    run: bool | None = None
    identify: bool | None = None
    only: RobotName | Literal[""] = ""

    @property
    def what(self) -> str:
        """The name of the one thing that is given.

        Raises:
            ValueError: none, or more than one.
        """
        given = [n for n in ACTIONS if getattr(self, n) is not None]
        if len(given) != 1:
            raise ValueError(f"an action does exactly one of {', '.join(ACTIONS)}")
        return given[0]


ACTIONS = (
    *("hold", "pull", "release", "set", "path", "move", "robot", "reset", "run"),
    "identify",
)


class Script(Data, frozen=True):
    """What the lab does by itself.

    Attributes:
        do: in any order.
        until: when it is over, [s].
    """

    do: tuple[Action, ...] = ()
    until: float = 5.0


class Option(Data, frozen=True):
    """An answer to choose.

    Attributes:
        text: as shown.
        answer: what is said to who chose it.
        right: whether it is right.
    """

    text: str
    answer: str
    right: bool = False


class Choice(Data, frozen=True, tag="choice", tag_field="kind"):
    """A prediction: one of some options."""

    question: str
    options: tuple[Option, ...]


class Sketch(Data, frozen=True, tag="sketch", tag_field="kind"):
    """A prediction: a curve over time, drawn by hand.

    Attributes:
        quantity: one of lessons.record.QUANTITIES.
        robot: whose; the truth of both is shown beside it.
        seconds: length of the time axis.
        top, bottom: ends of the other axis, in the quantity's unit.
    """

    question: str
    quantity: str
    seconds: float
    top: float
    bottom: float = 0.0
    robot: RobotName = "tracker"


Prediction = Choice | Sketch


class Window(Data, frozen=True):
    """Which instants of a run count.

    Attributes:
        during: always; held, pulled or free (neither).
        last: only the latest of those, [s]; 0 for all.
        least: for how long there must have been any, [s].
    """

    during: During = "always"
    last: float = 0.0
    least: float = 1.0


class Bound(Window, frozen=True, tag="bound", tag_field="kind"):
    """A quantity stays below, or above, something."""

    quantity: str = ""
    robot: RobotName = "follower"
    stat: Stat = "max"
    below: float | None = None
    above: float | None = None


class Compare(Window, frozen=True, tag="compare", tag_field="kind"):
    """A quantity of `larger` is at least `ratio` times that of the other robot."""

    quantity: str = ""
    larger: RobotName = "tracker"
    stat: Stat = "max"
    ratio: float = 1.0


class Event(Data, frozen=True, tag="event", tag_field="kind"):
    """Something has happened.

    Attributes:
        name: of a parameter for "set", a path for "path", a robot for "robot"; empty for any.
        times: how often at least.
    """

    event: EventName
    name: str = ""
    times: int = 1


class Order(Data, frozen=True, tag="order", tag_field="kind"):
    """Events have happened one after another; others may lie between. `set:K1` names one."""

    events: tuple[str, ...]


class Setting(Data, frozen=True, tag="setting", tag_field="kind"):
    """A parameter has a value, or lies in a range; `path` and `robot` can be asked for, too."""

    name: str
    equals: Value | None = None
    below: float | None = None
    above: float | None = None


Check = Bound | Compare | Event | Order | Setting


class Task(Data, frozen=True):
    """What the student does and the lab checks.

    Attributes:
        id: unique in the lesson, the same in all languages.
        text: what to do.
        hints: shown one at a time.
        check: all must hold at once.
        best: a quantity of the follower to get small, compared with one's own previous best.
    """

    id: str
    text: str
    check: tuple[Check, ...]
    hints: tuple[str, ...] = ()
    best: str = ""


class Quiz(Data, frozen=True):
    """A question at the end."""

    question: str
    options: tuple[Option, ...]


class LabLink(msgspec.Struct, frozen=True):
    """Words in the text that act on the lab."""

    label: str
    actions: tuple[Action, ...]


class Text(msgspec.Struct, frozen=True):
    """Part of a step's text, as safe HTML, and the links that follow it as buttons."""

    html: Markup
    links: tuple[LabLink, ...] = ()


Block = Text | Choice | Sketch | Task | Quiz


class Step(msgspec.Struct, frozen=True):
    """One page of a lesson.

    Attributes:
        line: where it begins in the file.
        blocks: in reading order.
        scene: what the lab is set to, or None for what the step before has.
        script: what the lab does by itself, or None.
    """

    kind: StepKind
    title: str
    line: int
    blocks: tuple[Block, ...]
    scene: StepSetup | None = None
    script: Script | None = None

    def predictions(self) -> list[Prediction]:
        """In this step."""
        return [block for block in self.blocks if isinstance(block, Choice | Sketch)]

    def tasks(self) -> list[Task]:
        """In this step."""
        return [block for block in self.blocks if isinstance(block, Task)]


class Front(Data, frozen=True):
    """The lines between +++ at the top of a lesson."""

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
        """What the lab is set to at a step, whichever way one comes to it."""
        scene = StepSetup()
        for step in self.steps[: index + 1]:
            scene = step.scene.after(scene) if step.scene is not None else scene
        return scene

    def tasks(self) -> list[Task]:
        """Of all steps."""
        return [task for step in self.steps for task in step.tasks()]


class Reference(Data, frozen=True):
    """For one task: what solves it, and what does not."""

    solution: Script
    failure: Script
