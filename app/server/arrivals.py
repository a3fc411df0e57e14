"""Asks new browsers for their local storage without blocking a thread.

viser's page answers at once; a client that does not answer gets no lab. viser's own function to
read local storage would block one of its 32 threads until the answer arrives.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

import viser

from onpath.app.common.error_log import log_error
from onpath.app.viser_adapter.addresses import storage_key
from onpath.app.viser_adapter.connection_limits import PerAddress
from onpath.app.viser_adapter.connections import connection_of, run_in_thread, turn_away
from onpath.app.viser_adapter.local_storage import ask_item

Kept = dict[str, str]


@dataclass(frozen=True, slots=True)
class Arrival:
    """A client that has answered.

    Attributes:
        kept: values by key; "" where there is none.
        address: the client's, as the limits on connections count it.
        prefix: of its page's address; see `app.viser_adapter.addresses`.
        language: the supported language that its browser prefers.
    """

    client: viser.ClientHandle
    kept: Kept
    address: str
    prefix: str
    language: str


MOST, MOST_EACH = 300, 100  # clients that have not answered, in total and per address


class Arrivals:
    """Clients that have not answered yet. Runs on viser's event loop, except `enter`.

    Args:
        keys: of local storage, and whether the value differs between classes.
        enter: called in one of viser's threads.
        most, most_each: clients whose answer may be missing, in total and per address; beyond that
            the oldest is disconnected.
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
        self._server = server
        self._silent = PerAddress[int](most, most_each)
        server.on_client_connect(self._greet)
        server.on_client_disconnect(self._forget)

    async def _greet(self, client: viser.ClientHandle) -> None:
        number = client.client_id
        connection = connection_of(self._server, number)
        if connection is None:  # disconnected already
            return
        address, prefix, language = connection.address, connection.prefix, connection.language
        surplus = self._silent.add(number, address)
        if surplus is not None:
            self._silent.discard(surplus)  # its page may connect again; then it is the newest
            turn_away(self._server, surplus, "a new client that does not answer")
        kept = Kept()

        def answered(key: str, value: str) -> None:
            kept[key] = value
            if len(kept) == len(self._keys) and self._silent.discard(number):
                arrival = Arrival(
                    client=client, kept=kept, address=address, prefix=prefix, language=language
                )
                run_in_thread(self._server, partial(self._let_in, arrival))

        for key, by_class in self._keys.items():
            stored = storage_key(key, prefix) if by_class else key
            ask_item(client, stored, partial(answered, key))
        client.flush()

    async def _forget(self, client: viser.ClientHandle) -> None:
        self._silent.discard(client.client_id)

    def _let_in(self, arrival: Arrival) -> None:
        try:
            self._enter(arrival)
        except Exception as error:
            log_error(error)
