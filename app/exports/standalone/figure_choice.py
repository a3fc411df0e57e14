"""What a figure shows: robot, laws, paths and parameters, and what readers may change."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from onpath.app.lab.shown_log import ShownLog
from onpath.models.arrays import Array
from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.simulation import (
    FREE,
    check_level_set,
    kernel_of,
    kind_of,
    raised,
    settings_vector,
)
from onpath.models.closed_loop.start import ON_PATH, Start, start_state
from onpath.models.control.forecast import check_possible
from onpath.models.control.laws.registry import law_name, law_named
from onpath.models.control.settable import changed, specs, with_values
from onpath.models.control.sides import DEFAULT_LAWS, SIDES
from onpath.models.errors import CodedError, message_of
from onpath.models.paths.curves import Curve
from onpath.models.studies.experiments import check_path
from onpath.models.systems.catalogue import ROBOTS, RobotEntry
from onpath.models.systems.law_parameters import LEVEL_SET
from onpath.models.systems.parameter_specs import unknown_name
from onpath.models.systems.parameters import Parameters, rise_of
from onpath.models.systems.robots import Robot

CONTROLS = ("hold", "pull", "drag", "run", "step", "reset", "path", "plot", "poles")
"""What a reader may do or see: hold robots back, pull them, drag points of the path, run or pause,
step, reset, choose a path, see the plot and the poles of the laws."""


@dataclass(frozen=True)
class FigureChoice:
    """A figure.

    Attributes:
        robot: name in the catalogue.
        laws: laws of the sides, from left to right: one or two.
        paths: name -> curve; the figure begins with the first one.
        parameters: parameters of the robot, the laws and the task.
        sliders: names of parameters that readers may change; each sets one number of the settings.
        controls: some of `CONTROLS`.
        choices: further laws that readers may choose for each side.
        scripted: further laws that a lesson's scripts and links choose.
        changing: names of parameters that change on the page otherwise than by sliders; they may
            need other loops, see loop_variants.py.
        bends: whether a script moves the path's control points; a reader who may drag them bends it
            in any case.
        begins: where and how the runs start.
        drawings: what may be drawn besides the robots; see drawings.py.
        logged: the log of a real arm that is drawn over the plots, or None.
        remade: parameters that make another robot -> their values on the page, each of which needs
            a figure of its own.
    """

    robot: str
    laws: tuple[str, ...]
    paths: Mapping[str, Curve]
    parameters: Parameters
    sliders: tuple[str, ...]
    controls: tuple[str, ...] = CONTROLS
    choices: tuple[str, ...] = ()
    scripted: tuple[str, ...] = ()
    changing: tuple[str, ...] = ()
    bends: bool = False
    begins: Start = ON_PATH
    drawings: tuple[str, ...] = ()
    logged: ShownLog | None = None
    remade: Mapping[str, tuple[Any, ...]] = dataclasses.field(
        default_factory=dict[str, tuple[Any, ...]]
    )

    @property
    def every_law(self) -> tuple[str, ...]:
        """The laws of the sides and then the further ones, each once."""
        return tuple(dict.fromkeys((*self.laws, *self.choices, *self.scripted)))

    @property
    def edits(self) -> bool:
        """Whether the path may be bent."""
        return self.bends or "drag" in self.controls

    @property
    def flexes(self) -> bool:
        """Whether α changes and has a critical value."""
        return "alpha" in (*self.sliders, *self.changing) and self.entry.flexible_link is not None

    @property
    def entry(self) -> RobotEntry:
        """The entry in the catalogue."""
        return ROBOTS[self.robot]

    @property
    def machine(self) -> Robot:
        """The robot with these parameters."""
        return self.entry.make(self.parameters)

    def kind(self, law: str, curve: Curve) -> Kind:
        """The kind of a side's loop, whose settings have the gains of all laws of the figure."""
        kind = kind_of(law, self.parameters, raised(curve, self.parameters))
        own = {gain.name for each in self.every_law for gain in law_named(each).own_gains}
        return dataclasses.replace(kind, further_gains=tuple(sorted(own)))

    def kernel(self, law: str, curve: Curve) -> Kernel:
        """The loop of a side on a path."""
        return kernel_of(self.machine, self.kind(law, curve))

    def start(self, law: str, curve: Curve) -> Array:
        """The first state of a side."""
        followed = raised(curve, self.parameters)
        kernel = self.kernel(law, curve)
        return start_state(self.machine, kernel, followed, self.parameters, self.begins)

    def start_at(self, curve: Curve) -> Array:
        """The configuration at rest on the path at θ = 0, shape (n,)."""
        robot, followed = self.machine, raised(curve, self.parameters)
        return robot.rest(robot.frame.lift(followed.at(np.array(followed.begin))))

    @property
    def planned(self) -> str:
        """The law whose plan the settings contain, or any law if none has one."""
        plans = (law for law in self.every_law if law_named(law).plan is not None)
        return next(plans, self.laws[0])

    def settings(self, law: str, curve: Curve, parameters: Parameters | None = None) -> Array:
        """The settings of a side that nothing obstructs."""
        parameters = parameters or self.parameters
        kernel = self.kernel(law, curve)
        followed = raised(curve, parameters)
        return settings_vector(self.machine, kernel, parameters, followed, FREE)


