"""Lets other threads than the network's wake the task that sends viser's messages."""

from __future__ import annotations

import asyncio
from contextlib import suppress

from viser.infra import WebsockMessageHandler


class MessageEvent(asyncio.Event):
    """An event that another thread may set, if the event loop sets it afterwards, too.

    viser does both. If the waiting task wakes up at the moment when the other thread wakes it,
    asyncio raises "deque mutated during iteration" in that thread. The event has been set by then.
    """

    def set(self) -> None:
        """See `asyncio.Event`."""
        with suppress(RuntimeError):
            super().set()


def let_threads_send(handler: WebsockMessageHandler) -> None:
    """Let any thread queue messages for the browsers of this handler."""
    handler.get_message_buffer().message_event.__class__ = MessageEvent
