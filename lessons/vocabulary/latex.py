"""Faults of formulas that the converter does not report: unknown commands, braces left open."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from itertools import accumulate

from latex2mathml import commands
from latex2mathml.symbols_parser import SYMBOLS

from onpath.lessons.problems import near

UNKNOWN = re.compile(r"<m[io][^>]*>(\\[A-Za-z]+)</m[io]>")
ENVIRONMENT = re.compile(r"\\begin\s*\{([^}]*)\}")
ENVIRONMENTS = (
    *("matrix", "pmatrix", "bmatrix", "Bmatrix", "vmatrix", "Vmatrix", "smallmatrix", "array"),
    *("cases", "align", "align*", "split"),
)


def latex_faults(latex: str, mathml: str) -> Iterator[str]:
    """The commands and environments of a formula that are unknown, with the nearest known ones.

    Args:
        mathml: the formula after conversion.
    """
    for name in dict.fromkeys(ENVIRONMENT.findall(latex)):
        if name not in ENVIRONMENTS:
            yield f"unknown environment {name!r}{near(name, ENVIRONMENTS)}"
    for name in dict.fromkeys(UNKNOWN.findall(mathml)):
        plain = f"\\operatorname{{{name[1:]}}}"
        yield f"unknown command {name}{near(name, _known())} A name is written {plain}"


def brace_faults(latex: str) -> Iterator[str]:
    """Braces, `\\left` and `\\right` without a counterpart."""
    bare = latex.replace("\\\\", " ").replace("\\{", " ").replace("\\}", " ")
    depths = [0, *accumulate((char == "{") - (char == "}") for char in bare)]
    if depths[-1] > 0:
        yield "a { is not closed by }"
    elif min(depths) < 0:
        yield "a } closes nothing"
    left, right = (len(re.findall(rf"\\{side}(?![A-Za-z])", bare)) for side in ("left", "right"))
    if left != right:
        yield f"{left} \\left and {right} \\right: each \\left( needs its \\right)"


@cache
def _known() -> tuple[str, ...]:
    """All commands that can be converted."""
    constants = [value for value in vars(commands).values() if isinstance(value, str)]
    return tuple(sorted({name for name in (*constants, *SYMBOLS) if name[:1] == "\\"}))
