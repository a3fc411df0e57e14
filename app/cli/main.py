"""The command `onpath`: serves the lab in the browser, or runs one of the subcommands."""

from __future__ import annotations

import contextlib
import io
import os
import re
import sys
import warnings
from collections.abc import Iterator
from importlib.metadata import version
from typing import Any

from onpath.app.cli.commands import COMMANDS, CommandGroup, Subcommand
from onpath.app.cli.help import group_help, top_help
from onpath.app.cli.options import parsed
from onpath.app.cli.paper import NAMES
from onpath.app.cli.supervisor import supervised
from onpath.models.errors import CodedError
from onpath.models.systems.parameter_specs import unknown_name

INTERRUPTED = 130
PLAINER = (
    (
        r"Error parsing (\S+): no type matching .* from \[(.*?)\]\..* count (\d+) of .*",
        r"\1: expected \3 numbers, got \2",
    ),
    (
        r"Error parsing (\S+): no type matching .* from \[(.*?)\]\..*",
        r"\1: expected numbers, got \2",
    ),
    (r"Error parsing (\S+): could not convert string to float: (.*)", r"\1: \2 is not a number"),
    (r"Error parsing (\S+): invalid literal for int.*?: (.*)", r"\1: \2 is not a whole number"),
)
"""Patterns of tyro's complaints -> what is said instead."""


def main() -> None:
    """Entry point of `onpath`."""
    _print_any_text()
    arguments = sys.argv[1:]
    if arguments and (arguments[0] in COMMANDS.keys() - {"serve"} or arguments[0] in _INSTEAD):
        sys.exit(run_command(arguments))

    def serve(again: bool) -> int:
        opened = {"--open"} if again else set[str]()  # its tab comes back by itself
        return run_command([given for given in arguments if given not in opened])

    sys.exit(supervised(serve))


def _print_any_text() -> None:
    """Allow any character in the output; Windows would limit a redirected file to 256."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            chosen = stream.isatty() or "PYTHONIOENCODING" in os.environ
            stream.reconfigure(encoding=None if chosen else "utf-8", errors="replace")


_INSTEAD = {
    "-h": ["--help"],
    "help": ["--help"],
    "-V": ["--version"],
    "version": ["--version"],
}


def run_command(arguments: list[str]) -> int:
    """Run one command line; return the exit code.

    The code is 0; 1 for lessons with problems, and for a lab without its database; 2, with one
    line on standard error, for other errors; or 130, the usual one, for an interrupted command.
    """
    try:
        with _remarks_on_stderr():
            return _run(arguments)
    except BrokenPipeError:
        return 0
    except SystemExit as stop:
        if stop.code:
            raise
        return 0  # after a help
    except KeyboardInterrupt:
        return INTERRUPTED
    except (ValueError, OSError) as error:
        print(f"onpath: {_one_line(str(error))}{_where_names_are(error)}", file=sys.stderr)
        return 2


def _where_names_are(error: Exception) -> str:
    """Which command lists the names, if an error is for an unknown one."""
    arguments = error.message.arguments if isinstance(error, CodedError) else {}
    listed = arguments.get("kind") in ("robot", "path", "law", "parameter")
    return " (onpath names lists all)" if listed else ""


@contextlib.contextmanager
def _remarks_on_stderr() -> Iterator[None]:
    """Print what Python's functions warn of, a line each."""
    with warnings.catch_warnings():
        usual = warnings.showwarning

        def told(message: Any, category: type[Warning], *place: Any, **more: Any) -> None:
            if issubclass(category, UserWarning):
                print(f"onpath: {_one_line(str(message))}", file=sys.stderr)
            else:
                usual(message, category, *place, **more)

        warnings.simplefilter("always", UserWarning)
        warnings.showwarning = told
        yield


def _run(arguments: list[str]) -> int:
    match arguments:
        case ["--help" | "-h"] | ["help"]:
            print(top_help())
            return 0
        case ["--version" | "-V" | "version", *_]:
            print(f"onpath {version('onpath')}")
            return 0
        case ["help", *command]:
            return _run([*command, "--help"])
        case ["figure", name, *_] if name in NAMES:
            raise ValueError(f"the paper's figures are drawn by onpath paper {name} now")
        case ["export", "figure", *_]:
            raise ValueError("onpath export figure is called onpath figure now")
        case ["arena", law, *_] if not law.startswith("-"):
            raise ValueError(f"a law is given as --law now: onpath arena --law {law}")
        case _:
            return parsed_command(arguments).run() or 0


def parsed_command(arguments: list[str]) -> Subcommand:
    """The subcommand of a command line; only its options are built, which starts sooner."""
    if not arguments or arguments[0].startswith("-"):
        arguments = ["serve", *arguments]
    known: Any = COMMANDS
    for used, name in enumerate(arguments, 1):
        if name not in known:
            if name in ("-h", "--help"):
                print(group_help(arguments[: used - 1]))
                raise SystemExit(0)
            of = " ".join(arguments[:used])
            raise unknown_name(of, [*known], "command")
        found = known[name]
        if not isinstance(found, CommandGroup):
            return _parsed_options(found, " ".join(["onpath", *arguments[:used]]), arguments[used:])
        known = found.commands
    raise ValueError(f"{' '.join(arguments)}: expected one of {', '.join(known)} after it")


def _parsed_options(command: type[Subcommand], prog: str, options: list[str]) -> Subcommand:
    complaint = io.StringIO()
    try:
        with contextlib.redirect_stderr(complaint):
            return parsed(command, prog, options)
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
    told = " ".join(kept).removesuffix(" (required)") or _one_line(text)
    for pattern, plain in PLAINER:
        told = re.sub(pattern, plain, told)
    return told


def _one_line(text: str) -> str:
    return " ".join(text.split())
