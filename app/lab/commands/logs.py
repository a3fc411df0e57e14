"""Commands that show the log of a real arm over the plots, and remove it."""

from __future__ import annotations

from dataclasses import dataclass

from typing_extensions import override

from onpath.app.lab.lab import Command, Lab
from onpath.app.lab.shown_log import ShownLog


@dataclass(frozen=True, slots=True, eq=False)
class ShowLog(Command):
    """Draw a log over the plots, from the beginning of each run on, in the place of any other."""

    log: ShownLog

    @override
    def apply(self, lab: Lab) -> None:
        lab.log = self.log
        if lab.lessons.lesson is None:
            lab.remark(lab.words("log.shown", file=self.log.file))
        else:
            lab.remark(lab.words("log.after_lesson", file=self.log.file))


@dataclass(frozen=True, slots=True)
class RemoveLog(Command):
    """Remove the log from the plots."""

    @override
    def apply(self, lab: Lab) -> None:
        lab.log = None
