"""A hostile browser has no effect, and a well-behaved one beside it still gets service."""

from __future__ import annotations

import asyncio
import http.client
import inspect
import logging
import math
import socket
import threading
from collections.abc import Callable, Iterator
from functools import partial
from random import Random
from types import SimpleNamespace
from typing import Any

import msgspec
import pytest
import viser
import websockets.sync.client
from viser import _messages
from viser.infra import _infra
from websockets.asyncio.messages import Assembler
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.typing import Origin, Subprotocol

from onpath.app.common import error_log
from onpath.app.common.allowance import Allowance
from onpath.app.viser_adapter import secure_connection, secure_server
from onpath.app.viser_adapter.secure_server import Limits, PortInUse, make_server
from tests.support import waiting

WAIT = 5.0
CAMERA = {
    "wxyz": [1.0, 0.0, 0.0, 0.0],
    "position": [0.0, -2.0, 1.0],
    "fov": 0.8,
    "near": 0.01,
    "far": 1000.0,
    "image_height": 600,
    "image_width": 800,
    "look_at": [0.0, 0.0, 0.0],
    "up_direction": [0.0, 0.0, 1.0],
}


class Lab:
    """The server under attack: every client gets a box, and all callbacks note."""

    def __init__(self, **options: Any) -> None:
        self.server = make_server(port=0, **options)
        self.port = self.server.get_port()
        self.events: list[tuple[int, str, Any]] = []
        self.boxes: dict[int, viser.BoxHandle] = {}
        self.server.on_client_connect(self._build)

    async def _build(self, client: viser.ClientHandle) -> None:
        box, marker = client.scene.add_box("/box"), client.scene.add_box("/marker")
        box.on_drag("left")(self._note(client, "drag", lambda e: e.end_position))
        box.on_click(self._note(client, "click", lambda e: e.ray_origin))
        marker.on_click(self._note(client, "marker", lambda e: e.ray_origin))
        client.camera.on_update(self._note(client, "camera", lambda c: tuple(c.position)))
        self.boxes[client.client_id] = box

    def _note(self, client: viser.ClientHandle, name: str, read: Callable[[Any], Any]) -> Any:
        async def note(event: Any) -> None:
            self.events.append((client.client_id, name, read(event)))

        return note

    def heard(self, browser: Browser) -> list[tuple[str, Any]]:
        """What callbacks saw from this browser, the markers of `settle` aside."""
        own = [(name, value) for client, name, value in self.events if client == browser.id]
        return [event for event in own if event[0] != "marker"]


class Browser:
    """A websocket that speaks viser's protocol and sends whatever it is told."""

    def __init__(self, lab: Lab, origin: str | None = None, announce: bool = True) -> None:
        self.lab = lab
        self.socket = websockets.sync.client.connect(
            f"ws://127.0.0.1:{lab.port}",
            subprotocols=[Subprotocol(f"viser-v{viser.__version__}")],
            origin=Origin(origin) if origin else None,
            max_size=None,
            compression=None,
            close_timeout=0.5,
        )
        self.markers = 0
        known = set(lab.boxes)
        if announce:
            self.send("ViewerCameraMessage", **CAMERA)
            wait_for(lambda: set(lab.boxes) - known)
            (self.id,) = set(lab.boxes) - known
            self.settle()
            lab.events.clear()

    def send(self, kind: str, **fields: Any) -> None:
        self.socket.send(msgspec.msgpack.encode({"type": kind, **fields}))

    def settle(self) -> None:
        """Return when all that was sent before has been dealt with."""
        self.markers += 1
        at = (float(self.markers), 0.0, 0.0)
        self.send("SceneNodeClickMessage", **click(self) | {"name": "/marker", "ray_origin": at})
        wait_for(lambda: (self.id, "marker", at) in self.lab.events)


wait_for = partial(waiting.wait_for, seconds=WAIT)


def closing(browser: Browser) -> ConnectionClosed:
    """How the server ends a connection that it must end."""
    with pytest.raises(ConnectionClosed) as closed:
        while True:
            browser.socket.recv(timeout=WAIT)
    return closed.value


@pytest.fixture(scope="module")
def lab() -> Iterator[Lab]:
    lab = Lab()
    yield lab
    lab.server.stop()


@pytest.fixture
def attacker(lab: Lab) -> Iterator[Browser]:
    browser = Browser(lab)
    yield browser
    browser.socket.close()


@pytest.fixture
def no_errors(caplog: pytest.LogCaptureFixture) -> Iterator[None]:
    """What is refused is refused by design, not by an exception further on."""
    yield
    assert [each for each in caplog.get_records("call") if each.levelno > logging.WARNING] == []


