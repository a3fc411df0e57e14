"""A page's two websockets come, break and come again in any order: it has its own lab, or none."""

from __future__ import annotations

import secrets
from collections.abc import Iterator
from functools import partial

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Subprotocol

from onpath.app.classroom.classroom import Classroom
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.arrivals import PAGE_KEY
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from onpath.app.viser_adapter.addresses import class_address
from onpath.app.viser_adapter.limits import Limits
from tests.bench.client_protocol import CAMERA, SUBPROTOCOL, answer, packed, unpacked
from tests.support import waiting
from tests.support.own_socket import OwnSocket

WAIT = 60.0
MANY = Limits(tab_burst_each=10_000.0)
ROOM = Classroom()
wait_for = partial(waiting.wait_for, seconds=WAIT)


@pytest.fixture(scope="module")
def server() -> Iterator[LabServer]:
    options = ServerOptions(limits=MANY, classrooms=[ROOM])
    server = LabServer("127.0.0.1", 0, LoopCache(), options)
    yield server
    server.stop()


def url(server: LabServer, path: str = "") -> str:
    return f"ws://127.0.0.1:{server.server.get_port()}{path}"


class Picture:
    """viser's websocket of a page, up to the answer to which page it belongs."""

    def __init__(self, address: str, page: str) -> None:
        self._socket: ClientConnection = connect(
            address,
            subprotocols=[Subprotocol(SUBPROTOCOL)],
            compression=None,
            close_timeout=0.5,
            max_size=None,
        )
        self._socket.send(packed("ViewerCameraMessage", **CAMERA))
        while True:
            raw = self._socket.recv(WAIT)
            assert isinstance(raw, bytes)
            replies = [answer(message, {PAGE_KEY: page}) for message in unpacked(raw)]
            if any(replies):
                return self._socket.send(next(filter(None, replies)))

    def close(self) -> None:
        """Close the websocket."""
        self._socket.close()

    @property
    def code(self) -> int:
        """With which the server closes it."""
        with pytest.raises(ConnectionClosed) as closed:
            while True:
                self._socket.recv(WAIT)
        assert closed.value.rcvd is not None
        return closed.value.rcvd.code


def is_empty(server: LabServer) -> bool:
    """Whether nothing is left of any page."""
    left = len(server.visits), len(server._room), len(server.registry.held())
    return left == (0, 0, 0) and not server.server.get_clients() and not server.visits._of_client


def code_of(own: OwnSocket) -> str:
    """The code of a page's lab, which it is told."""
    wait_for(lambda: "lab" in own.kinds())
    return next(message["code"] for message in own.told if message["is"] == "lab")


def test_a_picture_gets_the_lab_of_its_page_whenever_it_comes(server: LabServer) -> None:
    with OwnSocket(url(server)) as own, OwnSocket(url(server)) as other:
        codes = code_of(own), code_of(other)
        assert codes[0] != codes[1]
        picture = Picture(url(server), own.page)
        visits = {visit.hello.page: visit for visit in server.visits}
        wait_for(lambda: (feed := visits[own.page].feed) is not None and feed.scene)
        assert visits[other.page].client is None
        assert server.registry.find(codes[0]).client == visits[own.page].number  # type: ignore[union-attr]
        picture.close()
        wait_for(lambda: visits[own.page].client is None)
        assert not visits[own.page].has_ended
    wait_for(lambda: is_empty(server))


@pytest.mark.parametrize("page", ["", "0" * 32, "é", "x" * 5000])
def test_a_number_that_no_page_has_is_turned_away(server: LabServer, page: str) -> None:
    with OwnSocket(url(server)) as own:
        code_of(own)
        assert Picture(url(server), page).code == 1013
    assert Picture(url(server), own.page).code == 1013  # the page has left
    wait_for(lambda: is_empty(server))


def test_a_number_of_another_address_is_turned_away(server: LabServer) -> None:
    path = class_address(ROOM.code)
    with OwnSocket(url(server, path)) as own:
        code_of(own)
        assert Picture(url(server), own.page).code == 1013
        with OwnSocket(url(server), own.page) as stranger:
            wait_for(lambda: stranger._socket.protocol.close_code is not None)
            assert stranger._socket.protocol.close_code == 4001 and stranger.told == []
    wait_for(lambda: is_empty(server))


def test_of_two_with_one_number_the_later_one_stays(server: LabServer) -> None:
    with OwnSocket(url(server)) as former, OwnSocket(url(server), former.page) as latter:
        assert code_of(latter)
        wait_for(lambda: former._socket.protocol.close_code == 1001)
        pictures = [Picture(url(server), latter.page) for _ in range(2)]
        assert pictures[0].code == 1013
        assert len(server.visits) == 1
        pictures[1].close()
    wait_for(lambda: is_empty(server))


steps = st.lists(
    st.tuples(st.integers(0, 1), st.sampled_from(["own", "no own", "picture", "no picture"])),
    max_size=12,
)


@pytest.mark.thorough
@settings(max_examples=15, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(steps)
def test_in_any_order_a_page_is_told_of_its_own_lab_and_leaves_nothing(
    server: LabServer, steps: list[tuple[int, str]]
) -> None:
    pages = [secrets.token_hex(16) for _ in range(2)]
    owns: list[OwnSocket | None] = [None, None]
    pictures: list[Picture | None] = [None, None]
    codes: list[set[str]] = [set(), set()]
    for i, step in steps:
        own, picture = owns[i], pictures[i]
        if step == "own" and own is None:
            owns[i] = own = OwnSocket(url(server), pages[i], labs=",".join(codes[i]))
            codes[i].add(code_of(own))
        elif step == "no own" and own is not None:
            own.close()
            owns[i] = None
        elif step == "picture" and picture is None:
            pictures[i] = Picture(url(server), pages[i])
            if own is None:
                pictures[i] = None  # turned away, or what is left of its page has no script
        elif step == "no picture" and picture is not None:
            picture.close()
            pictures[i] = None
        assert not codes[0] & codes[1]
        assert len(server.visits) <= 2
    for each in (*owns, *pictures):
        if each is not None:
            each.close()
    wait_for(lambda: is_empty(server))
