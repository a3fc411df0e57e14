"""Commands that choose the control laws."""

from __future__ import annotations

from dataclasses import dataclass

from typing_extensions import override

from onpath.app.lab.commands import checks
from onpath.app.lab.lab import Command, Lab
from onpath.app.lab.plant_state import SIDE, PlantState
from onpath.models.control.laws.own import own_law
from onpath.models.control.laws.registry import law_named
from onpath.models.control.sides import checked_laws
from onpath.models.errors import CodedError


@dataclass(frozen=True, slots=True)
class ChooseLaw(Command):
    """Change the control law of a side, whose robot moves on from where it is.

    Attributes:
        side: one of `models.control.sides.SIDES`.
        law: the name of a law of the registry, or a typed law; see `law_named`.
    """

    side: str
    law: str

    @override
    def suits(self, lab: Lab, plant: PlantState) -> bool:
        return self.side != SIDE or self.law in plant.laws

    @override
    def apply(self, lab: Lab) -> None:
        simulation = lab.simulation
        law = checked_laws({self.side: self.law}, simulation.entry)[self.side]
        if not simulation.suits(law):
            raise CodedError("error.law_does_not_suit", law=law_named(law).label)
        simulation.choose_law(self.side, law)
        if lab.refused.pop(self.side, ""):
            lab.clear_message()


@dataclass(frozen=True, slots=True)
class TypeLaw(Command):
    """Change to a law that the user has typed; if it is refused, its field says why.

    Attributes:
        side: see `ChooseLaw`.
        text: see `models.control.laws.own`.
    """

    side: str
    text: str

    @override
    def suits(self, lab: Lab, plant: PlantState) -> bool:
        return self.side != SIDE

    @override
    def apply(self, lab: Lab) -> None:
        side = checks.side(self.side)
        try:
            own_law(self.text)  # names of the registry are not typed laws
            ChooseLaw(side, self.text).apply(lab)
        except ValueError as error:
            lab.refused[side] = lab.words.sentence(error)
            raise
