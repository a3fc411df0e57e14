"""Reads a browser's local storage without blocking."""

from __future__ import annotations

from collections.abc import Callable

import viser
from viser import _messages


def ask_item(client: viser.ClientHandle, key: str, answer: Callable[[str], None]) -> None:
    """Ask a browser for a value; `client.local_storage.get_item` would wait for it in a thread.

    Args:
        answer: called once with the value, "" if there is none, on viser's event loop; never if the
            browser does not answer.
    """
    connection, question = client._websock_connection, f"kept:{key}"
    kind = _messages.LocalStorageGetItemResponseMessage

    async def answered(_: int, message: _messages.LocalStorageGetItemResponseMessage) -> None:
        if message.request_uuid == question:
            connection.unregister_handler(kind, answered)
            answer(message.value or "")

    connection.register_handler(kind, answered)
    connection.queue_message(_messages.LocalStorageGetItemRequestMessage(key, question))
