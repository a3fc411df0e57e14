"""The votes of a class: what it is asked together, and until when an answer counts."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from onpath.lessons.given import Given
from onpath.lessons.progress import Notes, given_to


@dataclass(frozen=True, slots=True)
class Vote:
    """A question that a teacher has put to the class.

    Attributes:
        lesson, item: the question; see `Given.item`.
        step: index of the step that was opened for it, beyond which nobody goes meanwhile.
        again: whether it is asked again, after a discussion.
        closes: seconds since 1970, after which an answer is late; None while the vote is open.
    """

    lesson: str
    item: str
    step: int
    again: bool = False
    closes: float | None = None

    def is_about(self, lesson: str, item: str, again: bool) -> bool:
        """Whether it is the vote on this question, before a discussion or after it."""
        return (self.lesson, self.item, self.again) == (lesson, item, again)

    def is_open(self, now: float) -> bool:
        """Whether an answer given now, [s], counts."""
        return self.closes is None or now <= self.closes


def vote_on(votes: Iterable[Vote], lesson: str, item: str, again: bool = False) -> Vote | None:
    """The vote on a question, if it was put to the class."""
    return next((each for each in votes if each.is_about(lesson, item, again)), None)


def is_late(vote: Vote | None, given: Given) -> bool:
    """Whether an answer was given after the vote had been closed."""
    return vote is not None and not vote.is_open(given.time)


def counted(notes: Notes, item: str, vote: Vote | None, again: bool = False) -> Given | None:
    """The answer of a student that counts: the first one in time; None if there is none.

    Args:
        again: whether the question is asked again; the answers of that round are meant.
    """
    asked = notes.asked_again.count(item)
    if again and not asked:
        return None
    wanted = asked if again else 0
    given = [
        each for each in given_to(notes, item) if each.round == wanted and not is_late(vote, each)
    ]
    made = [each for each in given if not each.is_skipped]
    return next(iter(made or given), None)
