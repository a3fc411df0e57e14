"""The command that sets anything that is declared: parameters, gains, the lab's own settings."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, ClassVar

from typing_extensions import override

from onpath.app.lab.commands.wall import first_wall
from onpath.app.lab.lab import Command, Lab
from onpath.app.lab.plant_state import PlantState, settable
from onpath.app.lab.simulation import Simulation
from onpath.models.closed_loop.lab_settings import (
    SETTINGS,
    LabSettings,
    Role,
    changed_setting,
    settings_of_wall,
)
from onpath.models.closed_loop.profile_shapes import profile_of
from onpath.models.closed_loop.simulation import check_level_set, raised
from onpath.models.control.settable import changed, specs
from onpath.models.errors import CodedError
from onpath.models.paths.curve_faults import curve_faults
from onpath.models.systems.parameter_specs import unknown_name
from onpath.models.systems.parameters import Parameters

PATH_MATTERS = ("across", "rise")  # parameters that not every path allows together
UNPLACED = LabSettings(wall=True).obstacle
"""A wall that has no place yet, and gets one on the path."""


@dataclass(frozen=True, slots=True)
class Set(Command):
    """Set a parameter of the robot, a gain of a law, or one of the lab's own settings.

    If it is refused, `Lab.refused` says why until the same setting is set.

    Attributes:
        role: whose order it is.
        name: a name of `models.control.settable.specs`, or a field of `LabSettings`.
        value: in the unit of its `Spec`; None changes a switch to its other position.
    """

    role: ClassVar[Role] = "lab"
    name: str
    value: Any = None

    @override
    def suits(self, lab: Lab, plant: PlantState) -> bool:
        return settable(self.name, lab.simulation.parameters)

    @override
    def apply(self, lab: Lab) -> None:
        parameters = specs(lab.simulation.parameters)
        if self.name not in parameters and self.name not in SETTINGS:
            raise unknown_name(self.name, [*parameters, *SETTINGS], "setting")
        lab.refused.pop(self.name, None)
        try:
            self._set_own(lab) if self.name in SETTINGS else self._set_parameter(lab)
        except ValueError as error:
            lab.refused[self.name] = lab.words.sentence(error)
            raise

    def _set_own(self, lab: Lab) -> None:
        setting, simulation = SETTINGS[self.name], lab.simulation
        if not setting.allows(self.role):
            raise CodedError("error.set_by_process")
        before = simulation.settings
        wanted = changed_setting(before, self.name, self.value)
        if wanted.obstacle == UNPLACED and not before.wall:
            wall = first_wall(simulation.editor.curve)
            wanted = replace(wanted, **settings_of_wall(wall))
        if wanted.start != before.start:
            simulation.check_start(wanted.start)
            lab.clear_message()
        if (wanted.obstacle, wanted.hold_direction) != (before.obstacle, before.hold_direction):
            lab.return_to_present()
        simulation.change_settings(wanted)

    def _set_parameter(self, lab: Lab) -> None:
        simulation, before = lab.simulation, lab.simulation.parameters
        wanted = changed(before, self.name, self.value)
        if self.name in PATH_MATTERS:
            check_level_set(wanted, raised(simulation.editor.blend.target.plan, wanted))
        set_parameters(lab, wanted)
        if simulation.parameters != before:
            simulation.note("set", self.name)
            if self.name == "speed_profile" and _begins_later(simulation):
                lab.remark(lab.words("say.ramps_at_start"))


def _begins_later(simulation: Simulation) -> bool:
    """Whether the speed profile varies only at the start of a run, which has passed."""
    profile = profile_of(simulation.parameters)
    return profile is not None and not profile.period and simulation.time >= profile.times[-1]


def set_parameters(lab: Lab, wanted: Parameters) -> None:
    """Set all parameters, and tell the user if that has restarted the run.

    Raises:
        CodedError: they put the path into another plane, out of the robot's reach.
    """
    simulation, run = lab.simulation, lab.simulation.run_number
    robot, editor = simulation.entry.make(wanted), simulation.editor
    if robot.frame != simulation.robot.frame:
        for curve in (editor.blend.target, editor.curve):
            if faults := curve_faults(robot.margin, curve):
                reasons = tuple(fault.reason for fault in faults)
                raise CodedError(
                    "error.cannot_follow", robot=simulation.entry.label, reasons=reasons
                )
    simulation.set_parameters(wanted)
    if simulation.run_number != run:
        lab.remark(lab.words("say.begun_anew"))


class SetByProcess(Set):
    """The same as an order of those who run the process, such as `onpath --set`."""

    __slots__ = ()
    from_teacher: ClassVar[bool] = True
    role: ClassVar[Role] = "process"


@dataclass(frozen=True, slots=True)
class ResetParameters(Command):
    """Set all parameters to their defaults."""

    @override
    def apply(self, lab: Lab) -> None:
        set_parameters(lab, lab.simulation.entry.parameters())
        lab.refused.clear()
