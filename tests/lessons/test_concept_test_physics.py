"""What the right answers to the concept test claim happens in a run, wherever a run can show it.

Each test has the title of its question. Other bodies than arms are in test_concept_test_bodies.py.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

import onpath
from onpath.app.notebook.run import Run
from onpath.models.arrays import Array
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.system import decoupling_matrix
from tests.lessons import test_concept_test_bodies
from tests.support.built_in import built_in_course

TRACKER, FOLLOWER, WAITING = "trajectory_tracking", "path_following", "waiting_clock"
SPEED, RADIUS = 2 * np.pi, 0.05
HELD = (3.0, 5.0)


@cache
def run(law: str = FOLLOWER, duration: float = 8.0, **settings: Any) -> Run:
    """A run without integral."""
    return onpath.simulate(law=law, duration=duration, K3=0.0, **settings)


def farthest(made: Run, begin: float = 0.0, end: float = 99.0) -> float:
    """Largest distance from the path in an interval, [mm]."""
    return float(made.distance[(made.t >= begin) & (made.t < end)].max() * 1e3)


def error(made: Run) -> Array:
    """Distance of the end-point from the reference point, [mm]."""
    curve = made.experiment.curve()
    reference = np.array([curve.at(theta)[:2] for theta in made.theta_ref])
    return 1e3 * np.linalg.norm(made.y - reference, axis=1)


OF_NO_RUN = {"Ten seconds in the way", "A long pipe", "Three hundred metres", "At the press"}
"""Questions about what a controller has been told; "Held back, then let go" is played."""


def test_every_question_that_a_run_can_answer_is_answered_here() -> None:
    titles = [step.title for form in built_in_course()[0].forms("en") for step in form.steps]
    both = {**globals(), **vars(test_concept_test_bodies)}
    played = [str(test.__doc__) for name, test in both.items() if name.startswith("test_of_")]
    assert sorted(titles) == sorted([*played, *OF_NO_RUN])


def test_of_the_error() -> None:
    """Two errors"""
    held = run(TRACKER, hold=HELD)
    away = [1e3 * held.distance[np.abs(error(held) - e) < 0.5] for e in (20, 30)]
    assert all(np.ptp(each) > 5 for each in away)  # the same error, other distances
    assert away[0].max() > away[1].min()  # the smaller error, and farther away
    assert np.all(1e3 * held.distance <= error(held) + 1e-6)
    late = run(TRACKER, 0.1, clock_offset=0.6, velocity=(SPEED * RADIUS, 0.0))
    assert error(late)[0] == pytest.approx(30, abs=1) and farthest(late, 0, 0.0005) < 0.001


def test_of_the_hold() -> None:
    """Held back, then let go"""
    held, free = run(hold=HELD), run()
    assert held.theta_rate[held.t > HELD[1]].max() < 1.001 * SPEED
    assert held.theta_rate[-1] == pytest.approx(SPEED, rel=1e-3)
    at = np.searchsorted(free.theta, held.theta[-1])
    assert free.t[-1] - free.t[at] == pytest.approx(2.0, abs=0.2)  # the two seconds stay lost


def test_of_the_pull() -> None:
    """Pulled across"""
    pulled = [
        run(law, 3.0, speed=0.0, start=(RADIUS, 0.0), push=(1.0, 3.0, (0.08, 0.0)))
        for law in (TRACKER, FOLLOWER)
    ]
    first, second = (made.distance[-1] * 1e3 for made in pulled)
    assert first > 10 and second == pytest.approx(first, rel=0.02)


def test_of_the_clock() -> None:
    """A clock that waits"""
    assert farthest(run(WAITING, hold=HELD)) < min(2, farthest(run(hold=HELD)))
    turned = {law: farthest(run(law, 6.0, reverse_at=3.0), 2.5) for law in (WAITING, FOLLOWER)}
    assert turned[WAITING] > 3 and turned[FOLLOWER] < 0.005
    held, free = run(WAITING, hold=HELD), run(WAITING)
    assert free.theta[-1] - held.theta[-1] > 0.9 * 2 * SPEED  # it does not make up for the time


def test_of_the_velocity_across() -> None:
    """On the circle, moving across it"""
    across = run(duration=4.0, velocity=(SPEED * RADIUS, 0.2))
    assert farthest(across, 0, 0.0005) < 0.001 < 3 < farthest(across)
    assert farthest(across, 2) < 0.005


def test_of_attraction() -> None:
    """Drawn in, and kept"""
    along = (SPEED * RADIUS, 0.0)
    beside = run(TRACKER, start=(0.06, 0.01))
    assert farthest(beside, 0, 0.001) > 5 and farthest(beside, 3) < 0.005  # drawn in
    on_it = run(TRACKER, clock_offset=1.0, velocity=along)
    assert farthest(on_it, 0, 0.0005) < 0.001 and farthest(on_it) > 5 and farthest(on_it, 3) < 0.005
    assert farthest(run(velocity=along)) < 0.005
    assert farthest(run(velocity=(-0.3, 0.0))) < 0.005  # a follower, at any speed along it


def test_of_turning() -> None:
    """Turn round at once"""
    for speed in (3.0, SPEED, 9.0):
        turned = run(duration=6.0, speed=speed, reverse_at=3.0)
        assert farthest(turned) < 0.005
        assert turned.theta_rate[-1] == pytest.approx(-speed, rel=1e-2)


def test_of_the_motors() -> None:
    """Two motors, two directions"""
    entry = ROBOTS["five_bar"]
    parameters = entry.parameters()
    robot = entry.make(parameters)
    matrix = decoupling_matrix(robot.system)

    def smallest(q1: float, q2: float) -> float:
        """The smallest singular value of the matrix from torques to accelerations of the pen."""
        found = matrix(np.array([q1, q2]), robot.plant(parameters)).full()
        return float(np.linalg.svd(found, compute_uv=False)[-1])

    assert smallest(0.3, 0.3) == pytest.approx(0, abs=1e-9)
    assert smallest(0.3 + np.pi, 0.3) == pytest.approx(0, abs=1e-9)
    assert min(smallest(0.3 + bend, 0.3) for bend in (0.5, 1.0, 2.0, 2.6)) > 0.1


def test_of_the_measure() -> None:
    """What is measured"""
    back = {a: run(duration=4.0, start=(0.065, 0.0), across=a) for a in ("distance", "level_set")}
    first, second = (made.distance[:500] * 1e3 for made in back.values())
    assert np.abs(first - second).max() > 0.2  # another way back
    for made in back.values():
        assert farthest(made, 3) < 0.005  # to the same circle
    kept = run(duration=4.0, velocity=(SPEED * RADIUS, 0.0), across="level_set", reverse_at=2.0)
    assert farthest(kept) < 0.005


def test_of_the_model() -> None:
    """A model that is wrong"""
    wrong: dict[str, Any] = {"error_M11": 30.0, "error_M22": 30.0}
    soft, stiff = run(**wrong), run(K1=800.0, **wrong)
    assert 0.3 < farthest(stiff, 4) < farthest(soft, 4) < 5
    assert farthest(run(duration=16.0, **wrong), 12) == pytest.approx(farthest(soft, 4), rel=0.05)
    assert farthest(run(), 4) < 0.005


def test_of_the_outputs() -> None:
    """One beam, two outputs"""
    gains: list[dict[str, Any]] = [{}, {"K1": 1600.0, "K2": 80.0}]
    for gain in gains:
        tip = onpath.simulate("flexible", output="redefined", duration=2.0, alpha=1.0, **gain)
        assert tip.stopped_at is not None and tip.stopped_at < 1
    other = onpath.simulate("flexible", output="redefined", duration=8.0, alpha=0.5)
    assert other.stopped_at is None and farthest(other, 4) < 1
