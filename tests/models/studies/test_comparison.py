"""The fair comparison: what it shows of the laws, and that it is the same each time."""

from __future__ import annotations

import dataclasses
import json
import math
from functools import lru_cache

import pytest

from onpath.models.control.laws.registry import LAWS
from onpath.models.control.settable import value_of
from onpath.models.paths.curves import circle
from onpath.models.studies.comparison import (
    AFTER,
    BEFORE,
    MEASURES,
    OBSTRUCTIONS,
    Contest,
    Outcome,
    as_data,
    compare,
    worst,
)
from onpath.models.systems.catalogue import FIVE_BAR, FLEXIBLE
from tests.support.checkout import ROOT

README = ROOT / "models" / "studies" / "README.md"
CONTEST = Contest(FIVE_BAR, FIVE_BAR.parameters(), circle(0.05))
PAIR = ("trajectory_tracking", "path_following")


@lru_cache
def outcomes(law: str, obstruction: str) -> tuple[Outcome, ...]:
    """The outcomes on the rigid five-bar, a circle of 50 mm, with the default gains."""
    (found,) = compare(CONTEST, [law], [obstruction])
    return tuple(found)


def distances(law: str, obstruction: str) -> list[float]:
    return [1000 * o.max_distance_m for o in outcomes(law, obstruction)]


@pytest.mark.parametrize("law", CONTEST.laws())
def test_undisturbed_a_law_that_has_the_path_keeps_it(law: str) -> None:
    """Started on the path with its velocity. Clocks that wait, and the current of the velocity
    field, have first to find their rates."""
    (outcome,) = outcomes(law, "none")
    most = {"waiting_clock": 0.1, "maneuvering": 0.02, "velocity_field": 0.5}.get(law, 0.005)
    assert 1000 * outcome.max_distance_m < most
    assert outcome.peak_force_N == outcome.energy_given_J == 0


def test_the_clock_makes_the_gap_and_waiting_nearly_closes_it() -> None:
    """A brake of 2 s at eight places."""
    assert min(distances("trajectory_tracking", "brake")) > 40
    assert max(distances("path_following", "brake")) < 6
    assert max(distances("waiting_clock", "brake")) < 6


def test_the_readme_quotes_the_worst_places_of_the_brake() -> None:
    """48, 4 and 4 mm."""
    laws = ("trajectory_tracking", "path_following", "waiting_clock")
    assert [round(max(distances(law, "brake"))) for law in laws] == [48, 4, 4]


def test_laws_that_wait_are_late_and_laws_with_a_clock_are_not() -> None:
    for law in ("path_following", "waiting_clock"):
        assert all(2.0 < outcome.delay_s < 2.4 for outcome in outcomes(law, "brake"))
    assert all(abs(outcome.delay_s) < 0.01 for outcome in outcomes("trajectory_tracking", "brake"))


def test_the_velocity_field_gives_no_more_than_it_stores() -> None:
    stored = value_of(CONTEST.parameters, "field_energy")
    for name in ("brake", "push_across", "push_ahead", "push_back", "wall"):
        assert max(o.energy_given_J for o in outcomes("velocity_field", name)) < stored


def test_with_the_remedy_path_following_keeps_the_path_better_than_tracking() -> None:
    for name in ("weak_motors", "too_fast"):
        assert max(distances("path_following", name)) < min(distances("trajectory_tracking", name))


@pytest.mark.thorough
def test_every_law_that_commands_an_acceleration_gets_the_remedy_at_a_torque_limit() -> None:
    for law in CONTEST.laws():
        name = "weak_motors" if LAWS[law].plan else "too_fast"  # a plan is not too fast
        cut, remedied = distances(law, f"{name}_cut"), distances(law, name)
        assert (cut != remedied) is LAWS[law].commands_acceleration, law


@pytest.mark.thorough
def test_the_readme_quotes_both_rows_of_saturation() -> None:
    names = ("weak_motors_cut", "weak_motors", "too_fast_cut", "too_fast")
    for law in ("path_following", "trajectory_tracking", "waiting_clock", "event_based"):
        found = [f"{max(distances(law, name)):.0f}" for name in names]
        assert f"| `{law}` | {' | '.join(found)} |" in README.read_text(encoding="utf-8"), found


def test_slowing_down_is_given_to_path_following_and_not_to_timetables() -> None:
    slow = dataclasses.replace(CONTEST.parameters, at_limit="slow_down")
    contest = dataclasses.replace(CONTEST, parameters=slow)

    def worst_place(law: str, name: str) -> float:
        (found,) = compare(contest, [law], [name])
        return 1000 * max(o.max_distance_m for o in found)

    found = [worst_place("path_following", name) for name in ("weak_motors", "too_fast")]
    assert [f"{each:.1f}" for each in found] == ["0.9", "0.0"]
    tracking = worst_place("trajectory_tracking", "too_fast")
    assert tracking == max(distances("trajectory_tracking", "too_fast"))


def test_only_laws_that_can_take_part_are_compared() -> None:
    assert "set_point" in LAWS and "set_point" not in CONTEST.laws()
    flexible = Contest(FLEXIBLE, FLEXIBLE.parameters(), circle(0.05))
    assert "velocity_field" not in flexible.laws()
    assert set(PAIR) <= set(flexible.laws())


@pytest.mark.parametrize("obstruction", OBSTRUCTIONS.values(), ids=lambda o: o.name)
def test_every_run_lasts_as_long_as_it_says(obstruction: object) -> None:
    assert isinstance(obstruction, type(OBSTRUCTIONS["none"]))
    found = outcomes("path_following", obstruction.name)
    assert len(found) == obstruction.places
    assert all(o.stopped_at_s is None for o in found)
    seconds = BEFORE + obstruction.seconds + AFTER
    for o in found:  # the mean is over the whole run, and the largest is at least the mean
        assert 0 <= o.mean_distance_m <= o.max_distance_m
        assert o.impulse_Ns <= o.peak_force_N * seconds + 1e-12


def test_the_same_comparison_gives_the_same_numbers() -> None:
    def run() -> str:
        results = {(o[0].law, o[0].obstruction): o for o in compare(CONTEST, PAIR, ["brake"])}
        return json.dumps(as_data(CONTEST, results))

    assert run() == run()


def test_the_worst_is_the_worst_of_each_measure() -> None:
    found = outcomes("path_following", "brake")
    summary = worst(found)
    assert summary["max_distance_m"] == max(o.max_distance_m for o in found)
    assert summary["stopped_at_s"] is None


FAILING = ("u1 = 9; u2 = 0", "across = -K1*sqrt(xi); along = -K5*(dtheta - speed)")


@pytest.mark.parametrize("law", FAILING)
def test_a_law_that_stops_is_behind_all_that_do_not(law: str) -> None:
    (found,) = compare(CONTEST, [law], ["none"])
    assert 0 < (worst(found)["stopped_at_s"] or 0.0) < 4.5
    fails, works = worst(found), worst(outcomes("trajectory_tracking", "none"))
    for measure in MEASURES:
        assert (works[measure] or 0.0) < (fails[measure] or 0.0) == math.inf
    distances = {"stops": fails["max_distance_m"], "tracks": works["max_distance_m"]}
    assert min(distances, key=lambda name: distances[name] or 0.0) == "tracks"
