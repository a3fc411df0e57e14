"""Commands that show the log of a real arm over the plots, and remove it."""

from __future__ import annotations

from dataclasses import dataclass

from typing_extensions import override

from onpath.app.lab.lab import Command, Lab
from onpath.app.lab.plant_state import PlantState
from onpath.app.lab.shown_log import ShownLog


@dataclass(frozen=True, slots=True, eq=False)
class ShowLog(Command):
    """Draw a log over the plots, from the beginning of each run on, in the place of any other.

    Attributes:
        is_whole: whether it is the whole file, and not only its first law.
    """

    log: ShownLog
    is_whole: bool = True

    @override
    def suits(self, lab: Lab, plant: PlantState) -> bool:
        return True

    @override
    def apply(self, lab: Lab) -> None:
        lab.log = self.log
        key = "log.shown" if self.is_whole else "log.shown_in_part"
        if lab.lessons.lesson is not None:
            key = "log.after_lesson"
        lab.remark(lab.words(key, file=self.log.file))


@dataclass(frozen=True, slots=True)
class RemoveLog(Command):
    """Remove the log from the plots."""

    @override
    def suits(self, lab: Lab, plant: PlantState) -> bool:
        return True

    @override
    def apply(self, lab: Lab) -> None:
        lab.log = None
