"""Loops along drawings: all engines agree, and no setting reads beyond a table."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.models.arrays import Array
from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.loops import InterpretedLoop
from onpath.models.closed_loop.simulation import (
    Push,
    first_state,
    kernel_of,
    kind_of,
    settings_vector,
)
from onpath.models.closed_loop.translated_loop import fastest_batch, translate_loop
from onpath.models.paths.distance import path_distance
from onpath.models.paths.drawing_design import drawn
from onpath.models.paths.space_curves import saddle
from onpath.models.paths.spline_curves import DEGREE, MOST_PIECES, SplineCurve
from onpath.models.standalone.curve_scans import curve_scans
from onpath.models.systems.catalogue import ROBOTS
from tests.support.drawings import random_drawing, scrawl, signature
from tests.support.node_page import NodePage, needs_node
from tests.support.page_scans import steps_along
from tests.support.pulls import parameters_of, troubled
from tests.support.wasm_runs import rows_in_node, scanned_in_node

TICKS = 400
LAWS = "path_following", "trajectory_tracking"


def a_run(
    name: str, law: str, curve: SplineCurve, seed: int
) -> tuple[Kernel, tuple[Array, Array, Array]]:
    """A kernel, and state, settings and table of a robot that a hand pulls off its drawing."""
    rng, parameters = np.random.default_rng(seed), replace(ROBOTS[name].parameters(), speed=0.5)
    robot = ROBOTS[name].make(parameters)
    kernel = kernel_of(robot, kind_of(law, parameters, curve))
    frame = robot.frame.space if curve.dimension == 3 and robot.frame.space else robot.frame
    place = frame.lift(curve.at(np.array(rng.uniform(-3, 3))))
    state = first_state(robot, kernel, curve, robot.rest(place))
    push = Push(hand=place + 0.02 * rng.normal(size=robot.system.p))
    return kernel, (state, settings_vector(robot, kernel, parameters, curve, push), curve.table())


@pytest.mark.thorough
@settings(max_examples=8)
@given(
    seed=st.integers(0, 2**32),
    name=st.sampled_from(("five_bar", "two_link_arm", "spatial_arm")),
    law=st.sampled_from(LAWS),
    pieces=st.one_of(st.integers(5, 30), st.integers(5, MOST_PIECES)),
    closed=st.booleans(),
    rises=st.booleans(),
)
def test_compiled_and_interpreted_loops_agree_to_the_bit_and_batches_within_rounding(
    seed: int, name: str, law: str, pieces: int, closed: bool, rises: bool
) -> None:
    curve = random_drawing(seed, pieces, 0.03, closed)
    if rises and ROBOTS[name].make(ROBOTS[name].parameters()).frame.space is not None:
        curve = saddle(curve, 0.02)
        assert isinstance(curve, SplineCurve)
    kernel, given = a_run(name, law, curve, seed)
    wanted = InterpretedLoop(kernel).run(*given, TICKS)[1]
    compiled = translate_loop(kernel).run(*given, TICKS)[1]
    assert np.array_equal(compiled, wanted, equal_nan=True)
    _, rows = fastest_batch(kernel).run_many(*_together([given] * 5), 100)
    assert rows == pytest.approx(np.broadcast_to(wanted[:100], rows.shape), rel=1e-7, abs=1e-7)


def _together(
    runs: list[tuple[Array, Array, Array]],
) -> tuple[list[Array], list[Array], list[Array]]:
    return [run[0] for run in runs], [run[1] for run in runs], [run[2] for run in runs]


def test_a_batch_takes_its_own_piece_for_each_robot() -> None:
    curve = random_drawing(5, 200)
    every = [a_run("five_bar", "trajectory_tracking", curve, seed) for seed in range(6)]
    kernel, given = every[0][0], _together([run for _, run in every])
    _, wanted = translate_loop(kernel).run_many(*given, 100)
    _, found = fastest_batch(kernel).run_many(*given, 100)
    assert found == pytest.approx(wanted, rel=1e-7, abs=1e-7)


@pytest.fixture(scope="module")
def page() -> Iterator[NodePage]:
    page = NodePage()
    yield page
    page.close()


@pytest.mark.thorough
@needs_node
@pytest.mark.parametrize("law", LAWS)
def test_webassembly_goes_the_same_way_but_for_the_sines_of_another_library(
    page: NodePage, law: str
) -> None:
    for closed, pieces in ((True, 17), (False, 90)):
        kernel, given = a_run("five_bar", law, random_drawing(2, pieces, closed=closed), 4)
        wanted = InterpretedLoop(kernel).run(*given, TICKS)[1]
        assert rows_in_node(page, kernel, *given, TICKS) == pytest.approx(wanted, rel=0, abs=1e-12)


@needs_node
@pytest.mark.parametrize("pieces", [5, 60, MOST_PIECES])
@pytest.mark.parametrize("closed", [True, False])
def test_webassembly_reads_a_drawing_bit_for_bit(page: NodePage, pieces: int, closed: bool) -> None:
    curve, parameters = (
        random_drawing(pieces, pieces, 0.03, closed),
        ROBOTS["five_bar"].parameters(),
    )
    kind = kind_of("path_following", parameters, curve)
    scan = curve_scans(ROBOTS["five_bar"].make(parameters), kind)["curve"]
    state, count = np.array([0, -4.0, 8 / 300, 4.0]), 301
    _, wanted = steps_along(scan, kind, curve, state, count)
    pieces_of = np.array([float(pieces)])
    found = scanned_in_node(page, scan, state, pieces_of, curve.table(), count)
    np.testing.assert_array_equal(found, wanted)
    every = np.concatenate(curve.all_orders(state[1] + np.arange(count) * state[2]), axis=1)
    assert found[:-1] == pytest.approx(every[:-1], rel=1e-10, abs=1e-12 * np.abs(every).max())


@pytest.mark.parametrize("closed", [True, False])
@pytest.mark.parametrize("law", LAWS)
def test_no_number_reads_beyond_the_table(law: str, closed: bool) -> None:
    kernel, (state, given, table) = a_run("five_bar", law, random_drawing(2, 30, closed=closed), 4)
    edges = np.pi * np.array([-1, 1, -3, 3, 0]), [np.nan, np.inf, -np.inf, 1e300, -1e300]
    wild = [*np.concatenate(edges), np.nextafter(np.pi, 4), np.nextafter(-np.pi, -4)]
    pieces = np.array([30.0, 0.0, -7.0, 1e9, np.nan, np.inf, MOST_PIECES, MOST_PIECES + 0.5])
    loop, interpreted = translate_loop(kernel), kernel.basis
    for theta in wild:
        for count in pieces:
            start, own = state.copy(), given.copy()
            fields, asked = kernel.state.unpack(start), kernel.settings.unpack(own)
            fields["theta"][:] = fields["theta_ref"][:] = theta
            asked["pieces"][:] = count
            number = np.asarray(interpreted(start[: kernel.changed], own)[1])
            assert np.all((number >= 0) & (number < MOST_PIECES) & (number == np.floor(number)))
            loop.run(start, own, table, 2)
    assert len(table) == 2 * (MOST_PIECES + DEGREE)


def test_a_drawing_is_followed_and_one_loop_serves_all_of_its_kind() -> None:
    first, second = scrawl(1), scrawl(2)
    kernel, _ = a_run("five_bar", "path_following", first, 1)
    robot = ROBOTS["five_bar"].make(ROBOTS["five_bar"].parameters())
    for curve in (first, second):
        parameters = replace(ROBOTS["five_bar"].parameters(), speed=0.5)
        assert kernel_of(robot, kind_of("path_following", parameters, curve)) is kernel
        own = settings_vector(robot, kernel, parameters, curve, Push())
        state = first_state(robot, kernel, curve, robot.rest(curve.at(np.array(-3.0))))
        log = kernel.log.unpack(translate_loop(kernel).run(state, own, curve.table(), 4000)[1])
        moved = log["theta"][-1] - log["theta"][0]
        assert moved == pytest.approx(2.0 / curve.duration, rel=0.05)
        assert path_distance(robot.frame, curve, log["y"]).max() < 1e-4


@pytest.mark.thorough
@pytest.mark.parametrize("rate", [1000.0, 100.0])
@pytest.mark.parametrize("name", ["hovercraft", "two_link_arm"])
def test_random_pulls_on_drawings_stop_nothing(name: str, rate: float) -> None:
    parameters = parameters_of(name, control_rate=rate, encoder_counts=4000.0)
    for curve in (scrawl(3), drawn(signature(2)).curve):
        results = troubled(name, parameters, "path_following", 3, 6, curve)
        assert [each.fault for each in results if each.fault] == []
        assert max(each.late for each in results) < 3e-3