@pytest.fixture
def bystander(lab: Lab) -> Iterator[Browser]:
    """After the test, whatever it did, this one must still be served."""
    browser = Browser(lab)
    yield browser
    browser.send("SceneNodeDragMessage", **drag(browser))
    browser.settle()
    assert lab.heard(browser) == [("drag", (0.1, 0.0, 0.2))]
    browser.socket.close()


# Scene.


def drag(browser: Browser) -> dict[str, Any]:
    return {
        "phase": "update",
        "name": "/box",
        "instance_index": None,
        "start_position": [0.0, 0.0, 0.0],
        "start_screen_pos": [0.5, 0.5],
        "end_position": [0.1, 0.0, 0.2],
        "end_screen_pos": [0.6, 0.5],
        "button": "left",
        "modifier": None,
        "owner": str(browser.id),
    }


def click(browser: Browser) -> dict[str, Any]:
    return {
        "name": "/box",
        "instance_index": None,
        "ray_origin": [0.0, -2.0, 0.0],
        "ray_direction": [0.0, 1.0, 0.0],
        "screen_pos": [0.5, 0.5],
        "modifier": None,
        "owner": str(browser.id),
    }


def camera(_: Browser) -> dict[str, Any]:
    return CAMERA | {"position": [1.0, 1.0, 1.0]}


SCENE: dict[str, tuple[str, Callable[[Browser], dict[str, Any]], Any]] = {
    "drag": ("SceneNodeDragMessage", drag, (0.1, 0.0, 0.2)),
    "click": ("SceneNodeClickMessage", click, (0.0, -2.0, 0.0)),
    "camera": ("ViewerCameraMessage", camera, (1.0, 1.0, 1.0)),
}
NO_POSITION = [
    [math.nan, 0.0, 0.0],
    [0.0, math.inf, 0.0],
    [0.0, 0.0, -1e300],
    [0.0, 0.0],
    [0.0] * 4,
    [],
    ["0", "0", "0"],
    ["nan", "nan", "nan"],
    [True, True, True],
    [None] * 3,
    [[0.0]] * 3,
    "000",
    None,
    0.0,
    {"x": 0.0},
]
POSITIONS = {
    "drag": ("start_position", "end_position"),
    "click": ("ray_origin", "ray_direction"),
    "camera": ("position", "look_at", "up_direction"),
}
NO_SCENE_MESSAGE = [
    *((n, {key: bad}) for n, keys in POSITIONS.items() for key in keys for bad in NO_POSITION),
    *(("camera", {"wxyz": bad}) for bad in ([0.0] * 4, [math.nan] * 4, [1])),
    *((n, {"instance_index": bad}) for n in ("drag", "click") for bad in (-1, 0.5, "0", True)),
    *(("camera", {"fov": bad}) for bad in (math.nan, "1", None, [1.0], 0.0, -0.1, math.pi)),
    *(("camera", {"image_height": bad}) for bad in (math.inf, 0.5, 10**12, "600")),
    *(("click", {"screen_pos": bad}) for bad in ([], [0.5], [0.5, math.nan], [[0.5, 0.5]])),
    ("drag", {"end_screen_pos": [math.nan, 0.0]}),
    ("drag", {"phase": "forever"}),
    ("drag", {"button": ["left"]}),
    ("drag", {"modifier": "meta"}),
    ("drag", {"name": 7}),
    ("drag", {"surplus": 7}),
]


@pytest.mark.usefixtures("no_errors")
def test_no_client_reaches_the_nodes_of_another(
    lab: Lab, attacker: Browser, bystander: Browser
) -> None:
    for owner in (str(bystander.id), ""):
        attacker.send("SceneNodeDragMessage", **drag(bystander) | {"owner": owner})
        attacker.send("SceneNodeClickMessage", **click(bystander) | {"owner": owner})
    attacker.settle()
    bystander.settle()
    assert lab.heard(bystander) == []
    assert lab.heard(attacker) == []


def test_honest_scene_messages_arrive(lab: Lab, attacker: Browser) -> None:
    for kind, fields, _ in SCENE.values():
        attacker.send(kind, **fields(attacker))
    attacker.settle()
    assert lab.heard(attacker) == [(name, value) for name, (_, _, value) in SCENE.items()]


