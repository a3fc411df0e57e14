"""The steps that a teacher has opened to the class."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Pace:
    """Steps of one lesson, by their indices.

    Attributes:
        first, last: both are included.
    """

    lesson: str
    first: int
    last: int

    def holds(self, lesson: str, index: int) -> bool:
        """Whether a step is one of them."""
        return lesson == self.lesson and self.first <= index <= self.last
