"""The arena is fair, repeatable and complete: measures against their definitions, ranks, trials."""

from __future__ import annotations

import dataclasses
import random

import numpy as np
import pytest

from onpath.models.control.laws.registry import law_named
from onpath.models.studies.arena import (
    LARGER_IS_BETTER,
    MEASURES,
    OBSTRUCTIONS,
    OFF,
    STEPS,
    Result,
    Row,
    complete,
    entrants,
    measured,
    result_of,
    run_under,
    table,
    trials_of,
)
from onpath.models.systems.catalogue import ROBOTS

ROBOTS_HERE = ("five_bar", "spatial_arm")


def test_the_same_seed_gives_the_same_trials_and_another_one_others() -> None:
    first, again, other = (trials_of(ROBOTS_HERE, 2, seed) for seed in (3, 3, 4))
    assert first == again != other
    for trials in first:
        wanted = [(robot, name) for robot in ROBOTS_HERE for name in OBSTRUCTIONS]
        assert [(each.robot, each.obstruction) for each in trials] == wanted
    assert {each.condition for each in first[0]} == {"exact"}


def test_more_rounds_only_add_trials() -> None:
    assert trials_of(ROBOTS_HERE, 3, 5)[:2] == trials_of(ROBOTS_HERE, 2, 5)


def test_the_trials_of_a_robot_do_not_depend_on_others() -> None:
    both, alone = trials_of(ROBOTS_HERE, 2, 5), trials_of(ROBOTS_HERE[1:], 2, 5)
    for one, other in zip(both, alone, strict=True):
        mine = [dataclasses.replace(t, number=0) for t in one if t.robot == ROBOTS_HERE[1]]
        assert mine == [dataclasses.replace(trial, number=0) for trial in other]


def test_a_robot_is_given_only_paths_that_it_can_follow(monkeypatch: pytest.MonkeyPatch) -> None:
    """As a small arm from a file, for which some are too large."""
    monkeypatch.setattr("onpath.models.studies.arena.PATHS", ("circle 0.9", "circle", "ellipse"))
    given = [trial.path for trials in trials_of(("five_bar",), 8, 1) for trial in trials]
    assert set(given) == {"circle", "ellipse"} and set(given[:5]) == {"circle"}
    monkeypatch.setattr("onpath.models.studies.arena.PATHS", ("circle 0.9",))
    with pytest.raises(ValueError, match="five_bar: it can follow none"):
        trials_of(("five_bar",), 1, 1)


def test_all_laws_have_the_same_conditions_but_for_the_remedy() -> None:
    for trial in trials_of(("five_bar",), 2, 1)[1]:
        cut, remedy = trial.settings(False), trial.settings(True)
        assert {name for name in cut if cut[name] != remedy[name]} == {"at_limit"}
        limits = trial.experiment(False).parameters.torque_limit
        assert limits == trial.experiment(True).parameters.torque_limit > 0


@pytest.mark.parametrize("robot", ROBOTS_HERE)
def test_every_law_that_can_take_part_has_its_rows(robot: str) -> None:
    rows = entrants(robot)
    system = ROBOTS[robot].make(ROBOTS[robot].parameters()).system
    for law in dict.fromkeys(law for law, _ in rows):
        remedies = [remedy for name, remedy in rows if name == law]
        assert remedies == ([False, True] if law_named(law).commands_acceleration else [None])
        assert law_named(law).suits(system)


def test_a_growing_pull_has_the_force_that_it_says() -> None:
    """F = rate (t - from) across the path, whatever the speed along it."""
    (trial,) = [each for each in trials_of(("five_bar",), 1, 1)[0] if each.obstruction == "pull"]
    moved = run_under(trial.experiment(True), "path_following")
    values = trial.values
    acts = (moved.t > values["pull_from"] + 0.02) & (moved.t < values["pull_from"] + 0.5)
    wanted = np.abs(values["pull_rate"]) * (moved.t[acts] - values["pull_from"])
    force = np.linalg.norm(moved.fields["force"][acts], axis=1)
    np.testing.assert_allclose(force, wanted, atol=0.03)  # it grows every 10 ms
    theta = moved.fields["theta"][acts][:, 0]
    left = -np.stack([np.cos(theta), np.sin(theta)], axis=1)  # normal of a circle
    across = (moved.fields["force"][acts] * left).sum(1) * np.sign(values["pull_rate"])
    assert (across > 0.99 * force).all()


