"""`onpath completion`: a script with which a shell completes commands and options."""

from __future__ import annotations

import dataclasses
import io
from contextlib import redirect_stdout, suppress
from typing import TYPE_CHECKING, Annotated, Any, Union

import tyro

from onpath.app.cli.options import PLAIN, described

if TYPE_CHECKING:
    from collections.abc import Mapping

LINES = {
    "bash": """echo 'eval "$(onpath completion bash)"' >> ~/.bashrc""",
    "zsh": "mkdir -p ~/.zfunc && onpath completion zsh > ~/.zfunc/_onpath && "
    "echo 'fpath+=~/.zfunc; autoload -Uz compinit; compinit' >> ~/.zshrc",
    "fish": "mkdir -p ~/.config/fish/completions && "
    "onpath completion fish > ~/.config/fish/completions/onpath.fish",
}
"""What installs the completion for each shell."""
FILES_IN_BASH = """
_onpath() {
  _tyro_onpath "$@"
  [[ ${#COMPREPLY[@]} == 1 && -z ${COMPREPLY[0]} ]] && COMPREPLY=()
}
complete -o default -F _onpath onpath
"""
"""Completes names of files where there is no option."""


def completion_script(shell: str, commands: Mapping[str, Any], alone: type) -> str:
    """The script for a shell.

    Args:
        commands: the commands, or groups of commands, by their word.
        alone: the command without a word.
    """
    told = io.StringIO()
    printed = ["--tyro-print-completion", shell]
    with suppress(SystemExit), redirect_stdout(told):
        whole = _whole("onpath", commands, described(alone))
        tyro.cli(whole, prog="onpath", args=printed, config=PLAIN)
    return told.getvalue() + (FILES_IN_BASH if shell == "bash" else "")


def _whole(name: str, commands: Mapping[str, Any], *bases: type) -> type:
    """A command with subcommands, as tyro takes them."""
    kinds = [
        Annotated[
            described(each) if isinstance(each, type) else _whole(word, each.commands),
            tyro.conf.subcommand(word, prefix_name=False),
        ]
        for word, each in commands.items()
    ]
    union = Annotated[Union[tuple(kinds)], tyro.conf.arg(name="")]  # noqa: UP007
    return dataclasses.make_dataclass(name, [("do", union)], bases=bases, frozen=True, kw_only=True)
