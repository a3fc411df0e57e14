"""A real lab under attack: the attacker alone is turned away, the others keep their display rate.

tests/app/viser_adapter/test_hardening.py has each check by itself; here is the whole server, with
somebody in it.
"""

from __future__ import annotations

import asyncio
import logging
import math
import os
import random
import select
import signal
import socket
import struct
import subprocess
import sys
import threading
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from http import HTTPStatus
from itertools import cycle, islice, pairwise, product
from pathlib import Path
from typing import Any, get_args

import numpy as np
import pytest
import scipy.interpolate  # noqa: F401  a server loads it soon after its start: see warm_up
import websockets.sync.client
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.typing import Subprotocol

from onpath.app.channel.sheet_messages import SheetName
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.server.arrivals import PAGE_KEY
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from onpath.app.simulation.frame_length import FRAME
from onpath.app.view.lab_form import form_of, values_in
from onpath.app.viser_adapter.data_channel import SUBPROTOCOL as DATA
from onpath.app.viser_adapter.frame_channel import MOST_UNSENT
from onpath.app.viser_adapter.secure_server import Limits, make_server
from onpath.lessons.words import ENGLISH
from onpath.models.closed_loop.lab_settings import SETTINGS
from onpath.models.control.sides import SIDES
from onpath.models.paths.path_design import presets
from tests.bench.client_protocol import CAMERA, SUBPROTOCOL, answer, packed, unpacked
from tests.bench.hostile_messages import BROKEN, GARBAGE, VERSIONS
from tests.bench.raw_socket import WAIT, answer_question, frames, is_closed, knock, say
from tests.bench.simulated_browser import Browser
from tests.support import waiting
from tests.support.checkout import ROOT
from tests.support.lab import assert_sound
from tests.support.own_socket import OwnSocket, feeds, visit_of

pytestmark = pytest.mark.thorough

LEAST_RATE = 18.0  # frames that a witness is shown per second of processor time of this process
LONGEST_GAP = 0.5  # [s] of processor time from one to the next
LEAST = 40  # frames in which a witness is watched
wait_for = partial(waiting.wait_for, seconds=60.0)


class Guest:
    """A tab that answers as viser's page does, reads everything, and sends what a test sends."""

    def __init__(self, server: LabServer, inside: bool = True) -> None:
        before = set(feeds(server))
        self.own = OwnSocket(f"ws://127.0.0.1:{server.server.get_port()}")
        try:
            self.socket = websockets.sync.client.connect(
                f"ws://127.0.0.1:{server.server.get_port()}",
                subprotocols=[Subprotocol(SUBPROTOCOL)],
                max_size=None,
                compression=None,
                close_timeout=0.5,
            )
        except InvalidStatus:
            self.own.close()  # else it keeps a lab
            raise
        threading.Thread(target=self._read, daemon=True).start()
        self.send("ViewerCameraMessage", **CAMERA)
        if not inside:
            return
        (self.id,) = wait_for(lambda: set(feeds(server)) - before)
        self.client = server.server.get_clients()[self.id]
        self.visit, entries = visit_of(server, self.id), server.registry._entries.values()
        number = self.visit.number
        self.scheduled = next(entry.scheduled for entry in entries if entry.client == number)

    def close(self) -> None:
        """Leave the lab."""
        self.socket.close()
        self.own.close()

    def send(self, kind: str, **fields: Any) -> None:
        self.socket.send(packed(kind, **fields))

    def pour(self, messages: Iterable[dict[str, Any]]) -> None:
        """Send messages by the page's own websocket, almost as fast as the limit on them allows.

        The pause is the attacker's rate; there is nothing to wait for.
        """
        for message in messages:
            self.own.tell(message)
            time.sleep(1 / (0.9 * Limits().changes_per_second))

    @property
    def let_in(self) -> bool:
        """Whether it has a lab."""
        return "lab" in self.own.kinds()

    def _read(self) -> None:
        with suppress(ConnectionClosed):
            for raw in self.socket:
                assert isinstance(raw, bytes)
                for message in unpacked(raw):
                    if reply := answer(message, {PAGE_KEY: self.own.page}):
                        self.socket.send(reply)


class NotedFrames(Browser):
    """A browser that notes the processor time of this process at each frame, [s]."""

    def __init__(self, port: int) -> None:
        super().__init__(port, 0)
        self.shown = ProcessorTimes()


class ProcessorTimes(list[float]):
    """Takes an event's processor time instead of its time."""

    def append(self, _: float) -> None:
        super().append(time.process_time())


