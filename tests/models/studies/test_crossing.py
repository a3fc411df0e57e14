"""A path that crosses itself: what stays on its strand, and what jumps."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from onpath.models.arrays import Array
from onpath.models.closed_loop.simulation import check_level_set
from onpath.models.closed_loop.trajectory import Trajectory
from onpath.models.paths.path_design import presets
from onpath.models.studies.crossing import FOLLOWING, TRACKING, crossing_runs, jumps, planned
from onpath.models.studies.experiments import Experiment, on_path, run
from onpath.models.systems.catalogue import FIVE_BAR
from tests.support.suitable_laws import laws_for

EIGHT = presets()["figure of eight"].curve
CROSSING = np.pi / 2


def quiet(**values: float) -> Experiment:
    """The figure of eight with exact sensors, from rest at θ = 0."""
    return on_path(FIVE_BAR, FIVE_BAR.parameters(), EIGHT).with_values(values)


def steps(trajectory: Trajectory) -> Array:
    return np.abs(np.diff(trajectory.fields["theta"][:, 0]))


@pytest.mark.thorough
def test_of_three_ways_only_the_global_search_jumps_to_the_other_strand() -> None:
    elsewhere = set[bool]()
    for seed in (1, 2, 3):
        runs = crossing_runs(planned(seed))
        assert not len(jumps(runs["continued"])) and not len(jumps(runs["clock"]))
        assert len(jumps(runs["global"]))
        sides = {name: each.fields["y"][800, 0] > 0.04 for name, each in runs.items()}
        assert sides["continued"] and sides["clock"]  # the loop that their strand leads to
        elsewhere.add(not sides["global"])
        for each in runs.values():
            assert each.stopped_at is None and each.distance.max() < 2e-3
        where = EIGHT.at(runs["global"].fields["theta"][1:, 0][steps(runs["global"]) > 0.5])
        assert np.linalg.norm(where, axis=1).max() < 5e-3  # at the crossing, and nowhere else
    assert elsewhere == {True, False}  # noise decides


@pytest.mark.thorough
def test_without_noise_no_law_stops_and_none_leaves_its_strand_in_passing() -> None:
    for law in laws_for():
        trajectory = run(quiet(duration=3.0), law)
        assert trajectory.stopped_at is None and steps(trajectory).max() < 0.05, law


@pytest.mark.parametrize("law", [FOLLOWING, TRACKING])
def test_held_at_the_crossing_nothing_jumps_and_the_follower_stays_near(law: str) -> None:
    held = run(quiet(duration=4.5, hold_from=0.1, hold_to=2.1, hold_at=CROSSING), law)
    assert held.held.sum() == 2000 and held.stopped_at is None
    at = held.fields["theta"][held.held, 0] % (2 * np.pi)
    assert steps(held).max() < 0.05
    if law == FOLLOWING:
        assert np.abs(at - CROSSING).max() < 0.2
        assert held.distance.max() < 4e-3 and held.distance[-500:].max() < 1e-3


@pytest.mark.thorough
def test_pushed_at_the_crossing_forty_times_it_keeps_its_strand() -> None:
    rng, other_was_nearer = np.random.default_rng(5), 0
    for _ in range(40):
        angle, reach = rng.uniform(-np.pi, np.pi), rng.uniform(0.005, 0.03)
        begin, (z1, z2) = rng.uniform(0.2, 0.35), reach * np.array([np.cos(angle), np.sin(angle)])
        hand = {"push_from": begin, "push_to": begin + 0.5, "push_z1": z1, "push_z2": z2}
        pushed = run(quiet(duration=1.8, **hand), FOLLOWING)
        assert pushed.stopped_at is None and steps(pushed).max() < 0.1
        assert pushed.distance[-1] < 2e-3
        z, theta = pushed.fields["y"][200:900], pushed.fields["theta"][200:900, 0]
        found = EIGHT.nearest(z)[0] - theta
        away = np.abs((found + np.pi) % (2 * np.pi) - np.pi) > 0.5
        other_was_nearer += bool(away.any())
    assert other_was_nearer > 5  # where the whole path were searched, it would have jumped


def test_the_level_set_of_a_path_that_crosses_itself_is_refused() -> None:
    lemniscate = dataclasses.replace(EIGHT, equation="s = z1**4 - z1**2 + z2**2")
    with pytest.raises(ValueError, match="crosses itself"):
        check_level_set(FIVE_BAR.parameters(across="level_set"), lemniscate)
