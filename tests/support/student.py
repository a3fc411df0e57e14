"""A page without a browser: it stores its codes, sets what its form has, and connects again."""

from __future__ import annotations

import json
import re
import secrets
import socket
import time
from collections.abc import Callable
from contextlib import suppress
from html import unescape
from itertools import count
from types import TracebackType
from typing import Any, Self
from urllib.parse import urlsplit

from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Subprotocol

from onpath.app.channel.form_messages import AskForm
from onpath.app.channel.messages import encoded
from onpath.app.server.arrivals import PAGE_KEY
from onpath.app.viser_adapter.addresses import class_code_in, prefix_of
from onpath.app.viser_adapter.data_channel import SUBPROTOCOL as DATA
from tests.bench.client_protocol import CAMERA, SEEN, SUBPROTOCOL, answer, hello, packed, unpacked
from tests.bench.simulated_browser import MOVING, SEES

MOST_CODES = 8
PATIENCE = 60.0  # [s]; only ends a test that would hang
KEPT = ("teacher", "speaks", "sounds", "first_minute", "drives")
NEWS = 0.05  # [s] for which the page's own websocket is read before viser's


def remembered(code: str, known: str) -> str:
    """The codes that a browser keeps when it is told one, as `keepLab` of the page's script."""
    codes = [code, *re.findall(r"\b[a-z0-9]{12}\b", known)]
    return ",".join(list(dict.fromkeys(codes))[:MOST_CODES])


