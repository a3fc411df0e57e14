"""A simulated browser that stores its codes, reads its page and reconnects after a failure."""

from __future__ import annotations

import json
import re
import secrets
import socket
import time
from collections.abc import Callable
from contextlib import suppress
from html import unescape
from types import TracebackType
from typing import Any, Self
from urllib.parse import urlsplit

from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Subprotocol

from onpath.app.server.arrivals import PAGE_KEY
from onpath.app.viser_adapter.addresses import prefix_of, storage_key
from onpath.app.viser_adapter.data_channel import SUBPROTOCOL as DATA
from tests.bench.client_protocol import CAMERA, SEEN, SUBPROTOCOL, answer, hello, packed, unpacked
from tests.bench.simulated_browser import MOVING, SEES

MOST_CODES = 8
PATIENCE = 60.0  # [s]; only ends a test that would hang
KEPT = ("teacher", "speaks", "sounds", "first_minute")


def remembered(code: str, known: str) -> str:
    """The codes that a browser keeps when it is told one, as `keepLab` of the page's script."""
    codes = [code, *re.findall(r"\b[a-z0-9]{12}\b", known)]
    return ",".join(list(dict.fromkeys(codes))[:MOST_CODES])


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
        lesson: the last message of the data channel about the lessons; see `lesson_message`.
        message: what the lab tells its user, from that channel.
        draws: whether the tab is in front.
    """

    def __init__(self, address: str, through: int | None = None, **headers: str) -> None:
        self.address, self.headers = address, headers
        self._through, self.moving, self.received = through, 0, 0
        self.kept: dict[str, str] = {}
        self.widgets: dict[str, dict[str, Any]] = {}
        self._socket: ClientConnection | None = None
        self.draws, self._page, self._saw = True, "", 0.0
        self._data: ClientConnection | None = None
        self.lesson: dict[str, Any] = {}
        self.message = ""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: type[BaseException] | BaseException | TracebackType | None) -> None:
        self.close()

    def close(self) -> None:
        """Close the tab."""
        for each in (self._socket, self._data):
            if each is not None:
                each.close()

    @property
    def code(self) -> str:
        """Lab code of the lab."""
        return self.kept.get(self._labs, "").partition(",")[0]

    @property
    def _labs(self) -> str:
        """Where the browser keeps the codes of its labs."""
        return storage_key("onpath_sessions", prefix_of(urlsplit(self.address).path))

    def open(self) -> None:
        """Open the page, or open it again."""
        self.widgets.clear()
        self.lesson, self.message, self._page = {}, "", secrets.token_hex(16)
        self._data = self._connected(DATA)
        kept = {key: self.kept.get(f"onpath_{key}", "") for key in KEPT}
        self._data.send(hello(self._page, labs=self.kept.get(self._labs, ""), **kept))
        self._socket = self._connected(SUBPROTOCOL)
        self._socket.send(packed("ViewerCameraMessage", **CAMERA))

    def _connected(self, subprotocol: str) -> ClientConnection:
        way = self._through
        return connect(
            self.address,
            sock=socket.create_connection(("127.0.0.1", way)) if way else None,
            subprotocols=[Subprotocol(subprotocol)],
            additional_headers=self.headers,
            compression=None,
            max_size=None,
            close_timeout=1.0,
        )

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
                self._hear()
                continue
            self._take_frame(raw)
            self._hear()

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
        self._hear()

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
        self.read(lambda: self.has_widget(label))
        if commands := self._commands(label):
            return self.tell(*commands)
        widget = self.find(label)
        self.send("GuiUpdateMessage", uuid=widget["uuid"], updates={"value": value})

    def choose(self, option: str) -> None:
        """Wait for exactly this option, and choose it."""
        self.read(lambda: option in self._labels())
        self.set(option, option)

    def press(self, hotkey: str) -> None:
        """Press a key of the lab's, as viser's page tells it."""
        key = next(w for w in self.widgets.values() if w.get("hotkey") == hotkey)
        self.send("CommandTriggerMessage", uuid=key["uuid"])

    def send(self, kind: str, **fields: Any) -> None:
        """Any message."""
        assert self._socket is not None
        self._socket.send(packed(kind, **fields))

    def tell(self, *commands: dict[str, Any]) -> None:
        """Send commands through the data channel."""
        assert self._data is not None
        for command in commands:
            self._data.send(json.dumps(command))

    def has_widget(self, label: str) -> bool:
        """Whether the page has a widget whose label or option begins with `label`."""
        return bool(self._commands(label)) or any(text.startswith(label) for text in self._labels())

    def count(self, label: str) -> int:
        """Number of widgets with this label."""
        return sum(widget.get("label") == label for widget in self.widgets.values())

    def sees(self, text: str) -> bool:
        """Whether the page shows a text."""
        parts = ("content", "_markdown")
        return (
            text in self.column
            or text in self.message
            or any(text in str(w.get(part)) for w in self.widgets.values() for part in parts)
        )

    @property
    def column(self) -> str:
        """The HTML of the open step of a lesson, or of its end; empty without one."""
        if not self.lesson.get("lesson"):
            return ""
        at = "end" if self.lesson["ended"] else str(self.lesson["index"])
        return (
            "".join(self.lesson[part] for part in ("head", "pager")) + self.lesson["sections"][at]
        )

    def _commands(self, label: str) -> list[dict[str, Any]]:
        """What the shortest button of the column sends whose name begins with a label."""
        found = dict[str, str]()
        for attributes, text in re.findall(r"<button([^>]*)>([^<]*)</button>", self.column):
            sent = re.search("data-send='([^']*)'", attributes)
            name = re.search('aria-label="([^"]*)"', attributes)
            if sent is not None and (named := unescape(name[1] if name else text)).startswith(
                label
            ):
                found[named] = unescape(sent[1])
        if not found:
            return []
        commands = json.loads(found[min(found, key=len)])
        return commands if isinstance(commands, list) else [commands]

    def _hear(self) -> None:
        """Take what the page's own websocket tells, and tell that the page is drawn."""
        assert self._data is not None
        with suppress(TimeoutError, ConnectionClosed):
            if self.draws and time.monotonic() > self._saw + SEES:
                self._saw = time.monotonic()
                self._data.send(SEEN)
            while True:
                raw = self._data.recv(timeout=0)
                self.received += len(raw)
                self._take_message(json.loads(raw))

    def _take_message(self, message: dict[str, Any]) -> None:
        match message:
            case {"is": "lab", "code": code}:
                known = self.kept.get(self._labs, "")
                self.kept[self._labs] = remembered(code, known)
            case {"is": "store", "key": key, "value": value}:
                self.kept[f"onpath_{key}"] = value
            case {"is": "lesson"}:
                self.lesson = message
            case {"is": "state"}:
                self.message = message.get("message", self.message)

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
        if reply := answer(message, {PAGE_KEY: self._page}):
            assert self._socket is not None
            self._socket.send(reply)
        elif "props" in message and "uuid" in message:
            widget = {"uuid": message["uuid"], "value": message.get("value")}
            self.widgets[message["uuid"]] = {**widget, **message["props"]}
        elif kind in ("GuiUpdateMessage", "CommandUpdateMessage"):
            self.widgets.get(message["uuid"], {}).update(message["updates"])
        elif kind in ("GuiRemoveMessage", "RemoveCommandMessage"):
            self.widgets.pop(message["uuid"], None)
