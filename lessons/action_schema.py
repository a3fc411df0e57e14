"""The data of what a lesson does with the lab: its state as a step begins, and scripts."""

from __future__ import annotations

from typing import Literal

import msgspec

RobotName = Literal["follower", "tracker"]
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
