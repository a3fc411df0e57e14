"""Commands that choose the control laws."""

from __future__ import annotations

from dataclasses import dataclass

from onpath.app.lab.lab import Command, Lab
from onpath.models.control.benches import check_laws


@dataclass(frozen=True, slots=True)
class ChooseLaw(Command):
    """Change the control law of a bench, whose robot moves on from where it is.

    Attributes:
        bench: one of `models.control.benches.BENCHES`.
        law: a name in `models.control.laws.registry.LAWS`.
    """

    bench: str
    law: str

    def apply(self, lab: Lab) -> None:
        """See `Command.apply`."""
        check_laws({self.bench: self.law}, lab.session.entry)
        lab.session.choose_law(self.bench, self.law)
