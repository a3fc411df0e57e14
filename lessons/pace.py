"""The steps that a teacher has opened to the class."""

from __future__ import annotations

from dataclasses import dataclass

from onpath.lessons.concept_test.concept_test import sitting_of


@dataclass(frozen=True, slots=True)
class Pace:
    """Steps of one lesson, by their indices.

    Attributes:
        lesson: a test stands for both of its forms.
        first, last: both are included.
    """

    lesson: str
    first: int
    last: int

    def holds(self, lesson: str, index: int) -> bool:
        """Whether a step is one of them."""
        return sitting_of(lesson) == self.lesson and self.first <= index <= self.last
