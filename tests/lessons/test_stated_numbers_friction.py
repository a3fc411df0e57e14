"""The numbers of the lesson on friction and the integral are those that the lab shows."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

from onpath.models.control.settable import specs
from onpath.models.systems.five_bar_parameters import FiveBarParameters
from tests.support.stated_numbers import (
    Motion,
    Run,
    agrees,
    assert_stated,
    play,
    said,
    shown,
    value,
)

pytestmark = pytest.mark.thorough

LESSON, QUICK, GENTLE = "06b", "Ten seconds with an integral", "A quarter of it"
STICKY: dict[str, Any] = {"stiction": 0.1, "coulomb": 0.05}
AT_TOP = {**STICKY, "task": "position", "target": 1.57, "K3": 4000.0, "K4": 400.0, "K5": 40.0}
STILL = 1e-9  # [mm] in a tick
PLAIN, INTEGRAL = "-K1*xi - K2*dxi", "-K1*xi - K2*dxi - K3*int_xi"


def own(across: str) -> str:
    """A typed law that holds the top of the circle."""
    return f"across = {across}; along = -K4*(theta - 1.57) - K5*dtheta"


@cache
def top(until: float = 20.0, **settings: Any) -> Motion:
    """The follower, sent to the top of the circle with friction and an integral."""
    return play(until, [], **{**AT_TOP, **settings})["follower"]


@cache
def typed(across: str) -> Motion:
    """A robot with a custom law, sent to the top of the circle."""
    return play(20.0, [], left=own(across), **AT_TOP)["tracker"]


def slipping(run: Motion) -> np.ndarray:
    """Ticks in which the end-point moves."""
    return np.abs(np.diff(run.y, axis=0)).max(axis=1) > STILL


def spells(run: Motion, begin: float) -> tuple[list[float], list[float]]:
    """Lengths of all complete rests and slips after an instant, [s]."""
    moves = slipping(run)
    edges = np.flatnonzero(np.diff(moves.astype(int))) + 1
    edges = edges[run.t[edges] > begin]
    lengths, moved = np.diff(run.t[edges]), moves[edges[:-1]]
    return lengths[~moved].tolist(), lengths[moved].tolist()


def period(run: Motion, begin: float) -> float:
    """Mean period of the hunting after an instant, from whole rests and slips, [s]."""
    x = run.across[run.t > begin]
    up = np.flatnonzero((x[1:] > 0) & (x[:-1] <= 0))
    return float(np.diff(up).mean()) / 1e3


def heights(run: Motion, begin: float) -> tuple[float, float]:
    """Furthest on either side after an instant, without sign, [mm]."""
    x = run.across[run.t > begin]
    return float(x.max()), float(-x.min())


def stands(run: Motion, begin: float = 10.0) -> bool:
    """Whether the robot does not move any more after an instant."""
    return not slipping(run)[run.t[:-1] > begin].any()


def capacity(run: Motion) -> float:
    """What spring and integral ask for across when static friction gives way, [m/s²]."""
    x = run.across / 1e3
    asked = np.abs(AT_TOP["K3"] * np.cumsum(x) * 1e-3 + 400 * x)
    begins = np.flatnonzero(np.diff(slipping(run).astype(int)) == 1)
    return float(asked[begins[run.t[begins] > 3]].mean())


@pytest.mark.parametrize("target", [0.8, 1.57, 2.0, 2.4])
def test_without_an_integral_it_stands_beside_the_circle(target: float) -> None:
    run = top(6.0, target=target, K3=0.0)
    assert_stated(said(LESSON, f"| {target:g} | # mm |"), [abs(run.across[-1])])
    assert stands(run, 2.0)
    for settings in ({"stiction": 0.0, "coulomb": 0.0}, {"stiction": 0.0}):
        assert top(6.0, target=target, K3=0.0, **settings).at(5.9) < 1e-5


def test_integral_hunts() -> None:
    both: Run = shown(LESSON, QUICK)
    run, twin = both["follower"], both["tracker"]
    inside, outside, whole, rest, slide = said(
        LESSON,
        "It stands # mm inside the circle, jumps, stands # mm outside, jumps back. A whole period"
        " takes # s. In each half of it the arm stands still for # s and slides for # s.",
    )
    assert_stated([inside, outside], list(heights(run, 3)))
    assert_stated([whole], [period(run, 3)])
    rests, slides = spells(run, 3)
    assert_stated([rest, slide], [float(np.mean(rests)), float(np.mean(slides))])
    assert max(rests) - min(rests) < 0.02
    offsets = said(LESSON, "It stops # mm off the circle") + said(LESSON, "it stopped, at # mm.")
    assert_stated(offsets, 2 * [twin.across[-1]])
    assert stands(twin, 2.0)
    assert np.mean(run.across[run.t > 3]) == pytest.approx(0, abs=0.1)  # "on average"
    assert (np.abs(run.across[run.t > 3]) > 0.5).mean() > 0.8  # "and hardly ever in fact"


def test_smaller_integral_has_the_same_jumps_and_longer_waits() -> None:
    quick, gentle = shown(LESSON, QUICK)["follower"], shown(LESSON, GENTLE)["follower"]
    side, rare, often = said(
        LESSON, "The same jumps, # mm from side to side; but a period takes # s instead of # s."
    )
    assert_stated([side, side], [sum(heights(run, 12)) for run in (top(), gentle)])
    assert_stated([rare, often], [period(gentle, 7), period(quick, 3)])
    least, most = said(
        LESSON, "From the fourth jump on, the arm stands for # to # s between two jumps."
    )
    rests = spells(gentle, 9)[0]
    assert_stated([least, most], [min(rests), max(rests)])
    above, below, seldom, frequent = said(
        LESSON, "Yes: still from # mm to # mm on the other side, every # s instead of every # s."
    )
    assert_stated([above, below], list(heights(gentle, 12)))
    assert_stated([seldom, frequent], [period(gentle, 7) / 2, period(quick, 3) / 2])
    stated = said(
        LESSON, "The jumps were as high as before, and came every # s instead of every # s."
    )
    assert_stated(stated, [period(gentle, 7) / 2, period(quick, 3) / 2])


def test_formulas_of_jump_and_wait() -> None:
    run = top()
    most, sliding = capacity(run), capacity(run) * STICKY["coulomb"] / STICKY["stiction"]
    (withstood,) = said(LESSON, "static friction can withstand $f_s = #$ m/s² of it.")
    assert_stated([withstood], [most])
    assert_stated(said(LESSON, "takes half of that, $f_c = #$ m/s²."), [sliding])
    jump = (most - sliding) / 400 * 1e3
    assert_stated(said(LESSON, r"\frac{f_s - f_c}{K_1} = #\ \mathrm{mm}."), [jump])
    assert jump == pytest.approx(sum(heights(run, 5)), rel=0.02)
    (half,) = said(LESSON, "Now it stands on the other side, at $a$ = # mm.")
    assert_stated([half], [jump / 2])
    wait = 1e3 * (most + sliding) / (4000 * jump / 2)
    assert_stated(said(LESSON, r"\frac{f_s + f_c}{K_3\,a} = #\ \mathrm{s}."), [wait])
    measured, gentle = said(
        LESSON,
        "# s were measured: during the slip the integral runs, too. With K3 = 1000 it is # s",
    )
    assert_stated([measured], [float(np.mean(spells(run, 5)[0]))])
    assert_stated(
        [gentle, gentle],
        [4 * wait, float(np.mean(spells(shown(LESSON, GENTLE)["follower"], 9)[0]))],
    )


def test_the_formula_of_the_jump_holds_with_the_damping_that_suits_the_spring() -> None:
    stated = said(
        LESSON,
        "From side to side it is # mm with K2 = #. With less damping the arm slides past the place"
        " where the spring has taken up the surplus, as any swing does: # mm with K2 = #, and # mm"
        " with K2 = #. With more it creeps there, and the integral turns back meanwhile: # mm with"
        " K2 = #. And with K3 = # the integral pushes noticeably during the slip: # mm.",
    )
    for jump, damping in zip(stated[:8:2], stated[1:8:2], strict=True):
        assert_stated([jump], [sum(heights(top(K2=value(damping)), 10))])
    assert_stated(stated[9:], [sum(heights(top(K3=value(stated[8])), 10))])
    dampings = [10.0, 15.0, 20.0, 30.0, 40.0, 60.0, 80.0, 120.0, 200.0]
    jumps = [sum(heights(top(K2=damping), 10)) for damping in dampings]
    assert jumps == sorted(jumps, reverse=True)  # "Less damping makes the jumps higher"
    still, sliding = (
        said(LESSON, rf"$f_{letter} = #$ m/s²{after}")[0]
        for letter, after in (("s", " of it."), ("c", "."))
    )
    for stiff in (200.0, 300.0, 400.0, 600.0):  # takeaway: K2 = 2 √K1, a slow integral
        run = top(60.0, K1=stiff, K2=2 * stiff**0.5, K3=1000.0)
        surplus = 1e3 * (value(still) - value(sliding)) / stiff
        assert sum(heights(run, 20)) == pytest.approx(surplus, rel=0.05), stiff


def test_neither_cause_alone_makes_it_jump() -> None:
    assert stands(top(K3=0.0), 2.0)
    level = top(60.0, stiction=0.05)
    assert level.largest(10, 60) < 0.05


def hunts(row: str, run: Motion) -> list[str]:
    """Assert the height in a row of the table of remedies; the other numbers of the row."""
    height, *others = said(LESSON, row)
    assert all(agrees(height, each) for each in heights(run, 10)), heights(run, 10)
    return others


def test_table_of_remedies() -> None:
    same, slow, damped = top(), top(K3=1000.0), top(K2=80.0)
    assert_stated(hunts("K3 = 4000 | hunts, ±# mm, period # s |", same), [period(same, 10)])
    assert_stated(hunts("| K3 = 1000 | hunts, ±# mm, period # s |", slow), [period(slow, 7)])
    row = "more damping, K2 = 80 | hunts, ±# mm, period # s |"
    assert_stated(hunts(row, damped), [period(damped, 10)])
    loose = top(K2=10.0)
    row = "less damping, K2 = 10 | hunts, ±# mm, period # s |"
    assert_stated(hunts(row, loose), [period(loose, 10)])
    zone = typed("-K1*xi - K2*dxi - (K3*int_xi if abs(xi) > 0.001 else 0)")
    level = top(stiction=0.05)
    for row, run in (
        ("| K3 = 0 | stands, # mm off |", top(K3=0.0)),
        ("| static friction down to 0.05 N m | stands, # mm off |", level),
        ("no integral within 1 mm | stands, # mm off |", zone),
    ):
        assert_stated(said(LESSON, row), [run.at(19.9)])
        assert stands(run)
    shaken = typed(f"{INTEGRAL} + 2*sin(200*t)")
    (within,) = said(LESSON, "shaking, 2 m/s² at 200 rad/s | shakes, within # mm |")
    assert_stated([within], [shaken.largest(10, 20)])
    torque = float(shaken.torque[10000:].max())
    assert_stated(said(LESSON, "Shaking (*dither*): # N m from the motors"), [torque])
    stated = said(LESSON, "that took it from ±# mm to ±# mm, and K2 = 200, the most that the lab")
    assert_stated(stated, [max(heights(run, 10)) for run in (same, damped)])
    (left,) = said(LESSON, "the most that the lab allows, leaves ±# mm:")
    most = top(K2=200.0)
    assert specs(FiveBarParameters)["K2"].high == 200.0
    assert_stated([left], [max(heights(most, 10))])


def test_stiff_spring_is_quiet_for_half_a_minute_and_then_hunts() -> None:
    early, late = (top(until, K1=1600.0, K2=80.0) for until in (40.0, 150.0))
    (off,) = said(LESSON, "stiffer, K1 = 1600, K2 = 80 | stands, less than # mm off |")
    begin, other = said(LESSON, "At # s it jumps, to # mm on the other side")
    first = float(early.t[1:][slipping(early) & (early.t[1:] > 5)][0])
    assert_stated([begin], [first])
    assert early.largest(5, first) < value(off)
    assert early.at(first, "across") > 0
    assert_stated([other], [heights(early, first)[1]])
    (height,) = said(LESSON, "in the end it hunts by ±# mm.")
    assert_stated(2 * [height], list(heights(late, 120)))


def test_clock_is_an_integral() -> None:
    both = shown(LESSON, "Round, slowly")
    rate, off = said(LESSON, "The tracker goes round at # rad/s, up to # mm off the circle.")
    tracker, follower = both["tracker"], both["follower"]
    assert_stated([rate], [float(tracker.rate[3000:].mean())])
    assert_stated([off], [tracker.largest(1, 8)])
    assert not slipping(follower).any()
    asked = said(LESSON, "rad/s² along the path, which takes # N m")
    asked += said(LESSON, "The follower asks for the same torque for ever, # N m")
    asked += said(LESSON, "it asks for # N m, and the joints stick up to")
    asked += said(LESSON, "It asks for # N m and needs more")
    assert_stated(asked, 4 * [float(follower.torque[1000:].max())])
    starts, *rates, fastest = said(
        LESSON,
        "With K5 = # it starts, and goes round at # rad/s on average; with 15 at #,"
        " with 20 at #, with 30 at #, and in places at # rad/s.",
    )
    least = float(starts)
    for stated, gain in zip(rates, (least, 15.0, 20.0, 30.0), strict=True):
        run = play(8.0, [], speed=3.0, K5=gain, **STICKY)["follower"]
        assert_stated([stated], [float(run.rate[3000:].mean())])
    assert_stated([fastest], [float(run.rate[3000:].max())])
    assert not slipping(play(8.0, [], speed=3.0, K5=least - 0.2, **STICKY)["follower"]).any()
