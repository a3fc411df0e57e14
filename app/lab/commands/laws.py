"""Commands that choose the control laws."""

from __future__ import annotations

from dataclasses import dataclass

from typing_extensions import override

from onpath.app.lab.commands import checks
from onpath.app.lab.lab import Command, Lab
from onpath.models.control.benches import checked_laws
from onpath.models.control.laws.own import own_law
from onpath.models.control.laws.registry import law_named
from onpath.models.errors import CodedError


@dataclass(frozen=True, slots=True)
class ChooseLaw(Command):
    """Change the control law of a bench, whose robot moves on from where it is.

    Attributes:
        bench: one of `models.control.benches.BENCHES`.
        law: the name of a law of the registry, or a typed law; see `law_named`.
    """

    bench: str
    law: str

    @override
    def apply(self, lab: Lab) -> None:
        session = lab.session
        law = checked_laws({self.bench: self.law}, session.entry)[self.bench]
        if not session.suits(law):
            raise CodedError("error.law_does_not_suit", law=law_named(law).label)
        session.choose_law(self.bench, law)
        if lab.law_refusals.pop(self.bench, ""):
            lab.clear_message()


@dataclass(frozen=True, slots=True)
class TypeLaw(Command):
    """Change to a law that the user has typed; if it is refused, its panel tells why.

    Attributes:
        bench: see `ChooseLaw`.
        text: see `models.control.laws.own`.
    """

    bench: str
    text: str

    @override
    def apply(self, lab: Lab) -> None:
        bench = checks.bench(self.bench)
        try:
            own_law(self.text)  # names of the registry are not typed laws
            ChooseLaw(bench, self.text).apply(lab)
        except ValueError as error:
            lab.law_refusals[bench] = lab.words.sentence(error)
            raise
