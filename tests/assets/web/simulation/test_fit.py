"""The curve that a page puts through dragged points is that of the lab."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import Any

import casadi as ca
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from onpath.app.exports.standalone.figure_data import FIT
from onpath.models.arrays import Array
from onpath.models.closed_loop.simulation import kind_of
from onpath.models.errors import CodedError
from onpath.models.paths.curve_fit import closed_through, open_through
from onpath.models.paths.path_design import presets
from onpath.models.standalone.edit import edit_functions
from onpath.models.systems.catalogue import ROBOTS
from tests.support.node_page import NodePage, needs_node

pytestmark = needs_node


@pytest.fixture(scope="module")
def page() -> Iterator[NodePage]:
    page = NodePage()
    yield page
    page.close()


@cache
def table(closed: bool) -> ca.Function:
    """What the module makes of the sums."""
    entry, curve = ROBOTS["five_bar"], presets()["circle" if closed else "segment"].curve
    kind = kind_of("path_following", entry.parameters(), curve)
    return edit_functions(entry.make(entry.parameters()), kind)["table"]


def products(page: NodePage, points: Array, closed: bool) -> Any:
    return page.evaluate("given => products(...given)", [points.tolist(), closed, FIT])


@pytest.mark.thorough
@settings(max_examples=60)
@given(st.booleans(), st.integers(2, 24), st.integers(0, 2**32))
def test_a_curve_is_fitted_as_in_the_lab(
    page: NodePage, closed: bool, count: int, seed: int
) -> None:
    points = np.random.default_rng(seed).uniform(-0.2, 0.2, (max(count, 3 if closed else 2), 2))
    ring = np.vstack([points, points[:1]])
    assume(np.linalg.norm(np.diff(ring, axis=0), axis=1).min() > 2e-4)
    sums = np.array(products(page, points, closed)).reshape(-1, 2).T
    expected = (closed_through if closed else open_through)(points).table()
    found = table(closed)(sums).full().ravel(order="F")
    np.testing.assert_allclose(found, expected, atol=1e-10)


def test_points_that_coincide_and_short_paths_are_refused(page: NodePage) -> None:
    points = presets()["circle"].points.copy()
    points[3] = points[2] + 5e-5
    assert products(page, points, True) == "standalone.coincide"
    short = np.array([[0.0, 0.0], [0.015, 0.0]])
    assert products(page, short, False) == "error.path_too_short"
    assert page.evaluate("given => lengthOf(given)", short.tolist()) == pytest.approx(0.015)
    with pytest.raises(CodedError):
        open_through(short)
    assert isinstance(products(page, 2 * short, False), list)
