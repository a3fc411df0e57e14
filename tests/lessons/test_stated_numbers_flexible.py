"""What lesson 7 and the READMEs tell in numbers of the flexible robot, each millisecond."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

from onpath.models.closed_loop.trajectory import Trajectory
from onpath.models.studies.experiments import experiments, run
from onpath.models.systems.flexible_five_bar import HOME
from onpath.models.systems.flexible_links import load_links
from onpath.models.systems.zero_dynamics import flexible_zero_dynamics
from tests.support.one_robot import FOLLOWER, TRACKER, Driven, at, largest
from tests.support.stated_numbers import agrees, assert_stated, said, stated_in_readme, value

pytestmark = pytest.mark.thorough

LESSON, LINKS = "07", load_links()
SPEED = 2.0  # [rad/s], as the lesson's scenes have it


@cache
def going(who: str = FOLLOWER, until: float = 10.0, **settings: Any) -> Driven:
    """Round the circle and nothing else."""
    return Driven(who, "flexible", **{"speed": SPEED, "output": "redefined"} | settings).run(until)


def gone(settings: dict[str, Any], until: float = 10.0) -> Driven:
    return going(FOLLOWER, until, **settings)


# The steps in order -------------------------------------------------------------------------------


def test_the_link_bends_four_times_as_far_at_twice_the_speed() -> None:
    runs = [gone({"output": "composite", "speed": speed}) for speed in (2.0, 4.0)]
    bent = [largest(robot.deflection, 2, 10) for robot in runs]
    assert_stated(said(LESSON, "You should get # mm and # mm: *four* times."), bent)
    assert_stated(said(LESSON, "Still the link bends, at 2 rad/s by # mm."), bent[:1])
    (near,) = said(LESSON, "both robots keep their tips within about # mm of the path")
    for who in (FOLLOWER, TRACKER):
        off = largest(going(who, output="composite", speed=4.0).distance, 2, 10)
        assert agrees(near, off) and off > largest(runs[0].distance, 2, 10)


def test_a_quiet_output() -> None:
    robot = Driven(FOLLOWER, "flexible", speed=SPEED, output="redefined", alpha=0.0).run(2.0)
    robot.pull(20, 0).run(2.5).let_go().run(8.0)
    jolt = said(LESSON, "a jolt of # mJ as the hand grips, # mJ while it pulls")
    assert_stated(jolt, [largest(robot.energy, 2, 2.1), largest(robot.energy, 2.2, 2.5)])
    (quiet,) = said(LESSON, "after 3 s ξ₁ and ξ₃ are below # mm and stay there")
    assert largest(robot.across, 3, 8) < value(quiet)
    swing = [largest(robot.deflection, begin, begin + 0.25) for begin in (3.0, 5.0, 7.75)]
    texts = said(
        LESSON,
        "After 3 s it swings # mm to either side, after 5 s # mm, and at the end still more"
        " than # mm.",
    )
    assert_stated(texts, swing)
    texts = said(LESSON, "The energy falls from # mJ at 3 s to # at 5 s and # at the end")
    assert_stated(texts, [at(robot.energy, time) for time in (3, 5, 7.999)])


@pytest.mark.parametrize("alpha", ["0", "0.5", "0.7"])
def test_more_alpha_less_error(alpha: str) -> None:
    (stated,) = said(LESSON, f"| {alpha} | # mm |")
    assert_stated([stated], [largest(gone({"alpha": float(alpha)}).distance, 2, 10)])


@cache
def past_the_limit(law: str) -> Driven:
    robot = Driven(law, "flexible", speed=SPEED, output="redefined", alpha=0.5).run(3.0)
    return robot.set(alpha=0.75).run(7.0)


def test_past_the_limit() -> None:
    robot = past_the_limit(FOLLOWER)
    rows = (
        "in the last second before # s",
        *(f"in the quarter second after {t} s" for t in (4, 5, 6)),
    )
    windows = ((2, 3), (4, 4.25), (5, 5.25), (6, 6.25))
    for row, window in zip(rows, windows, strict=True):
        texts = said(LESSON, f"| {row} | # mm | # mJ | # N m |")[-3:]
        seen = (robot.across, robot.energy, robot.torque)
        assert_stated(texts, [largest(values, *window) for values in seen])
    stopped = (
        said(LESSON, "At # s the lab stops it and says"),
        said(LESSON, "stopped first, at # s."),
    )
    for text, law in zip(stopped, (FOLLOWER, TRACKER), strict=True):
        assert_stated(text, [past_the_limit(law).stopped or 0.0])
    before, end = largest(robot.energy, 2, 3), len(robot.energy) / 1e3
    assert largest(robot.energy, 5, 5.25) > 5000 * before
    assert largest(robot.energy, 3, end) > 1e6 * before
    (jolt,) = said(LESSON, "There is a jolt at 3 s, # mm")
    assert_stated([jolt], [largest(robot.across, 3, 3.25)])
    (late,) = said(LESSON, "just after 5 s the output is at most # mm off")
    assert_stated([late], [largest(robot.across, 5, 5.25)])
    (left,) = said(LESSON, "You had such a plot at 5 s of the second run, # s before the lab")
    assert_stated([left], [(robot.stopped or 0.0) - 5])


def stepped(alpha: float, modes: int = 3) -> float:
    """From the step to the stop, [s]."""
    robot = Driven(FOLLOWER, "flexible", speed=SPEED, output="redefined", alpha=0.5, modes=modes)
    robot.run(3.0).set(alpha=alpha).run(6.0)
    assert robot.stopped is not None
    return robot.stopped - 3


def test_how_fast_it_is_with_more_alpha_and_that_this_is_the_truncation_s() -> None:
    texts = said(
        LESSON,
        "a step to 0.9 ends after # s, one with a step to 1 after # s. The last number says more"
        " about the model than about a beam: with one bending mode it is # s, with six # s.",
    )
    assert_stated(texts, [stepped(0.9), stepped(1.0), stepped(1.0, 1), stepped(1.0, 6)])


# The tasks ----------------------------------------------------------------------------------------


def test_the_reflected_tip_is_off_by_twice_the_deflection() -> None:
    steady, first = said(
        LESSON, "the tip is off by *twice* the deflection, # mm at 2 rad/s, and # mm at first"
    )
    distance = going(FOLLOWER, 70.0, alpha=-1.0).distance
    assert_stated([first, steady], [largest(distance, 2, 10), largest(distance, 60, 70)])


def test_a_promise_that_is_not_kept() -> None:
    (within,) = said(LESSON, 'the tip must stay within # mm."')
    assert largest(gone({"alpha": 0.8, "modes": 1}).distance, 0, 10) < value(within)
    (soon,) = said(LESSON, "The robots start anew and are stopped within # s.")
    for law in (FOLLOWER, TRACKER):
        assert 0 < (going(law, alpha=0.8).stopped or 9.0) < value(soon)


def test_composite_control() -> None:
    texts = said(
        LESSON,
        "the tip is at most # mm off the path, compared with # at α = 0.5. It needs a good model:"
        " with the beam's frequency wrong by 10 % it is up to # mm.",
    )
    wrong = [{"output": "composite", "error_omega1": error} for error in (-10.0, 10.0)]
    settings: list[dict[str, Any]] = [{"output": "composite"}, {"alpha": 0.5}, *wrong]
    good, half, *off = (largest(gone(each).distance, 2, 10) for each in settings)
    assert_stated(texts, [good, half, max(off)])


@cache
def held(law: str, begin: float, output: str) -> Driven:
    robot = Driven(law, "flexible", speed=SPEED, output=output, alpha=0.5).run(begin).hold()
    return robot.run(begin + 2.2)


def test_holding_the_tip() -> None:
    said(LESSON, "a held link swings further and further, and is stopped within a second.")
    for law in (FOLLOWER, TRACKER):
        for begin in (2.0, 2.5, 3.0):
            assert 0 < (held(law, begin, "redefined").stopped or 9.0) - begin < 1
    begins = np.arange(2.0, 5.1, 0.4)
    energies = [largest(held(FOLLOWER, t, "composite").energy, t, t + 2.2) for t in begins]
    (most,) = said(LESSON, "so that the follower's link never stores more than # mJ")
    assert max(energies) < value(most)


@cache
def turned(law: str, begin: float, k5: float) -> tuple[float, float]:
    """Largest distance and deflection, [mm], from the reversal on."""
    robot = Driven(law, "flexible", speed=SPEED, output="redefined", alpha=0.5, K5=k5).run(begin)
    robot.set(speed=-SPEED).run(begin + 4.5)
    distance, deflection = robot.distance, robot.deflection
    return largest(distance, begin, begin + 4.5), largest(deflection, begin, begin + 4.5)


def test_turning_round() -> None:
    begins = np.arange(2.0, 5.2, 0.25)
    follower, tracker, gently = (
        np.array([turned(law, begin, k5) for begin in begins])
        for law, k5 in ((FOLLOWER, 5.0), (TRACKER, 5.0), (FOLLOWER, 1.0))
    )
    assert turned(TRACKER, 2.0, 1.0) == turned(TRACKER, 2.0, 5.0)
    texts = said(
        LESSON,
        "With K5 = 5 the tip goes # to # mm off in the turn, depending on where it turns."
        " The tracker: # to # mm, whatever K5 is.",
    )
    off = (follower[:, 0], tracker[:, 0])
    assert_stated(texts, [float(f(x)) for x in off for f in (np.min, np.max)])
    texts = said(
        LESSON,
        "bends the tracker's link by # to # mm and, with K5 = 1, the follower's by less than # mm.",
    )
    assert_stated(texts[:2], [tracker[:, 1].min(), tracker[:, 1].max()])
    assert gently[:, 1].max() < value(texts[2])
    (far,) = said(LESSON, "with the follower's tip never further than # mm from the path")
    assert gently[:, 0].max() < value(far)


# The plant unit_modes -----------------------------------------------------------------------------


def test_the_riddle() -> None:
    calm = going(FOLLOWER, 8.0, alpha=1.0, plant="unit_modes")
    assert_stated(
        said(LESSON, "the tip itself, and is calm: # mm."), [largest(calm.distance, 2, 8)]
    )
    shown, density, stops = said(
        LESSON, "The limit is then ρ = #; with ρ = # the same robot is stopped after # s."
    )
    stopped = going(FOLLOWER, 8.0, alpha=1.0, plant="unit_modes", rho=value(density)).stopped
    assert_stated([stops], [stopped or 0.0])
    zero = flexible_zero_dynamics(3, "unit_modes")
    for rho, sign in ((value(shown) - 0.005, -1), (value(shown) + 0.005, 1)):
        parameters = zero.system.parameter_vector(LINKS.lumped(1.0) | {"rho": rho})
        rightmost = zero.exponents(np.concatenate([HOME, np.zeros(3)]), parameters)[0, 0]
        assert np.sign(rightmost.real) == sign
    assert going(FOLLOWER, 8.0, alpha=1.0, rho=0.05).stopped is not None


# The READMEs -------------------------------------------------------------------------------------


@cache
def flexible(**settings: object) -> Trajectory:
    chosen = experiments()["flexible"]
    return run(chosen.with_values({k: str(v) for k, v in settings.items()}), FOLLOWER)


def test_how_soon_the_tip_is_lost_is_told_with_the_number_of_modes() -> None:
    texts = stated_in_readme("is stopped after # ms; with one mode it takes # ms, with six # ms,")
    found = [flexible(alpha=1, modes=modes).stopped_at or 0.0 for modes in (3, 1, 6)]
    assert_stated(texts, [1e3 * seconds for seconds in found])


def test_composite_control_is_told_with_its_window() -> None:
    texts = stated_in_readme(
        "from # s to its end at # s, the follower's tip is # mm rms off the ellipse and at most"
        " # mm, against # and # mm with `alpha=0.5`. (Over all 6 s both are # mm rms: it starts"
        " # mm off.)"
    )
    found, whole = [2.0, 6.0], list[float]()
    for settings in ({"output": "composite"}, {"alpha": 0.5}):
        log = flexible(**settings)
        distance, late = 1e3 * log.distance, log.t >= 2
        found += [float(np.sqrt(np.mean(distance[late] ** 2))), float(distance[late].max())]
        whole.append(float(np.sqrt(np.mean(distance**2))))
        assert log.t[-1] == pytest.approx(6.0, abs=2e-3)
    assert agrees(texts[6], whole[0])
    assert_stated(texts, [*found, whole[1], 1e3 * float(flexible(alpha=0.5).distance[0])])
