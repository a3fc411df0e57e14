"""The table of pulls in README.md is what pulls give. It takes minutes, so parts are drawn."""

from __future__ import annotations

import random

import pytest

from onpath.models.systems.catalogue import ROBOTS
from tests.bench.pulls import COUNT, RATES, drawn, parameters, paths, shown
from tests.support import cases

NAMES = sorted(paths())


def test_the_table_has_every_robot_and_says_where_none_is_run() -> None:
    table = shown()
    assert [*table] == [(robot, rate) for robot in ROBOTS for rate in RATES]
    for (robot, rate), told in table.items():
        assert told is None or told[1] <= COUNT * len(NAMES)
        assert (told is None) == (ROBOTS[robot].caution(parameters(robot, rate)) is not None)


@pytest.mark.thorough
def test_a_part_of_the_pulls_is_no_worse_than_the_table_says() -> None:
    """Two paths in two cells of the table, which are drawn."""
    table = {cell: told for cell, told in shown().items() if told is not None}
    for robot, rate in cases.drawn(sorted(table), 2):
        stops, _, late = table[robot, rate]
        names = random.Random(f"{robot} {rate}").sample(NAMES, 2)
        cell = drawn(robot, rate, names=names)
        assert cell.stops <= stops, (robot, rate)
        assert 1e3 * cell.late <= late + 0.1 * max(1.0, late), (robot, rate)


@pytest.mark.thorough
def test_a_row_of_the_table_is_what_is_drawn() -> None:
    """A row with stops: which runs do stop depends on the last bit, and so on the processor."""
    for rate in cases.drawn(RATES, 1):
        cell, told = drawn("planar_arm", rate), shown()["planar_arm", rate]
        assert told is not None and len(cell.results) == told[1]
        assert abs(cell.stops - told[0]) <= 2
