"""What the server answers to HTTP: headers for browsers, HEAD, odd requests, and /health."""

from __future__ import annotations

import http.client
import logging
import socket
from collections.abc import Iterator

import pytest
from websockets import Headers
from websockets.http11 import Request, Response

from onpath.app.viser_adapter.request_filter import RequestFilter
from onpath.app.viser_adapter.secure_server import make_server

WAIT = 10.0  # [s]
METRICS = "pid, memory"


@pytest.fixture(scope="module")
def port() -> Iterator[int]:
    server = make_server(port=0, health=lambda query: METRICS + query)
    yield server.get_port()
    server.stop()


def ask(
    port: int, method: str = "GET", path: str = "/", headers: list[tuple[str, str]] | None = None
) -> tuple[http.client.HTTPResponse, bytes]:
    """A response and its body; headers may be repeated."""
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=WAIT)
    named = {name for name, _ in headers or ()}
    connection.putrequest(method, path, skip_host="Host" in named, skip_accept_encoding=True)
    for name, value in headers or ():
        connection.putheader(name, value)
    connection.endheaders()
    response = connection.getresponse()
    body = response.read()
    connection.close()
    return response, body


@pytest.mark.parametrize("path", ["/", "/index.html", "/nothing", "/health", "/../x"])
def test_every_response_tells_a_browser_what_it_may_do(port: int, path: str) -> None:
    response, _ = ask(port, path=path)
    policy = (response.getheader("Content-Security-Policy") or "").split("; ")
    assert "frame-ancestors 'self'" in policy and "object-src 'none'" in policy
    assert response.headers.get_all("X-Frame-Options") == ["SAMEORIGIN"]
    assert response.headers.get_all("X-Content-Type-Options") == ["nosniff"]
    assert response.getheader("Referrer-Policy") == "no-referrer"


@pytest.mark.parametrize(
    ("host", "sockets"),
    [
        ("lab.lan:8080", ["ws://lab.lan:8080", "wss://lab.lan:8080"]),
        ("LAB.lan", ["ws://lab.lan", "wss://lab.lan"]),
        ("[::1]:8080", []),  # a policy cannot name it; 'self' is left
        ("evil; script-src *", []),
        ("a b", []),
        ("*", []),
    ],
)
def test_a_page_may_connect_to_its_own_host_and_to_the_origins(
    host: str, sockets: list[str]
) -> None:
    door = RequestFilter(("https://Friend.example/",), local_only=False)
    response = Response(200, "OK", Headers())
    door.add_headers(Request("/", Headers(Host=host)), response)
    rules = [rule.split() for rule in response.headers["Content-Security-Policy"].split(";")]
    (allowed,) = [rule[1:] for rule in rules if rule[0] == "connect-src"]
    friends = ["ws://friend.example", "wss://friend.example"]
    assert sorted(allowed) == sorted(["'self'", "blob:", "data:", *sockets, *friends])
    assert [rule[0] for rule in rules].count("script-src") == 1


@pytest.mark.parametrize("path", ["/", "/index.html?x=1", "/nothing", "/health"])
def test_head_is_answered_as_get_without_a_body(port: int, path: str) -> None:
    (head, body), (get, shown) = ask(port, "HEAD", path), ask(port, "GET", path)
    assert body == b"" and head.status == get.status
    for name in ("Content-Length", "Content-Type", "Content-Security-Policy"):
        assert head.getheader(name) == get.getheader(name)
    if shown:
        assert int(head.getheader("Content-Length") or 0) == len(shown)


def test_a_head_that_comes_in_pieces_is_one(port: int) -> None:
    with socket.create_connection(("127.0.0.1", port), WAIT) as raw:
        raw.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        for part in (b"H", b"EA", b"D", b" /health HTTP/1.1\r\n", b"Host: x\r\n\r\n"):
            raw.sendall(part)
        answer = b"".join(iter(lambda: raw.recv(1 << 16), b""))
    assert answer.startswith(b"HTTP/1.1 200 ") and answer.endswith(b"\r\n\r\n")


HANDSHAKE = [
    ("Upgrade", "websocket"),
    ("Connection", "Upgrade"),
    ("Sec-WebSocket-Key", "dGhlIHNhbXBsZSBub25jZQ=="),
    ("Sec-WebSocket-Version", "13"),
]


def test_head_opens_no_websocket(port: int) -> None:
    assert ask(port, "HEAD", "/", HANDSHAKE)[0].status == 200


@pytest.mark.parametrize(
    ("headers", "status"),
    [
        ([("Accept-Encoding", "br"), ("Accept-Encoding", "gzip")], 200),
        ([("Upgrade", "websocket"), *HANDSHAKE], 400),
        ([("Upgrade", "h2c"), *HANDSHAKE], 400),
        ([*HANDSHAKE, ("Sec-WebSocket-Version", "13")], 400),
        ([*HANDSHAKE, ("Sec-WebSocket-Key", "x")], 400),
        ([("Host", "localhost"), ("Host", "evil.example")], 200),
        ([("Origin", "http://a"), ("Origin", "http://b"), *HANDSHAKE], 403),
        ([("Connection", "close"), ("Connection", "close")], 200),
    ],
)
def test_repeated_headers_are_no_error_of_the_server(
    port: int, headers: list[tuple[str, str]], status: int
) -> None:
    response, _ = ask(port, headers=headers)
    assert response.status == status
    if headers[0][0] == "Accept-Encoding":
        assert response.getheader("Content-Encoding") == "gzip"


# Health.


def health(peer: str, **headers: str) -> str:
    door = RequestFilter((), local_only=False, health=lambda _: METRICS)
    named = Headers({name.replace("_", "-"): text for name, text in headers.items()})
    answer = door.refusal(Request("/health?seconds=3", named), peer)
    assert answer is not None and answer[0] == 200
    return answer[1]


