"""Messages and bytes that no page of ours would send, for attackers and for tests."""

from __future__ import annotations

import dataclasses
import json
import math
import random
from collections.abc import Callable, Iterable
from typing import Any, get_args

from websockets.frames import Opcode

from onpath.app.channel.sheet_messages import SheetName
from onpath.app.channel.symbol_messages import JointSymbol
from onpath.app.lab.commands.command_codec import page_commands
from onpath.app.server.built_in_course import built_in_course
from onpath.models.closed_loop.lab_settings import SETTINGS
from onpath.models.control.laws.registry import LAWS
from onpath.models.paths.path_design import presets
from onpath.models.systems.catalogue import ROBOTS
from tests.bench.client_protocol import CAMERA
from tests.bench.raw_socket import frames

ROOM = "/"
RAY = {"ray_origin": [0.0, -2.0, 0.0], "ray_direction": [0.0, 1.0, 0.0]}
DRAG = {
    "phase": "start",
    "name": ROOM,
    "instance_index": 0,
    "owner": "0",
    "start_position": [0.3, 0.0, 0.2],
    "start_screen_pos": [0.5, 0.5],
    "end_position": [0.3, 0.0, 0.3],
    "end_screen_pos": [0.5, 0.4],
    "button": "left",
    "modifier": None,
}
CLICK = {"name": ROOM, "instance_index": 0, "screen_pos": [0.5, 0.5], "modifier": None}
UPLOAD = {"source_component_uuid": "x", "transfer_uuid": "x"}
HONEST: dict[str, dict[str, Any]] = {
    "ViewerCameraMessage": CAMERA,
    "SceneNodeClickMessage": {**CLICK, **RAY, "owner": "0"},
    "SceneNodeDragMessage": DRAG,
    "GuiUpdateMessage": {"uuid": "x", "updates": {"value": 0.0}},
    "CommandTriggerMessage": {"uuid": "x"},
    "LocalStorageGetItemResponseMessage": {"value": None, "error": None, "request_uuid": "x"},
    "FileTransferStartUpload": {
        **UPLOAD,
        "filename": "x",
        "mime_type": "x",
        "part_count": 1,
        "size_bytes": 1,
    },
    "FileTransferPart": {**UPLOAD, "part_index": 0, "content": b"x"},
}
"""A message of each kind that passes the checks of its form."""
HOSTILE: list[Any] = [
    *(None, True, -1, 0, 1, 7, 2**31, 2**63, 1.5, 1e9, 1e300, -1e300, math.nan, math.inf),
    *("", "x" * 5000, "\x00", "../..", b"", b"\xff" * 100, [], {}, [[[]]], {"value": 1}),
    *([0.0] * 3, [0.0] * 4, [1e9] * 3, [-1e9] * 3, [math.nan] * 3, [1e-300] * 3),
    *("start", "update", "end", "click", "rect-select", "left", "right", "shift"),
]
INDEXES = (None, 2**30, 10**9, 999, 64, 19, 8, 5, 3, 2, 1, 0)
VERSIONS = [None, "viser-v0.0.0", "viser-v1.1.0", "viser-v[/bold]", "viser-v" + "9" * 4000, "chat"]
GARBAGE = {
    "not HTTP": b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03" + bytes(200),
    "no websocket key": b"GET / HTTP/1.1\r\nHost: x\r\nUpgrade: websocket\r\n\r\n",
    "an endless header": b"GET / HTTP/1.1\r\nX: " + b"x" * 100_000,
    "many headers": b"GET / HTTP/1.1\r\n" + b"X: x\r\n" * 1000 + b"\r\n",
    "another method": b"DELETE / HTTP/1.1\r\nHost: x\r\n\r\n",
    "a body": b"POST / HTTP/1.1\r\nContent-Length: 1000000000\r\n\r\n" + bytes(1000),
    "an old HTTP": b"GET / HTTP/0.9\r\n\r\n",
    "nothing": b"",
}
BROKEN = {
    "reserved bits": b"\xf2\x80" + bytes(4),
    "unmasked": b"\x82\x05hello",
    "no such opcode": b"\x83\x80" + bytes(4),
    "a continuation of nothing": b"\x80\x80" + bytes(4),
    "a long ping": b"\x89\xfe\xff\xff" + bytes(4 + 0xFFFF),
    "a petabyte": b"\x82\xff" + (2**50).to_bytes(8, "big") + bytes(4),
    "a length of its own": b"\x82\xff" + (2**63 + 5).to_bytes(8, "big") + bytes(4),
    "no text": frames(b"\xff\xff", opcode=Opcode.TEXT),
    "a strange close": frames(b"\x00\x00bye", opcode=Opcode.CLOSE),
}
COMMANDS = [
    "",
    "[" * 100_000,
    '{"do": "Dance"}',
    '{"do": "Freeze", "on": true}',
    '{"do": "Hold", "on": 1}',
    '{"do": "Grab", "side": "left", "target": [1e9, -1e9]}',
    '{"do": "MovePoint", "index": -1000000000, "target": [0, 0]}',
    '{"do": "DrawPath", "stroke": [[0.1, 0.1], [0.1, 0.1]]}',
    '{"do": "Set", "name": "K1", "value": 1e9}',
    '{"do": "TypeLaw", "side": "left", "text": "across = ((((((e1))))))"}',
    '{"do": "ChooseRobot", "name": "flexible"}',
    '{"do": "ChooseRobot", "name": "five_bar"}',
    '{"do": "LookAt", "ago": 30}',
    '{"do": "GoOn"}',
    '{"do": "UndoGoOn"}',
    '{"do": "Identify"}',
    '{"do": "GoToStep", "by": 1000000000}',
    '{"do": "SetLanguage", "language": "../de"}',
    '{"do": "UseShared", "text": "ONPATH1-aaaa"}',
]
"""Messages for a data channel: some are no commands, others are commands that cost much."""
ASKED: dict[str, dict[str, Any]] = {
    "hello": {"page": "0" * 32},
    "seen": {},
    "dark": {"on": True},
    "resized": {},
    "skip": {},
    "fields": {},
    "set": {"name": "K1", "value": 500.0, "number": 1},
    "light": {"symbol": "q_1"},
    "plots": {"fields": ["xi"]},
    "send": {"number": 1, "name": "a.csv", "size": 4, "use": {"kind": "path"}},
    "part": {"number": 1, "content": "MCww"},
    "drop": {"number": 1},
    "make": {"file": "table"},
    "freehand": {},
    "ask": {"what": "laws"},
    "prefer": {"name": "sounds", "on": True},
    "view": {},
    "summary": {},
    "enter": {"code": "k7mf2xqa9tzr"},
    "choose_tip": {"robot": "planar_arm", "tip": "tool0"},
    "compare_laws": {"laws": ["path_following"], "obstruction": "brake"},
    "join": {"code": "234567", "name": "Ada"},
    "leave": {},
    "ask_place": {},
    "forget_me": {},
    "identify": {"typed": "123"},
    "link": {"word": "green cactus"},
    "teach": {"key": "k7mf2xqa9tzr"},
    "lead": {"do": "freeze", "member": 1},
    "drive": {"what": "beat"},
}
"""A message of each kind that a page sends besides commands."""
NUMBERS = [-1e9, -1.0, -1e-9, 0.0, 1e-300, 0.05, 0.3, 1.0, 1e9]
NAMES = [*("left", "right", "de", "en", "K1", "speed", "dt", "delay", "certain"), *ROBOTS, *LAWS]
NAMES += [*presets(), *built_in_course().lessons]


