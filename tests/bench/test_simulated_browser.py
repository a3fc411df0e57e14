"""Simulated browsers do what real ones do, and the shortcuts for many of them change nothing."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from contextlib import aclosing, contextmanager
from itertools import cycle
from socket import create_server
from threading import Thread

import numpy as np
import pytest
import websockets.exceptions
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from onpath.models.closed_loop.simulation import (
    FREE,
    Push,
    brake_at,
    kernel_of,
    kind_of,
    pushed,
    settings_vector,
)
from onpath.models.paths.curves import circle
from onpath.models.systems.catalogue import ROBOTS
from tests.bench.attacks import scripts
from tests.bench.simulated_browser import Browser, NotServed, Observations, crowd, first_poses

WAIT = 60.0  # [s]; only ends a test that would hang
FRAMES = 20  # of the data channel


@settings(max_examples=3)
@given(name=st.sampled_from(list(ROBOTS)))
def test_filling_in_a_push_is_the_same_as_packing_anew(name: str) -> None:
    parameters, curve = ROBOTS[name].parameters(), circle(0.05)
    robot = ROBOTS[name].make(parameters)
    kernel = kernel_of(robot, kind_of("path_following", parameters, curve))
    y = robot.frame.lift(np.array([0.01, 0.02]))
    pushes = [FREE, Push(hand=y), Push(hold=brake_at(robot, curve, y, 0.3))]
    pushes.append(Push(pushes[1].hand, pushes[2].hold))
    packs = [settings_vector(robot, kernel, parameters, curve, push) for push in pushes]
    for before in packs:
        for push, pack in zip(pushes, packs, strict=True):
            assert np.array_equal(pushed(kernel, before, push), pack)


@pytest.mark.thorough
def test_simulated_browsers_see_and_do_what_real_ones_do() -> None:
    async def look(port: int) -> list[Observations]:
        async with aclosing(crowd(port, 2, seconds=4.5)) as seen:
            return [await anext(seen) for _ in range(2)]

    server = LabServer("127.0.0.1", 0, LoopCache())
    try:
        first, then = asyncio.run(look(server.server.get_port()))
        labs = server.thread.labs
    finally:
        server.stop()
    assert first.clients == then.clients == 2
    assert then.seconds == pytest.approx(4.5, abs=0.5)
    assert 10 < then.slowest_hz <= then.median_hz < 62
    assert then.bytes_per_s > 0 and 0 < then.cpu < 1.5
    assert all(lab.simulation.time > 1.0 for lab in labs)
    assert max(run.max_distance for lab in labs for run in lab.simulation.runs.values()) > 0.004
    assert any(lab.simulation.parameters.K1 != 400.0 for lab in labs)


@pytest.mark.thorough
def test_what_a_script_says_reaches_its_lab_also_after_it_was_hung_up_on() -> None:
    said = cycle([b"no text", '{"do": "Set", "name": "K1", "value": 77.0}'])
    server = LabServer("127.0.0.1", 0, LoopCache())

    async def attack() -> None:
        speaks = scripts(1, lambda draw: next(said))
        browsing = asyncio.create_task(speaks(server.server.get_port()))
        async with asyncio.timeout(WAIT):
            while all(lab.simulation.parameters.K1 != 77.0 for lab in server.thread.labs):
                await asyncio.sleep(0.05)
        browsing.cancel()
        await asyncio.gather(browsing, return_exceptions=True)

    try:
        asyncio.run(attack())
    finally:
        server.stop()


@pytest.mark.thorough
def test_a_crowd_that_is_not_served_says_so() -> None:
    async def settle(port: int, patience: float) -> None:
        async with aclosing(crowd(port, 2, 1.0, patience)) as seen:
            await anext(seen)

    server = LabServer("127.0.0.1", 0, LoopCache(), ServerOptions(most_clients=1))
    try:
        with pytest.raises(NotServed, match=r"only 1 of 2 clients .* moving robots in 3 s"):
            asyncio.run(settle(server.server.get_port(), 3.0))
    finally:
        server.stop()
    with (
        answering(REFUSED, REFUSED) as (port, _),
        pytest.raises(NotServed, match=r"turned away: .*503"),
    ):
        asyncio.run(settle(port, 5.0))


REFUSED = b"HTTP/1.1 503 Service Unavailable\r\nContent-Length: 0\r\nConnection: close\r\n\r\n"


@contextmanager
def answering(*answers: bytes) -> Iterator[tuple[int, Thread]]:
    """A port where each connection gets one of these answers in turn, then none is taken."""

    def serve() -> None:
        for answer in answers:
            connection, _ = listener.accept()
            with connection:
                connection.recv(4096)
                connection.sendall(answer)
        listener.close()

    with create_server(("127.0.0.1", 0)) as listener:
        thread = Thread(target=serve, daemon=True)
        thread.start()
        yield int(listener.getsockname()[1]), thread


def test_the_bench_waits_for_a_server_that_is_not_ready() -> None:
    async def wait(port: int, early: Thread) -> None:
        waiting = asyncio.create_task(first_poses(port))
        await asyncio.to_thread(early.join, 5.0)
        assert not early.is_alive() and not waiting.done()
        server = LabServer("127.0.0.1", port, LoopCache())
        try:
            await asyncio.wait_for(waiting, 20.0)
        finally:
            server.stop()

    with answering(REFUSED, b"", b"HTTP/1.1 ") as (port, early):
        asyncio.run(wait(port, early))


def test_the_bench_does_not_wait_for_a_server_that_refuses() -> None:
    forbidden = REFUSED.replace(b"503", b"403")
    with answering(forbidden) as (port, _), pytest.raises(websockets.exceptions.InvalidStatus):
        asyncio.run(asyncio.wait_for(first_poses(port), 5.0))


@pytest.mark.thorough
def test_a_simulated_browser_opens_the_data_channel_of_its_page() -> None:
    async def told(port: int) -> int:
        browser = Browser(port, 0)
        browsing = asyncio.create_task(browser.browse(60.0))
        while browser.told < FRAMES and not browsing.done():
            await asyncio.sleep(0.05)
        browsing.cancel()
        await asyncio.gather(browsing, return_exceptions=True)
        return browser.told

    server = LabServer("127.0.0.1", 0, LoopCache())
    try:
        assert asyncio.run(told(server.server.get_port())) >= FRAMES
    finally:
        server.stop()
