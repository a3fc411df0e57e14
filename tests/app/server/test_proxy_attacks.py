"""Broken requests from several addresses at the supplied nginx: nobody else notices anything.

A request that a process does not answer makes nginx ask the next one, which takes the class over;
and one that nginx takes for the end of a process may keep everybody away from it.
"""

from __future__ import annotations

import socket
import threading
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import ExitStack, contextmanager, suppress
from http.client import HTTPConnection

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus

from tests.support.site import HOST, needs_nginx
from tests.support.site_class import CODES, Class, Running, quiet

pytestmark = [pytest.mark.thorough, needs_nginx]

NEIGHBOUR, *ATTACKERS = (f"127.0.0.{number}" for number in range(2, 9))
ROUNDS = 4
PATHS = "/", f"/c/{CODES[0]}/", "/l/abcdefghijkm/", "/health"
SPELLINGS = (
    CODES[0].upper(),
    CODES[0][:-1] + CODES[0][-1].upper(),
    CODES[0].title(),
    f"{CODES[0]}/x",
    f"{CODES[0]}?utm_source=x",
    f"%{ord(CODES[0][0]):02x}{CODES[0][1:]}",
    f"./{CODES[0]}/",
    f"{CODES[0]}/../../c/{CODES[0].upper()}",
)
UPGRADE = "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13"
KEY = "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ=="
FAULTS = (
    "Content-Length: 1\r\n\r\nx",
    "Content-Length: 900\r\n\r\n" + "x" * 900,
    "Content-Length: 2000\r\n\r\n" + "x" * 2000,
    "Transfer-Encoding: chunked\r\n\r\n1\r\nx\r\n0\r\n\r\n",
    "Transfer-Encoding: chunked\r\nContent-Length: 4\r\n\r\n0\r\n\r\n",
    "A: b\r\n" * 200 + "\r\n",
    "A: b\x01c\r\n\r\n",
    "A\x01b: c\r\n\r\n",
    f"A: {'x' * 3000}\r\n" * 5 + "\r\n",
    "Cookie: \xfc=\xe4; onpath=..\r\n\r\n",
    f"{UPGRADE}\r\n\r\n",
    f"{UPGRADE}\r\nSec-WebSocket-Key: short\r\n\r\n",
    f"{UPGRADE}\r\n{KEY}\r\n{KEY}\r\n\r\n",
    f"{UPGRADE}\r\n{KEY}\r\nUpgrade: h2c\r\n\r\n",
    f"{UPGRADE}\r\n{KEY}\r\nOrigin: https://evil.example\r\n\r\n",
    f"{UPGRADE}\r\n{KEY}\r\nContent-Length: 3\r\n\r\nabc",
    "Upgrade: h2c\r\nConnection: Upgrade, HTTP2-Settings\r\nHTTP2-Settings: AA\r\n\r\n",
)
UNFINISHED = "", "A: b\r\n", "A: ", "Content-Length: 900\r\n\r\nx", f"{UPGRADE}\r\n"


def requests() -> Iterator[str]:
    """All broken requests that are complete."""
    for path in PATHS:
        for fault in FAULTS:
            yield f"GET {path} HTTP/1.1\r\nHost: {HOST}\r\n{fault}"
        for start in (f"POST {path} HTTP/1.1", f"GET {path} HTTP/1.0", f"GET {path}\x01 HTTP/1.1"):
            yield f"{start}\r\nHost: {HOST}\r\nContent-Length: 0\r\n\r\n"
    for spelling in SPELLINGS:
        yield f"GET /c/{spelling} HTTP/1.1\r\nHost: {HOST}\r\n{UPGRADE}\r\n{KEY}\r\n\r\n"


def attack(port: int, source: str, stop: threading.Event) -> int:
    """Send all broken requests from an address, and leave some unfinished ones open.

    Returns:
        Number of requests, all of which were answered.
    """
    sent = 0

    def send(stack: ExitStack, text: str) -> socket.socket:
        made = socket.create_connection(("127.0.0.1", port), 60.0, source_address=(source, 0))
        stack.enter_context(made)
        made.sendall(text.encode("latin-1"))
        return made

    for _ in range(ROUNDS):
        with ExitStack() as left_open:
            for rest in UNFINISHED:
                send(left_open, f"GET {PATHS[1]} HTTP/1.1\r\nHost: {HOST}\r\n{rest}")
            for text in requests():
                if stop.is_set():
                    return sent
                with ExitStack() as stack:
                    answer = send(stack, text).recv(1 << 16)
                status = answer.partition(b"\r\n")[0].split(b" ")[1:2]
                assert status and int(status[0]) < 500, (text[:300], answer[:300])
                sent += 1
    return sent


@contextmanager
def under_attack(port: int) -> Iterator[list[Future[int]]]:
    """All attackers at once."""
    stop = threading.Event()
    with ThreadPoolExecutor(len(ATTACKERS)) as pool:
        attacks = [pool.submit(attack, port, source, stop) for source in ATTACKERS]
        try:
            yield attacks
        finally:
            stop.set()


def status(port: int, path: str) -> int:
    """What a neighbour is answered."""
    made = HTTPConnection("127.0.0.1", port, timeout=60.0, source_address=(NEIGHBOUR, 0))
    try:
        made.request("GET", path, headers={"Host": HOST})
        return made.getresponse().status
    finally:
        made.close()


def closed(klass: Class) -> list[ConnectionClosed]:
    """Who of a class has been thrown out; all of them read what they were sent."""
    ended: list[ConnectionClosed] = []
    for each in klass.all:
        try:
            each.read_what_has_come()
        except ConnectionClosed as end:
            ended.append(end)
    return ended


def test_no_spelling_of_its_address_moves_a_class(running: Running) -> None:
    with ExitStack() as stack:
        klass = Class(running, stack)
        klass.come_in()
        serving = running.site.serving()
        for spelling in SPELLINGS:
            stranger = stack.enter_context(running.site.student(f"c/{spelling}"))
            with suppress(InvalidStatus):  # most are refused
                stranger.open()
                stranger.read(lambda stranger=stranger: stranger.may_join)
            with running.site.student(klass.prefix) as student:
                student.open()
                student.read(lambda student=student: student.may_join)
            assert closed(klass) == []
        klass.until(klass.teacher_sees_both)
        assert serving.connections() >= len(klass.all)
    quiet(running)


def test_no_broken_request_is_noticed_by_anybody_else(running: Running) -> None:
    site = running.site
    with ExitStack() as stack:
        klass = Class(running, stack)
        klass.come_in()
        serving = site.serving()
        with under_attack(site.port) as attacks:
            while not all(each.done() for each in attacks):
                assert [status(site.port, path) for path in PATHS] == [302, 200, 200, 200]
                with site.student(f"c/{CODES[0]}") as newcomer:  # connects at the first try
                    newcomer.open()
                    newcomer.read(lambda newcomer=newcomer: newcomer.may_join)
                assert closed(klass) == []
            least = ROUNDS * len([*requests()])
            assert [each.result() for each in attacks] == [least] * len(ATTACKERS)
        assert closed(klass) == []
        klass.until(klass.is_back)  # as soon as the attackers' last connections have ended
        assert site.serving() is serving
        for path in PATHS:
            assert status(site.port, path) in (200, 302)
    quiet(running)
