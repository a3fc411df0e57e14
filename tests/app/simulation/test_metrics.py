"""The metrics of /health are true, short, cheap, and contain no personal data."""

from __future__ import annotations

import json
import os
import time
import urllib.request
from functools import partial
from types import SimpleNamespace

import msgspec
import pytest

from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.app.simulation import metrics
from onpath.app.simulation.metrics import LONGEST, Metrics, measure_metrics, metrics_json
from onpath.app.simulation.simulation_thread import SimulationThread
from tests.support.waiting import wait_for


@pytest.fixture
def thread(monkeypatch: pytest.MonkeyPatch) -> SimulationThread:
    """A minute of frames until now, those of the last ten seconds 5 ms late and one of them 80."""
    made, now = SimulationThread(), 1000.0
    clock = SimpleNamespace(perf_counter=lambda: now, process_time=time.process_time)
    monkeypatch.setattr(metrics, "time", clock)
    for i in range(3600):
        ago = 60.0 - i / 60
        made.frames.append(now - ago, 0.08 if i == 3400 else 0.005 if ago < 10.5 else 0.0)
    return made


def test_metrics_are_those_of_the_window(thread: SimulationThread) -> None:
    lately, long = measure_metrics(thread, 9.0), measure_metrics(thread, LONGEST)
    assert lately.late_ms == (5.0, 5.0, 5.0) and max(long.late_ms) == 5.0 > min(long.late_ms)
    for _ in range(20):
        thread.frames.append(thread.frames.latest()[-1, 0], 0.08)
    assert [lately.overdue, long.overdue] == pytest.approx([1 / 540, 1 / 3600], rel=0.02)
    after = measure_metrics(thread, 9.0)
    assert after.late_ms[2] == 80.0 and after.overdue == pytest.approx(21 / 560, rel=0.02)
    assert lately.frames_per_s == pytest.approx(60.0, abs=1.0)
    assert lately.pid == os.getpid() and lately.labs == 0 == len(lately.simulated_s)


def test_a_thread_that_stands_still_is_seen_to(thread: SimulationThread) -> None:
    old = SimulationThread()
    for began, late in thread.frames.latest():
        old.frames.append(began - LONGEST, late)
    for silent in (old, SimulationThread()):
        assert measure_metrics(silent).frames_per_s == 0.0


@pytest.mark.parametrize("age", [0.0, 0.01, 0.5, 3.0, 9.99, 10.0, 30.0])
@pytest.mark.parametrize("query", ["", "seconds=1", "seconds=60"])
def test_a_thread_of_any_age_is_measured(age: float, query: str) -> None:
    young = SimulationThread()
    for ago in (age, age / 2, 0.0):
        young.frames.append(time.perf_counter() - ago, 0.001)
    assert json.loads(metrics_json(young, query))["frames_per_s"] >= 0.0


@pytest.mark.parametrize("query", ["", "seconds=x", "seconds=nan", "seconds=1e9", "seconds=", "%"])
def test_nonsense_is_answered_as_if_it_were_not_there(query: str, thread: SimulationThread) -> None:
    answer = json.loads(metrics_json(thread, query))
    assert answer["late_ms"] == [5.0, 5.0, 5.0]


def _moving(address: str) -> Metrics | None:
    """What a server says of itself, once it has simulated lately."""
    with urllib.request.urlopen(address, timeout=9) as reply:
        body = reply.read()
        assert reply.status == 200 and len(body) < 400
    told = msgspec.json.decode(body, type=Metrics)
    return told if told.frames_per_s > 0 else None


def test_a_server_reports_its_metrics() -> None:
    server = LabServer("127.0.0.1", 0, LoopCache())
    try:
        address = f"http://127.0.0.1:{server.server.get_port()}/health"
        for query in ("", "?seconds=3"):
            told = wait_for(partial(_moving, address + query), 30.0)
            assert told.pid == os.getpid() and told.cpu_s > 0
    finally:
        server.stop()
