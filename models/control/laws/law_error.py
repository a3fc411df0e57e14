"""What a user is told of an error in a law's own code."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from functools import partial
from pathlib import Path
from traceback import walk_tb
from typing import Any

from onpath.models.errors import CodedError

LONGEST = 300  # characters of the error itself


def law_error(name: str, error: BaseException, function: Callable[..., Any]) -> CodedError:
    """A message with the law's name, the error, and the line of the law's file that led to it.

    Args:
        name: of the law.
        error: which the function has raised, or has caused elsewhere by what it returned.
        function: of the law. Its first line is given if the error was raised elsewhere.
    """
    while isinstance(function, partial):
        function = function.func
    code = getattr(function, "__code__", None) or type(function).__call__.__code__
    return error_in(name, error, code.co_filename, code.co_firstlineno)


def error_in(name: str, error: BaseException, file: str, line: int = 1) -> CodedError:
    """The message of `law_error`, with the last line of a file in the error's traceback.

    Args:
        line: which is given if the traceback does not pass through the file.
    """
    if isinstance(error, SyntaxError) and error.filename == file:
        line = error.lineno or line
    for frame, number in walk_tb(error.__traceback__):
        if frame.f_code.co_filename == file:
            line = number
    reason = f"{type(error).__name__}: {' '.join(str(error).split())}{_has(error)}"[:LONGEST]
    return CodedError(
        "error.law_fails", law=name, reason=reason, file=Path(file).name, line=str(line)
    )


def _has(error: BaseException) -> str:
    """What a law's argument, or a part of it, has instead of what its code asked for."""
    asked = error.obj if isinstance(error, AttributeError) else None
    if not dataclasses.is_dataclass(asked):
        return ""
    return f"; it has {', '.join(field.name for field in dataclasses.fields(asked))}"
