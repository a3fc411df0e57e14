"""The data of a task and its checks, which lessons/checks.py evaluates."""

from __future__ import annotations

from typing import Literal

from onpath.lessons.action_schema import Data, RobotName, Script, Value

Stat = Literal["max", "min", "mean", "rms", "final", "settling", "overshoot"]
During = Literal["always", "held", "pulled", "free", "released"]
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


class Window(Data, frozen=True):
    """The instants of a run that a check evaluates.

    Attributes:
        during: "always", "held", "pulled", "free" (neither held nor pulled), or "released" (free
            again, after the first hold or pull).
        last: the latest seconds of those to consider, [s]; 0 for all.
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


class Better(Window, frozen=True, tag="better", tag_field="kind"):
    """A statistic of a quantity is less than it was in the run before, up to the last reset.

    Attributes:
        share: largest admissible share of the earlier value.
    """

    quantity: str = ""
    robot: RobotName = "follower"
    stat: Stat = "max"
    share: float = 1.0


class Event(Data, frozen=True, tag="event", tag_field="kind"):
    """An event has happened.

    Attributes:
        name: of a parameter for "set", a path for "path", a robot for "robot", a law for "law";
            empty for any.
        times: least number of times.
        since: events, as in `Order`; only events after the latest of them count.
    """

    event: EventName
    name: str = ""
    times: int = 1
    since: tuple[str, ...] = ()


class Order(Data, frozen=True, tag="order", tag_field="kind"):
    """Events have happened in this order, possibly with others in between. `set:K1` names one."""

    events: tuple[str, ...]


class Setting(Data, frozen=True, tag="setting", tag_field="kind"):
    """A parameter has a value or lies in a range.

    Attributes:
        name: of a parameter; or "path" or "robot"; or "length" of the path, [mm]; or "left" or
            "right" for the law of a side.
    """

    name: str
    equals: Value | None = None
    below: float | None = None
    above: float | None = None


class Only(Data, frozen=True, tag="only", tag_field="kind"):
    """No setting other than these differs from the step's setup.

    Attributes:
        names: as in `Setting`, without "length"; or "start", or "wall".
    """

    names: tuple[str, ...]


class Once(Bound, frozen=True, tag="once", tag_field="kind"):
    """A bound that was kept at some time since the step began, with a setting at a given value.

    Attributes:
        name, equals: the setting, as in `Setting`.
        since: events, as in `Order`; only a bound kept after the latest of them counts.
    """

    name: str = ""
    equals: Value = 0
    since: tuple[str, ...] = ()


Check = Bound | Compare | Better | Event | Order | Setting | Only | Once


class TaskWay(Data, frozen=True):
    """One way of passing a task, after which something else is said.

    Attributes:
        when: what holds at the moment when a task is passed in this way.
        passed: as in `Task`.
    """

    when: Bound | Compare | Event | Order | Setting
    passed: str


class Task(Data, frozen=True):
    """What the student has to do, and how the lab checks it.

    Attributes:
        id: unique within the lesson, the same in all languages.
        check: the checks, which must all be satisfied at the same time.
        hints: shown one at a time.
        best: a quantity of the follower to minimise; the student's best value is kept.
        passed: an explanation of why it worked, shown once the task is passed.
        way: other explanations; the first whose condition holds is shown instead of `passed`.
        exploratory: whether the solution is meant to be found by trying. Such a task counts
            nothing in a grade, and students who draw at random may pass it.
    """

    id: str
    text: str
    check: tuple[Check, ...]
    hints: tuple[str, ...] = ()
    best: str = ""
    passed: str = ""
    way: tuple[TaskWay, ...] = ()
    exploratory: bool = False

    @property
    def evaluated(self) -> tuple[Check, ...]:
        """Its checks, and the conditions of its ways."""
        return (*self.check, *(way.when for way in self.way))

    @property
    def explanations(self) -> dict[int, str]:
        """What is said once it is passed, by the number of the way; 0 is `passed`."""
        texts = (self.passed, *(way.passed for way in self.way))
        return {number: text for number, text in enumerate(texts) if text}


class Reference(Data, frozen=True):
    """Scripts for one task: some that solve it, and one that does not.

    Attributes:
        variant: other solutions, as different as those of thoughtful students are.
        fair: controls with which the task may be passed besides those of the solution; see
            `lessons.cheating`.
    """

    solution: Script
    failure: Script
    variant: tuple[Script, ...] = ()
    fair: tuple[str, ...] = ()