def test_the_measures_are_what_they_say() -> None:
    trials = {each.obstruction: each for each in trials_of(("five_bar",), 1, 1)[0]}
    brake = trials["brake"]
    experiment = brake.experiment(False)
    moved = run_under(experiment, "path_following")
    result = measured("path_following", False, brake, experiment, moved)
    assert result.distance_m == moved.distance.max() == result.shown[:, 1].max()
    assert result.force_N is None and len(result.shown) == len(moved.t) // 20 + 1
    lap = 2 * np.pi / experiment.parameters.speed
    assert result.delay_s == pytest.approx(1.0, abs=0.25 * lap)  # held for a second
    work = (moved.fields["force"][:-1] * np.diff(moved.fields["y"], axis=0)).sum(1)
    assert result.energy_J == pytest.approx(max(-np.cumsum(work).min(), 0), abs=1e-9)
    assert brake.released is not None and result.overshoot_m is not None
    after = moved.distance[moved.t >= brake.released]
    assert result.overshoot_m <= after.max()
    pulled = result_of(("path_following", False), trials["pull"])
    assert pulled.distance_m is None and pulled.force_N is not None
    far = int((pulled.shown[:, 1] > OFF).argmax())
    at = pulled.shown[far, 0] - trials["pull"].values["pull_from"]
    assert pulled.force_N == pytest.approx(2.0 * at, abs=0.06)


def drawn_results(choice: random.Random, rows: list[Row]) -> list[Result]:
    """Results with random numbers, ties and stops."""
    trials = trials_of(("five_bar",), 1, 1)[0]
    found = list[Result]()
    for law, remedy in rows:
        for trial in trials:
            values = {
                name: choice.choice([None, np.inf, choice.randrange(4) * STEPS[name]])
                for name in MEASURES
            }
            stop = choice.choice([None, None, None, 0.5])
            result = Result(law, remedy, trial, stopped_at_s=stop)
            found.append(result if stop else dataclasses.replace(result, **values))
    return found


@pytest.mark.parametrize("seed", range(50))
def test_ranks_follow_the_worst_value_and_stops_come_last(seed: int) -> None:
    rows: list[Row] = [(law, remedy) for law in "abcd" for remedy in (False, True)]
    results = drawn_results(random.Random(seed), rows)
    cells = table(rows, results)
    for name in MEASURES:
        for one in rows:
            for other in rows:
                mine, its = cells[one][name], cells[other][name]
                stops = [
                    any(r.stopped_at_s for r in results if r.row == row) for row in (one, other)
                ]
                if stops == [False, True]:
                    assert mine.rank < its.rank
                if stops[0] == stops[1] and mine.worst is not None and its.worst is not None:
                    better = mine.worst < its.worst
                    if name in LARGER_IS_BETTER:
                        better = mine.worst > its.worst
                    assert (mine.rank < its.rank) == better
                    assert (mine.rank == its.rank) == (mine.worst == its.worst)
        assert min(cell[name].rank for cell in cells.values()) == 1


def test_only_trials_that_all_rows_have_finished_are_shown() -> None:
    rows: list[Row] = [("a", False), ("b", False)]
    trials = trials_of(("five_bar",), 2, 1)
    results = [Result(law, False, trial) for law, _ in rows for trial in trials[0]]
    late = [Result("a", False, trial) for trial in trials[1]]
    shown = complete({"five_bar": rows}, [*results, *late])
    assert {each.trial.number for each in shown["five_bar"]} == {t.number for t in trials[0]}
    assert complete({"five_bar": rows}, late) == {}
