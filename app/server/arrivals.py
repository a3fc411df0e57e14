"""Asks viser's new clients for the number of their page, without blocking a thread.

viser's page answers at once; a client that does not answer is shown nothing. viser's own function
to read local storage would block one of its 32 threads until the answer arrives.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import viser

from onpath.app.viser_adapter.connection_limits import PerAddress
from onpath.app.viser_adapter.connections import connection_of, turn_away
from onpath.app.viser_adapter.local_storage import ask_item

PAGE_KEY = "page"  # answered by assets/web/channel/connection.ts
MOST, MOST_EACH = 300, 100  # clients that have not answered, in total and per address


class Arrivals:
    """Clients that have not answered yet. Runs on viser's event loop.

    Args:
        enter: called with a client and the number of its page.
        most, most_each: clients whose answer may be missing, in total and per address; beyond that
            the oldest is disconnected.
    """

    def __init__(
        self,
        server: viser.ViserServer,
        enter: Callable[[viser.ClientHandle, str], None],
        most: int = MOST,
        most_each: int = MOST_EACH,
    ) -> None:
        self._enter, self._server = enter, server
        self._silent = PerAddress[int](most, most_each)
        server.on_client_connect(self._greet)
        server.on_client_disconnect(self._forget)

    async def _greet(self, client: viser.ClientHandle) -> None:
        number = client.client_id
        connection = connection_of(self._server, number)
        if connection is None:  # disconnected already
            return
        surplus = self._silent.add(number, connection.address)
        if surplus is not None:
            self._silent.discard(surplus)  # its page may connect again; then it is the newest
            turn_away(self._server, surplus, "a new client that does not answer")
        ask_item(client, PAGE_KEY, partial(self._answered, client))
        client.flush()

    def _answered(self, client: viser.ClientHandle, answer: str) -> None:
        if self._silent.discard(client.client_id):
            self._enter(client, answer)

    async def _forget(self, client: viser.ClientHandle) -> None:
        self._silent.discard(client.client_id)
