"""Lets any thread, and not only the network's, wake the task that sends viser's messages."""

from __future__ import annotations

import asyncio
from contextlib import suppress

from typing_extensions import override
from viser.infra import WebsockMessageHandler


class MessageEvent(asyncio.Event):
    """An event that another thread may set, provided that the event loop then sets it, too.

    viser does both. If the waiting task wakes up just when the other thread wakes it, asyncio
    raises "deque mutated during iteration" in that thread. The event is set by then.
    """

    @override
    def set(self) -> None:
        with suppress(RuntimeError):
            super().set()


def let_threads_send(handler: WebsockMessageHandler) -> None:
    """Let any thread queue messages for the browsers of this handler."""
    handler.get_message_buffer().message_event.__class__ = MessageEvent
