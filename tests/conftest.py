"""What the tests of the models share: one robot, its closed loops, and curves at random."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator
from datetime import date
from zlib import crc32

import numpy as np
import pytest
from hypothesis import settings

from onpath.models.control.laws.registry import LAWS, OWN_GAINS
from onpath.models.paths.curves import HARMONICS, Curve, fourier
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.five_bar import five_bar, load_links
from tests.support.rig import Rig

# How long an example takes is not what is tested. `make test` gives the same verdict every time;
# `make fuzz` searches longer and at random, and what it finds becomes an @example.
settings.register_profile("laws", deadline=None, derandomize=True, max_examples=40)
settings.register_profile("fuzz", deadline=None, print_blob=True)
settings.load_profile("laws")
signal.signal(signal.SIGINT, signal.default_int_handler)  # servers started from here heed it, too,
# when a shell has started the tests in the background

MOST_REPEATED = 5
"""Tests that `.ci/run` may repeat before they pass; it shows why each of them failed."""


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--half", action="store_true", help="half of the thorough tests, others daily")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out the thorough tests that `--half` does not run today."""
    if config.getoption("--half"):
        today = date.today().isoformat()

        def left_out(item: pytest.Item) -> bool:
            drawn = crc32(f"{today} {item.nodeid}".encode()) % 2 == 0
            return item.get_closest_marker("thorough") is not None and not drawn

        config.hook.pytest_deselected(items=list(filter(left_out, items)))
        items[:] = [item for item in items if not left_out(item)]


def pytest_sessionfinish(session: pytest.Session) -> None:
    """Fail if more tests than that were repeated."""
    reporter = session.config.pluginmanager.get_plugin("terminalreporter")
    reports = [] if reporter is None else reporter.stats.get("rerun", [])
    if len({report.nodeid for report in reports}) > MOST_REPEATED:
        session.exitstatus = pytest.ExitCode.TESTS_FAILED


@pytest.fixture(scope="module", autouse=True)
def only_our_own() -> Iterator[None]:
    """Remove laws and robots that a file of tests has added: tests over all mean OnPath's own."""
    laws, gains, robots = set(LAWS), set(OWN_GAINS), set(ROBOTS)
    yield
    for known, before in ((LAWS, laws), (OWN_GAINS, gains), (ROBOTS, robots)):
        for name in known.keys() - before:
            known.pop(name)


@pytest.fixture(scope="session")
def rig() -> Rig:
    return Rig(load_links(), five_bar())


@pytest.fixture(scope="session")
def random_curve() -> Callable[[int], Curve]:
    """A closed curve about y = 0, of some 5 cm, that a robot can follow, by its seed."""

    def build(seed: int) -> Curve:
        rng = np.random.default_rng(seed)
        falling = 2e-3 / np.arange(1, HARMONICS + 1)[:, None] ** 2
        a, b = falling * rng.normal(size=(2, HARMONICS, 2))
        a[0, 0] += rng.uniform(0.03, 0.06)
        b[0, 1] += rng.uniform(0.03, 0.06)
        return fourier(5e-3 * rng.normal(size=2), a, b)

    return build
