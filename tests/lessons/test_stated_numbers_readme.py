"""The numbers of the READMEs that no lesson tells, too."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import pytest

import onpath
from onpath.models.closed_loop.trajectory import Trajectory
from onpath.models.paths.path_design import presets
from onpath.models.studies.comparison import Contest, compare
from onpath.models.studies.experiments import experiments, run
from onpath.models.studies.paper_figures import FIGURES
from onpath.models.systems import flexible_robot, tip_load
from onpath.models.systems.catalogue import FIVE_BAR
from tests.support.stated_numbers import assert_stated, stated_in_readme, value

pytestmark = pytest.mark.thorough

FOLLOWER, TRACKER = "path_following", "trajectory_tracking"


def did(name: str, law: str, /, **settings: object) -> Trajectory:
    return run(experiments()[name].with_values(settings), law)


def millimetres(distance: np.ndarray) -> float:
    """The largest."""
    return 1e3 * float(distance.max())


def test_a_ramp_of_the_speed_removes_the_start_up_error() -> None:
    seconds, without, less, ramp = stated_in_readme(
        "within # s, the tracker is # mm off without one and less than # mm with # rad/s²."
    )
    alone = {"hold_from": 0, "hold_to": 0, "duration": value(seconds), "speed": 2 * np.pi}
    off = [
        millimetres(did("obstruction", TRACKER, **alone, ramp=each).distance)
        for each in (0.0, value(ramp))
    ]
    assert_stated([without], off[:1])
    assert off[1] < value(less)


def test_a_wall_gives_way() -> None:
    stiffness, most = stated_in_readme("with # N for each millimetre and at most # N.")
    grip = FIVE_BAR.make(FIVE_BAR.parameters()).grip
    assert_stated([stiffness, most], [grip.wall.stiffness / 1e3, grip.wall.largest])
    (deep,) = stated_in_readme("slides along it, # mm deep in a wall through the circle's centre")
    wall = (2.0, 10.0, (0.0, 0.0), 0.0)
    runs = [
        onpath.simulate(law=law, wall=wall, duration=10, K1=gain, K2=2 * gain**0.5)
        for law, gain in ((TRACKER, 400.0), (FOLLOWER, 400.0), (TRACKER, 2500.0))
    ]
    tracker, follower, stiff = (-1e3 * float(run.y[2500:, 0].min()) for run in runs)
    assert_stated([deep], [tracker])
    assert 0 < follower < 1 and np.ptp(runs[1].theta[5000:]) < 1e-3  # "waits at it"
    assert np.ptp(np.unwrap(runs[0].theta[5000:])) > 2 * np.pi  # "and goes on"
    assert stiff > value(most) / value(stiffness)  # the force is at its limit


def test_twenty_grams_on_the_tip(monkeypatch: pytest.MonkeyPatch) -> None:
    grams, stopped, rms, begin, without = stated_in_readme(
        "hangs # g on the tip, of which no controller knows: with `alpha=0.5` the run is stopped"
        " after # s, and `output=composite` is # mm rms off from # s on, for the most part by the"
        " weight (# mm without it)"
    )
    load = value(grams) / 1e3
    assert stated_in_readme("`--set payload=#` hangs") == [f"{load:g}"]
    half = did("flexible", FOLLOWER, alpha=0.5, payload=load)
    found = [half.stopped_at or 0.0]
    for gravity in (tip_load.GRAVITY, 0.0):
        with monkeypatch.context() as patch:
            patch.setattr(tip_load, "GRAVITY", gravity)
            patch.setattr(flexible_robot, "_robot", lru_cache(flexible_robot._made))
            tip = did("flexible", FOLLOWER, output="composite", payload=load)
        found.append(1e3 * float(np.sqrt(np.mean(tip.distance[tip.t >= value(begin)] ** 2))))
    assert_stated([stopped, rms, without], found)


def test_figure_5() -> None:
    begin, end, most, within = stated_in_readme(
        "held back from # to # s: # mm from the circle at most, and by the end of the hold within"
        " # mm,"
    )
    (figure,) = FIGURES[5].runs()
    held = figure.t[figure.held]
    assert_stated([begin, end, most], [held[0], held[-1], millimetres(figure.distance)])
    assert 1e3 * figure.distance[figure.held][-1] <= value(within)


def test_the_comparison_under_a_brake() -> None:
    stated = stated_in_readme(
        "a brake for # s, the worst of eight places is # mm for tracking, # mm for path following,"
        " and # mm for a clock that waits"
    )
    contest = Contest(FIVE_BAR, FIVE_BAR.parameters(), presets()["circle"].curve)
    laws = [TRACKER, FOLLOWER, "waiting_clock"]
    found = [list(outcomes) for outcomes in compare(contest, laws, ["brake"])]
    assert [len(outcomes) for outcomes in found] == [8, 8, 8]
    worst = [1e3 * max(each.max_distance_m for each in outcomes) for outcomes in found]
    assert_stated(stated, [2.0, *worst])
