"""A simulated browser that stores its codes, reads its page and reconnects after a failure."""

from __future__ import annotations

import socket
import time
from collections.abc import Callable
from contextlib import suppress
from types import TracebackType
from typing import Any, Self
from urllib.parse import urlsplit

from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Subprotocol

from onpath.app.viser_adapter.addresses import place_of, storage_key
from tests.bench.client_protocol import CAMERA, SUBPROTOCOL, answer, packed, unpacked
from tests.bench.simulated_browser import MOVING

PATIENCE = 60.0  # [s]; only ends a test that would hang


class Student:
    """One tab.

    Args:
        address: URL of the websocket.
        through: port on this machine to connect to, instead of that in the address.
        headers: headers of the handshake.

    Attributes:
        kept: the browser's local storage.
        widgets: properties of the widgets on the page, by id.
        moving: number of updates of the poses.
        received: amount of data, [B].
    """

    def __init__(self, address: str, through: int | None = None, **headers: str) -> None:
        self.address, self.headers = address, headers
        self._through, self.moving, self.received = through, 0, 0
        self.kept: dict[str, str] = {}
        self.widgets: dict[str, dict[str, Any]] = {}
        self._socket: ClientConnection | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: type[BaseException] | BaseException | TracebackType | None) -> None:
        self.close()

    def close(self) -> None:
        """Close the tab."""
        if self._socket is not None:
            self._socket.close()

    @property
    def code(self) -> str:
        """Session code of the lab."""
        key = storage_key("onpath_sessions", place_of(urlsplit(self.address).path))
        return self.kept.get(key, "").partition(",")[0]

    def open(self) -> None:
        """Open the page, or open it again."""
        self.widgets.clear()
        way = socket.create_connection(("127.0.0.1", self._through)) if self._through else None
        self._socket = connect(
            self.address,
            subprotocols=[Subprotocol(SUBPROTOCOL)],
            additional_headers=self.headers,
            compression=None,
            max_size=None,
            close_timeout=1.0,
            sock=way,
        )
        self._socket.send(packed("ViewerCameraMessage", **CAMERA))

    def reopen(self) -> None:
        """Reconnect as viser's page does: retry until it succeeds."""
        end = time.monotonic() + PATIENCE
        while True:
            try:
                return self.open()
            except Exception:
                if time.monotonic() > end:
                    raise
                time.sleep(0.2)

    def read(self, until: Callable[[], Any]) -> None:
        """Read messages until a condition holds."""
        end = time.monotonic() + PATIENCE
        while not until():
            assert time.monotonic() < end, sorted(map(str, self._labels()))
            assert self._socket is not None
            try:
                raw = self._socket.recv(timeout=0.2)
            except TimeoutError:
                continue
            self._take_frame(raw)

    def read_what_was_sent(self) -> None:
        """Read what the server had sent when it heard of this."""
        assert self._socket is not None
        assert self._socket.ping().wait(PATIENCE)
        self.read_what_has_come()

    def read_what_has_come(self) -> None:
        """Read what has arrived so far, without waiting."""
        assert self._socket is not None
        with suppress(TimeoutError):
            while True:
                self._take_frame(self._socket.recv(timeout=0))

    def wait_until_closed(self) -> None:
        """Wait until the server has closed the connection."""
        try:
            self.read(lambda: False)
        except ConnectionClosed:
            return

    def find(self, label: str) -> dict[str, Any]:
        """Wait for a widget whose label or option begins with `label`; the shortest is meant."""
        self.read(lambda: self.has_widget(label))
        labels = self._labels()
        return labels[min((text for text in labels if text.startswith(label)), key=len)]

    def set(self, label: str, value: Any) -> None:
        """Set the value of a widget, as by moving a slider or pressing a button."""
        widget = self.find(label)
        self.send("GuiUpdateMessage", uuid=widget["uuid"], updates={"value": value})

    def choose(self, option: str) -> None:
        """Wait for exactly this option, and choose it."""
        self.read(lambda: option in self._labels())
        self.set(option, option)

    def send(self, kind: str, **fields: Any) -> None:
        """Any message."""
        assert self._socket is not None
        self._socket.send(packed(kind, **fields))

    def has_widget(self, label: str) -> bool:
        """Whether the page has a widget whose label or option begins with `label`."""
        return any(text.startswith(label) for text in self._labels())

    def count(self, label: str) -> int:
        """Number of widgets with this label."""
        return sum(widget.get("label") == label for widget in self.widgets.values())

    def sees(self, text: str) -> bool:
        """Whether the page shows a text."""
        parts = ("content", "_markdown")
        return any(text in str(w.get(part)) for w in self.widgets.values() for part in parts)

    def _labels(self) -> dict[str, dict[str, Any]]:
        shown = [w for w in self.widgets.values() if w["value"] is not None]
        options = {option: w for w in shown for option in w.get("options") or ()}
        return {**options, **{str(w["label"]): w for w in shown if w.get("label")}}

    def _take_frame(self, raw: str | bytes) -> None:
        assert isinstance(raw, bytes)
        self.received += len(raw)
        for message in unpacked(raw):
            self._take(message)

    def _take(self, message: dict[str, Any]) -> None:
        kind = message["type"]
        self.moving += message.get("name") == MOVING
        if reply := answer(message, self.kept):
            assert self._socket is not None
            self._socket.send(reply)
        elif kind == "LocalStorageSetItemMessage":
            self.kept[message["key"]] = message["value"]
        elif "props" in message and "uuid" in message:
            widget = {"uuid": message["uuid"], "value": message.get("value")}
            self.widgets[message["uuid"]] = {**widget, **message["props"]}
        elif kind == "GuiUpdateMessage":
            self.widgets.get(message["uuid"], {}).update(message["updates"])
        elif kind == "GuiRemoveMessage":
            self.widgets.pop(message["uuid"], None)
