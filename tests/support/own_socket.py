"""A page's own websocket, which is read and told that the page is drawn, in a thread of its own."""

from __future__ import annotations

import json
import secrets
import socket
import threading
import time
from contextlib import suppress
from typing import Any, Self

from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect
from websockets.typing import Subprotocol

from onpath.app.server.lab_feed import LabFeed
from onpath.app.server.lab_server import LabServer
from onpath.app.server.visit import Visit
from onpath.app.viser_adapter.data_channel import SUBPROTOCOL
from tests.bench.client_protocol import SEEN, hello
from tests.bench.simulated_browser import SEES


def feeds(server: LabServer) -> dict[int, LabFeed]:
    """What shows labs in pages whose part of viser is there, by viser's number of the client."""
    shown = [visit.feed for visit in server.visits if visit.feed is not None]
    return {feed.scene.client.client_id: feed for feed in shown if feed.scene is not None}


def visit_of(server: LabServer, client: int) -> Visit:
    """The visit to which a client of viser belongs."""
    return next(v for v in server.visits if v.client is not None and v.client.client_id == client)


class OwnSocket:
    """The websocket of one page.

    Args:
        address: URL of the websocket.
        through: the port of a proxy of this computer that has the address; 0: none.
        kept: what the browser keeps; see `Hello`.

    Attributes:
        page: the page's number, which viser's websocket must show.
        told: all messages so far.
    """

    def __init__(self, address: str, page: str = "", through: int = 0, **kept: str) -> None:
        self.page = page or secrets.token_hex(16)
        self.told: list[dict[str, Any]] = []
        self._socket = connect(
            address,
            sock=socket.create_connection(("127.0.0.1", through)) if through else None,
            subprotocols=[Subprotocol(SUBPROTOCOL)],
            compression=None,
            close_timeout=0.5,
            ping_interval=None,  # a browser does not ping
            max_size=None,
        )
        self._socket.send(hello(self.page, **kept))
        threading.Thread(target=self._read, daemon=True).start()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Close the websocket."""
        self._socket.close()

    def tell(self, message: dict[str, Any]) -> None:
        """Send a message or a command."""
        self._socket.send(json.dumps(message))

    def kinds(self) -> set[str]:
        """The kinds of the messages so far."""
        return {message["is"] for message in list(self.told)}

    @property
    def code(self) -> int | None:
        """With which the server has closed it."""
        return self._socket.close_code

    def _read(self) -> None:
        saw = 0.0
        with suppress(ConnectionClosed):
            for text in self._socket:
                self.told.append(json.loads(text))
                if time.monotonic() > saw + SEES:
                    saw = time.monotonic()
                    self._socket.send(SEEN)