def _points(draw: random.Random) -> list[list[float]]:
    spread = draw.choice([1e-6, 0.05, 1.0, 1e9])
    return [[draw.gauss(0, spread), draw.gauss(0, spread)] for _ in range(draw.choice([1, 2, 300]))]


_DRAWN: dict[str, Callable[[random.Random], Any]] = {
    "bool": lambda draw: draw.random() < 0.5,
    "int": lambda draw: draw.choice([-(10**9), -1, 0, 1, 3, 10**9]),
    "float": lambda draw: draw.choice(NUMBERS),
    "str": lambda draw: draw.choice(NAMES),
    "Any": lambda draw: draw.choice([*NAMES, *NUMBERS]),
    "Array": lambda draw: draw.choice([draw.choices(NUMBERS, k=2), _points(draw)]),
    "tuple[float, ...]": lambda draw: draw.choices(NUMBERS, k=draw.randrange(40)),
}
"""Values of fields, by their types."""


def wild_message(draw: random.Random) -> str | bytes:
    """A message for a data channel: a command or a request with any values, or one of the above.

    Few are no text; for these, a connection is closed.
    """
    kind = draw.random()
    if kind < 0.01:
        return draw.randbytes(100)
    if kind < 0.1:
        return draw.choice(COMMANDS)
    if kind < 0.4:
        return wild_request(draw)
    commands: list[tuple[str, Any]] = [*page_commands().items()]
    name, command = draw.choice(commands)
    fields = {field.name: _value(str(field.type), draw) for field in dataclasses.fields(command)}
    return json.dumps({"do": name, **fields}, default=repr)


def wild_request(draw: random.Random, kinds: Iterable[str] = ASKED) -> str:
    """A message of a page that is no command, some of whose fields have other values or none.

    Args:
        kinds: one of these.
    """
    kind = draw.choice([*kinds])
    others = [*NAMES, *NUMBERS, *HOSTILE, *get_args(JointSymbol), *get_args(SheetName), *SETTINGS]
    found: dict[str, Any] = {"is": kind}
    for name, value in ASKED[kind].items():
        if (way := draw.random()) < 0.9:
            found[name] = value if way < 0.5 else draw.choice(others)
    return json.dumps(found, default=repr)


def _value(kind: str, draw: random.Random) -> Any:
    """A value of a field, or a hostile one."""
    drawn = _DRAWN.get(kind.removesuffix(" | None"))
    return drawn(draw) if drawn is not None and draw.random() < 0.9 else draw.choice(HOSTILE)