@pytest.mark.parametrize("host", ["127.0.0.1:8080", "localhost", "localhost:8080", "[::1]:8080"])
def test_this_machine_is_told_the_metrics(host: str) -> None:
    assert health("127.0.0.1", Host=host) == health("::1", Host=host) == METRICS


@pytest.mark.parametrize(
    ("peer", "headers"),
    [
        ("192.0.2.7", {"Host": "localhost"}),
        ("", {"Host": "localhost"}),  # a Unix socket, behind which is a proxy
        ("127.0.0.1", {"Host": "lab.example.org"}),  # rebound, or a proxy
        ("127.0.0.1", {"Host": "localhost.evil.example"}),
        ("127.0.0.1", {"Host": "[::1"}),
        ("127.0.0.1", {}),
        ("127.0.0.1", {"Host": "localhost", "X_Forwarded_For": "192.0.2.7"}),
        ("127.0.0.1", {"Host": "localhost", "Origin": "http://evil.example"}),
    ],
)
def test_others_are_told_no_more_than_a_probe_needs(peer: str, headers: dict[str, str]) -> None:
    assert health(peer, **headers) == "well\n"


def test_health_over_the_wire(port: int) -> None:
    assert ask(port, path="/health?seconds=3")[1] == METRICS.encode() + b"seconds=3"
    assert ask(port, path="/health", headers=[("Host", "lab.example.org")])[1] == b"well\n"


# The log.


def test_a_connection_without_a_request_is_not_logged_before_the_first_page_either(
    caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """viser's own filter begins with the first page, and a probe of the port asks for none."""
    monkeypatch.setattr(logging.getLogger("websockets.server"), "filters", [])
    server = make_server(port=0)
    with socket.create_connection(("127.0.0.1", server.get_port())) as raw:
        raw.shutdown(socket.SHUT_WR)
        assert raw.recv(1) == b""
    server.stop()
    assert not [record for record in caplog.records if record.levelno >= logging.WARNING]


# Requests that are none.

MALFORMED = {
    "a body": b"GET / HTTP/1.1\r\nHost: x\r\nContent-Length: 1\r\n\r\nx",
    "a length that is no number": b"GET / HTTP/1.1\r\nHost: x\r\nContent-Length: x\r\n\r\n",
    "chunks": b"GET / HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n",
    "200 headers": b"GET / HTTP/1.1\r\nHost: x\r\n" + b"a: b\r\n" * 200 + b"\r\n",
    "a control byte": b"GET / HTTP/1.1\r\nHost: x\r\nA: b\x01\r\n\r\n",
    "a name with a space": b"GET / HTTP/1.1\r\nHost: x\r\nA b: c\r\n\r\n",
    "a long line": b"GET /" + b"x" * 10_000 + b" HTTP/1.1\r\n\r\n",
    "another method": b"POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 0\r\n\r\n",
    "another version": b"GET / HTTP/1.0\r\n\r\n",
    "no request": b"hello\r\n\r\n",
    "binary": bytes(range(256)) + b"\r\n",
    "a request without end": b"GET / HTTP/1.1\r\nHost: x\r\nA: ",
    "a byte": b"G",
}


@pytest.mark.parametrize("text", MALFORMED.values(), ids=MALFORMED.keys())
@pytest.mark.parametrize("bytewise", [False, True])
def test_a_malformed_request_is_answered(port: int, text: bytes, bytewise: bool) -> None:
    """A proxy would take a connection that is closed without an answer for a dead process."""
    with socket.create_connection(("127.0.0.1", port), WAIT) as raw:
        raw.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        for part in [bytes([each]) for each in text[:300]] if bytewise else [text]:
            raw.sendall(part)
        raw.shutdown(socket.SHUT_WR)
        answer = b"".join(iter(lambda: raw.recv(1 << 16), b""))
    head, _, body = answer.partition(b"\r\n\r\n")
    assert head.startswith(b"HTTP/1.1 400 ") and b"\r\nConnection: close" in head and not body
    assert answer.count(b"HTTP/1.1") == 1


@pytest.mark.parametrize("together", [True, False])
@pytest.mark.parametrize("after", [b"GET / HTTP/1.1\r\nHost: a\r\n\r\n", b"\xff" * 300, b"\x81"])
@pytest.mark.parametrize("asked", [b"", b"Upgrade: websocket\r\n"])
def test_bytes_after_a_request_do_not_keep_it_from_its_answer(
    port: int, caplog: pytest.LogCaptureFixture, asked: bytes, after: bytes, together: bool
) -> None:
    request = b"GET /health HTTP/1.1\r\nHost: 127.0.0.1\r\n" + asked + b"\r\n"
    with socket.create_connection(("127.0.0.1", port), WAIT) as raw:
        raw.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        for part in [request + after] if together else [request[:-3], request[-3:] + after]:
            raw.sendall(part)
        answer = b"".join(iter(lambda: raw.recv(1 << 16), b""))
    assert answer.startswith(b"HTTP/1.1 200 ") and answer.count(b"HTTP/1.1") == 1
    assert not [record for record in caplog.records if record.levelno >= logging.WARNING]


def test_an_error_of_our_own_is_logged(
    caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(logging.getLogger("websockets.server"), "filters", [])

    def fails(_: str) -> str:
        raise ZeroDivisionError("in the health report")

    server = make_server(port=0, health=fails)
    ask(server.get_port())  # viser's filter begins with the first page
    assert ask(server.get_port(), path="/health")[0].status == 500
    server.stop()
    assert [type(each.exc_info[1]) for each in caplog.records if each.exc_info] == [
        ZeroDivisionError
    ]
