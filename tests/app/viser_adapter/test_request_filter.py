"""The handshake lets in the server's own page and invited ones, and no path leaves the folder."""

from __future__ import annotations

import pytest
from websockets import Headers
from websockets.http11 import Request

from onpath.app.viser_adapter.request_filter import RequestFilter


def request(path: str = "/", **headers: str) -> Request:
    return Request(path, Headers({name.replace("_", "-"): text for name, text in headers.items()}))


def status(door: RequestFilter, asked: Request) -> int:
    refusal = door.refusal(asked)
    return 200 if refusal is None else refusal[0].value


@pytest.mark.parametrize(
    ("origin", "host", "local", "public"),
    [
        ("http://localhost:8080", "localhost:8080", 200, 200),
        ("http://[::1]:8080", "[::1]:8080", 200, 200),
        ("http://LocalHost:8080", "localhost:8080", 200, 200),
        ("http://lab.lan:8080", "lab.lan:8080", 403, 200),  # a name that may be rebound
        ("https://friend.example", "127.0.0.1:8080", 200, 200),
        ("https://friend.example.evil", "127.0.0.1:8080", 403, 403),
        ("http://friend.example", "127.0.0.1:8080", 403, 403),
        ("null", "", 403, 403),
    ],
)
def test_origin_rule(origin: str, host: str, local: int, public: int) -> None:
    asked = request(Origin=origin, Host=host, Upgrade="websocket")
    for local_only, expected in ((True, local), (False, public)):
        door = RequestFilter(("https://Friend.example/",), local_only=local_only)
        assert status(door, asked) == 503  # before the guards are in place
        door.open = True
        assert status(door, asked) == expected


def test_neither_spelling_nor_repetition_evades_the_origin_rule() -> None:
    door = RequestFilter((), local_only=True)
    door.open = True
    evil = "http://evil.example"
    assert status(door, request(Origin=evil, Host="localhost", Upgrade="WebSocket")) == 403
    twice = request(Host="localhost", Upgrade="websocket", Origin="http://localhost")
    assert status(door, twice) == 200
    twice.headers["Origin"] = evil
    assert status(door, twice) == 403


@pytest.mark.parametrize(
    "path",
    ["/C:/Windows/win.ini", "/c%3A/x", "/..%5cx", "/a/%2e%2e/b", "/..", "/a%00b", "/" + "x" * 300],
)
def test_door_turns_away_paths_that_leave(path: str) -> None:
    assert status(RequestFilter((), local_only=True), request(path)) == 404