class Witness:
    """An honest browser that uses its lab all the time, in a thread of its own.

    It shares this process with the server and the attacker. What the machine does besides takes no
    processor time of this process; the work of an attacker does, and comes before its frames.
    """

    def __init__(self, port: int) -> None:
        self._browser = NotedFrames(port)
        self._loop = asyncio.new_event_loop()
        self._browsing = self._loop.create_task(self._browser.browse(600.0))
        self._thread = threading.Thread(target=self._browse, daemon=True)
        self._thread.start()
        self.watch(LEAST)

    def _browse(self) -> None:
        with suppress(ConnectionClosed, OSError, asyncio.CancelledError):
            self._loop.run_until_complete(self._browsing)

    def close(self) -> None:
        """Close the connection, and end its thread."""
        self._loop.call_soon_threadsafe(self._browsing.cancel)
        self._thread.join(WAIT)

    @contextmanager
    def served(self) -> Iterator[None]:
        """Assert that the witness keeps its display rate meanwhile."""
        before, begun = len(self._browser.shown), time.process_time()
        yield
        wait_for(lambda: len(self._browser.shown) >= before + LEAST)
        shown, ended = self._browser.shown[before:], time.process_time()
        rate = len(shown) / (ended - begun)
        gap = max(b - a for a, b in pairwise([begun, *shown, ended]))
        assert rate > LEAST_RATE and gap < LONGEST_GAP, f"{rate:.1f} Hz, {gap:.3f} s"

    def watch(self, frames: int) -> None:
        """Return when it has been shown that many more frames."""
        before = len(self._browser.shown)
        wait_for(lambda: len(self._browser.shown) >= before + frames)


@pytest.fixture(scope="module")
def server() -> Iterator[LabServer]:
    server = LabServer("127.0.0.1", 0, LoopCache())
    yield server
    server.stop()


@pytest.fixture(scope="module")
def witness(server: LabServer) -> Iterator[Witness]:
    witness = Witness(server.server.get_port())
    yield witness
    witness.close()


@pytest.fixture
def attacker(server: LabServer) -> Iterator[Guest]:
    guest = Guest(server)
    yield guest
    guest.close()
    wait_for(lambda: guest.id not in feeds(server))


@pytest.fixture
def quiet_log(
    caplog: pytest.LogCaptureFixture, capfd: pytest.CaptureFixture[str]
) -> Iterator[None]:
    """At most one warning for each client, and no traceback."""
    caplog.set_level(logging.WARNING)
    yield
    records = caplog.get_records("call")
    assert [each.getMessage() for each in records if each.levelno > logging.WARNING] == []
    assert len(records) < 13
    assert "Traceback" not in "".join(capfd.readouterr())


# Settings.

NO_VALUES: list[Any] = [
    *(math.nan, math.inf, -math.inf, 1e300, -1e300, 2**63, 0.5, -1),
    *("", "nan", "x" * 20_000, "ONPATH1-" + "a" * 5000, None),
    *([], [math.nan] * 3, [1e300, -1e300], [[[]]], {"value": 1}),
]
TRIED = 300  # of all fields with all these values


def test_no_field_of_the_lab_takes_an_impossible_value(
    server: LabServer, attacker: Guest, witness: Witness
) -> None:
    lab = attacker.scheduled.lab
    first = take_page_snapshot(lab, 1.0)
    names = [*values_in(first, {}, (), ENGLISH), *SETTINGS]
    tried = random.Random(0).sample([*product(names, NO_VALUES)], TRIED)
    with witness.served():
        attacker.pour(
            {"is": "set", "name": name, "value": value, "number": number}
            for number, (name, value) in enumerate(tried)
        )
    wait_for(lambda: not lab._inbox)
    assert_sound(lab)
    last = take_page_snapshot(lab, 1.0)
    for group in form_of(last, None, ENGLISH).groups:
        for field in group.fields:
            value = values_in(last, {}, (), ENGLISH).get(field.name)
            if field.kind == "number":
                assert isinstance(value, float | int) and field.low <= value <= field.high
            elif field.kind == "choice" and field.name not in SIDES:
                assert value in [option.value for option in field.options]
    assert attacker.id in feeds(server)  # it may go on


# Floods.

UNREAD = 100_000  # messages are more than buffers hold: some have been sent after the closing


@pytest.mark.parametrize(
    "messages",
    [
        [{"do": "ChoosePath", "name": name} for name in presets()],
        [{"do": "Identify"}],
        [{"do": "Share"}],
        [{"is": "make", "file": "film"}],
        [{"is": "ask", "what": what} for what in get_args(SheetName)],
    ],
    ids=["paths", "identification", "share codes", "recordings", "sheets"],
)
@pytest.mark.usefixtures("quiet_log")
def test_requesting_long_work_all_the_time_delays_only_the_sender(
    attacker: Guest, witness: Witness, messages: list[dict[str, Any]]
) -> None:
    """As fast as the limit on messages allows: the work, not the messages, is the burden."""
    with witness.served():
        attacker.pour(islice(cycle(messages), 200))
    assert len(attacker.scheduled.lab._inbox) <= 500


