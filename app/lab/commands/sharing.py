"""Commands that make and use share codes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from onpath.app.lab.command import Command
from onpath.app.lab.setup import capture, restore
from onpath.app.lab.share_code import decode, encode

if TYPE_CHECKING:
    from onpath.app.lab.session import Session


@dataclass(frozen=True, slots=True)
class Share(Command):
    """Make a share code of the lab as it is."""

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        session.shared = encode(capture(session))


@dataclass(frozen=True, slots=True)
class UseShared(Command):
    """Set the lab up as a share code says."""

    text: str

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        restore(session, decode(self.text))
        session.show_message("")
