"""Asks new browsers for their local storage without blocking a thread.

viser's page answers at once; a client that does not answer gets no lab. viser's own call to read
local storage would block one of its 32 threads until the answer arrives.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from uuid import uuid4

import viser
from viser import _messages as wire
from websockets.frames import CloseCode

from onpath.app.common.error_log import log_error
from onpath.app.viser_adapter.connection_limits import PerAddress
from onpath.app.viser_adapter.message_filter import warn_once
from onpath.app.viser_adapter.places import storage_key

Kept = dict[str, str | None]


@dataclass(frozen=True, slots=True)
class Arrival:
    """A client that has answered.

    Attributes:
        kept: values of the keys, by the names that were asked for.
        address: the client's, as the limits on connections count it.
        place: of its page; see `app.viser_adapter.places`.
    """

    client: viser.ClientHandle
    kept: Kept
    address: str
    place: str


MOST, MOST_EACH = 300, 100  # clients that have not answered, in total and per address


class Arrivals:
    """Clients that have not answered yet. Runs on viser's event loop, except `enter`.

    Args:
        keys: of local storage, and whether each class has a value of its own.
        enter: called in one of viser's threads.
        most, most_each: clients that may be unanswered, in total and per address; beyond that the
            oldest is disconnected.
    """

    def __init__(
        self,
        server: viser.ViserServer,
        keys: Mapping[str, bool],
        enter: Callable[[Arrival], None],
        most: int = MOST,
        most_each: int = MOST_EACH,
    ) -> None:
        self._keys, self._enter = keys, enter
        self._threads = server._thread_executor
        self._sockets = server._websock_server._live_connections
        self._silent = PerAddress[int](most, most_each)
        self._farewells: set[asyncio.Task[None]] = set()
        server.on_client_connect(self._greet)
        server.on_client_disconnect(self._forget)

    async def _greet(self, client: viser.ClientHandle) -> None:
        socket = self._sockets.get(client.client_id)
        if socket is None:  # disconnected already
            return
        address: str = getattr(socket, "address", "")
        place: str = getattr(socket, "place", "")
        surplus = self._silent.add(client.client_id, address)
        if surplus is not None:
            self._turn_away(surplus)
        connection = client._websock_connection
        waits = {uuid4().hex: key for key in self._keys}
        kept = Kept()

        def answered(_: int, message: wire.LocalStorageGetItemResponseMessage) -> None:
            key = waits.pop(message.request_uuid, None)
            if key is not None:
                kept[key] = message.value
                if not waits and self._silent.discard(client.client_id):
                    arrival = Arrival(client, kept, address, place)
                    self._threads.submit(self._let_in, arrival)

        connection.register_handler(wire.LocalStorageGetItemResponseMessage, answered)
        for question, key in waits.items():
            stored = storage_key(key, place) if self._keys[key] else key
            connection.queue_message(wire.LocalStorageGetItemRequestMessage(stored, question))
        client.flush()

    async def _forget(self, client: viser.ClientHandle) -> None:
        self._silent.discard(client.client_id)

    def _let_in(self, arrival: Arrival) -> None:
        try:
            self._enter(arrival)
        except Exception as error:
            log_error(error)

    def _turn_away(self, number: int) -> None:
        """Disconnect a client. Its page may reconnect; then it is the newest."""
        self._silent.discard(number)
        socket = self._sockets.get(number)
        if socket is not None:
            warn_once(socket, "a newcomer that answers nothing")
            farewell = asyncio.ensure_future(socket.close(CloseCode.TRY_AGAIN_LATER))
            self._farewells.add(farewell)
            farewell.add_done_callback(self._farewells.discard)
