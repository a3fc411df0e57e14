"""What a page computes of paths and poles is what Python computes, step by step."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from onpath.models.arrays import Array
from onpath.models.closed_loop.loop_vectors import settings_layout
from onpath.models.closed_loop.simulation import kind_of
from onpath.models.closed_loop.wasm_loop import Scan
from onpath.models.control.poles import channels
from onpath.models.errors import CodedError, Message
from onpath.models.page.edit import CHECKS, ROW, edit_scans
from onpath.models.page.fit import (
    PIECE,
    arc_scan,
    resample_scan,
    spline_function,
    table_function,
)
from onpath.models.page.poles import BEHAVIOURS, SLOW, STEPS, pole_functions, roots_scan
from onpath.models.paths.curve_faults import SAMPLES, curve_faults
from onpath.models.paths.curve_fit import closed_through, open_through
from onpath.models.paths.curves import TERMS, Curve
from onpath.models.paths.path_design import REACH, PathDesign, presets
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.five_bar_parameters import FiveBarParameters
from onpath.models.systems.parameters import changed

pytestmark = pytest.mark.thorough


def scanned(
    scan: Scan, state: Array, constants: Array, rows: Array, count: int
) -> tuple[Array, Array]:
    """The last state, and all results as columns."""
    if not count:
        return state, np.zeros((scan.step.numel_out(1), 0))
    given = np.tile(constants, (1, count))
    states, results = scan.step.mapaccum(count)(state, given, rows)
    return states.full()[:, -1], results.full()


def fitted(points: Array, closed: bool) -> tuple[Array, float]:
    """The table of the curve through control points, and how many samples it was made of."""
    pieces, state, bad = (each.full() for each in spline_function(closed, len(points))(points.T))
    assert bad[0] == 0
    state, arcs = state.ravel(), list[tuple[Array, Array]]()
    for i, count in enumerate(pieces[1, :-1].astype(int)):
        pair = pieces[:, i : i + 2]
        state, rows = scanned(arc_scan(), state, pair, np.zeros((0, count)), count)
        arcs.append((pair, rows))
    sums = np.zeros(3 + 2 * TERMS)
    sums[1:3] = state[1], state[4]
    for pair, rows in arcs:
        sums, _ = scanned(resample_scan(closed), sums, pair, rows, rows.shape[1])
    return table_function(closed)(sums).full().ravel(order="F"), float(sums[0])


@settings(max_examples=12)
@given(st.booleans(), st.integers(3, 16), st.randoms(use_true_random=False))
def test_a_curve_is_fitted_as_in_the_lab(closed: bool, count: int, random: Any) -> None:
    points = np.array([[random.uniform(-0.2, 0.2) for _ in range(2)] for _ in range(count)])
    ring = np.vstack([points, points[:1]])
    assume(np.linalg.norm(np.diff(ring, axis=0), axis=1).min() > 2e-4)
    table, samples = fitted(points, closed)
    expected = (closed_through if closed else open_through)(points)
    assert samples == 256
    np.testing.assert_allclose(table, expected.table(), atol=1e-10)


def test_points_that_coincide_and_short_paths_are_refused() -> None:
    points = presets()["circle"].points.copy()
    points[3] = points[2] + 5e-5
    assert spline_function(True, len(points))(points.T)[2][0] == 1
    short = np.array([[0.0, 0.0], [0.015, 0.0]])
    assert spline_function(False, 2)(short.T)[2].full().ravel() == pytest.approx([2, 15])
    with pytest.raises(CodedError):
        open_through(short)
    assert spline_function(False, 2)(2 * short.T)[2][0] == 0


def found_faults(name: str, curve: Curve) -> dict[str, Array]:
    """Check -> where it fails, as a page finds it."""
    entry = ROBOTS[name]
    robot = entry.make(entry.parameters())
    kind = kind_of("path_following", entry.parameters(), curve)
    scans, table = edit_scans(robot, kind), curve.table()
    table = table.reshape(kind.table_shape, order="F")
    _, rows = scanned(scans["check"], np.zeros(4), table, np.zeros((0, SAMPLES + 1)), SAMPLES + 1)
    i, j = np.triu_indices(SAMPLES, 1)
    state = np.zeros((7, len(i)))
    state[4:] = j - i, i, np.full(len(i), rows[2, -1])
    both = np.vstack([rows[:, :-1], rows[:, 1:]])
    step = scans["strands"].step.map(len(i))
    after = step(state, both[:, i], both[:, j])[0].full()
    for end in (i, j):
        np.maximum.at(rows[ROW - 1], end, after[0])
    crossings = after[2:4, after[1] > 0].T
    found = {
        check: rows[:2, :SAMPLES][:, bad].T
        for k, check in enumerate(CHECKS)
        if (bad := rows[3 + k, :SAMPLES] > 0).any()
    }
    if len(crossings):
        found.pop("narrow", None)
        found["crosses"] = crossings
    return found


@pytest.mark.parametrize("name", ROBOTS)
def test_a_curve_is_refused_for_the_lab_s_reasons_and_in_the_same_places(name: str) -> None:
    entry, rng, seen = ROBOTS[name], np.random.default_rng(3), set[str]()
    robot = entry.make(entry.parameters())
    designs = [presets()[preset] for preset in ("clover", "segment", "figure of eight")]
    for design in designs:
        for index in range(8):
            aside = robot.reach * rng.uniform(-0.5, 0.5, 2)
            moved = design.moved(index % len(design.points), aside)
            seen |= _compared(name, moved, robot.margin)
    corners = REACH * np.array([(1, 1), (1, -1), (-1, 1), (-1, -1)])
    beyond = {"outside"} if (robot.margin(corners) == 0).any() else set[str]()
    assert seen >= {"bends", "crosses"} | beyond
    bent = _compared(name, presets()["clover"].moved(0, np.array([0.03, 0.0])), robot.margin)
    assert bent


def _compared(name: str, design: PathDesign, reach: Any) -> set[str]:
    found = found_faults(name, design.curve)
    expected = curve_faults(reach, design.curve)
    assert [fault.reason.code for fault in expected] == [f"fault.{check}" for check in found]
    for fault, points in zip(expected, found.values(), strict=True):
        if not fault.reason.code.endswith("crosses"):  # there, one for each point of the curve
            np.testing.assert_allclose(fault.points, points, atol=1e-12)
    return set(found)


GAINS = st.floats(0, 1000)


@settings(max_examples=30)
@given(
    st.tuples(GAINS, st.floats(0, 100), st.sampled_from([0.0, 50.0, 3000.0])),
    st.tuples(st.floats(0, 50), st.floats(0, 40), st.sampled_from(["speed", "position"])),
    st.sampled_from([100, 200, 1000]),
    st.sampled_from([0.0, 0.5, 1.0, 1.5, 2.0]),
)
def test_poles_are_those_of_the_lab(
    across: tuple[float, float, float],
    along: tuple[float, float, str],
    rate: int,
    delay: float,
) -> None:
    parameters = replace(FiveBarParameters(), control_rate=rate, delay=delay)
    for name, gain in zip(("K1", "K2", "K3"), across, strict=True):
        parameters = changed(parameters, name, gain)
    for name, value in zip(("K4", "K5", "task"), along, strict=True):
        parameters = changed(parameters, name, value)
    layout = settings_layout(ROBOTS["five_bar"].make(parameters).system)
    numbers = np.zeros(layout.size)
    for gain in ("K1", "K2", "K3", "K4", "K5"):
        numbers[layout.slices[gain]] = getattr(parameters, gain)
    functions, scan = pole_functions(parameters, layout), roots_scan(parameters)
    *polynomials, first = functions["polynomials"](numbers)
    for channel, polynomial in zip(channels(parameters), polynomials, strict=True):
        values = polynomial.full()
        roots, _ = scanned(scan, first.full().ravel(), values, np.zeros((0, STEPS)), STEPS)
        found = functions["settling"](roots, values, 1 / rate).full().ravel()
        poles = np.sort(found[1 : 1 + 2 * SLOW : 2][: int(found[0])])
        expected = np.sort(channel.poles.real)
        scale = max(1.0, float(np.abs(expected).max()))
        np.testing.assert_allclose(poles / scale, expected / scale, atol=1e-4)
        near = np.abs(expected + 1e-3).min() < 1e-5 or abs(found[-1] - 0.995) < 1e-3
        if near:
            continue  # rounding decides
        said = channel.behaviour()
        kind = said.arguments.get("kind", said)
        assert isinstance(kind, Message)
        assert f"behaviour.{BEHAVIOURS[int(found[-3])]}" == kind.code
        if "seconds" in said.arguments:
            assert float(str(said.arguments["seconds"])) == pytest.approx(found[-2], rel=0.06)


def test_the_poles_of_a_new_lab_are_the_double_ones_of_the_text() -> None:
    parameters = replace(FiveBarParameters(), K1=400.0, K2=40.0, K3=0.0)
    layout = settings_layout(ROBOTS["five_bar"].make(parameters).system)
    numbers = np.zeros(layout.size)
    numbers[layout.slices["K1"]], numbers[layout.slices["K2"]] = 400.0, 40.0
    functions, scan = pole_functions(parameters, layout), roots_scan(parameters)
    across, _, first = functions["polynomials"](numbers)
    roots, _ = scanned(scan, first.full().ravel(), across.full(), np.zeros((0, STEPS)), STEPS)
    found = functions["settling"](roots, across, 1e-3).full().ravel()
    assert found[0] == 2 and found[2] == found[4] == 0
    np.testing.assert_allclose(found[[1, 3]], -20, rtol=0.02)
    assert PIECE == 10
