"""The numbers of the lessons on spoilers and on the challenge are those that the lab shows."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from onpath.lessons.action_schema import Action
from onpath.lessons.course import BUILT_IN
from onpath.models.control.poles import channels
from onpath.models.paths.path_design import presets
from onpath.models.systems.five_bar_parameters import FiveBarParameters
from tests.support.stated_numbers import (
    Motion,
    assert_stated,
    held,
    play,
    pulled,
    said,
    shown,
    value,
)

pytestmark = pytest.mark.thorough

RADIUS, TURN = 0.05, 2 * np.pi
PD: dict[str, Any] = {"K3": 0.0}  # of lesson 6, but for the task on the integral

# Lesson 6

SPOILERS: dict[str, dict[str, Any]] = {
    "none": {},
    "controller's M11 30 % too small": {"error_M11": -30},
    "M11 30 % too large": {"error_M11": 30},
    "b1 50 % too large": {"error_b1": 50},
    "b1 50 % too small": {"error_b1": -50},
    "dry friction of 0.05 N m": {"coulomb": 0.05},
    "control at 100 Hz, not 1000": {"control_rate": 100},
    "encoders with 2000 steps a turn": {"encoder_counts": 2000, "observer_time": 0.0},
    "the same encoders, with the observer": {"encoder_counts": 2000},
    "torque limit of 0.3 N m": {"torque_limit": 0.3},
    "torque limit of 0.2 N m": {"torque_limit": 0.2},
}


@pytest.mark.parametrize("spoiler", SPOILERS)
def test_spoiler_shows_across_and_along(spoiler: str) -> None:
    follower = play(6.0, [], **PD, **SPOILERS[spoiler])["follower"]
    stated = said("06", f"| {spoiler} | # mm | # rad/s |")
    assert_stated(stated, [follower.largest(1, 6), float(follower.rate[1000:].mean())])


def test_look_ahead_of_half_an_interval_makes_late_control_as_fast_as_it_should_be() -> None:
    follower = play(6.0, [], **PD, control_rate=100, look_ahead="half_interval")["follower"]
    rate, off = said("06", "at 100 Hz the follower then turns at # rad/s, and stays within # mm")
    assert_stated([rate], [float(follower.rate[1000:].mean())])
    assert 0.9 * value(off) < follower.largest(1, 6) < value(off)


def test_late_control_is_fast_control() -> None:
    rates = [
        play(6.0, [], **PD, **SPOILERS[name])["follower"].rate[1000:].mean()
        for name in ("control at 100 Hz, not 1000", "encoders with 2000 steps a turn")
    ]
    stated = said("06", "At 100 Hz the follower is # % too fast, with the encoders # %")
    assert_stated(stated, [100 * (float(rate) / TURN - 1) for rate in rates])


def test_wrong_model_costs_some_millimetres() -> None:
    tracker = shown("06", "Forty per cent too light")["tracker"]
    stated = said("06", "and is # mm off on average from 3 s on")
    assert_stated(stated, [float(tracker.distance[3000:].mean())])
    wrong: dict[str, Any] = {"error_M11": -40, "error_M22": -40, **PD}
    stiff = play(9.0, [], K1=800, **wrong)["follower"].distance[7000:].mean()
    assert_stated(said("06", "| too light, twice K1 | # mm | # mm |")[1:], [float(stiff)])
    half: dict[str, Any] = {"error_M11": -20, "error_M22": -20, **PD}
    derived = play(9.0, [], **half)["follower"].distance[7000:].mean()
    assert_stated(said("06", "$\\omega = 2\\pi$: # mm outside."), [float(derived)])


def test_more_gain_until_it_is_fatal() -> None:
    follower = shown("06", "Turn it up")["follower"]
    stated = said(
        "06",
        "In the last second of each stage the follower is # mm off on average, then #, then #:",
    )
    assert_stated(
        stated, [float(follower.distance[a : a + 1000].mean()) for a in (1000, 3000, 5000)]
    )
    low, high = said("06", "In the first stage, from 1 s on, the follower is # to # mm off")
    off = follower.distance[1000:2000]
    assert_stated([low, high], [float(off.min()), float(off.max())])
    do = [Action(at=2.0, set={"K1": 2500, "K2": 150})]
    settings: dict[str, Any] = {"error_M11": -40, "error_M22": -40, "control_rate": 50}
    survives = play(8.0, do, **settings, **PD)["follower"].distance[4000:].mean()
    stated = said("06", "and the arm survives, # mm off on average")
    assert_stated(stated, [float(survives)])


def test_too_heavy_a_model_costs_stability_where_no_accuracy_was_lost() -> None:
    more, gain, interval, factor, stopped = said(
        "06",
        "K1 = 1600 and K2 = 80, make it $1 - #\\cdot #\\cdot # = #$: started with them, the"
        " follower is stopped after # s.",
    )
    assert_stated([factor], [1 - value(more) * value(gain) * value(interval)])
    stage: dict[str, Any] = {"K1": 1600, "K2": value(gain), **PD}
    heavy: dict[str, Any] = {"error_M11": 40, "error_M22": 40}
    slow: dict[str, Any] = {"control_rate": round(1 / value(interval))}
    lost = play(8.0, [], **stage, **heavy, **slow)["follower"]
    assert_stated([stopped], [float(lost.t[-1])])
    (never,) = said("06", "the same gains and the same 50 Hz it is never more than # mm off")
    assert_stated([never], [play(8.0, [], **stage, **slow)["follower"].largest(0, 8)])
    (fast,) = said("06", "A thousand times a second, the model too heavy is # mm off at most")
    assert_stated([fast], [play(8.0, [], **stage, **heavy)["follower"].largest(0, 8)])
    for error in (40, -40):  # "with these gains, still a stable one", "stands that, too"
        wrong: dict[str, Any] = {"error_M11": error, "error_M22": error, **PD}
        off = play(20.0, [], **wrong)["follower"]
        assert off.t[-1] > 19.9 and off.largest(10, 20) < 5


def test_arm_that_nobody_has_identified() -> None:
    wrong: dict[str, Any] = {"error_M11": -40, "error_M22": -50, "error_b1": 30, "error_b2": -30}
    off = play(8.0, [], **wrong, **PD)["follower"].largest(3, 8)
    assert_stated(said("06", "at full speed it would be up to # mm off"), [off])


def test_largest_damping_is_where_the_poles_say() -> None:
    at_100, at_50 = said("06", "they are unstable from # on, and at 50 Hz from # on, not 100")
    (far,) = said("06", "T counts twice, and they are unstable from # on")
    cases = (100, at_100, "half_tick"), (50, at_50, "half_tick"), (100, far, "half_interval")
    for rate, text, look_ahead in cases:
        stated = value(text)
        stable = [
            channels(FiveBarParameters(control_rate=rate, K2=damping, look_ahead=look_ahead, **PD))[
                0
            ].stable
            for damping in (stated - 1, stated)
        ]
        assert stable == [True, False]
        late = 1e-3 if look_ahead == "half_tick" else 1 / rate  # "as if T were 1 ms longer"
        assert stated == pytest.approx(2 / (1 / rate + late), abs=1.5)
    with_it = play(3.0, [], K1=2500, K2=200, control_rate=100, **PD)["follower"]
    assert 1.0 <= with_it.t[-1] < 1.1  # "stops the follower after one second"


def test_the_integral_learns_and_what_it_learns() -> None:
    spoilers: dict[str, dict[str, Any]] = {
        "M11, M22 too light by 40 %": {"error_M11": -40, "error_M22": -40},
        "encoders, 2000 steps, no observer": {"encoder_counts": 2000, "observer_time": 0.0},
        "dry friction 0.05 N m": {"coulomb": 0.05},
    }
    for row, spoiler in spoilers.items():
        stated = said("06", f"| {row} | # mm | {'**# mm**' if 'friction' in row else '# mm'} |")
        off = [play(8.0, [], K3=gain, **spoiler)["follower"].largest(2, 8) for gain in (0, 4000)]
        assert_stated(stated, off)
    hand = [Action(at=1.0, pull=(30.0, 0.0)), Action(at=3.0, release=True)]
    without, learnt = (play(4.0, hand, speed=0.0, K3=gain)["follower"] for gain in (0, 4000))
    assert_stated(said("06", "without K3 the follower comes # mm off and stays"), [without.at(2.9)])
    assert_stated(said("06", "With K3 = 4000 it is soon only # mm off"), [learnt.largest(1.5, 3)])
    assert_stated(said("06", "it shoots # mm to the other side"), [float(learnt.across.max())])


# Lesson 8


def bulge(index: int, right: float, up: float, *more: Action, **settings: Any) -> Motion:
    """The follower on the circle with a ball moved."""
    return play(8.0, [Action(at=0.0, move=(index, right, up)), *more], **settings)["follower"]


def test_bulge_costs_what_its_bend_needs() -> None:
    right, slow = bulge(4, 15, 0), bulge(4, 15, 0, speed=TURN / 2)
    top = bulge(6, 0, 15)
    costs = [float(run.torque[4000:].max()) for run in (right, top, slow)]
    assert_stated(said("08", "The bulge to the right costs # N m, twice"), costs[:1])
    assert_stated(said("08", "The same bulge at the top costs #. And"), costs[1:2])
    assert_stated(said("08", "the right one costs #: not half"), costs[2:])
    assert_stated(said("08", "The plot said #; out there"), costs[:1])
    circle = presets()["circle"]
    curve, theta = circle.moved(4, circle.points[4] + [0.015, 0]).curve, np.linspace(-1, 1, 4001)
    first, second = curve.at(theta, 1), curve.at(theta, 2)
    length = np.linalg.norm(first, axis=1)
    bend = np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]) / length**3
    sharpest, speed = int(bend.argmax()), TURN * length
    stated = said("08", "at $R = #$ mm, and the end-point passes it at # m/s: # m/s²")
    across = float(bend[sharpest] * speed[sharpest] ** 2)
    assert_stated(stated, [1e3 / bend[sharpest], float(speed[sharpest]), across])
    drawn = (BUILT_IN / "08-challenge" / "bend.svg").read_text(encoding="utf-8")
    assert f"v²/R = {stated[2]} m/s²" in drawn and f"{costs[0]:.2f} N m" in drawn
    estimate = said("08", r"\frac{#\cdot #}{#} = #\ \text{N m}")
    assert_stated(estimate, [0.0226, across, 0.2, 0.0226 * value(stated[2]) / 0.2])
    told = said(
        "08",
        "$M_{22} = #$ is only half as large: # by this estimate, and # in the plot."
        " (The # given earlier is motor 1's,",
    )
    first, second = (float(most) for most in top.torques[4000:].max(axis=0))
    assert_stated(told, [0.012, 0.012 * value(stated[2]) / 0.2, second, first])


def test_six_times_the_gain_and_less_speed() -> None:
    both = shown("08", "More gain, or less speed")
    follower, tracker = both["follower"], both["tracker"]
    stated = said("08", "| six times the gain | # mm | # mm | # N m |")
    parts = [follower.largest(4.5, 8), tracker.largest(4.5, 8), 0.3]
    assert_stated(stated, parts)
    begin, *stated = said("08", "| 4 rad/s, from # s | # mm | # mm | # N m |")
    parts = [run.largest(value(begin), 12) for run in (follower, tracker)]
    assert_stated(stated, [*parts, float(follower.torque[int(1e3 * value(begin)) :].max())])
    assert_stated(
        said("08", "Yes: # mm, # mm, and from # s on # mm."),
        [follower.largest(1, 4), follower.largest(4.5, 8), value(begin), parts[0]],
    )
    assert_stated(
        said("08", "# mm becomes # mm, and stays there."),
        [follower.largest(1, 4), follower.largest(4.5, 8)],
    )


def test_tracker_is_closer_from_the_second_lap_on() -> None:
    both = shown("08", "More gain, or less speed")
    tracker, follower = both["tracker"], both["follower"]
    off = [follower.largest(1, 4), tracker.largest(1, 4)]
    assert_stated(said("08", "| full speed, from 1 s | # mm | # mm |"), off)
    assert off[1] < off[0]
    stated = said(
        "08",
        "From the second lap on, the *tracker* is a little closer. (In the first lap it begins by"
        " cutting the corner, and gets up to # mm off.)",
    )
    assert_stated(stated, [tracker.largest(0, 1)])


def test_clover_at_full_speed_and_at_the_hint_s() -> None:
    runs = [play(8.0, [], path="clover", speed=speed)["follower"] for speed in (TURN, 4.0, 3.9)]
    full, four, less = (float(run.torque[3000:].max()) for run in runs)
    assert_stated(said("08", "At full speed it would take #."), [full])
    stated = said(
        "08",
        "× √(0.5/#) = #. That is # mm/s. "
        "For an instant it takes # N m, a hair too much; at 3.9 it is #",
    )
    speed, mean = TURN * np.sqrt(0.5 / full), runs[1].speed[3000:].mean()
    assert_stated(stated, [full, speed, float(mean), four, less])


def test_path_with_two_gentle_bulges() -> None:
    second = Action(at=0.3, move=(2, 0, -15))
    plain = bulge(6, 0, 15, second)
    stated = said("08", "each pulled 15 mm outwards, cost # N m and give # mm/s")
    assert_stated(stated, [float(plain.torque[3000:].max()), float(plain.speed[3000:].mean())])
    real: dict[str, Any] = {
        "payload": 0.02,
        "coulomb": 0.02,
        "control_rate": 200,
        "encoder_counts": 4000,
        "observer_time": 0.0,
    }
    gentle, hard = (
        play(
            11.0,
            [Action(at=0.0, move=(6, 0, 15)), second, Action(at=1.0, reset=True)],
            torque_limit=0.5,
            K1=2500,
            K2=k2,
            **real,
        )["follower"]
        for k2 in (100, 200)
    )
    means = [float(one.distance[3000:10000].mean()) for one in (gentle, hard)]
    stated = said("08", "the follower, untouched, stays within # mm of the circle")
    assert_stated(stated, [gentle.largest(0, 10)])
    assert_stated(said("08", "from 3 s on # mm off on average"), means[:1])
    slower = 100 * (1 - float(hard.speed[3000:].mean() / gentle.speed[3000:].mean()))
    stated = said("08", "it is up to # mm and # mm on average, and it goes # % slower")
    assert_stated(stated, [hard.largest(0, 10), means[1], slower])
    assert_stated(said("08", "K2 = 200 turned # mm on average into # mm."), means)


def test_course_on_one_page() -> None:
    slow = held(3.0, speed=2.0), held(3.0, speed=2.0, robot="tracker")
    stated = said(
        "08", "hold them from 3 s to 5 s: the tracker is # mm off, as before. The follower: # mm"
    )
    assert_stated(stated, [slow[1].largest(3, 5), slow[0].largest(3, 5)])
    follower = held(3.0)
    clock = RADIUS * 1e3 * np.stack([np.cos(TURN * follower.t), np.sin(TURN * follower.t)], axis=1)
    lag = np.linalg.norm(follower.y - clock, axis=1)[3000:].max()
    stated = said("08", "is up to # mm from where the clock would have it, and # mm from the path.")
    assert_stated(stated, [float(lag), follower.largest(3, 5)])
    stated = said(
        "08",
        "a hand 30 mm to the right moves it # mm, and only # mm with K1 = 1600 and K2 = 80."
        " Then the integral takes over, up to its bound: after three seconds of pulling # mm are"
        " left.",
    )
    usual, stiff = pulled(30.0), pulled(30.0, K1=1600, K2=80)
    assert_stated(stated, [usual.largest(1, 4), stiff.largest(1, 4), usual.distance[-1]])


def test_the_law_across_is_linear_from_one_millimetre_to_ten() -> None:
    near, far, ratio = said(
        "08",
        "At speed 0 and K3 = 0, pull the follower # mm or # mm off and let go: at every instant"
        " of the return the second curve is # times the first.",
    )
    small, large = (
        play(
            2.5,
            [Action(at=1.0, pull=(hand, 0.0)), Action(at=2.0, release=True)],
            speed=0.0,
            **PD,
        )["follower"].across[2000:]
        for hand in (2.0, 20.0)
    )
    assert_stated([near, far], [-small[0], -large[0]])
    for instant in range(0, 300, 10):
        assert_stated([ratio], [large[instant] / small[instant]])


def test_stiff_tracker_presses_harder_and_leaves_the_circle_all_the_same() -> None:
    stiff, usual = held(3.0, robot="tracker", K1=1600, K2=80), held(3.0, robot="tracker")
    stated = said(
        "08",
        "with # N at K1 = 1600 and with # N at K1 = 400, "
        "and left the circle all the same, by # and # mm",
    )
    pressed = [float(run.force[3100:].max()) for run in (stiff, usual)]
    assert_stated(stated, [*pressed, stiff.largest(3, 5), usual.largest(3, 5)])
