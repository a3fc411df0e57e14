"""What a page must know of the server: its session's code, and how to go to another's."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Desk:
    """For one client.

    Attributes:
        code: of its session.
        keeps: whether labs outlive the server.
        enter: go to the session of a code; raises ValueError with words.
    """

    code: str
    keeps: bool
    enter: Callable[[str], None]