def test_a_flood_of_messages_closes_the_sender(
    server: LabServer, witness: Witness, quiet_log: None
) -> None:
    raw = knock(server.server.get_port())
    camera = frames(packed("ViewerCameraMessage", **CAMERA)) * 50
    sent = 0
    with witness.served():
        with suppress(OSError):
            while not is_closed(raw) and sent < UNREAD:
                raw.sendall(camera)
                sent += 50
        wait_for(lambda: is_closed(raw))
        raw.close()
    assert sent > 500


# Frames and handshakes.


def test_a_wrong_version_is_told_so_and_closed(
    server: LabServer, witness: Witness, quiet_log: None
) -> None:
    clients = set(server.server.get_clients())
    with witness.served():
        raws = [knock(server.server.get_port(), version) for version in VERSIONS * 5]
        for raw in raws:
            wait_for(lambda raw=raw: is_closed(raw))
            raw.close()
    assert set(server.server.get_clients()) == clients


def test_an_invalid_request_is_closed_and_not_logged_in_full(
    server: LabServer, witness: Witness, quiet_log: None
) -> None:
    with witness.served():
        for garbage in [*GARBAGE.values()] * 5:
            with socket.create_connection(("127.0.0.1", server.server.get_port())) as raw:
                with suppress(OSError):
                    raw.sendall(garbage)
                    raw.shutdown(socket.SHUT_WR)
                wait_for(lambda raw=raw: is_closed(raw))


def test_a_broken_frame_closes_its_sender(
    server: LabServer, witness: Witness, quiet_log: None
) -> None:
    with witness.served():
        for broken in BROKEN.values():
            raws = [knock(server.server.get_port()) for _ in range(5)]
            for raw in raws:
                wait_for(lambda raw=raw: select.select([raw], [], [], 0)[0])
                raw.sendall(frames(packed("ViewerCameraMessage", **CAMERA)) + broken)
            for raw in raws:
                wait_for(lambda raw=raw: is_closed(raw))
                raw.close()


# Connections.


def memory() -> int:
    """Of this process, [B]."""
    pages = int(Path("/proc/self/statm").read_text(encoding="utf-8").split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")


def test_a_client_that_reads_nothing_costs_a_bounded_amount(
    server: LabServer, witness: Witness, quiet_log: None
) -> None:
    before, sockets = set(feeds(server)), server.server._websock_server._live_connections
    known = set(sockets.values())
    raw = socket.socket()
    raw.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    raw.connect(("127.0.0.1", server.server.get_port()))
    silent = websockets.sync.client.connect(
        f"ws://127.0.0.1:{server.server.get_port()}",
        sock=raw,
        subprotocols=[Subprotocol(SUBPROTOCOL)],
        compression=None,
        max_queue=1,
    )
    (connection,) = wait_for(lambda: set(sockets.values()) - known)
    connection.transport.get_extra_info("socket").setsockopt(
        socket.SOL_SOCKET, socket.SO_SNDBUF, 4096
    )
    own = OwnSocket(f"ws://127.0.0.1:{server.server.get_port()}")
    silent.send(packed("ViewerCameraMessage", **CAMERA))
    answer_question(silent, own.page)
    (deaf,) = wait_for(lambda: set(feeds(server)) - before)
    client = server.server.get_clients()[deaf]
    buffer = client._websock_connection._state.message_buffer
    wait_for(lambda: connection.transport.get_write_buffer_size() > 0)
    waiting: list[int] = []
    with witness.served():
        for _ in range(30):
            waiting.append(len(buffer.message_from_id))
            assert connection.transport.get_write_buffer_size() < 16 * MOST_UNSENT
            witness.watch(3)
    assert max(waiting[-10:]) <= max(waiting[:20]) + 20  # what is late is merged
    raw.close()
    wait_for(lambda: deaf not in feeds(server))
    own.close()


def test_a_client_that_answers_nothing_is_closed() -> None:
    server = make_server(port=0, limits=Limits(silence=0.2, farewell=0.2))
    raw = knock(server.get_port())
    say(raw, packed("ViewerCameraMessage", **CAMERA))
    wait_for(server.get_clients)
    wait_for(lambda: is_closed(raw), seconds=3.0)
    wait_for(lambda: not server.get_clients())
    raw.close()
    server.stop()


def _let_in(server: LabServer) -> Guest | None:
    """A newcomer, unless too many tabs have been opened lately; a page then tries again."""
    try:
        return Guest(server)
    except InvalidStatus as refused:
        assert refused.response.status_code == HTTPStatus.TOO_MANY_REQUESTS
        time.sleep(2 / Limits().tabs_per_second_each)  # until both of its websockets may be opened
        return None


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="reads /proc")
def test_800_connections_in_a_row(server: LabServer, witness: Witness, quiet_log: None) -> None:
    """Some leave at once, some during the handshake, some after it, politely or not.

    Others open a page's own websocket and never greet.
    """
    port = server.server.get_port()
    camera = frames(packed("ViewerCameraMessage", **CAMERA))
    subprotocols = ["", SUBPROTOCOL, SUBPROTOCOL, SUBPROTOCOL, DATA]
    labs, threads, used = len(server.thread.labs), threading.active_count(), memory()
    with witness.served():
        for number in range(800):
            way = number % 5
            raw = (
                knock(port, subprotocols[way])
                if way
                else socket.create_connection(("127.0.0.1", port))
            )
            if way > 1:
                raw.recv(1 << 12)
            if way in (2, 3):
                raw.sendall(camera)
            if way == 3:
                raw.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
            raw.close()
    assert threading.active_count() < threads + 50
    wait_for(lambda: _let_in(server)).close()
    wait_for(lambda: len(server.thread.labs) <= labs + 3)
    wait_for(lambda: len(server.server._websock_server._live_connections) <= 2)
    assert memory() - used < 30e6