def chosen(
    robot: str,
    laws: Sequence[str] = tuple(DEFAULT_LAWS.values()),
    paths: Mapping[str, Curve] | None = None,
    values: Mapping[str, Any] | None = None,
    sliders: Sequence[str] | None = None,
    controls: Sequence[str] | None = None,
    choices: Sequence[str] = (),
) -> FigureChoice:
    """The figure with these choices, checked.

    Args:
        robot, laws, paths, choices: see `FigureChoice`.
        values: parameters by name, where they differ from the robot's defaults.
        sliders: see `FigureChoice`; None: the speed or the target, and the gains of the laws.
        controls: see `FigureChoice`; None: all that are possible.

    Raises:
        ValueError: a name is unknown, a value is out of range, the robot cannot follow a path, or
            a slider cannot set a parameter.
    """
    if robot not in ROBOTS:
        raise unknown_name(robot, list(ROBOTS), "robot")
    if not 1 <= len(laws) <= len(SIDES):
        raise ValueError(f"laws: expected one or two, got {len(laws)}")
    entry = ROBOTS[robot]
    parameters = with_values(entry.parameters(), values or {})
    if parameters.speed_profile != "constant":
        raise ValueError("speed_profile: a figure has a constant speed")
    names, others = (tuple(map(law_name, each)) for each in (laws, choices))
    shown = _usual_sliders((*names, *others), parameters) if sliders is None else tuple(sliders)
    figure = FigureChoice(
        robot=robot,
        laws=names,
        paths=dict(paths or {}),
        parameters=parameters,
        sliders=shown,
        controls=(),
        choices=others,
    )
    _check(figure)
    if controls is None:
        controls = [name for name in CONTROLS if refusal(figure, name) is None]
    for control in controls:
        if control not in CONTROLS:
            raise unknown_name(control, list(CONTROLS), "control")
        if reason := refusal(figure, control):
            raise ValueError(f"control {control}: {reason}")
    return dataclasses.replace(figure, controls=tuple(controls))


def refusal(figure: FigureChoice, control: str) -> str | None:
    """The reason why a figure cannot have a control; None if it can."""
    parameters = figure.parameters
    if control == "poles" and not any(law_named(law).linear for law in figure.every_law):
        return "none of the laws has poles that a figure computes"
    if control != "drag":
        return None
    if rise_of(parameters) or any(path.dimension == 3 for path in figure.paths.values()):
        return "a space curve cannot be changed in a figure"
    planned = law_named(figure.planned).plan is not None
    if parameters.across == LEVEL_SET or parameters.at_limit == "slow_down" or planned:
        return "the law has been adapted to the path as it is"
    return None


def _usual_sliders(laws: Sequence[str], parameters: Parameters) -> tuple[str, ...]:
    """The parameter of the wanted motion, and the gains that act in one of the laws.

    A page cannot compute a plan, which contains the speed and the law's own gains.
    """
    task, unused = ("speed", "K4") if parameters.task == "speed" else ("target", "")
    chosen = [law_named(name) for name in laws]
    gains = dict.fromkeys(
        gain for law in chosen for gain in (law.gains if law.plan else law.gain_names)
    )
    if any(law.plan for law in chosen) and task == "speed":
        return tuple(gain for gain in gains if gain != unused)
    return task, *(gain for gain in gains if gain != unused)


def _check(figure: FigureChoice) -> None:
    robot = figure.machine
    if not figure.paths:
        raise ValueError("paths: expected at least one")
    for law in figure.every_law:
        if not law_named(law).suits(robot.system):
            raise CodedError("error.law_does_not_suit", law=law_named(law).label)
    if len({law_named(law).plan for law in figure.every_law} - {None}) > 1:
        raise ValueError("laws: a figure has room for the plan of one law only")
    for name, curve in figure.paths.items():
        try:
            check_path(robot, raised(curve, figure.parameters))
            check_level_set(figure.parameters, curve)
            for law in figure.every_law:
                check_possible(robot, law, figure.parameters, figure.start_at(curve))
        except ValueError as error:
            raise CodedError(
                "error.path_named", name=repr(name), reason=message_of(error)
            ) from None
    for name in figure.sliders:
        check_slider(figure, name)


def check_slider(figure: FigureChoice, name: str) -> None:
    """Check that a slider can set a parameter: its value is one number of the settings.

    Raises:
        ValueError: the parameter changes more than this number.
    """
    known = specs(type(figure.parameters))
    if name not in known:
        raise unknown_name(name, list(known))
    spec = known[name]
    for law in figure.every_law:
        for curve in figure.paths.values():
            for value in (spec.low, spec.high) if not spec.options else ():
                parameters = changed(figure.parameters, name, value)
                kernel = figure.kernel(law, curve)
                wanted = figure.settings(law, curve)
                if name in kernel.settings.slices:
                    wanted[kernel.settings.slices[name]] = value
                if kind_of(law, parameters, curve) == kind_of(
                    law, figure.parameters, curve
                ) and np.array_equal(wanted, figure.settings(law, curve, parameters)):
                    continue
                raise ValueError(f"sliders: {name} cannot be changed in a figure")
    if spec.options:
        raise ValueError(f"sliders: {name} cannot be changed in a figure")
