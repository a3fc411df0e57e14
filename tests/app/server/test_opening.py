"""Opening a lab never blocks other tabs, however long it takes or often it is tried."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from onpath.app.common import error_log
from onpath.app.common.access_codes import new_code
from onpath.app.common.presses import Presses
from onpath.app.common.throttle import TRIES
from onpath.app.lab.lab import Lab
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_registry import LabRegistry
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from onpath.app.simulation.simulation_thread import SimulationThread
from onpath.app.storage.lab_state import LabState
from onpath.app.storage.records import Records, file_url
from onpath.app.viser_adapter.secure_server import Limits
from tests.support.lab import loop_cache
from tests.support.own_socket import feeds
from tests.support.student import Student
from tests.support.waiting import wait_for

WAIT = 20.0  # [s]
SLOW, QUICK = "s" * 12, "q" * 12
WIDE = Limits(message_burst=1_000_000, change_burst=1_000_000)
PRESSES = 2000


class Gate:
    """A place at which a caller can be blocked."""

    def __init__(self) -> None:
        self.reached, self.open = threading.Event(), threading.Event()

    def pass_by(self) -> None:
        self.reached.set()
        assert self.open.wait(WAIT)


class Held:
    """A database that blocks whoever opens a certain lab."""

    def __init__(self, where: str) -> None:
        self.gate, self._where = Gate(), where

    def _hold(self, where: str, code: str) -> None:
        if where == self._where and code == SLOW:
            self.gate.pass_by()

    def is_current(self, code: str) -> bool:
        self._hold("is_current", code)
        return True

    def flush(self, code: str) -> bool:
        self._hold("flush", code)
        return True

    def load(self, code: str) -> LabState:
        self._hold("load", code)
        return {"setup": {}, "lessons": {}}

    def submit(self, *_: object) -> None: ...

    def fails(self, _: str) -> bool:
        return False

    generation = 0


@pytest.fixture(params=["is_current", "load", "flush"])
def held(request: pytest.FixtureRequest) -> Iterator[Held]:
    made = Held(request.param)
    yield made
    made.gate.open.set()


def in_thread(act: Callable[[], Any]) -> threading.Thread:
    thread = threading.Thread(target=act, daemon=True)
    thread.start()
    return thread


def ends(act: Callable[[], Any]) -> bool:
    """Whether a call returns, and does not block for ever."""
    done = threading.Event()

    def acting() -> None:
        act()
        done.set()

    in_thread(acting)
    return done.wait(WAIT / 2)


def new_registry(held: Held) -> LabRegistry:
    keeper: Any = held
    make = lambda: Lab(loop_cache())  # noqa: E731
    current = held.is_current
    return LabRegistry(SimulationThread(), make, load=held.load, is_current=current, keeper=keeper)


@pytest.mark.thorough
@pytest.mark.parametrize("way", ["enter", "join"])
def test_a_lab_that_is_waited_for_holds_up_nobody_else(held: Held, way: str) -> None:
    registry = new_registry(held)
    others = [registry.join(client, None).code for client in (1, 2)]
    if way == "enter":
        registry.join(3, None)
    open_slowly = {
        "enter": lambda: registry.enter(3, SLOW),
        "join": lambda: registry.join(3, SLOW),
    }[way]

    def come_and_go() -> None:
        for _ in range(2):  # the second time the lab is here already
            open_slowly()
            registry.leave(3)

    in_thread(come_and_go)
    assert held.gate.reached.wait(WAIT)

    def live_on() -> None:
        assert set(others) <= set(registry.held())
        assert registry.enter(1, QUICK).client == 1
        registry.leave(2)
        assert registry.join(4, others[1]).code == others[1]
        assert registry.join(5, None).client == 5
        assert QUICK in registry.held()
        assert registry.lose(QUICK) == 1

    assert ends(live_on)
    held.gate.open.set()
    wait_for(lambda: SLOW not in registry.held(), WAIT)


@pytest.mark.thorough
def test_two_who_want_the_same_lab_at_once_get_it_once() -> None:
    held = Held("load")
    registry, found = new_registry(held), []
    threads = [
        in_thread(lambda n=n: found.append(registry.join(n, f"{SLOW},{QUICK}"))) for n in range(3)
    ]
    assert held.gate.reached.wait(WAIT)
    held.gate.open.set()
    for thread in threads:
        thread.join(WAIT)
    codes = [entry.code for entry in found]
    assert len(set(codes)) == 3 and {SLOW, QUICK} < set(codes)
    assert sorted(registry.held()) == sorted(codes) and len(registry.thread.labs) == 3


def test_codes_that_nobody_has_make_no_lab_and_soon_are_refused_unasked() -> None:
    made, asked = [], []

    def make() -> Lab:
        made.append(Lab(loop_cache()))
        return made[-1]

    registry = LabRegistry(SimulationThread(), make, load=asked.append)  # type: ignore[arg-type]
    entry = registry.join(1, None)
    said = set()
    for _ in range(PRESSES):
        with pytest.raises(ValueError, match=r"no lab|too many") as refused:
            registry.enter(1, new_code())
        said.add(str(refused.value))
    assert len(made) == 1 and len(asked) == TRIES and len(said) == 2
    assert registry.held() == [entry.code]
    registry.join(2, None)
    with pytest.raises(ValueError, match="no lab"):
        registry.enter(2, new_code())


def test_presses_while_one_is_under_way_are_dropped() -> None:
    gate, begun, presses = Gate(), list[threading.Thread](), Presses()

    def act() -> None:
        begun.append(threading.current_thread())
        gate.pass_by()
        raise RuntimeError  # does not keep the next press from its turn

    assert presses.run(act)
    assert not any(presses.run(act) for _ in range(PRESSES))
    assert gate.reached.wait(WAIT) and len(begun) == 1
    gate.open.set()
    begun[0].join(WAIT)
    assert presses.run(act)
    wait_for(lambda: len(begun) == 2, WAIT)


def test_a_tab_that_presses_for_ever_is_one_of_many(tmp_path: Path) -> None:
    records = Records(file_url(tmp_path / "labs.db"))
    own = LoopCache()  # ends with the server
    server = LabServer("127.0.0.1", 0, own, ServerOptions(records=records, limits=WIDE))
    gate, loads = Gate(), []

    def load(code: str) -> None:
        loads.append(code)
        gate.pass_by()

    try:
        address = f"ws://127.0.0.1:{server.server.get_port()}"
        with Student(address) as attacker, Student(address) as insider:
            for tab in (attacker, insider):
                tab.open()
                tab.read(lambda tab=tab: tab.moving > 5)
            server.registry.load = load  # type: ignore[assignment]
            attacker.tell(*[{"is": "enter", "code": new_code()}] * PRESSES)
            attacker.tell({"do": "Share"})  # its lab goes on
            attacker.read(lambda: attacker.state["shared"])
            assert gate.reached.wait(WAIT) and len(loads) == 1
            queue = server.server._thread_executor._work_queue
            wait_for(lambda: queue.qsize() == 0, WAIT)
            assert insider.code in server.registry.held()
            insider.tell({"is": "enter", "code": new_code()})
            wait_for(lambda: len(loads) == 2, WAIT)
            gate.open.set()
            for tab in (attacker, insider):
                tab.read(lambda tab=tab: "told" in tab.told)
            assert "no lab with this code" in insider.told["told"]["text"]
    finally:
        gate.open.set()
        server.stop()
    assert loads.count(loads[0]) <= TRIES


def test_a_scene_is_replaced_when_no_frame_shows_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """A frame that drew in a scene already removed would raise, and log it."""
    server, gate = LabServer("127.0.0.1", 0, LoopCache()), Gate()
    with Student(f"ws://127.0.0.1:{server.server.get_port()}") as student:
        student.open()
        student.read(lambda: student.moving)
        (entry,) = server.registry._entries.values()
        (visit,) = server.visits
        scene = next(iter(feeds(server).values())).scene
        assert scene is not None
        show = scene.show

        def shown_slowly(snapshot: Any) -> None:
            gate.pass_by()
            show(snapshot)

        monkeypatch.setattr(scene, "show", shown_slowly)
        assert gate.reached.wait(WAIT)
        before = error_log._seen.copy()
        reopened = in_thread(lambda: server._reopen(visit, entry))
        wait_for(lambda: server.thread._calls or not reopened.is_alive(), WAIT)
        gate.open.set()
        reopened.join(WAIT)
        assert not reopened.is_alive()
        wait_for(lambda: any(f.scene is not scene for f in feeds(server).values()), WAIT)
        assert error_log._seen == before
    server.stop()
