"""Serve the lab in the browser, or run one of the subcommands."""

from __future__ import annotations

import contextlib
import io
import os
import re
import sys
from dataclasses import dataclass
from importlib.metadata import version
from typing import Protocol

import tyro

from onpath.app.cli.arena import ArenaCommand
from onpath.app.cli.compare import CompareCommand
from onpath.app.cli.experiment import ExperimentCommand, ZeroDynamicsCommand
from onpath.app.cli.export import ExportCommand
from onpath.app.cli.figure import FigureCommand
from onpath.app.cli.identify import IdentifyCommand
from onpath.app.cli.lessons import LessonsCommand
from onpath.app.cli.serve import Serve
from onpath.app.cli.supervisor import supervised

INTERRUPTED = 130


@dataclass(frozen=True)
class Forget:
    """Delete all stored labs. This cannot be undone."""

    database: str | None = None
    """URL of the database, also as ONPATH_DATABASE; the file in your data folder if not given."""

    def run(self) -> None:
        """Delete the labs, and print their number."""
        from onpath.app.storage.database_url import database_url
        from onpath.app.storage.forget import forget

        gone = forget(database_url(self.database))
        print(f"deleted: {gone.labs} labs, {len(gone.files)} files moved aside as broken")


class Subcommand(Protocol):
    """A subcommand with its options."""

    def run(self) -> int | None:
        """Run it; return the exit code, None for 0."""
        ...


COMMANDS: dict[str, type[Subcommand]] = {
    "serve": Serve,
    "experiment": ExperimentCommand,
    "compare": CompareCommand,
    "arena": ArenaCommand,
    "figure": FigureCommand,
    "identify": IdentifyCommand,
    "zero-dynamics": ZeroDynamicsCommand,
    "lessons": LessonsCommand,
    "export": ExportCommand,
    "forget": Forget,
}


def main() -> None:
    """Entry point of `onpath`."""
    _print_any_text()
    arguments = sys.argv[1:]
    if arguments and arguments[0] in COMMANDS.keys() - {"serve"}:
        sys.exit(run_command(arguments))

    def serve(again: bool) -> int:
        return run_command([*arguments, "--no-open"] if again else arguments)  # its tab comes back

    sys.exit(supervised(serve))


def _print_any_text() -> None:
    """Allow any character in the output; Windows would limit a redirected file to 256."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            chosen = stream.isatty() or "PYTHONIOENCODING" in os.environ
            stream.reconfigure(encoding=None if chosen else "utf-8", errors="replace")


def run_command(arguments: list[str]) -> int:
    """Run one command line; return the exit code.

    The code is 0; 1 for lessons with problems, and for a lab without its database; 2, with one
    line on standard error, for other errors; or 130, the usual one, for an interrupted command.
    """
    if arguments == ["--version"]:
        print(f"onpath {version('onpath')}")
        return 0
    if not arguments or arguments[0] not in (*COMMANDS, "-h", "--help"):
        if arguments and not arguments[0].startswith("-"):
            print(f"onpath: {unknown_command(arguments[0])}", file=sys.stderr)
            return 2
        arguments = ["serve", *arguments]
    try:
        return _parse(arguments).run() or 0
    except BrokenPipeError:
        return 0
    except KeyboardInterrupt:
        return INTERRUPTED
    except (ValueError, OSError) as error:
        print(f"onpath: {_one_line(str(error))}", file=sys.stderr)
        return 2


def unknown_command(name: str) -> str:
    """The error message for a command that does not exist."""
    return f"unknown command {name!r}: there are {', '.join(COMMANDS)}"


def _parse(arguments: list[str]) -> Subcommand:
    """Parse a command line; only its subcommand's options are built, which starts sooner."""
    name, *options = arguments
    complaint = io.StringIO()
    try:
        with contextlib.redirect_stderr(complaint):
            if name in COMMANDS:
                return tyro.cli(COMMANDS[name], prog=f"onpath {name}", args=options)
            return tyro.extras.subcommand_cli_from_dict(
                COMMANDS, prog="onpath", description=__doc__, args=arguments
            )
    except SystemExit as stop:
        if stop.code in (0, None):
            raise
        raise ValueError(_unboxed(complaint.getvalue())) from None


def _unboxed(text: str) -> str:
    """Put a framed message on one line, without its frame, title and pointers to the help."""
    _, *sections = re.split(r"[\u2500-]{5,}", re.sub(r"\x1b\[[0-9;]*m", "", text))
    lines = [_one_line(re.sub(r"[\u2500-\u257f]", " ", section)) for section in sections]
    pointers = ("For full helptext", "Argument helptext")
    kept = [line for line in lines if line and not line.startswith(pointers)]
    return " ".join(kept) or _one_line(text)


def _one_line(text: str) -> str:
    return " ".join(text.split())
