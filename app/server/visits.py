"""All visits of a server: pages greet it, viser's clients find their page, and both leave."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from itertools import count

import msgspec
import viser

from onpath.app.channel.messages import Hello
from onpath.app.server.arrivals import Arrivals
from onpath.app.server.tab_visibility import TICK
from onpath.app.server.visit import Visit
from onpath.app.viser_adapter.connections import (
    connection_of,
    disconnect,
    run_in_thread,
    turn_away,
)
from onpath.app.viser_adapter.data_channel import DataChannel, PageStream
from onpath.app.viser_adapter.scene_release import release_scene
from onpath.app.viser_adapter.secure_connection import SecureConnection

DIGITS = 10  # most digits of a request's number
_hello = msgspec.json.Decoder(Hello)


class Visits:
    """The visits of the pages that are connected. Runs on the event loop unless noted otherwise.

    Args:
        come: called in a thread with each new visit, to give it its lab.
        furnish: called in a thread when viser's client of a page has come.
        leave: called with the number of a visit that ends, before its page can be back.
        takes: whether there is a page at a prefix and a screen; see `CountedConnection`.

    Attributes:
        channel: the pages' own websockets.
    """

    def __init__(
        self,
        come: Callable[[Visit], None],
        furnish: Callable[[Visit], None],
        leave: Callable[[int], object],
        takes: Callable[[str, str], bool] = lambda *_: True,
    ) -> None:
        self._takes = takes
        self._come, self._furnish, self._leave = come, furnish, leave
        self.channel = DataChannel(self._greet)
        self._of_page = dict[str, Visit]()
        self._of_client = dict[int, Visit]()
        self._numbers = count(1)

    def attend(self, server: viser.ViserServer) -> None:
        """Attend to the clients of a server. Call it once, before the first one."""
        self._server = server
        Arrivals(server, self._client_comes)
        server.on_client_disconnect(self._client_leaves)
        server.get_event_loop().call_soon_threadsafe(self._check)

    def __iter__(self) -> Iterator[Visit]:
        """Thread-safe."""
        return iter(list(self._of_page.values()))

    def __len__(self) -> int:
        return len(self._of_page)

    def under(self, prefix: str) -> set[int]:
        """The numbers of the visits at a page's address. Thread-safe."""
        return {visit.number for visit in self if visit.prefix == prefix}

    def send_away(self, numbers: set[int]) -> None:
        """Close connections whose lab is elsewhere; their pages connect again. Thread-safe."""
        for visit in self:
            if visit.number in numbers:
                self.channel.call(partial(self._send_away, visit))

    def _greet(self, text: str, connection: SecureConnection) -> PageStream | None:
        try:
            hello = _hello.decode(text)
        except (ValueError, RecursionError, MemoryError):
            return None
        visit = self._of_page.get(hello.page)
        if not self._takes(connection.prefix, connection.screen):
            return None
        if visit is None:
            visit = self._begun(hello, connection)
            run_in_thread(self._server, partial(self._come, visit))
        elif (visit.prefix, visit.screen) != (connection.prefix, connection.screen):
            return None
        else:
            connection.loop.call_soon(visit.renew)
        return visit.stream

    def _begun(self, hello: Hello, connection: SecureConnection) -> Visit:
        def left() -> None:
            self._end_if_left(visit)

        visit = Visit(next(self._numbers), hello, connection, self.channel, left)
        self._of_page[hello.page] = visit
        return visit

    def _client_comes(self, client: viser.ClientHandle, answer: str) -> None:
        """Give viser's client to the page that has asked for it.

        Args:
            answer: "PAGE.ASKED": its number, and how many times it has asked for a picture.
        """
        page, _, asked = answer.partition(".")
        visit, connection = self._of_page.get(page), connection_of(self._server, client.client_id)
        if connection is None:  # disconnected already
            return
        if visit is None or visit.prefix != connection.prefix:
            turn_away(self._server, client.client_id, "a picture without a page")
            return
        before, visit.client = visit.client, client
        visit.asked = int(asked) if asked.isdecimal() and len(asked) < DIGITS else 1
        self._of_client[client.client_id] = visit
        if before is not None:
            turn_away(self._server, before.client_id, "a picture that another one replaces")
        run_in_thread(self._server, partial(self._furnish, visit))

    async def _client_leaves(self, client: viser.ClientHandle) -> None:
        visit = self._of_client.pop(client.client_id, None)
        if visit is not None and visit.client is client:
            visit.client = None
            self._end_if_left(visit)
        run_in_thread(self._server, partial(self._release, client, visit))

    def _release(self, client: viser.ClientHandle, visit: Visit | None) -> None:
        """Forget the scene of a client. In a thread."""
        if visit is not None and visit.feed is not None:
            visit.feed.unfurnish(client)
        release_scene(client)

    def _end_if_left(self, visit: Visit) -> None:
        if not visit.is_connected and self._of_page.pop(visit.hello.page, None) is not None:
            self._leave(visit.number)
            run_in_thread(self._server, visit.close)

    def _send_away(self, visit: Visit) -> None:
        client, visit.client = visit.client, None
        visit.stream.end()
        if client is not None:
            disconnect(self._server, {client.client_id})
        self._end_if_left(visit)

    def _check(self) -> None:
        self._server.get_event_loop().call_later(TICK, self._check)
        for visit in self:
            visit.sight.check()
