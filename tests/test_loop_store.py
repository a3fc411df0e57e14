"""Loops are there at once; compiled ones take over when they are ready, and nobody notices."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from lab import FRAME, new_session, states

from app.loop_store import LoopStore
from app.session import Session
from models.controllers import NAMES
from models.loop_kind import Kind
from models.loops import CompiledLoop, InterpretedLoop, find_compiler
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


def test_without_a_compiler_loops_are_interpreted_and_built_once(tmp_path: Path) -> None:
    store = LoopStore(None, tmp_path)
    loops = [store.get(rigid_five_bar(), kind) for kind in KINDS]
    assert all(isinstance(loop, InterpretedLoop) for loop in loops)
    assert [store.get(rigid_five_bar(), kind) for kind in KINDS] == loops
    assert store.progress() == (0, 0) and not list(tmp_path.iterdir())
    store.close()


@needs_compiler
def test_first_loop_does_not_wait_for_the_compiler(tmp_path: Path) -> None:
    gate = tmp_path / "gate"
    waiting = f'while [ ! -e "{gate}" ]; do sleep 0.02; done; exec "{find_compiler()}" "$@"'
    store = LoopStore(script(tmp_path, waiting), tmp_path / "cache")
    session, reference = Session(store), new_session()
    try:
        for _ in range(30):
            session.advance(FRAME)
            reference.advance(FRAME)
        assert store.progress() == (0, 2)
        kinds = [r.kind for r in session.runs.values()]
        assert all(isinstance(store.get(session.robot, k), InterpretedLoop) for k in kinds)
        gate.touch()
        wait(lambda: store.progress() == (2, 2))
        assert all(isinstance(store.get(session.robot, k), CompiledLoop) for k in kinds)
        for _ in range(30):
            session.advance(FRAME)
            reference.advance(FRAME)
    finally:
        gate.touch()
        store.close()
    for name, state in states(session).items():
        assert np.abs(state - reference.runs[name].state).max() < 1e-9
        assert session.runs[name].diverged is None


@pytest.mark.parametrize("failure", ["exit 1", 'printf "\\377\\376"; exit 1', ""])
def test_failing_compiler_is_told_once_and_the_lab_goes_on(
    failure: str, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    session = Session(LoopStore(script(tmp_path, failure), tmp_path / "cache"))
    _fails_once(session, caplog)


def test_missing_compiler_and_unwritable_cache_are_told_once(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    _fails_once(Session(LoopStore(str(tmp_path / "nothing"), tmp_path)), caplog)
    caplog.clear()
    (tmp_path / "file").write_text("")
    compiler = script(tmp_path, "exit 0")
    _fails_once(Session(LoopStore(compiler, tmp_path / "file" / "cache")), caplog)


def _fails_once(session: Session, caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.WARNING):
        session.advance(FRAME)
        wait(lambda: session._store.progress() == (0, 0))
        for _ in range(20):
            session.advance(FRAME)
    warnings = [r for r in caplog.records if r.name == "app.loop_store"]
    assert len(warnings) == 1 and "interpreted" in warnings[0].getMessage()
    assert session._store.progress() == (0, 0)
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