class Student:
    """One tab.

    Args:
        address: URL of the websocket.
        through: port on this machine to connect to, instead of that in the address.
        scene: whether viser's websocket is opened, too, for the robots' picture.
        headers: headers of the handshake.

    Attributes:
        kept: the browser's local storage.
        page: the number of the page.
        told: the last message of each kind from the page's own websocket; of those that tell
            changes, everything that has been told.
        moving: number of updates of the poses in the picture.
        received: amount of data, [B].
        draws: whether the tab is in front.
    """

    def __init__(
        self, address: str, through: int | None = None, *, scene: bool = True, **headers: str
    ) -> None:
        self.address, self.headers = address, headers
        self._through, self.moving, self.received = through, 0, 0
        self.kept: dict[str, str] = {}
        self.draws, self.page, self._saw = True, "", 0.0
        self.told: dict[str, dict[str, Any]] = {}
        self._has_scene, self._numbers = scene, count(1)
        self._data: ClientConnection | None = None
        self._scene: ClientConnection | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: type[BaseException] | BaseException | TracebackType | None) -> None:
        self.close()

    def close(self) -> None:
        """Close the tab."""
        for each in (self._scene, self._data):
            if each is not None:
                each.close()

    def listen_no_more(self) -> None:
        """Close the page's own websocket alone."""
        assert self._data is not None
        self._data.close()
        self._data = None

    @property
    def code(self) -> str:
        """Lab code of the lab."""
        return self.kept.get(self._labs, "").partition(",")[0]

    @property
    def _labs(self) -> str:
        """Where the browser keeps the codes of its labs; see assets/web/channel/kept.ts."""
        room = class_code_in(prefix_of(urlsplit(self.address).path))
        return f"onpath_sessions_{room}" if room else "onpath_sessions"

    def open(self) -> None:
        """Open the page, or open it again."""
        self.told.clear()
        self.page = secrets.token_hex(16)
        self._data = self._connected(DATA)
        kept = {key: self.kept.get(f"onpath_{key}", "") for key in KEPT}
        self._data.send(hello(self.page, labs=self.kept.get(self._labs, ""), **kept))
        if self._has_scene:
            self._scene = self._connected(SUBPROTOCOL)
            self._scene.send(packed("ViewerCameraMessage", **CAMERA))

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
            ping_interval=None,  # a browser does not ping
        )

    def reopen(self) -> None:
        """Connect again as the page does: try until it succeeds."""
        end = time.monotonic() + PATIENCE
        while True:
            try:
                return self.open()
            except Exception:
                if time.monotonic() > end:
                    raise
                self.close()  # what has been opened: its lab would be in use
                time.sleep(0.2)

    # What comes

    def read(self, until: Callable[[], Any]) -> None:
        """Read messages until a condition holds."""
        end = time.monotonic() + PATIENCE
        while not until():
            assert time.monotonic() < end, self.values.keys() | self.buttons.keys()
            self._hear(NEWS)

    def read_what_has_come(self) -> None:
        """Read what has arrived so far, without waiting."""
        self._hear(0.0)

    def wait_until_closed(self) -> None:
        """Wait until the server has closed a connection."""
        try:
            self.read(lambda: False)
        except ConnectionClosed:
            return

    @property
    def values(self) -> dict[str, Any]:
        """The values of the fields, by name; empty until the page has its form."""
        return self.told.get("values", {}).get("values", {})

    @property
    def state(self) -> dict[str, Any]:
        """What the page is told of its lab; see `StateMessage`."""
        return self.told.get("state", {})

    @property
    def lesson(self) -> dict[str, Any]:
        """What the page is told of the lessons; see `LessonMessage`."""
        return self.told.get("lesson", {})

    @property
    def fields(self) -> dict[str, dict[str, Any]]:
        """The fields of the forms of the lab and of a teacher's class, by name."""
        forms = [self.told.get(f"form {place}", {}) for place in ("lab", "class")]
        groups = [group for form in forms for group in form.get("groups", ())]
        return {field["name"]: field for group in groups for field in group["fields"]}

    @property
    def column(self) -> str:
        """The HTML of the open step of a lesson, or of its end; empty without one."""
        lesson = self.lesson
        if not lesson.get("lesson"):
            return ""
        at = "end" if lesson["ended"] else str(lesson["index"])
        return "".join(lesson[part] for part in ("head", "pager")) + lesson["sections"][at]

    @property
    def buttons(self) -> dict[str, Any]:
        """What each button of the open step sends, by its name."""
        found = dict[str, Any]()
        for attributes, text in re.findall(r"<button([^>]*)>([^<]*)</button>", self.column):
            sent = re.search("data-send='([^']*)'", attributes)
            name = re.search('aria-label="([^"]*)"', attributes)
            if sent is not None:
                found[unescape(name[1] if name else text)] = json.loads(unescape(sent[1]))
        return found

    def has_button(self, label: str) -> bool:
        """Whether the open step has a button whose name begins so."""
        return any(name.startswith(label) for name in self.buttons)

    def sees(self, text: str) -> bool:
        """Whether the page shows a text: in the open step, or as a message of the lab."""
        return text in self.column or text in self.state.get("message", "")

    # What the student does

    def value(self, name: str) -> Any:
        """The value of a field, as soon as there is one."""
        self.read(lambda: name in self.values)
        return self.values[name]

    def set(self, name: str, value: Any) -> int:
        """Set a field, as soon as it is there; returns the number of the message."""
        self.value(name)
        number = next(self._numbers)
        self.tell({"is": "set", "name": name, "value": value, "number": number})
        return number

    def settle(self, name: str, value: Any) -> None:
        """Set a field, and return when this counts: so does whatever was sent before."""
        number = self.set(name, value)
        self.read(lambda: self.told["values"]["heard"].get(name, 0) >= number)

    def press(self, label: str) -> None:
        """Press the button of the open step whose name begins so; the shortest is meant."""
        self.read(lambda: self.has_button(label))
        sent = self.buttons[min((n for n in self.buttons if n.startswith(label)), key=len)]
        self.tell(*(sent if isinstance(sent, list) else [sent]))

    def ask(self, what: str) -> dict[str, Any]:
        """Open a sheet: the message with what it shows."""
        self.read(lambda: self.values)
        self.told.pop(what, None)
        self.tell({"is": "ask", "what": what})
        self.read(lambda: what in self.told)
        return self.told[what]

    @property
    def seat(self) -> dict[str, Any]:
        """The lab's place in a class; see `ClassMessage`."""
        return self.told.get("class", {})

    @property
    def is_member(self) -> bool:
        """Whether the page says that its lab is in the class."""
        return self.seat.get("membership") == "member"

    @property
    def may_join(self) -> bool:
        """Whether the page asks for a nickname."""
        return self.seat.get("membership") == "guest"

    def join(self, name: str, code: str = "") -> dict[str, Any]:
        """Ask to join a class; returns what has come of it: see `SeatAnswer`.

        Args:
            code: of the class; only needed where the page's address has none.
        """
        return self._sit({"is": "join", "code": code, "name": name})

    def teach(self, key: str) -> dict[str, Any]:
        """Ask for the teacher's page with a key; returns why not and the like, or nothing."""
        return self._sit({"is": "teach", "key": key})

    @property
    def teaches(self) -> bool:
        """Whether the page shows the class."""
        return "class.table" in self.values

    def lead(self, order: str) -> None:
        """Give an order to the class; see `Order`."""
        self.read(lambda: f"class.{order}" in self.fields)
        self.tell(self.fields[f"class.{order}"]["act"])

    def _sit(self, request: dict[str, Any]) -> dict[str, Any]:
        self.read(lambda: self.seat)
        self.told.pop("seat", None)
        self.tell(request)
        self.read(lambda: "seat" in self.told or self.kept.get("onpath_teacher"))
        return self.told.get("seat", {})

    def tell(self, *messages: dict[str, Any]) -> None:
        """Send messages or commands through the page's own websocket."""
        assert self._data is not None
        for message in messages:
            self._data.send(json.dumps(message))

    def send(self, kind: str, **fields: Any) -> None:
        """Send any message through viser's websocket."""
        assert self._scene is not None
        self._scene.send(packed(kind, **fields))

    # Both websockets

    def _hear(self, patience: float) -> None:
        """Read what both websockets have, and tell that the page is drawn.

        Args:
            patience: for the first message of the page's own one, [s].
        """
        with suppress(TimeoutError):
            if self._data is not None and self.draws and time.monotonic() > self._saw + SEES:
                self._saw = time.monotonic()
                self._data.send(SEEN)
            while self._data is not None:
                raw = self._data.recv(timeout=patience)
                self.received += len(raw)
                self._take_message(json.loads(raw))
                patience = 0.0
        with suppress(TimeoutError):
            while self._scene is not None:
                self._take_frame(self._scene.recv(timeout=0))

    def _take_message(self, message: dict[str, Any]) -> None:
        kind, told = message["is"], self.told
        match message:
            case {"is": "lab", "code": code}:
                known = self.kept.get(self._labs, "")
                self.kept[self._labs] = remembered(code, known)
                told.pop("values", None)  # those of another lab, perhaps
                assert self._data is not None
                self._data.send(encoded(AskForm()).decode())
            case {"is": "store", "key": key, "value": value}:
                self.kept[f"onpath_{key}"] = value
            case {"is": "form", "place": place}:
                told[f"form {place}"] = message
            case {"is": "state"}:
                message = {**self.state, **message}
            case {"is": "values"}:
                before = told.get("values", {})
                parts = ("values", "refused", "heard")
                news = {part: {**before.get(part, {}), **message.get(part, {})} for part in parts}
                message = {**message, **news}
        told[kind] = message

    def _take_frame(self, raw: str | bytes) -> None:
        assert isinstance(raw, bytes) and self._scene is not None
        self.received += len(raw)
        for message in unpacked(raw):
            self.moving += message.get("name") == MOVING
            if reply := answer(message, {PAGE_KEY: self.page}):
                self._scene.send(reply)
            self.hear_scene(message)

    def hear_scene(self, message: dict[str, Any]) -> None:
        """Called with each message about the picture."""
