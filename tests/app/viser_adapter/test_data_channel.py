"""A page's own websocket: a greeting opens it, and it is limited as viser's own one is."""

from __future__ import annotations

import gc
import threading
import time
import weakref
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from functools import partial
from typing import Any

import pytest
import viser
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.frames import CloseCode, Frame, Opcode
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Origin, Subprotocol

from onpath.app.viser_adapter import data_channel
from onpath.app.viser_adapter.connection_limits import CountedConnection
from onpath.app.viser_adapter.data_channel import (
    MOST_UNSENT,
    NO_GREETING,
    SUBPROTOCOL,
    DataChannel,
    PageStream,
)
from onpath.app.viser_adapter.limits import Limits
from onpath.app.viser_adapter.secure_server import make_server
from tests.bench.raw_socket import is_closed, knock, say
from tests.support import waiting

WAIT = 10.0
wait_for = partial(waiting.wait_for, seconds=WAIT)


class Pages:
    """A server, and the streams of some pages, which greet by a number of their own.

    What the pages say is answered in capitals if it is a question.
    """

    def __init__(self, **limits: Any) -> None:
        self.streams = dict[str, PageStream]()
        self.left = list[PageStream]()
        self.channel = DataChannel(lambda text, _: self.streams.get(text))
        self.server = make_server(port=0, limits=Limits(**limits), channel=self.channel)
        self.port = self.server.get_port()
        self.received = list[str]()

    def stream(self) -> PageStream:
        stream = PageStream(self.channel, lambda: self.left.append(stream))
        stream.receive = self._receive
        self.streams[str(len(self.streams))] = stream
        return stream

    def number(self, stream: PageStream) -> str:
        return next(number for number, each in self.streams.items() if each is stream)

    def _receive(self, text: str) -> bytes:
        self.received.append(text)
        return text.upper().encode() if text.startswith("?") else b""

    def tab(self, said: Any, subprotocol: str = SUBPROTOCOL, **options: Any) -> Any:
        """A connection that says something first, such as the number of a stream."""
        made = connect(
            f"ws://127.0.0.1:{self.port}",
            subprotocols=[Subprotocol(subprotocol)],
            compression=None,
            close_timeout=0.5,
            **options,
        )
        if said is not None:
            made.send(self.number(said) if isinstance(said, PageStream) else said)
        return made

    def tell(self, stream: PageStream, *texts: bytes) -> None:
        stream.hand_over(*(partial(bytes, text) for text in texts))
        self.channel.send()


@pytest.fixture
def pages() -> Iterator[Pages]:
    pages = Pages()
    yield pages
    pages.server.stop()


def closing(tab: ClientConnection) -> ConnectionClosed:
    """How the server ends a connection that it must end."""
    with pytest.raises(ConnectionClosed) as closed:
        while True:
            tab.recv(timeout=WAIT)
    return closed.value


def code_of(closed: ConnectionClosed) -> int:
    assert closed.rcvd is not None
    return closed.rcvd.code


def test_a_page_that_has_greeted_is_told_and_heard(pages: Pages) -> None:
    stream, other = pages.stream(), pages.stream()
    with pages.tab(stream) as tab:
        wait_for(lambda: stream.is_open)
        assert not other.is_open
        pages.tell(stream, b"one", b"two")
        assert [tab.recv(WAIT), tab.recv(WAIT)] == ["one", "two"]
        tab.send("?so")
        assert tab.recv(WAIT) == "?SO"
        assert pages.received == ["?so"]
    wait_for(lambda: not stream.is_open)
    with pages.tab(stream):  # it may come back
        wait_for(lambda: stream.opened == 2)


@pytest.mark.parametrize("said", ["", "x", "x" * 100_000, b"bytes", "\0"])
def test_what_is_no_greeting_is_refused(pages: Pages, said: Any) -> None:
    stream = pages.stream()
    with pages.tab(said or "1") as tab:
        assert code_of(closing(tab)) == NO_GREETING
    assert not stream.is_open


def test_a_stream_that_is_ended_is_no_longer_heard(pages: Pages) -> None:
    stream = pages.stream()
    with pages.tab(stream) as tab:
        wait_for(lambda: stream.is_open)
        pages.channel.call(stream.end)
        assert code_of(closing(tab)) == CloseCode.SERVICE_RESTART
    assert not stream.is_open and pages.received == pages.left == []  # who ends it knows


