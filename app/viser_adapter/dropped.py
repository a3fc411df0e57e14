"""Logs what is dropped of what a browser sends."""

from __future__ import annotations

import weakref
from typing import Any

from websockets.asyncio.server import ServerConnection

from onpath.app.common.error_log import log_warning

_warned: weakref.WeakSet[Any] = weakref.WeakSet()


def warn_once(connection: ServerConnection | None, description: str) -> None:
    """Log that a message of a browser was dropped, once per connection."""
    if connection is not None and connection not in _warned:
        _warned.add(connection)
        client = connection.remote_address
        log_warning("client %s: dropped %s; further messages are not logged", client, description)
