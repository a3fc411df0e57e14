"""Robots that advance together do what each does alone."""

from __future__ import annotations

from dataclasses import replace

import casadi as ca
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.models.arrays import Array
from onpath.models.closed_loop import translated_loop
from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loops import InterpretedLoop
from onpath.models.closed_loop.operations import LIBRARY, OPERATIONS
from onpath.models.closed_loop.simulation import (
    Push,
    first_state,
    kernel_of,
    kind_of,
    settings_vector,
)
from onpath.models.closed_loop.translated_loop import (
    fastest_batch,
    most_lanes,
    translate_batch,
    translate_loop,
)
from onpath.models.paths.curves import circle, ellipse
from onpath.models.systems.catalogue import FIVE_BAR, ROBOTS
from onpath.models.systems.robots import RobotEntry
from tests.support.scalar_operations import PAIRS, applied, logging_kernel
from tests.support.suitable_laws import suitable_pairs

WIDTHS = [lanes for lanes in (4, 8) if lanes <= most_lanes()]
EVERY: dict[str, int] = {name: code for name, code in vars(ca).items() if name[:3] == "OP_"}
TRANSLATED = {name: code for name, code in EVERY.items() if code in OPERATIONS}
SMOOTH = {"OP_CONSTPOW", *(f"OP_{name.upper()}" for name in LIBRARY)}
CURVES = circle(0.05), ellipse((0.06, 0.04), (0.01, 0.0), 0.3)
Robots = tuple[list[Array], list[Array], list[Array]]
if not WIDTHS:
    pytest.skip("this processor has no vectors", allow_module_level=True)


@pytest.mark.thorough
@pytest.mark.parametrize("lanes", WIDTHS)
@pytest.mark.parametrize("name", TRANSLATED)
def test_every_operation_in_lanes_is_that_on_numbers(name: str, lanes: int) -> None:
    """To the bit, except for the functions of libmvec, of which 4 in the last place are allowed."""
    x = ca.SX.sym("x", 2)
    kernel = logging_kernel([applied(TRANSLATED[name], x[0], x[1])], x)
    given = PAIRS, [np.zeros(1)] * len(PAIRS), [circle(0.05).table()] * len(PAIRS), 1
    wanted = translate_loop(kernel).run_many(*given)[1].ravel()
    found = translate_batch(kernel, lanes).run_many(*given)[1].ravel()
    if name not in SMOOTH:
        assert np.array_equal(found, wanted, equal_nan=True)
        numbers = ~np.isnan(wanted)
        assert np.array_equal(np.signbit(found)[numbers], np.signbit(wanted)[numbers])
        return
    assert np.array_equal(np.isnan(found), np.isnan(wanted))
    numbers = np.isfinite(wanted)
    assert np.array_equal(found[~numbers], wanted[~numbers], equal_nan=True)
    off = np.abs(found[numbers] - wanted[numbers])
    assert np.all(off <= 4 * np.spacing(np.abs(wanted[numbers])))


def some_robots(entry: RobotEntry, law: str, count: int) -> tuple[Kernel, Robots]:
    """A kernel, and states, settings and curves of robots that differ in all of them."""
    rng, parameters = np.random.default_rng(count), entry.parameters()
    robot = entry.make(parameters)
    kernel = kernel_of(robot, kind_of(law, parameters, CURVES[0]))
    states, settings, tables = list[Array](), list[Array](), list[Array]()
    for k in range(count):
        curve = CURVES[k % 2]
        place = robot.frame.lift(curve.at(np.array(rng.uniform(-3, 3))))
        q = robot.rest(place) + 1e-3 * rng.normal(size=robot.system.n)
        own = replace(parameters, speed=float(rng.uniform(1, 4)))
        push = Push(hand=place + 0.02 * rng.normal(size=robot.system.p) if k % 3 else None)
        states.append(first_state(robot, kernel, curve, q))
        settings.append(settings_vector(robot, kernel, own, curve, push))
        tables.append(curve.table())
    return kernel, (states, settings, tables)


@pytest.mark.parametrize("lanes", WIDTHS)
@pytest.mark.parametrize("count", [1, 7, 8, 19])
def test_a_batch_of_any_size_does_what_each_robot_does(count: int, lanes: int) -> None:
    kernel, given = some_robots(FIVE_BAR, "path_following", count)
    for wanted, found in zip(
        translate_loop(kernel).run_many(*given, 300),
        translate_batch(kernel, lanes).run_many(*given, 300),
        strict=True,
    ):
        assert found.shape == wanted.shape
        assert np.abs(found - wanted).max() < 1e-10


@pytest.mark.thorough
@settings(max_examples=15)
@given(st.sampled_from(suitable_pairs()))
def test_a_batch_under_any_law_does_what_each_robot_does(pair: tuple[str, str]) -> None:
    entry, law = ROBOTS[pair[0]], pair[1]
    kernel, given = some_robots(entry, law, 5)
    ticks = 50  # in more, the rounding of a pendulum that falls grows beyond this
    _, wanted = translate_loop(kernel).run_many(*given, ticks)
    _, found = fastest_batch(kernel).run_many(*given, ticks)
    assert found == pytest.approx(wanted, rel=1e-7, abs=1e-7)


def test_without_a_library_of_vector_functions_a_batch_has_the_same_bits(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(translated_loop, "_is_found", lambda _: False)
    kernel, given = some_robots(FIVE_BAR, "path_following", 9)
    wanted = translate_loop(kernel).run_many(*given, 100)
    found = translate_batch(kernel, WIDTHS[-1]).run_many(*given, 100)
    assert all(np.array_equal(one, other) for one, other in zip(wanted, found, strict=True))


def test_a_robot_that_is_lost_takes_no_other_with_it() -> None:
    kernel, (states, settings, tables) = some_robots(FIVE_BAR, "path_following", 8)
    loop = fastest_batch(kernel)
    _, wanted = loop.run_many(states, settings, tables, 100)
    states[3] = np.full_like(states[3], np.nan)
    _, found = loop.run_many(states, settings, tables, 100)
    others = [k for k in range(8) if k != 3]
    assert np.array_equal(found[others], wanted[others])
    assert np.isnan(found[3]).any()


def test_what_cannot_be_compiled_is_interpreted() -> None:
    x = ca.SX.sym("x", 2)
    kernel = replace(logging_kernel([ca.SX.unary(ca.OP_ERFINV, x[0])], x), law="erring")
    assert isinstance(fastest_batch(kernel), InterpretedLoop)


def test_a_processor_without_vectors_gets_the_loop_for_one(monkeypatch: pytest.MonkeyPatch) -> None:
    kernel = kernel_of(FIVE_BAR.make(FIVE_BAR.parameters()), Kind("path_following"))
    monkeypatch.setattr(translated_loop, "most_lanes", lambda: 1)
    assert isinstance(fastest_batch(kernel), translated_loop.CompiledLoop)
    with pytest.raises(RuntimeError, match="no vectors of 8"):
        translate_batch(kernel, 8)
