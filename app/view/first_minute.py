"""The first minute in the lab: invitations in the strip, one after the other, each once."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Final

from onpath.app.lab.snapshots.page_snapshot import PageSnapshot

KEPT_AS: Final = "first_minute"
"""Under which name a browser keeps how many of the invitations it has shown."""
PAUSE = 2.5
"""Simulated time between invitations, to see the consequence of the last one [s]."""
READ = 6.0
"""Simulated time for which an explanation stays after what it explains [s]."""


@dataclass(frozen=True, slots=True)
class Invitation:
    """An invitation to do something.

    Attributes:
        name: in the message catalogue.
        is_followed: whether it has been followed, according to a snapshot.
        act: the command of its button, as JSON; None if it is followed elsewhere on the page.
        explained: name of the sentence that takes its place while it is being followed, and for
            `READ` afterwards; empty: there is none.
    """

    name: str
    is_followed: Callable[[PageSnapshot], bool]
    act: Mapping[str, str] | None = None
    explained: str = ""


LAST = "lesson"
INVITATIONS = (
    Invitation("hold", lambda shown: shown.held),
    Invitation("let_go", lambda shown: not shown.held),
    Invitation("pull", lambda shown: shown.grabbed is not None, explained="pulled"),
    Invitation("bend", lambda shown: shown.edit.name in ("edited", "drawn")),
    Invitation(LAST, lambda shown: shown.key.in_lesson),
)


class FirstMinute:
    """Shows the invitations that a user has not followed yet; see assets/web/parts/voice.ts.

    Args:
        lesson: name of the first lesson, to which the last invitation leads; may be empty.
        kept: how many this browser has shown, as it has kept it. The value is not trusted.
        keep: has the browser keep it.

    Attributes:
        shown: the present invitation, or None.
    """

    def __init__(
        self, lesson: str, kept: str = "", keep: Callable[[str], None] = lambda _: None
    ) -> None:
        self._lesson, self._keep = lesson, keep
        self.shown: Invitation | None = None
        known = [str(count) for count in range(len(INVITATIONS) + 1)]
        self._next = known.index(kept) if kept in known else 0
        self._since: float | None = None
        self._followed: float | None = None  # when the present one was followed last, [s]

    @property
    def is_over(self) -> bool:
        """Whether all have been shown."""
        return self._next >= len(INVITATIONS)

    def end(self) -> None:
        """Show no more invitations, nor when this browser comes again."""
        self._next, self.shown = len(INVITATIONS), None
        self._keep(str(self._next))

    def follow(self, snapshot: PageSnapshot) -> None:
        """Show the next invitation, or remove the one that has been followed."""
        if self.is_over or snapshot.plant is not None:
            return
        if snapshot.key.in_lesson and INVITATIONS[self._next].name != LAST:
            self.shown = None  # a lesson says itself what to do
            return
        if self._since is None or snapshot.time < self._since:  # the first, or after a reset
            self._since = snapshot.time - PAUSE * (self._next == 0)
        wanted, followed = INVITATIONS[self._next], self._followed
        if wanted.is_followed(snapshot) and wanted.explained:
            self._followed = snapshot.time
            self.shown = Invitation(wanted.explained, wanted.is_followed)
        elif wanted.is_followed(snapshot) or (
            followed is not None and not followed <= snapshot.time < followed + READ
        ):
            self._next, self._since, self._followed = self._next + 1, snapshot.time, None
            self._keep(str(self._next))
            self.shown = None
        elif self.shown is None and snapshot.time >= self._since + PAUSE:
            self.shown = self._invitation()

    def _invitation(self) -> Invitation:
        found = INVITATIONS[self._next]
        leads = found.name == LAST and self._lesson
        return replace(found, act={"do": "OpenLesson", "name": self._lesson}) if leads else found
