"""What a teacher asks of a student's lab; see app/lab/commands.py.

No widget of a student's page makes these.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from onpath.app.lab.setup import Setup

if TYPE_CHECKING:
    from onpath.app.lab.session import Session


@dataclass(frozen=True, slots=True)
class Freeze:
    """Time stands still and the student's commands are refused; or all goes on."""

    on: bool


@dataclass(frozen=True, slots=True)
class TakeSetup:
    """The lab set up so, in the free lab or in the step that is open."""

    setup: Setup


@dataclass(frozen=True, slots=True)
class TakeStep:
    """A step of a lesson, from wherever the student is."""

    lesson: str
    step: int


@dataclass(frozen=True, slots=True)
class ShowMessage:
    """How the lab is now, to somebody who must not keep it waiting."""

    to: Callable[[Session], None]


ClassCommand = Freeze | TakeSetup | TakeStep | ShowMessage
