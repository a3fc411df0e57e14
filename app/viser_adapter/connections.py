"""Finds and closes the connections of a server's clients."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable

import viser
from viser.infra import ClientId
from websockets.frames import CloseCode

from onpath.app.viser_adapter.dropped import warn_once
from onpath.app.viser_adapter.secure_connection import SecureConnection


def connection_of(server: viser.ViserServer, client: int) -> SecureConnection | None:
    """The connection of a client; None if it has disconnected, or the server is not `secure`."""
    found = server._websock_server._live_connections.get(ClientId(client))
    return found if isinstance(found, SecureConnection) else None


def run_in_thread(server: viser.ViserServer, act: Callable[[], None]) -> None:
    """Call a function in one of the threads in which a server runs callbacks."""
    server._thread_executor.submit(act)


def disconnect(server: viser.ViserServer, clients: Iterable[int]) -> None:
    """Close connections whose lab is elsewhere; their pages connect again within a second."""
    for client in clients:
        _close(server, client, CloseCode.SERVICE_RESTART, "this lab has moved to another process")


def turn_away(server: viser.ViserServer, client: int, description: str) -> None:
    """Close a connection, and log its description. Its page may connect again."""
    warn_once(connection_of(server, client), description)
    _close(server, client, CloseCode.TRY_AGAIN_LATER, "")


def _close(server: viser.ViserServer, client: int, code: CloseCode, reason: str) -> None:
    connection = connection_of(server, client)
    if connection is not None:
        closing = connection.close(code, reason)
        asyncio.run_coroutine_threadsafe(closing, server.get_event_loop())
