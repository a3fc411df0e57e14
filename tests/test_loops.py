"""All loops of a kernel are the same loop; what cc compiled is cached, and nothing needs it."""

from __future__ import annotations

import os
import stat
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from conftest import FOLLOWING, Rig

from models.controllers import NAMES
from models.curves import Curve, chebyshev_curve, circle
from models.loop_kind import Kind
from models.loops import (
    BLOCK,
    InterpretedLoop,
    Loop,
    compile_loop,
    find_compiler,
    generate_source,
)
from models.translated_loop import translate_loop

KINDS = [
    Kind(controller, closed, level_set, encoder, free)
    for controller in NAMES
    for closed, level_set in ((True, False), (True, True), (False, False))
    for encoder in (False, True)
    for free in (False, True)
]
needs_compiler = pytest.mark.skipif(find_compiler() is None, reason="no C compiler")


@pytest.mark.parametrize("kind", KINDS, ids=repr)
def test_loops_agree(rig: Rig, random_curve: Callable[[int], Curve], kind: Kind) -> None:
    bent = chebyshev_curve(np.array([[0.0, 0.0], [0.05, 0.0], [0.0, 0.02], [0.0, 0.01]]))
    curve = (circle(0.05) if kind.level_set else random_curve(4)) if kind.closed else bent
    start = rig.on_path(kind, curve, -1.0, 2.0)
    changes = {"K3": 20, "hand_active": 1, "hand_target": (0.03, 0.03), "coulomb": 0.01}
    settings = rig.settings(kind, plant=rig.spoiled, speed=2.0, hold_ticks=2, **changes)
    loops = InterpretedLoop(rig.kernel(kind)), translate_loop(rig.kernel(kind)), rig.loop(kind)
    results = [loop.run(start, settings, curve.table(), 1000) for loop in loops]
    for interpreted, translated, compiled in zip(*results, strict=True):
        assert np.array_equal(interpreted, translated)
        assert np.abs(interpreted - compiled).max() < 1e-12
    assert np.ptp(results[0][1], axis=0).max() > 0.1


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind.free], ids=repr)
def test_the_lean_loop_computes_the_same_while_nothing_acts(
    rig: Rig, random_curve: Callable[[int], Curve], kind: Kind
) -> None:
    bent = chebyshev_curve(np.array([[0.0, 0.0], [0.05, 0.0], [0.0, 0.02], [0.0, 0.01]]))
    curve = (circle(0.05) if kind.level_set else random_curve(4)) if kind.closed else bent
    start = rig.on_path(kind, curve, -1.0, 2.0)
    settings = rig.settings(kind, plant=rig.spoiled, speed=2.0, K3=20)
    lean, whole = (
        InterpretedLoop(rig.kernel(k)).run(start, settings, curve.table(), 1000)
        for k in (kind, replace(kind, free=False))
    )
    for one, other in zip(lean, whole, strict=True):
        assert np.abs(one - other).max() < 1e-11
    pushed = rig.settings(kind, hand_active=1, hand_target=(0.03, 0.03))
    moved = InterpretedLoop(rig.kernel(replace(kind, free=False)))
    assert np.abs(moved.run(start, pushed, curve.table(), 1000)[0] - whole[0]).max() > 1e-3


def every_loop(rig: Rig) -> tuple[Loop, ...]:
    kernel = rig.kernel(FOLLOWING)
    return InterpretedLoop(kernel), translate_loop(kernel), rig.loop(FOLLOWING)


@pytest.mark.parametrize("ticks", [0, 1, BLOCK - 1, BLOCK, 2 * BLOCK + 3])
def test_any_number_of_ticks(rig: Rig, ticks: int) -> None:
    start, settings = rig.state(FOLLOWING, np.array([0.06, 0.0])), rig.settings(FOLLOWING)
    given = start.copy()
    for loop in every_loop(rig):
        state, rows = loop.run(start, settings, circle(0.05).table(), ticks)
        assert rows.shape == (ticks, loop.kernel.log.size) and state.shape == start.shape
        assert np.array_equal(start, given)
        q = loop.kernel.log.unpack(rows)["q"]
        assert ticks < 2 or not np.array_equal(q[0], q[-1])
        assert ticks > 0 or np.array_equal(state, start)


def test_results_are_not_overwritten_by_the_next_call(rig: Rig) -> None:
    start, settings = rig.state(FOLLOWING, np.array([0.06, 0.0])), rig.settings(FOLLOWING)
    for loop in every_loop(rig):
        state, rows = loop.run(start, settings, circle(0.05).table(), BLOCK)
        kept = state.copy(), rows.copy()
        loop.run(state, settings, circle(0.05).table(), BLOCK)
        assert np.array_equal(state, kept[0]) and np.array_equal(rows, kept[1])


def logging_compiler(folder: Path, compiler: str) -> Path:
    """A compiler that writes down each compilation."""
    script = folder / "logged"
    script.write_text(f'#!/bin/sh\necho "$@" >> "{folder}/calls"\nexec "{compiler}" "$@"\n')
    script.chmod(script.stat().st_mode | stat.S_IXUSR)
    return script


@needs_compiler
def test_cache_compiles_once_per_source(rig: Rig, tmp_path: Path) -> None:
    compiler = find_compiler()
    assert compiler is not None
    script, cache = logging_compiler(tmp_path, compiler), tmp_path / "cache"
    for _ in range(3):
        compile_loop(rig.kernel(FOLLOWING), cache, str(script))
    compilations = [c for c in (tmp_path / "calls").read_text().splitlines() if ".c" in c]
    assert len(compilations) == 1
    compile_loop(rig.kernel(Kind("path_following", closed=False)), cache, str(script))
    assert len(list(cache.iterdir())) == 2  # two libraries, nothing left lying about
    assert all(file.suffix == ".so" for file in cache.iterdir())
    assert stat.S_IMODE(cache.stat().st_mode) == 0o700


def test_source_is_reproducible(rig: Rig) -> None:
    assert generate_source(rig.kernel(FOLLOWING)) == generate_source(rig.kernel(FOLLOWING))


def test_failing_compiler_is_named_with_what_it_said(rig: Rig, tmp_path: Path) -> None:
    broken = tmp_path / "broken"
    broken.write_text('#!/bin/sh\necho "loop.c: no space left on device" >&2\nexit 1\n')
    broken.chmod(0o755)
    with pytest.raises(RuntimeError, match=r"broken failed: loop\.c: no space left on device"):
        compile_loop(rig.kernel(FOLLOWING), tmp_path / "cache", str(broken))
    assert not list((tmp_path / "cache").iterdir())


def test_without_a_compiler_the_interpreted_loop_runs() -> None:
    script = """
from models.five_bar import five_bar, load_links
from models.frames import Plane
from models.kernel import build_kernel
from models.loop_kind import Kind
from models.loops import InterpretedLoop, find_compiler
import numpy as np
assert find_compiler() is None
kernel = build_kernel(five_bar(), Plane(), Kind("path_following"))
state = InterpretedLoop(kernel).run(
    np.ones(kernel.state.size), np.ones(kernel.settings.size), np.ones(200), 5
)[0]
assert state.shape == (kernel.state.size,)
"""
    environment = {"PATH": "", "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    subprocess.run([sys.executable, "-c", script], check=True, env=environment)


def test_compiler_of_the_environment_is_preferred(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    own = tmp_path / "own-cc"
    own.write_text("")
    own.chmod(0o755)
    monkeypatch.setenv("CC", str(own))
    assert find_compiler() == str(own)
    monkeypatch.setenv("CC", str(tmp_path / "missing"))
    assert find_compiler() is None
