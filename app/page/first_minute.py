"""The first minute in the lab: invitations in the scene, one after the other, each once."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import viser

from onpath.app.common.templates import render
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.viser_adapter.local_storage import ask_item
from onpath.lessons.words import Words

KEPT_AS = "first_minute"
"""Where a browser keeps how many of the invitations it has shown."""
PAUSE = 2.5
"""Simulated time between invitations, to see the consequence of the last one [s]."""


@dataclass(frozen=True, slots=True)
class Invitation:
    """An invitation to do something.

    Attributes:
        name: in the message catalogue.
        is_followed: whether it has been followed, according to a snapshot.
        key: the lab's key that its button presses; empty if it is followed in the scene itself.
    """

    name: str
    is_followed: Callable[[PageSnapshot], bool]
    key: str = ""


INVITATIONS = (
    Invitation("hold", lambda shown: shown.held, "h"),
    Invitation("let_go", lambda shown: not shown.held, "h"),
    Invitation("pull", lambda shown: shown.grabbed is not None),
    Invitation("bend", lambda shown: shown.edit.name in ("edited", "drawn")),
    Invitation("lesson", lambda shown: shown.key.in_lesson, "o"),
)


def end_first_minute(client: viser.ClientHandle) -> None:
    """Record in the browser that all invitations have been shown."""
    client.local_storage.set_item(KEPT_AS, str(len(INVITATIONS)))


class FirstMinute:
    """Shows the invitations that a user has not followed yet; see assets/page/invitation.js."""

    def __init__(self, client: viser.ClientHandle, words: Words) -> None:
        self._client, self._words = client, words
        self._handle = client.gui.add_html("")
        self._next = len(INVITATIONS)  # until the browser reports which it has shown
        self._since: float | None = None
        ask_item(client, KEPT_AS, self._begin)

    def follow(self, snapshot: PageSnapshot) -> None:
        """Show the next invitation, or remove the one that has been followed."""
        if self._next >= len(INVITATIONS):
            return
        if self._since is None or snapshot.time < self._since:  # the first, or after a reset
            self._since = snapshot.time - PAUSE * (self._next == 0)
        if INVITATIONS[self._next].is_followed(snapshot):
            self._next, self._since = self._next + 1, snapshot.time
            self._client.local_storage.set_item(KEPT_AS, str(self._next))
            self._handle.content = ""
        elif not self._handle.content and snapshot.time >= self._since + PAUSE:
            self._handle.content = self._content()

    def _begin(self, kept: str) -> None:
        """Continue after the invitations that this browser has shown. Its value is not trusted."""
        known = [str(count) for count in range(len(INVITATIONS) + 1)]
        self._next = known.index(kept) if kept in known else 0

    def _content(self) -> str:
        words, invitation = self._words, INVITATIONS[self._next]
        return render(
            "panel/invitation.html",
            text=words(f"invite.{invitation.name}"),
            button=words(f"invite.{invitation.name}_button") if invitation.key else "",
            key=invitation.key,
            end=len(INVITATIONS),
            words=words,
        )