def test_a_page_that_leaves_is_noticed_once_and_its_former_connection_not(pages: Pages) -> None:
    stream = pages.stream()
    with pages.tab(stream):
        wait_for(lambda: stream.opened == 1)
        with pages.tab(stream) as latter:
            wait_for(lambda: stream.opened == 2)
            latter.ping().wait(WAIT)
            assert pages.left == []
        wait_for(lambda: pages.left == [stream])


def test_a_message_is_said_at_once_to_a_page_that_listens(pages: Pages) -> None:
    stream, other = pages.stream(), pages.stream()
    with pages.tab(stream) as tab:
        wait_for(lambda: stream.is_open)
        other.say(b"lost")
        stream.say(b"said")
        assert tab.recv(WAIT) == "said"


def test_a_silent_client_is_closed_and_may_come_again(
    pages: Pages, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert data_channel.GREETING >= 60.0  # a page whose first messages take 30 s each way
    monkeypatch.setattr(data_channel, "GREETING", 0.2)
    stream = pages.stream()
    with pages.tab(None) as tab:
        assert code_of(closing(tab)) == CloseCode.TRY_AGAIN_LATER
    with pages.tab(stream):
        wait_for(lambda: stream.is_open)


def test_the_first_message_only_is_the_greeting(pages: Pages) -> None:
    stream = pages.stream()
    with pages.tab("?") as tab, suppress(ConnectionClosed):
        tab.send(pages.number(stream))
        closing(tab)
    assert not stream.is_open and pages.received == []


def test_a_page_has_one_connection_the_latest(pages: Pages) -> None:
    """Its former one may be half-open, which nobody notices for a while."""
    stream = pages.stream()
    with pages.tab(stream) as former:
        wait_for(lambda: stream.opened == 1)
        with pages.tab(stream) as latter:
            wait_for(lambda: stream.opened == 2)
            pages.tell(stream, b"told")
            assert latter.recv(WAIT) == "told"
            assert code_of(closing(former)) == CloseCode.GOING_AWAY
        wait_for(lambda: not stream.is_open)


@pytest.mark.parametrize("version", ["onpath-1", "onpath-2", "onpath-"])
def test_a_page_of_another_version_is_told_to_reload(pages: Pages, version: str) -> None:
    with pages.tab(None, version) as tab:
        closed = closing(tab)
    assert code_of(closed) == CloseCode.PROTOCOL_ERROR
    assert closed.rcvd is not None and "reload" in closed.rcvd.reason


def test_a_page_of_another_origin_is_refused(pages: Pages) -> None:
    stream = pages.stream()
    with pytest.raises(InvalidStatus) as refused:
        pages.tab(stream, origin=Origin("https://elsewhere.example"))
    assert refused.value.response.status_code == 403
    with pages.tab(stream, origin=Origin(f"http://127.0.0.1:{pages.port}")):
        wait_for(lambda: stream.is_open)


def test_more_connections_than_allowed_are_refused() -> None:
    pages = Pages(max_connections_each=2)
    streams = [pages.stream() for _ in range(3)]
    tabs = pages.tab(streams[0]), pages.tab(streams[1])
    with tabs[0], tabs[1], pytest.raises(InvalidStatus) as refused:
        pages.tab(streams[2])
    assert refused.value.response.status_code == 503
    pages.server.stop()


def test_a_message_that_is_too_large_closes_the_connection(pages: Pages) -> None:
    stream = pages.stream()
    with pages.tab(stream) as tab, suppress(ConnectionClosed):
        tab.send("x" * 1_000_001)
        assert code_of(closing(tab)) == CloseCode.MESSAGE_TOO_BIG
    assert pages.received == []


def test_data_that_are_no_text_close_the_connection(pages: Pages) -> None:
    stream = pages.stream()
    with pages.tab(stream) as tab:
        wait_for(lambda: stream.is_open)
        tab.send(b"?")
        assert code_of(closing(tab)) == CloseCode.UNSUPPORTED_DATA
    assert pages.received == []


def test_a_flood_of_commands_closes_the_connection() -> None:
    pages = Pages(change_burst=20.0)
    stream = pages.stream()
    with pages.tab(stream) as tab:
        with suppress(ConnectionClosed):
            for _ in range(200):
                tab.send("command")
        closed = closing(tab)
    assert code_of(closed) == CloseCode.POLICY_VIOLATION
    assert closed.rcvd is not None and "per second" in closed.rcvd.reason
    assert len(pages.received) <= 30
    pages.server.stop()


def test_an_unfinished_message_closes_the_connection() -> None:
    pages = Pages(message_seconds=0.2)
    stream = pages.stream()
    raw = knock(pages.port, SUBPROTOCOL)
    say(raw, pages.number(stream).encode(), opcode=Opcode.TEXT)
    wait_for(lambda: stream.is_open)
    raw.sendall(Frame(Opcode.TEXT, b"{", fin=False).serialize(mask=True))
    wait_for(lambda: is_closed(raw))
    wait_for(lambda: not stream.is_open)
    raw.close()
    pages.server.stop()


@pytest.mark.thorough
def test_nothing_more_is_sent_to_a_page_that_reads_too_slowly(pages: Pages) -> None:
    """Until it has read most; then it gets what was handed over, and is free for more."""
    stream, other = pages.stream(), pages.stream()
    raw = knock(pages.port, SUBPROTOCOL)
    say(raw, pages.number(stream).encode(), opcode=Opcode.TEXT)
    wait_for(lambda: stream.is_open)
    sent = 0
    while not stream.is_busy:
        pages.tell(stream, b"x" * MOST_UNSENT)
        sent += 1
        with suppress(AssertionError):
            waiting.wait_for(lambda: not stream.is_busy, 1.0)
        assert sent < 200  # the system's buffers are smaller
    with pages.tab(other) as quick:
        wait_for(lambda: other.is_open)
        pages.tell(other, b"told")
        assert quick.recv(WAIT) == "told"
    assert stream.is_busy
    received = 0
    while received < sent * MOST_UNSENT:
        received += raw.recv(1 << 20).count(b"x")
    assert wait_for(lambda: not stream.is_busy)
    raw.close()


def test_a_page_that_comes_back_is_not_sent_what_its_former_connection_was(pages: Pages) -> None:
    stream = pages.stream()
    pages.tell(stream, b"to nobody")
    wait_for(lambda: pages.channel._loop is None or not stream.is_busy)
    with pages.tab(stream) as tab:
        wait_for(lambda: stream.is_open)
        wait_for(lambda: not stream.is_busy)
        pages.tell(stream, b"to the page")
        while (text := tab.recv(WAIT)) == "to nobody":
            pass
        assert text == "to the page"


def test_a_connection_is_free_as_soon_as_it_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without a collection, until which thousands could come and go."""
    made, opened = list[weakref.ref[Any]](), CountedConnection.connection_made

    def connection_made(connection: CountedConnection, transport: Any) -> None:
        made.append(weakref.ref(connection))
        opened(connection, transport)

    monkeypatch.setattr(CountedConnection, "connection_made", connection_made)
    pages = Pages()
    stream = pages.stream()
    gc.disable()
    try:
        for said in (stream, "wrong", stream, stream):
            with pages.tab(said) as tab, suppress(ConnectionClosed, TimeoutError):
                tab.recv(0.1)
        wait_for(lambda: len(made) == 4 and not any(one() for one in made[:-1]))
    finally:
        gc.enable()
        pages.server.stop()


def test_a_server_without_pages_takes_no_greeting() -> None:
    server = make_server(port=0)
    tab = connect(f"ws://127.0.0.1:{server.get_port()}", subprotocols=[Subprotocol(SUBPROTOCOL)])
    with tab:
        tab.send("0")
        assert code_of(closing(tab)) == NO_GREETING
    server.stop()


def test_an_early_page_waits_until_its_server_is_prepared() -> None:
    prepared, opened = threading.Event(), list[bool]()

    def come(port: int) -> None:
        with connect(f"ws://127.0.0.1:{port}", subprotocols=[Subprotocol(SUBPROTOCOL)]):
            opened.append(prepared.is_set())

    def prepare(server: viser.ViserServer) -> None:
        page.submit(come, server.get_port())
        time.sleep(0.3)  # in which the page would be let in
        prepared.set()

    with ThreadPoolExecutor() as page:
        server = make_server(port=0, prepare=prepare)
    server.stop()
    assert opened == [True]


def test_visers_own_websocket_takes_no_greeting(pages: Pages) -> None:
    stream = pages.stream()
    with pages.tab(stream, f"viser-v{viser.__version__}") as tab:
        time.sleep(0)  # nothing to wait for: the message is dropped
        tab.ping().wait(WAIT)
    assert not stream.is_open
