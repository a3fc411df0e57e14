"""What a lesson does with the lab: the setup at the beginning of each step, and scripts."""

from __future__ import annotations

from typing import Literal

import msgspec

RobotName = Literal["follower", "tracker"]
Value = bool | float | int | str


class Data(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Base of everything that is read from TOML; unknown names are errors."""


class Laws(Data, frozen=True):
    """Control laws of the sides; an empty one is that of a new lab, or stays as it is."""

    left: str = ""
    right: str = ""

    @property
    def named(self) -> dict[str, str]:
        """The laws that are given, by side."""
        return {side: law for side, law in msgspec.structs.asdict(self).items() if law}


class RunStart(Data, frozen=True):
    """The start of both robots relative to the path; all values are 0 in a new lab.

    Attributes:
        place: path parameter of the point near which they start, [rad].
        across: distance from that point, positive to the left of the path, as ξ₁, [mm].
        speed: along the path, [mm/s].
        across_rate: velocity across the path, as ξ₂, [mm/s].
        lead: how far ahead the clock starts, for a law that has one, [rad].
    """

    place: float = 0.0
    across: float = 0.0
    speed: float = 0.0
    across_rate: float = 0.0
    lead: float = 0.0

    @property
    def numbers(self) -> dict[str, float]:
        """The values that are not 0, in SI units, named as in `models.closed_loop.start.Start`."""
        named = {
            "theta": self.place,
            "beside": 1e-3 * self.across,
            "along": 1e-3 * self.speed,
            "across": 1e-3 * self.across_rate,
            "clock_offset": self.lead,
        }
        return {name: value for name, value in named.items() if value}


class SceneMark(Data, frozen=True):
    """A text in the scene, or an arrow with a text at its tail, at both robots.

    Attributes:
        at: position of the text or of the arrow's tip, right and up from the middle of the preset
            paths, [mm].
        tail: position of the arrow's tail; None for a text alone. In TOML it is called `from`.
        text: may be empty if there is an arrow.
    """

    at: tuple[float, float]
    tail: tuple[float, float] | None = msgspec.field(name="from", default=None)
    text: str = ""


class StepSetup(Data, frozen=True):
    """The state of the lab at the beginning of a step.

    Attributes:
        robot: name of the robot; empty: that of the lesson.
        path: name of a preset; empty: the circle.
        laws: control laws of the sides.
        set: parameters and settings of the lab that differ from a new lab's; all others are reset.
        controls: the controls that are shown: names of settings, or members of CONTROLS.
        plot: what is plotted besides the distance: one of PLOTS, a list of two, or empty for none.
        start: where and how both robots start.
        show: what is drawn besides the robots: members of DRAWINGS.
        marks: texts and arrows in the scene.
        running: whether time runs.
        keep: whether robot, path, laws and parameters of the step before are kept, except those
            named here.
    """

    robot: str = ""
    path: str = ""
    laws: Laws = Laws()
    set: dict[str, Value] = {}
    controls: tuple[str, ...] = ()
    plot: str | tuple[str, ...] = ""
    start: RunStart = RunStart()
    show: tuple[str, ...] = ()
    marks: tuple[SceneMark, ...] = ()
    running: bool = True
    keep: bool = False

    @property
    def plots(self) -> tuple[str, ...]:
        """Names of the plots besides that of the distance."""
        return tuple(filter(None, [self.plot])) if isinstance(self.plot, str) else self.plot

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
        set: parameters and settings of the lab.
        path: name of a preset.
        move: move a control point (index, right, up), by [mm].
        robot: change the robot.
        laws: change the control laws of the sides.
        reset: put both robots back to the start.
        run: run or pause.
        identify: fit the controller's model to the measured motion.
        start: put both robots to another start, and restart there.
        rate: how fast time goes from now on, compared with the student's own tempo; 0.25 is slow
            motion.
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
    start: RunStart | None = None
    rate: float | None = None
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
    *("identify", "start", "rate"),
)


class Script(Data, frozen=True):
    """A sequence of actions that the lab performs by itself.

    Attributes:
        do: the actions, in any order.
        until: end of the script, [s].
    """

    do: tuple[Action, ...] = ()
    until: float = 5.0

    @property
    def seconds(self) -> float:
        """The time it takes to watch, [s]; slow motion makes it longer than `until`."""
        time, rate, taken = 0.0, 1.0, 0.0
        for action in sorted(self.do, key=lambda action: action.at):
            if action.rate:
                taken += (action.at - time) / rate
                time, rate = action.at, action.rate
        return taken + (self.until - time) / rate
