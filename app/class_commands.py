"""What a teacher asks of a student's lab; see app/commands.py.

No widget of a student's page makes these.
"""

from __future__ import annotations

from dataclasses import dataclass

from app.setups import Setup


@dataclass(frozen=True, slots=True)
class Freeze:
    """Time stands still and the student's commands are refused; or all goes on."""

    on: bool


@dataclass(frozen=True, slots=True)
class TakeSetup:
    """The free lab, set up so."""

    setup: Setup


@dataclass(frozen=True, slots=True)
class TakeStep:
    """A step of a lesson, from wherever the student is."""

    lesson: str
    step: int


ClassCommand = Freeze | TakeSetup | TakeStep