# Capacity.


def test_beyond_capacity_a_newcomer_is_told_to_wait_and_gets_the_first_free_place() -> None:
    server = LabServer("127.0.0.1", 0, LoopCache(), ServerOptions(most_clients=2))
    try:
        inside = Witness(server.server.get_port())
        leaving = Guest(server)
        with inside.served():
            late = [Guest(server, inside=False) for _ in range(3)]
            for guest in late:
                wait_for(lambda guest=guest: "wait" in guest.own.kinds())
                assert "All 2 places are taken" in str(guest.own.told)
            assert len(server.thread.labs) == 2
        leaving.close()
        wait_for(lambda: len(feeds(server)) == 2 and leaving.id not in feeds(server))
        known = set(feeds(server))
        wait_for(lambda: any(guest.let_in for guest in late))
        outside = [guest for guest in late if not guest.let_in]
        visits = len(server.visits)
        outside[0].close()  # who waits and leaves frees nothing
        wait_for(lambda: len(server.visits) < visits)
        inside.watch(LEAST)
        assert set(feeds(server)) == known
        assert len(outside) == 2 and not any(guest.let_in for guest in outside)
        inside.close()
    finally:
        server.stop()


# Misfortune.


def test_a_clock_that_jumps_is_not_noticed(
    server: LabServer, witness: Witness, quiet_log: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    genuine = time.time
    labs = set(server.thread.labs)
    with witness.served():
        for jump in (86400.0, -86400.0, 3e9, 0.0):
            monkeypatch.setattr(time, "time", lambda jump=jump: genuine() + jump)
            witness.watch(10)
            newcomer = Guest(server)
            begun = newcomer.scheduled.simulation.time
            wait_for(lambda n=newcomer, b=begun: n.scheduled.simulation.time > b + 0.1)
            newcomer.socket.close()
    assert labs <= set(server.thread.labs)


SUSPENDED = """
import sys
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.arrivals import PAGE_KEY
from onpath.app.server.lab_server import LabServer
server = LabServer("127.0.0.1", 0, LoopCache())
print("told", server.server.get_port(), flush=True)
for _ in sys.stdin:
    (lab,) = server.thread.labs
    print("told", lab.simulation.time, server.thread.frames.count, flush=True)
"""


@pytest.mark.skipif(not hasattr(signal, "SIGSTOP"), reason="no way to suspend a process here")
def test_a_suspended_process_continues_where_it_was_and_does_not_catch_up() -> None:
    pipe = subprocess.PIPE
    command = [sys.executable, "-c", SUSPENDED]
    process = subprocess.Popen(
        command, cwd=ROOT, stdin=pipe, stdout=pipe, stderr=pipe, text=True, bufsize=1
    )
    stdin, stdout = process.stdin, process.stdout
    assert stdin is not None and stdout is not None

    def told() -> list[float]:
        line = next(line for line in stdout if line.startswith("told"))
        return [float(word) for word in line.split()[1:]]

    def now() -> np.ndarray:
        """Simulated time, [s], and the number of frames."""
        stdin.write("\n")
        return np.array(told())

    try:
        witness = Witness(int(*told()))
        before = now()
        process.send_signal(signal.SIGSTOP)
        time.sleep(2.0)  # wall time must pass while the process is suspended
        process.send_signal(signal.SIGCONT)
        woken = now()
        assert woken[0] - before[0] < 1.0  # the sleep is not made up for
        witness.watch(LEAST)
        simulated, frames = now() - before
        assert 0.5 * LEAST * FRAME < simulated <= (frames + 2) * FRAME
        witness.close()
    finally:
        process.kill()
        errors = process.communicate()[1]
    assert "Traceback" not in errors
