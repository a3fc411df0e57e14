"""Reads a browser's local storage without blocking."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import viser
from viser import _messages

_ANSWER = _messages.LocalStorageGetItemResponseMessage


def ask_item(client: viser.ClientHandle, key: str, answer: Callable[[str], None]) -> None:
    """Ask a browser for a value; `client.local_storage.get_item` would wait for it in a thread.

    Args:
        answer: called on viser's event loop, once, with the value or "" if there is none; never
            called if the browser does not answer.
    """
    question = _Question(client._websock_connection, f"kept:{key}", answer)
    question.ask(key)


class _Question:
    """Waits for one answer. It has no reference to itself, so it is freed after the answer."""

    def __init__(self, connection: Any, name: str, answer: Callable[[str], None]) -> None:
        self._connection, self._name, self._answer = connection, name, answer

    def ask(self, key: str) -> None:
        self._connection.register_handler(_ANSWER, self._heard)
        message = _messages.LocalStorageGetItemRequestMessage(key, self._name)
        self._connection.queue_message(message)

    async def _heard(self, _: int, message: _messages.LocalStorageGetItemResponseMessage) -> None:
        if message.request_uuid == self._name:
            self._connection.unregister_handler(_ANSWER, self._heard)
            self._answer(message.value or "")
