"""Commands that choose the robot, and identify its model."""

from __future__ import annotations

from dataclasses import dataclass

from typing_extensions import override

from onpath.app.lab.lab import Command, Lab
from onpath.lessons.sides import law_label
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameter_specs import unknown_name


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
        lab.refused.clear()
        unsuitable = [law for side, law in before.items() if law != lab.simulation.laws[side]]
        lab.show_message("")
        if unsuitable:
            names = ", ".join(law_label(law, lab.words) for law in dict.fromkeys(unsuitable))
            lab.show_message(lab.words("say.laws_replaced", laws=names))
