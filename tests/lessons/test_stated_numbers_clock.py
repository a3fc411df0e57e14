"""The numbers of the lesson on the clock that waits are those that the lab shows."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

from onpath.lessons.action_schema import Action
from tests.support.stated_numbers import (
    Motion,
    Run,
    assert_stated,
    play,
    said,
    shown,
    value,
)

pytestmark = pytest.mark.thorough

LESSON, RADIUS, TURN = "01b", 0.05, 2 * np.pi
PD: dict[str, Any] = {"K3": 0.0}
PLACES = [3 + eighth / 8 for eighth in range(8)]
HELD, TURNED = "The same hold, another clock", "Turn round"


def waiting(until: float, *do: Action, **settings: Any) -> Run:
    """Both robots, with the waiting clock on the left."""
    return play(until, list(do), left="waiting_clock", **PD, **settings)


@cache
def held_at(begin: float, **settings: Any) -> Run:
    """Both robots, held from an instant for two seconds."""
    return waiting(begin + 2, Action(at=begin, hold=True), **settings)


def turned(left: str = "waiting_clock", **settings: Any) -> Run:
    """Both robots, told at 3 s to turn round."""
    begin = settings.pop("ramp", 0.0)
    do = [Action(at=3.0, set={"ramp": begin}), Action(at=3.0, set={"speed": -TURN})]
    return play(8.0, do, left=left, **PD, **settings)


def assert_within(stated: str, measured: float) -> None:
    """Assert that a distance is below a stated bound."""
    assert 0 < measured < value(stated)


def test_waiting_clock_stays_near_the_circle_while_it_is_held() -> None:
    clock, follower = shown(LESSON, HELD)["tracker"], shown(LESSON, HELD)["follower"]
    assert_stated(said(LESSON, "the arm stays within # mm of the circle"), [clock.largest(3, 5)])
    assert_stated(said(LESSON, "The follower was up to # mm off."), [follower.largest(3, 5)])
    places = [float(np.degrees(run.at(3.0, "place"))) - 3 * 360 for run in (clock, follower)]
    assert_stated(said(LESSON, "at different places, at #° and at #°"), places)
    stated = said(LESSON, "is off by # to # mm, the follower by # to # mm.")
    runs = [(begin, held_at(begin)) for begin in PLACES]
    off = [[run[who].largest(at, 9) for at, run in runs] for who in ("tracker", "follower")]
    assert_stated(stated, [each for own in off for each in (min(own), max(own))])
    apart = np.linalg.norm(clock.y[-1] - follower.y[-1])
    assert_stated(said(LESSON, "the two end-points are # mm apart"), [float(apart)])
    arches = play(8.0, [Action(at=3.0, hold=True), Action(at=5.0, hold=False)], **PD)["tracker"]
    assert_stated(said(LESSON, "four arches, each # mm high"), [arches.largest(3, 5)])


def test_the_point_stops_where_the_feeling_outweighs_the_speed() -> None:
    stated = said(LESSON, r"at $\omega/\mu = #$ rad, or #°. In the run it was #°.")
    both = shown(LESSON, HELD)
    ahead = both["tracker"].at(4.9, "reference") - both["tracker"].at(4.9, "place")
    assert_stated(stated, [TURN / 50, np.degrees(TURN / 50), np.degrees(ahead)])
    assert_stated(said(LESSON, r"K_1 r\,\omega/\mu = #$ m/s²"), [400 * RADIUS * TURN / 50])
    assert_stated(said(LESSON, r"asks for $K_5\, r\,\omega = #$ m/s²"), [10 * RADIUS * TURN])
    leans = [both[who].at(4.9, "force") for who in ("tracker", "follower")]
    assert_stated(said(LESSON, "At 4.9 s the brake felt # N from the one and # N"), leans)


def test_how_strongly_a_clock_must_feel() -> None:
    assert_stated(said(LESSON, r"\mu > 2\omega = #\ "), [2 * TURN])
    too_little, enough = said(LESSON, "the point escapes with μ = # and stops with #.")

    def lost(run: Run, begin: float) -> bool:
        """Whether the point ran round while the robot was held."""
        clock = run["tracker"]
        return bool(np.ptp(clock.reference[clock.during(begin, begin + 2)]) > np.pi)

    at_three = [lost(held_at(3.0, clock_gain=value(mu)), 3.0) for mu in (too_little, enough)]
    assert at_three == [True, False]
    lazy, better, far = said(
        LESSON,
        "the point still escapes at two places with μ = #, and at none with μ = #;"
        " but the arm then stands up to # mm off",
    )
    gone = [
        [lost(held_at(begin, clock_gain=value(mu)), begin) for begin in PLACES]
        for mu in (lazy, better)
    ]
    assert [sum(own) for own in gone] == [2, 0]
    rest = [held_at(b, clock_gain=value(better))["tracker"].largest(b + 1, 9) for b in PLACES]
    assert_stated([far], [max(rest)])


def test_a_hand_finds_no_difference_along_the_path() -> None:
    hand = Action(at=1.0, pull=(0.0, 30.0)), Action(at=3.0, release=True)
    both = waiting(4.0, *hand, speed=0.0)
    ends = [both[who].y[-1] for who in ("tracker", "follower")]
    moved, apart = said(LESSON, "# mm from where they began, and less than # mm from each")
    for end in ends:
        assert_stated([moved], [float(np.linalg.norm(end - [50, 0]))])
    assert np.linalg.norm(ends[0] - ends[1]) < value(apart)


@pytest.mark.parametrize("place", range(0, 8, 2))
def test_a_hint_that_stops_the_faster_clock_stops_it_everywhere(place: int) -> None:
    begin = 3 + place / 8 * TURN / 12
    far, near = (held_at(begin, speed=12.0, clock_gain=mu)["tracker"] for mu in (20, 80))
    assert near.largest(begin, 9) < 10
    assert begin > 3 or far.largest(begin, 9) > 40  # "Hold, and the point runs away."


def test_turning_round_takes_only_the_waiting_clock_off() -> None:
    both = shown(LESSON, TURNED)
    clock, follower = both["tracker"], both["follower"]
    turn, stop, never = said(
        LESSON,
        "the waiting clock leaves the circle by # mm, both times. Told to stop, by # mm. The"
        " follower is never more than # mm off",
    )
    assert_stated([turn, turn, stop], [clock.largest(a, a + 2) for a in (3, 5, 7)])
    assert follower.largest(1, 9) < value(never)
    assert_stated(said(LESSON, "in a narrow loop # mm outside"), [clock.largest(3, 5)])
    radii = np.linalg.norm(clock.y[clock.during(3, 5)], axis=1)
    assert radii.max() - 1e3 * RADIUS == pytest.approx(clock.largest(3, 5))  # not inside
    (both_within,) = said(LESSON, "From 1 s on both go round within # mm of the circle.")
    assert max(run.largest(1, 3) for run in both.values()) < value(both_within)
    instants = [int(np.argmax(run.rate[3000:] < 0)) / 1e3 for run in (follower, clock)]
    stated = said(LESSON, "stands still for an instant after # s, the waiting clock after # s")
    assert_stated(stated, instants)
    torques = [float(run.torque[3000:].max()) for run in (follower, clock)]
    stated = said(LESSON, "the follower give at most # N m, those of the waiting clock # N m")
    assert_stated(stated, torques)
    for answer in ("Yes: # mm, and less than # mm.", "The waiting clock was # mm off. Its arm"):
        assert_stated(said(LESSON, answer)[:1], [clock.largest(3, 5)])
    below, off = said(LESSON, "it was less than # mm off. The waiting clock was # mm off.")
    assert follower.largest(3, 5) < value(below)
    assert_stated([off], [clock.largest(3, 5)])


def test_more_feeling_does_not_cure_it() -> None:
    first, usual, eager = (turned(clock_gain=mu)["tracker"] for mu in (20, 50, 200))
    off = [run.largest(3, 8) for run in (first, usual, eager)]
    stated = said(LESSON, "takes the arm # mm off, with 50 it is # mm, with 200 it is # mm:")
    assert_stated(stated, off)
    torques = [float(run.torque[3000:].max()) for run in (eager, usual)]
    stated = said(LESSON, "Yes: # mm, against # mm. For that the motors gave up to # N m, against")
    assert_stated(stated, [off[2], off[1], torques[0]])
    assert_stated(said(LESSON, "gave up to 6.7 N m, against #."), torques[1:])


def row(begin: str, runs: list[Motion], after: float, until: float) -> None:
    """Assert that a row of the table tells the largest distances of three robots."""
    stated = said(LESSON, f"| {begin} | # mm | # mm | # mm |")
    assert_stated(stated, [run.largest(after, until) for run in runs])


def three(tracking: Run, clock: Run) -> list[Motion]:
    """The tracker, the waiting clock and the follower."""
    return [tracking["tracker"], clock["tracker"], clock["follower"]]


def test_what_the_waiting_clock_has_caught_up_and_what_it_has_not() -> None:
    hold = [Action(at=3.0, hold=True), Action(at=5.0, hold=False)]
    plain = play(8.0, hold, **PD)
    row("held from 3 s to 5 s", three(plain, shown(LESSON, HELD)), 3, 5)
    row("from rest, in the first second", three(plain, shown(LESSON, HELD)), 0, 1)
    hand = Action(at=1.0, pull=(30.0, 0.0))
    pulled = three(play(3.0, [hand], speed=0.0, **PD), waiting(3.0, hand, speed=0.0))
    row("pulled 30 mm across at speed 0, at rest", pulled, 2.9, 3)
    at_once = three(turned("trajectory_tracking"), turned())
    row("wanted speed jumps to −6.3 rad/s at 3 s", at_once, 3, 8)
    gently = three(turned("trajectory_tracking", ramp=20.0), turned(ramp=20.0))
    row("the same change, but at 20 rad/s²", gently, 3, 8)


@pytest.mark.parametrize("path", ["circle", "ellipse"])
@pytest.mark.parametrize("phase", [0.0, 0.37])
def test_no_speed_reference_takes_the_follower_off(path: str, phase: float) -> None:
    """It leaves the path by the length of a tick only, where the waiting clock leaves it."""
    jumps = [(2.0, -TURN), (2.4, 9.0), (3.1, 0.0), (3.5, -9.0), (4.2, TURN)]
    do = [Action(at=at + phase, set={"speed": speed}) for at, speed in jumps]
    both = play(6.0, do, path, "waiting_clock", **PD)
    assert both["follower"].distance.max() < 0.01
    assert both["tracker"].largest(2, 6) > 3


def test_relatives() -> None:
    event = shown(LESSON, "Side road: the event-based clock")
    stated = said(LESSON, "it waits, but # mm off the circle. It leans on the brake with # N,")
    assert_stated(stated, [event["tracker"].at(5.1), event["tracker"].at(5.1, "force")])
    lean = said(LESSON, "the follower with # N: it acts")
    assert_stated(lean, [event["follower"].at(5.1, "force")])
    assert event["tracker"].largest(6, 8) < 0.01  # "it is back at once"

    contour = shown(LESSON, "Side road: contouring")["tracker"]
    stated = said(LESSON, "of holding is enough to take it # mm off")
    assert_stated(stated, [contour.largest(3, 6)])
    long = play(5.0, [Action(at=3.0, hold=True)], left="contouring", **PD)["tracker"]
    assert_stated(said(LESSON, "after # s the lab stops it"), [float(long.t[-1]) - 3])
    gently = turned("contouring", ramp=20.0)["tracker"]
    assert_within(said(LESSON, "at 20 rad/s², it stays within # mm.")[0], gently.largest(3, 8))

    field = shown(LESSON, "Side road: a velocity field")["tracker"]
    stated = said(LESSON, "Held, it waits # mm off the circle and leans on the brake with # N.")
    assert_stated(stated, [field.at(4.9), field.at(4.9, "force")])
    stated = said(LESSON, "it goes round again, but at # mm/s instead of #:")
    assert_stated(stated, [float(field.speed[7000:].mean()), field.at(2.9, "speed")])


def test_virtual_constraint_is_invariant_and_goes_nowhere() -> None:
    wire = shown(LESSON, "Side road: a virtual constraint")["tracker"]
    assert_within(said(LESSON, "It stays on the circle, within # mm, so")[0], wire.largest(2, 5))
    low, high = said(LESSON, "Its speed goes up and down between # and # mm/s")
    speeds = np.abs(wire.speed[2100:5000])
    assert_stated([low, high], [float(speeds.min()), float(speeds.max())])
    assert (wire.rate[2000:5000] > 0).all()  # "it takes no notice"
    assert wire.at(6.9, "force") < 1e-6
    assert np.linalg.norm(wire.y[-1] - wire.y[7010]) < 0.01  # "it stays where it is"
