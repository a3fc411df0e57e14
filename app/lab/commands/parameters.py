"""Commands that choose the robot and its parameters."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from typing_extensions import override

from onpath.app.lab.lab import Command, Lab
from onpath.app.lab.simulation import Simulation
from onpath.lessons.sides import law_label
from onpath.models.closed_loop.profile_shapes import profile_of
from onpath.models.closed_loop.simulation import check_level_set, raised
from onpath.models.control.settable import changed
from onpath.models.errors import CodedError
from onpath.models.paths.curve_faults import curve_faults
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameter_specs import unknown_name
from onpath.models.systems.parameters import Parameters

PATH_MATTERS = ("across", "rise")  # parameters that not every path allows together


@dataclass(frozen=True, slots=True)
class SetParameter(Command):
    """Set one field of the parameters.

    Attributes:
        name: a field of `models.systems.parameters.Parameters`.
        value: in the unit of its `Spec`; `changed` checks name, type and range.
    """

    name: str
    value: Any

    @override
    def apply(self, lab: Lab) -> None:
        simulation, before = lab.simulation, lab.simulation.parameters
        wanted = changed(before, self.name, self.value)
        if self.name in PATH_MATTERS:
            check_level_set(wanted, raised(simulation.editor.blend.target.plan, wanted))
        _check_plane(simulation, wanted)
        _set(lab, wanted)
        if simulation.parameters != before:
            simulation.note("set", self.name)
            if self.name == "speed_profile" and self._begins_later(simulation):
                lab.remark(lab.words("say.ramps_at_start"))

    @staticmethod
    def _begins_later(simulation: Simulation) -> bool:
        """Whether the speed profile varies only at the start of a run, which has passed."""
        profile = profile_of(simulation.parameters)
        return profile is not None and not profile.period and simulation.time >= profile.times[-1]


def _set(lab: Lab, wanted: Parameters) -> None:
    """Set the parameters, and tell the user if that has restarted the run."""
    simulation, run = lab.simulation, lab.simulation.run_number
    simulation.set_parameters(wanted)
    if simulation.run_number != run:
        lab.remark(lab.words("say.begun_anew"))


def _check_plane(simulation: Simulation, wanted: Parameters) -> None:
    """Refuse another plane of the path if the path would be out of the robot's reach there.

    Raises:
        CodedError: it would.
    """
    robot, editor = simulation.entry.make(wanted), simulation.editor
    if robot.frame == simulation.robot.frame:
        return
    for curve in (editor.blend.target, editor.curve):
        if faults := curve_faults(robot.margin, curve):
            reasons = tuple(fault.reason for fault in faults)
            raise CodedError("error.cannot_follow", robot=simulation.entry.label, reasons=reasons)


@dataclass(frozen=True, slots=True)
class ResetParameters(Command):
    """Set all parameters to their defaults."""

    @override
    def apply(self, lab: Lab) -> None:
        _check_plane(lab.simulation, lab.simulation.entry.parameters())
        _set(lab, lab.simulation.entry.parameters())


@dataclass(frozen=True, slots=True)
class Identify(Command):
    """Identify a model from the follower's recent motion, and give it to the controllers."""

    @override
    def apply(self, lab: Lab) -> None:
        lab.identification.begin(lab.simulation.robot, lab.simulation.history.copy())


@dataclass(frozen=True, slots=True)
class ChooseRobot(Command):
    """Choose another robot; its previous path and parameters, or the defaults, are restored."""

    name: str

    @override
    def apply(self, lab: Lab) -> None:
        if self.name not in ROBOTS:
            raise unknown_name(self.name, list(ROBOTS), "robot")
        if ROBOTS[self.name] is lab.simulation.entry:
            return
        before = lab.simulation.laws
        lab.simulation.choose_robot(ROBOTS[self.name])
        unsuitable = [law for side, law in before.items() if law != lab.simulation.laws[side]]
        lab.show_message("")
        if unsuitable:
            names = ", ".join(law_label(law, lab.words) for law in dict.fromkeys(unsuitable))
            lab.show_message(lab.words("say.laws_replaced", laws=names))
