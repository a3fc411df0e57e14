"""`onpath --help`, and the help of a group of subcommands."""

from __future__ import annotations

import shutil
from collections.abc import Iterable, Sequence
from pathlib import Path
from textwrap import TextWrapper
from typing import Any

import onpath
from onpath.app.cli.commands import COMMANDS, CommandGroup
from onpath.app.cli.completion import LINES
from onpath.app.cli.options import options
from onpath.app.cli.serve import Serve

OFTEN = "--port", "--open", "--robot", "--classroom", "--host"
"""Options of the lab that the first help shows."""
EXAMPLES = (
    ("onpath --open", "the lab, in your browser"),
    ("onpath --classroom --host 0.0.0.0", "a class, for other devices too"),
    ("onpath experiment obstruction --plot held.png", "the paper's experiment, drawn"),
    ("onpath figure held.html --law both --path circle,clover", "a live page without a server"),
    ("onpath sweep --law both --set K1=400,900 --hold 1 2", "a table of runs"),
)


DOCUMENTS = "README.md", "models/studies/README.md", "lessons/README.md", "app/README.md"


def top_help() -> str:
    """The help of `onpath`."""
    texts = {each.flag: each.help for each in options(Serve)}
    shown = [(flag, texts[flag]) for flag in OFTEN]
    shown.append(("--version", "Print the version."))
    home = Path(onpath.__path__[-1])
    documents = ", ".join(name for name in DOCUMENTS if (home / name).is_file())
    parts = [
        "OnPath: a lab in which path following and trajectory tracking can be compared.",
        "onpath [OPTIONS]           serves the lab for your browser, until Ctrl-C\n"
        "onpath COMMAND [OPTIONS]   runs one of the commands below",
        "Options of the lab; onpath serve --help shows all of them:",
        _table(shown),
        "Commands; onpath COMMAND --help, or onpath help COMMAND, shows the options of one:",
        _table((name, _text(each)) for name, each in COMMANDS.items()),
        "Examples:",
        _table(EXAMPLES),
        "Robot, path, law and settings are --robot, --path, --law and --set NAME=VALUE in all\n"
        "commands; what may be given more than once also takes commas. onpath names lists them.",
        "Your shell completes commands and options after one of these lines, in a new window:",
        "\n".join(f"  {shell:4}  {line}" for shell, line in LINES.items()),
        f"Documentation, in {home}:\n  {documents}\n  In Python: help(onpath)",
    ]
    return "\n".join(f"{part}\n" if not part.endswith(":") else part for part in parts).rstrip("\n")


def group_help(words: Sequence[str]) -> str:
    """The help of a group of subcommands."""
    known: Any = COMMANDS
    for word in words:
        group = known[word]
        known = group.commands
    of = " ".join(["onpath", *words])
    table = _table((name, _text(each)) for name, each in known.items())
    return f"{group.text}\n\n{of} COMMAND --help shows the options of a command:\n{table}"


def _text(command: Any) -> str:
    return command.text if isinstance(command, CommandGroup) else command.__doc__.split("\n\n")[0]


def _table(rows: Iterable[tuple[str, str]]) -> str:
    """Two columns, the second one wrapped."""
    rows = [(name, " ".join(text.split())) for name, text in rows]
    wide = max(len(name) for name, _ in rows) + 4
    width = min(shutil.get_terminal_size().columns, 100)
    lines = list[str]()
    for name, text in rows:
        wrapper = TextWrapper(
            width=max(width, wide + 30),
            initial_indent=f"  {name}".ljust(wide),
            subsequent_indent=" " * wide,
            break_on_hyphens=False,
        )
        lines += wrapper.wrap(text)
    return "\n".join(lines)
