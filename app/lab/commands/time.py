"""Commands that run, pause, reset and rewind simulated time, or change how it is displayed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from typing_extensions import override

from onpath.app.lab.commands.checks import finite
from onpath.app.lab.lab import Command, Lab
from onpath.app.lab.looking_back import go_on, look_back, undo_going_on


@dataclass(frozen=True, slots=True)
class SetRunning(Command):
    """Run or pause; None toggles."""

    lets_time_run: ClassVar[bool] = True
    running: bool | None = None

    @override
    def apply(self, lab: Lab) -> None:
        running = not lab.simulation.running if self.running is None else self.running
        if running:
            lab.return_to_present()
        lab.simulation.running = running


@dataclass(frozen=True, slots=True)
class StepOnce(Command):
    """Make one step of simulated time while paused."""

    lets_time_run: ClassVar[bool] = True

    @override
    def apply(self, lab: Lab) -> None:
        lab.return_to_present()
        lab.lessons.check_unlocked()
        lab.simulation.step_once()


@dataclass(frozen=True, slots=True)
class Reset(Command):
    """Put both robots at the start, at rest; path and parameters are kept."""

    @override
    def apply(self, lab: Lab) -> None:
        lab.lessons.judge(lab.simulation)
        lab.simulation.reset()
        lab.show_message("")


@dataclass(frozen=True, slots=True)
class ReplayBreakdown(Command):
    """Show the last moments before a robot stopped, slowly.

    Does nothing if no robot has stopped: the page sends it on its own, and it may arrive after a
    reset.
    """

    @override
    def apply(self, lab: Lab) -> None:
        simulation = lab.simulation
        if lab.breakdown.begin(simulation):
            bends = simulation.entry.flexible_link is not None
            larger = {"larger": f"{simulation.settings.larger:g}"} if bends else {}
            key = "say.slowly_larger" if bends else "say.slowly"
            lab.show_message(lab.fault_words(key, **larger), "replay")


@dataclass(frozen=True, slots=True)
class UseEarlierSettings(Command):
    """Reset with the settings under which no robot had stopped."""

    lets_time_run: ClassVar[bool] = True

    @override
    def apply(self, lab: Lab) -> None:
        lab.breakdown.use_earlier_settings(lab.simulation)
        lab.show_message("")


@dataclass(frozen=True, slots=True)
class LookAt(Command):
    """Pause and view the state `ago` seconds before now; 0 is now."""

    ago: float

    @override
    def apply(self, lab: Lab) -> None:
        _look_back(lab, finite(self.ago))


@dataclass(frozen=True, slots=True)
class LookBack(Command):
    """View a state further back, or forward if negative, [s]."""

    by: float

    @override
    def apply(self, lab: Lab) -> None:
        now, viewing = lab.simulation.time, lab.simulation.viewing
        _look_back(lab, now - (now if viewing is None else viewing) + finite(self.by))


@dataclass(frozen=True, slots=True)
class GoOn(Command):
    """Continue from the viewed instant; the later history can be restored by `UndoGoOn`."""

    lets_time_run: ClassVar[bool] = True

    @override
    def apply(self, lab: Lab) -> None:
        discarded = go_on(lab.simulation)
        if discarded is None:
            lab.clear_message()
            return
        lab.script = None
        time, seconds = (f"{number:.1f}" for number in discarded)
        lab.remark(lab.words("say.went_on", time=time, seconds=seconds))


@dataclass(frozen=True, slots=True)
class UndoGoOn(Command):
    """Swap the current history with the one replaced by the last `GoOn`."""

    @override
    def apply(self, lab: Lab) -> None:
        if undo_going_on(lab.simulation):
            lab.remark(lab.words("say.brought_back", time=f"{lab.simulation.time:.1f}"))
        else:
            lab.show_message(lab.words("say.nothing_discarded"))


def _look_back(lab: Lab, ago: float) -> None:
    simulation, words = lab.simulation, lab.words
    if ago <= 0 or not len(simulation.history):
        lab.return_to_present()
        return
    if simulation.viewing is None:
        said = words("say.looking_back")
        if simulation.forces.hands:
            said += " " + words("say.let_go")
        lab.show_message(said, holds=lambda: simulation.viewing is not None)
    look_back(simulation, ago)
