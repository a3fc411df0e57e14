"""Loops are there at once; compiled ones take over when they are ready, and nobody notices."""

from __future__ import annotations

import logging
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from lab import FRAME, states

from app import loop_store
from app.loop_store import LoopStore
from app.session import Session
from models.controllers import NAMES
from models.loop_kind import Kind
from models.loops import CompiledLoop, InterpretedLoop, Loop, find_compiler
from models.robots import rigid_five_bar

KINDS = [Kind(name) for name in NAMES]
needs_compiler = pytest.mark.skipif(find_compiler() is None, reason="no C compiler")


def wait(condition: Callable[[], bool], seconds: float = 30.0) -> None:
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "it never happened"
        time.sleep(0.01)


def script(folder: Path, text: str) -> str:
    """A compiler of our own."""
    file = folder / "compiler"
    file.write_text(f"#!/bin/sh\n{text}\n")
    file.chmod(0o755)
    return str(file)


def late(gate: threading.Event, made: Callable[..., Loop]) -> Callable[..., Loop]:
    """The same, but not before the gate is open."""

    def wait_and_make(*arguments: object) -> Loop:
        assert gate.wait(30.0)
        return made(*arguments)

    return wait_and_make


COMPILERS = [pytest.param(find_compiler(), id="cc", marks=needs_compiler), pytest.param(None)]


@pytest.mark.parametrize("compiler", COMPILERS)
def test_loops_are_interpreted_at_once_and_compiled_later(
    compiler: str | None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    gate = threading.Event()
    for name in ("compile_loop", "translate_loop"):
        monkeypatch.setattr(loop_store, name, late(gate, getattr(loop_store, name)))
    store, never = LoopStore(compiler, tmp_path), LoopStore(str(tmp_path / "missing"), tmp_path)
    session, reference = Session(store), Session(never)
    try:
        for kind_of_loop in (InterpretedLoop, CompiledLoop):
            for _ in range(30):
                session.advance(FRAME)
                reference.advance(FRAME)
            kinds = [r.kind for r in session.runs.values()]
            loops = [store.get(session.robot, kind) for kind in kinds]
            assert all(isinstance(loop, kind_of_loop) for loop in loops)
            assert [store.get(session.robot, kind) for kind in kinds] == loops
            assert store.progress() == (2 * gate.is_set(), 2)
            gate.set()
            wait(lambda: store.progress() == (2, 2))
    finally:
        gate.set()
        store.close()
    for name, state in states(session).items():
        assert np.abs(state - reference.runs[name].state).max() < 1e-9
        assert session.runs[name].diverged is None
    assert bool(list(tmp_path.iterdir())) == (compiler is not None)


@pytest.mark.parametrize("failure", ["exit 1", 'printf "\\377\\376"; exit 1', ""])
def test_failing_compiler_is_told_once_and_loops_are_translated(
    failure: str, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    session = Session(LoopStore(script(tmp_path, failure), tmp_path / "cache"))
    _fails_once(session, caplog, "translated", compiled=2)


def test_missing_compiler_and_unwritable_cache_are_told_once(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    compiler = str(tmp_path / "nothing")
    _fails_once(Session(LoopStore(compiler, tmp_path)), caplog, "translated", compiled=2)
    caplog.clear()
    (tmp_path / "file").write_text("")
    compiler = script(tmp_path, "exit 0")
    store = LoopStore(compiler, tmp_path / "file" / "cache")
    _fails_once(Session(store), caplog, "translated", compiled=2)


def test_what_cannot_be_translated_is_told_once_and_the_lab_goes_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setitem(sys.modules, "llvmlite.binding", None)
    _fails_once(Session(LoopStore(None, tmp_path)), caplog, "interpreted", compiled=0)


def _fails_once(
    session: Session, caplog: pytest.LogCaptureFixture, instead: str, compiled: int
) -> None:
    with caplog.at_level(logging.WARNING):
        session.advance(FRAME)
        wait(lambda: session._store.progress() == (compiled, compiled))
        for _ in range(20):
            session.advance(FRAME)
    warnings = [r for r in caplog.records if r.name == "app.loop_store"]
    assert len(warnings) == 1 and instead in warnings[0].getMessage()
    assert session._store.progress() == (compiled, compiled)
    assert session.time == pytest.approx(21 * FRAME, abs=2e-3)


def test_closing_gives_up_what_is_waiting(tmp_path: Path) -> None:
    count = tmp_path / "count"
    store = LoopStore(script(tmp_path, f'echo x >> "{count}"; sleep 0.3; exit 1'), tmp_path)
    for closed in (True, False):
        for encoder in (True, False):
            store.get(rigid_five_bar(), Kind(NAMES[0], closed=closed, encoder=encoder))
    store.close()
    time.sleep(0.8)
    assert len(count.read_text().split()) <= 2  # of one loop: its version, its compilation