@pytest.mark.usefixtures("no_errors")
def test_messages_are_handled_in_the_order_in_which_they_were_sent(
    lab: Lab, attacker: Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Those that are handled at once (see `GESTURES`), and those that wait for viser."""
    sent, random, at_once = list[tuple[str, Any]](), Random(1), list[object]()
    handle = secure_server._handle_at_once
    counted = lambda *told: (at_once.append(told), handle(*told))  # noqa: E731
    monkeypatch.setattr(secure_server, "_handle_at_once", counted)
    for i in range(200):
        if random.random() < 0.1:
            attacker.settle()
        if random.random() < 0.1:
            attacker.socket.ping()
        kind = random.choice(["drag", "click", "camera"])
        number = float(i)
        sent.append((kind, (number, 0.0, 0.0)))
        if kind == "camera":
            attacker.send("ViewerCameraMessage", **CAMERA | {"position": [number, 0.0, 0.0]})
        elif kind == "drag":
            place = {"end_position": [number, 0.0, 0.0]}
            attacker.send("SceneNodeDragMessage", **drag(attacker) | place)
        else:
            ray = {"ray_origin": [number, 0.0, 0.0]}
            attacker.send("SceneNodeClickMessage", **click(attacker) | ray)
    attacker.settle()
    assert lab.heard(attacker) == sent
    gestures = sum(kind != "click" for kind, _ in sent)
    assert 20 < len(at_once) / 2 < gestures  # each in two scopes: the server's and the client's


def test_a_callback_of_a_gesture_that_waits_is_an_error(
    lab: Lab, attacker: Browser, bystander: Browser, caplog: pytest.LogCaptureFixture
) -> None:
    async def waits(_: Any) -> None:
        await asyncio.sleep(0.0)
        lab.events.append((attacker.id, "waited", None))

    lab.boxes[attacker.id].on_drag("left")(waits)
    attacker.send("SceneNodeDragMessage", **drag(attacker))
    attacker.settle()
    assert lab.heard(attacker) == [("drag", (0.1, 0.0, 0.2))]
    assert "a handler of SceneNodeDragMessage waits" in caplog.text


@pytest.mark.usefixtures("no_errors")
def test_impossible_scene_messages_reach_no_callback(
    lab: Lab, attacker: Browser, bystander: Browser
) -> None:
    for name, change in NO_SCENE_MESSAGE:
        kind, fields, _ = SCENE[name]
        attacker.send(kind, **fields(attacker) | change)
    attacker.settle()
    assert lab.heard(attacker) == []


# Widgets, of which a page has none.

OF_WIDGETS: dict[str, dict[str, Any]] = {
    "GuiUpdateMessage": {"uuid": "x", "updates": {"value": 1.0}},
    "CommandTriggerMessage": {"uuid": "x"},
    "FileTransferStartUpload": {
        "source_component_uuid": "x",
        "transfer_uuid": "y",
        "filename": "z",
        "mime_type": "text/plain",
        "part_count": 1,
        "size_bytes": 1,
    },
    "FileTransferPart": {
        "source_component_uuid": "x",
        "transfer_uuid": "y",
        "part_index": 0,
        "content": b"1",
    },
}


@pytest.mark.usefixtures("no_errors")
def test_what_concerns_widgets_is_dropped(lab: Lab, attacker: Browser, bystander: Browser) -> None:
    """Even if there were some."""
    gui = lab.server.get_clients()[attacker.id].gui
    slider, button = gui.add_slider("slider", 0.0, 10.0, 0.1, 2.5), gui.add_upload_button("files")
    for kind, fields in OF_WIDGETS.items():
        for uuid in (slider._impl.uuid, button._impl.uuid, "x"):
            own = {name: uuid for name in ("uuid", "source_component_uuid") if name in fields}
            attacker.send(kind, **fields | own)
    attacker.settle()
    assert slider.value == 2.5 and button.value.content == b""
    assert gui._current_file_upload_states == {}
    assert lab.heard(attacker) == []


# Frames.


@pytest.mark.usefixtures("no_errors")
def test_invalid_messages_are_skipped(lab: Lab, attacker: Browser, bystander: Browser) -> None:
    def packed(message: Any) -> bytes:
        return msgspec.msgpack.encode(message)

    frames = [
        "a text frame",
        b"",
        b"\xc1",
        b"\xdd\xff\xff\xff\xff",
        b"\x81\xa1a" + b"\x91" * 100_000,
        b"\x82\xa4type\xadNoSuchMessage\xa1a" + b"\x91" * 100_000,
        b"\x82\xa4type\xb0GuiUpdateMessage\xa7updates" + b"\x91" * 100_000,
        b"\x81\xa4type\xa1\xff",
        packed(7),
        packed({}),
        packed({1: 2}),
        packed({"type": None}),
        packed({"type": ["GuiUpdateMessage"]}),
        packed({"type": "NoSuchMessage"}),
        packed({"type": "RunJavascriptMessage", "source": "alert(1)"}),
        packed({"type": "GuiFormDirtyMessage", "uuid": "invented"}),  # of widgets that no page has
        packed({"type": "GuiUpdateMessage"}),
        packed({"type": "GuiUpdateMessage", "uuid": "x", "updates": [1]}),
        packed({"type": "GuiUpdateMessage", "uuid": ["x"], "updates": {}}),
        packed({"type": "SceneNodeUpdateMessage", "name": "/box", "updates": {"visible": False}}),
    ]
    for frame in frames:
        attacker.socket.send(frame)
    attacker.settle()
    assert lab.heard(attacker) == []


@pytest.mark.usefixtures("no_errors")
def test_a_message_that_is_too_large_closes_its_connection(
    lab: Lab, attacker: Browser, bystander: Browser
) -> None:
    attacker.send("ViewerCameraMessage", **CAMERA | {"name": "x" * 2_000_000})
    closed = closing(attacker).rcvd
    assert closed is not None and closed.code == 1009
    assert lab.heard(attacker) == []


@pytest.mark.parametrize("flood", ["drags", "messages", "pings", "fragments"])
@pytest.mark.usefixtures("no_errors")
def test_a_flood_of_messages_closes_its_connection_and_says_why(
    lab: Lab, attacker: Browser, bystander: Browser, flood: str
) -> None:
    def pour() -> None:
        with pytest.raises(ConnectionClosed):
            while True:
                if flood == "drags":
                    attacker.send("SceneNodeDragMessage", **drag(attacker))
                elif flood == "messages":
                    attacker.send("ViewerCameraMessage", **camera(attacker))
                elif flood == "pings":
                    attacker.socket.ping()
                else:
                    attacker.socket.send(b"x" for _ in range(100_000))

    pouring = threading.Thread(target=pour)
    pouring.start()
    closed = closing(attacker).rcvd
    pouring.join(WAIT)
    assert not pouring.is_alive()
    assert closed is not None and closed.code == 1008
    limit = "more than 25 changes" if flood == "drags" else "more than 120 messages"
    assert closed.reason == f"{limit} per second"


def test_a_brisk_but_honest_client_is_served(monkeypatch: pytest.MonkeyPatch) -> None:
    """50 camera messages and 20 drags a second, the most that viser's page sends.

    And so for longer than a burst can carry.
    """
    limits = Limits(message_burst=30, change_burst=30)
    clock = SimpleNamespace(now=0.0)
    timed = partial(Allowance, clock=lambda: clock.now)
    monkeypatch.setattr(secure_connection, "Allowance", timed)
    brisk = Lab(limits=limits)
    browser = Browser(brisk)
    for i in range(200):
        browser.send("ViewerCameraMessage", **camera(browser))
        if i % 5 in (0, 2):
            browser.send("SceneNodeDragMessage", **drag(browser))
            browser.settle()  # before the clock goes on
        clock.now += 1 / 50
    browser.settle()
    assert len(brisk.heard(browser)) == 200 + 80
    browser.socket.close()
    brisk.server.stop()


# The share tunnel.


def test_no_client_opens_a_share_tunnel(
    lab: Lab, attacker: Browser, bystander: Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[str] = []
    monkeypatch.setattr(lab.server, "request_share_url", lambda: asked.append("open"))
    monkeypatch.setattr(lab.server, "disconnect_share_url", lambda: asked.append("close"))
    handlers = lab.server._websock_server._incoming_handlers
    assert not {_messages.ShareUrlRequest, _messages.ShareUrlDisconnect} & handlers.keys()
    attacker.send("ShareUrlRequest")
    attacker.send("ShareUrlDisconnect")
    attacker.settle()
    assert asked == []


# Handshake and files.


def test_pages_of_other_sites_may_not_connect(lab: Lab) -> None:
    foreign = [
        "http://evil.example",
        f"http://evil.example:{lab.port}",
        f"http://127.0.0.1:{lab.port + 1}",
        f"http://127.0.0.1.evil.example:{lab.port}",
        "null",
        "file://",
        "http://[",
    ]
    for origin in foreign:
        with pytest.raises(InvalidStatus) as refused:
            Browser(lab, origin=origin)
        assert refused.value.response.status_code == 403
    own = Browser(lab, origin=f"http://127.0.0.1:{lab.port}")
    own.settle()
    own.socket.close()


def test_the_web_server_serves_its_folder_and_nothing_else(lab: Lab) -> None:
    def get(path: str) -> tuple[int, bytes]:
        connection = http.client.HTTPConnection("127.0.0.1", lab.port, timeout=WAIT)
        connection.putrequest("GET", path, skip_host=False)
        connection.endheaders()
        response = connection.getresponse()
        return response.status, response.read()

    assert get("/")[0] == 200
    up = ["..", "%2e%2e", ".%2E", "%2e.", "..%5c..", "..%2f..", "%252e%252e", "....//", "..;"]
    paths = [f"/{dots}/package.json" for dots in up]  # lies in the folder above
    paths += [f"/assets/{dots}/{dots}/package.json" for dots in up]
    paths += ["//etc/passwd", "/%2fetc/passwd", "/file:///etc/passwd", "/%00", "/assets", "/x" * 99]
    for path in paths:
        assert get(path)[0] == 404, path
    assert get("/" + "x" * 5000)[0] in (404, 500)
    assert get("/")[0] == 200


# Address.


def test_a_taken_port_is_an_error_that_shows_the_way_out() -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        with pytest.raises(PortInUse, match=f"port {port} .* in use: .*another port"):
            make_server(port=port)


def test_it_listens_where_it_was_told_and_by_default_to_this_machine_only(lab: Lab) -> None:
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    server = make_server(port=port)
    assert (server.get_host(), server.get_port()) == ("127.0.0.1", port)
    with pytest.raises(OSError):
        socket.create_connection(("127.0.0.2", port), timeout=WAIT)
    server.stop()


def test_an_address_of_another_machine_is_an_error_not_a_hang() -> None:
    with pytest.raises(OSError, match="assign"):
        make_server("192.0.2.1", 0)


# What a server says.


def test_one_warning_for_a_client_and_no_traceback(
    lab: Lab, attacker: Browser, caplog: pytest.LogCaptureFixture, capfd: pytest.CaptureFixture[str]
) -> None:
    error_log._warned.clear()  # other tests have warned a lot lately
    for _ in range(20):
        attacker.send("ViewerCameraMessage", **CAMERA | {"fov": math.nan})
        attacker.socket.send(b"\xc1")
        attacker.send("SceneNodeDragMessage", **drag(attacker) | {"end_position": [math.nan] * 3})
    attacker.settle()
    assert [record.levelno for record in caplog.records] == [logging.WARNING]
    assert capfd.readouterr().err == ""


def failing(lab: Lab, browser: Browser, calls: list[str]) -> None:
    """Make several kinds of callback of this browser fail."""

    def fails(_: Any) -> None:
        calls.append("plain")
        raise RuntimeError("plain")

    async def fails_in_the_loop(_: Any) -> None:
        calls.append("async")
        raise RuntimeError("async")

    async def fails_in_a_gesture(_: Any) -> None:
        calls.append("gesture")
        raise RuntimeError("gesture")

    box = lab.server.get_clients()[browser.id].scene.add_box("/fails")
    box.on_click(fails)
    box.on_click(fails_in_the_loop)
    box.on_drag("left")(fails_in_a_gesture)


def test_failing_callbacks_kill_nothing_and_are_logged_once_each(
    lab: Lab,
    attacker: Browser,
    bystander: Browser,
    caplog: pytest.LogCaptureFixture,
    capfd: pytest.CaptureFixture[str],
) -> None:
    calls: list[str] = []
    failing(lab, attacker, calls)
    for _ in range(30):
        attacker.send("SceneNodeClickMessage", **click(attacker) | {"name": "/fails"})
        attacker.send("SceneNodeDragMessage", **drag(attacker) | {"name": "/fails"})
    wait_for(lambda: len(calls) == 90)
    attacker.settle()
    assert {name: calls.count(name) for name in set(calls)} == dict.fromkeys(
        ("plain", "async", "gesture"), 30
    )
    in_full = [record for record in caplog.records if record.exc_info]
    assert len(in_full) == 3
    assert len(caplog.records) == 6  # and that it happened ten times
    assert "Traceback" not in capfd.readouterr().err


# What hardening relies on.


def test_viser_calls_what_hardening_replaces() -> None:
    worker = inspect.getsource(_infra.WebsockServer._background_worker)
    assert worker.count("websockets.asyncio.server.serve(") == 1
    assert "self._handle_incoming_message(client_id, message)" in worker
    assert "client_connection._handle_incoming_message(client_id, message)" in worker
    assert "self.frames: SimpleQueue[" in inspect.getsource(Assembler.__init__)
    consumer = inspect.getsource(_infra._message_consumer)
    assert "await websocket.recv()" in consumer and "message_class.deserialize(raw)" in consumer
