"""The subcommands of `onpath`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Literal, Protocol

import tyro

from onpath.app.cli.arena import ArenaCommand
from onpath.app.cli.compare import CompareCommand
from onpath.app.cli.completion import completion_script
from onpath.app.cli.control import ControlCommand
from onpath.app.cli.experiment import ExperimentCommand, ZeroDynamicsCommand
from onpath.app.cli.export_controller import ExportController
from onpath.app.cli.export_lesson import ExportLesson
from onpath.app.cli.export_site import ExportSite
from onpath.app.cli.figure import FigureCommand
from onpath.app.cli.forget import Forget
from onpath.app.cli.identify import IdentifyCommand
from onpath.app.cli.lesson_pages import WriteGuide, WriteWorksheet
from onpath.app.cli.lesson_play import PlayLesson
from onpath.app.cli.lessons import CheckLessons, ListLessons, ListNames
from onpath.app.cli.names import NamesCommand
from onpath.app.cli.paper import PaperCommand
from onpath.app.cli.serve import Serve
from onpath.app.cli.sweep import SweepCommand


class Subcommand(Protocol):
    """A subcommand with its options."""

    def run(self) -> int | None:
        """Run it; return the exit code, None for 0."""
        ...


@dataclass(frozen=True)
class CommandGroup:
    """Subcommands that share their first word.

    Attributes:
        text: what they are for, in a sentence.
        commands: by their second word.
    """

    text: str
    commands: Mapping[str, type[Subcommand]]


@dataclass(frozen=True)
class CompletionCommand:
    """Print a script with which your shell completes commands and options; see onpath --help."""

    shell: Annotated[Literal["bash", "zsh", "fish"], tyro.conf.Positional]
    """Your shell."""

    def run(self) -> None:
        """Print the script."""
        print(completion_script(self.shell, COMMANDS, Serve), end="")


COMMANDS: Mapping[str, type[Subcommand] | CommandGroup] = {
    "serve": Serve,
    "experiment": ExperimentCommand,
    "compare": CompareCommand,
    "sweep": SweepCommand,
    "arena": ArenaCommand,
    "figure": FigureCommand,
    "paper": PaperCommand,
    "identify": IdentifyCommand,
    "zero-dynamics": ZeroDynamicsCommand,
    "control": ControlCommand,
    "names": NamesCommand,
    "lessons": CommandGroup(
        "List, check, play or print the lessons, the built-in ones or your own.",
        {
            "list": ListLessons,
            "check": CheckLessons,
            "names": ListNames,
            "play": PlayLesson,
            "guide": WriteGuide,
            "worksheet": WriteWorksheet,
        },
    ),
    "export": CommandGroup(
        "Write the course as pages, a lesson for a learning platform, or a controller in C.",
        {"site": ExportSite, "lesson": ExportLesson, "controller": ExportController},
    ),
    "forget": Forget,
    "completion": CompletionCommand,
}
