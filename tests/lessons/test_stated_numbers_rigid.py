"""The numbers that the lessons on the rigid robot tell are those that the lab shows.

Each is taken from its sentence and replayed; the largest values are those of every millisecond.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from onpath.app.lab.dry_runs.step_truth import computed_truth
from onpath.lessons.action_schema import Action
from onpath.lessons.schema import Lesson
from onpath.models.arrays import Array
from onpath.models.control.poles import channels
from onpath.models.control.settable import specs
from onpath.models.systems.five_bar import load_links
from onpath.models.systems.five_bar_parameters import FiveBarParameters
from onpath.models.systems.five_bar_robot import RIGID_FIVE_BAR
from tests.support.built_in import built_in_course
from tests.support.rig import jacobian
from tests.support.stated_numbers import (
    WORST,
    assert_stated,
    held,
    play,
    said,
    shown,
    value,
)

pytestmark = pytest.mark.thorough

RADIUS, TURN = 0.05, 2 * np.pi
PD: dict[str, Any] = {"K3": 0.0}  # what lessons 1 and 4 are about
STAGES = (0, 4, 8, 12)  # [s], when the gains go up in lesson 4


def along_to_across(place: Array) -> float:
    """N . J M^-1 J^T T at a place of the circle, (2,), [m]; in 1/kg."""
    links, outwards = load_links().lumped(), place / np.linalg.norm(place)
    j = jacobian(RIGID_FIVE_BAR.rest(place))
    mobility = j @ np.diag([1 / links["M11"], 1 / links["M22"]]) @ j.T
    return float(-outwards @ mobility @ [-outwards[1], outwards[0]])


def lesson_one() -> Lesson:
    return built_in_course()[0].lesson("01-path-or-timetable", "en")


def is_nearly(text: str, measured: float) -> bool:
    """Whether a measured value is a little less than the written one."""
    return 0.0 < value(text) - measured < 0.03 * value(text)


def turning_points(across: np.ndarray) -> list[float]:
    """Where it turns back, in order."""
    return across[np.flatnonzero(np.diff(np.sign(np.diff(across)))) + 1].tolist()


# Lesson 1


def test_no_gain_keeps_the_tracker_near_the_circle() -> None:
    soft, stiff, spring, damper = said(
        "01",
        "caught at the right-hand end, it gets nearly # mm off with these, and still # mm with the"
        " stiffest, K1 = # and K2 = #.",
    )
    found = [
        held(3.0, robot="tracker", K1=gain, K2=damping, K3=0).largest(3, 5)
        for gain, damping in ((100.0, 20.0), (value(spring), value(damper)))
    ]
    assert is_nearly(soft, found[0])
    assert_stated([stiff], found[1:])
    assert specs(FiveBarParameters)["K1"].high == value(spring)


def test_tracker_draws_four_arches_of_one_height() -> None:
    tracker = shown("01", "Held from 3 s to 5 s")["tracker"]
    first, each, mean = said(
        "01",
        "Its distance rises to # mm, falls almost to zero, rises again: # mm four times. "
        "On average it is # mm off",
    )
    heights = [tracker.largest(3 + i / 2, 3.5 + i / 2) for i in range(4)]
    assert_stated([first, *4 * [each]], [heights[0], *heights])
    assert_stated([mean], [float(tracker.distance[tracker.during(3, 5)].mean())])
    assert tracker.distance[tracker.during(3.3, 4.7)].min() < 1


def test_soft_tracker_is_torn_off_further() -> None:
    soft = shown("01", "The same hold, softer")["tracker"].largest(3, 5)
    stiff = shown("01", "Held from 3 s to 5 s")["tracker"].largest(3, 5)
    told, of_stiff = said("01", "torn nearly # mm off the circle; the stiff one got to # mm")
    assert_stated([of_stiff], [stiff])
    truth = computed_truth(lesson_one(), 4)  # at every frame, as a chart shows it
    assert truth is not None
    answers = (
        "a soft spring. It got nearly # mm",
        "to move. It got nearly # mm",
        "Yes: nearly # mm.",
    )
    for text in (told, *(each for answer in answers for each in said("01", answer))):
        assert is_nearly(text, soft) and is_nearly(text, max(truth.tracker))


def test_slower_clock_runs_on_and_no_clock_takes_any_speed() -> None:
    slow = held(3.0, robot="tracker", speed=TURN / 2, **PD).distance[3000:]
    usual = held(3.0, robot="tracker", **PD).distance[3000:]
    for arches, distance in ((2, slow), (4, usual)):  # "the same arches appear, only wider"
        assert np.count_nonzero(np.diff(distance > 25)) == 2 * arches
        assert 45 < distance.max() < 50
    jumps = [
        Action(at=at, set={"speed": speed}) for at, speed in ((1.0, -TURN), (2.0, 0), (3.0, 9))
    ]
    free = play(4.0, jumps, **PD)  # "The follower has no clock at all."
    assert free["follower"].distance.max() < 0.01
    assert free["tracker"].distance.max() > 1


def test_brake_feels_the_catch_and_then_the_lean() -> None:
    both = shown("01", "Held from 3 s to 5 s")
    lean = both["follower"].at(4.9, "force")
    press = float(both["tracker"].force[3100:5000].max())
    quiz = "it leaned on the brake with # N, the tracker with up to # N. (Catching them took # N"
    assert_stated(said("01", "and leans on the brake with # N"), [lean])
    for robot in both.values():
        assert_stated(said("01", quiz), [lean, press, float(robot.force[3000:5000].max())])


def test_nudge_is_what_the_arm_makes_of_the_lean() -> None:
    follower = shown("01", "Held from 3 s to 5 s")["follower"]
    lean, nudge = follower.at(4.9, "force"), 400 * follower.at(4.9) * 1e-3
    stated = said("01", "the brake catches it at #°")
    assert_stated(stated, [float(np.degrees(follower.at(3.0, "place"))) - 3 * 360])
    assert_stated(said("01", "There the nudge is # m/s²"), [nudge])
    formula = r"K_1\lambda = #\ \mathrm{m/s^2} \quad\Rightarrow\quad \lambda = #\ "
    assert_stated(said("01", formula), [nudge, follower.at(4.9)])
    share = along_to_across(follower.y[3000] * 1e-3)
    stated = said("04", "with # N along the circle, $N\\cdot JM^{-1}J^{\\top}T$ is # per kg there")
    assert_stated(stated, [lean, share])
    assert_stated(said("04", "and $#\\cdot # = #$ m/s² was the nudge"), [share, lean, nudge])
    assert share * lean == pytest.approx(nudge, rel=0.02)  # the brake gives a little


def test_nudge_depends_on_the_place() -> None:
    places = np.radians(np.arange(-180, 180, 1.0))
    circle = RADIUS * np.stack([np.cos(places), np.sin(places)], axis=1)
    signs = np.sign([along_to_across(place) for place in circle])
    assert np.count_nonzero(np.diff(signs, append=signs[0])) == 4  # "At four places"
    earlier, later = held(3.15, **PD), held(3.16, **PD)  # one of the four lies between
    assert earlier.across[-1] * later.across[-1] < 0


def test_leaning_less_on_the_brake_helps_at_rest() -> None:
    rest = [held(WORST, 3.0, K5=gain, **PD).largest(WORST + 0.8, 9) for gain in (2.0, 10.0)]
    assert rest[0] < 0.25 * rest[1]


def test_tracker_is_torn_off_wherever_it_is_held() -> None:
    low, high = map(value, said("01", "the tracker gets to between # and # mm wherever you hold"))
    off = [held(3 + i / 8, robot="tracker").largest(3, 9) for i in range(8)]
    assert low <= min(off) <= max(off) <= high


def test_pull_across_moves_both_alike() -> None:
    both = shown("01", "Across, then along")
    stated = said("01", "The follower comes to rest # mm off the circle, the tracker # mm")
    assert_stated(stated, [both["follower"].at(2.9), both["tracker"].at(2.9)])


def test_a_path_alone_asks_for_no_speed() -> None:
    (gain,) = said("05", "says somebody, and sets K5 = #. The follower starts on the path")
    alone = play(3.0, [], K5=value(gain))["follower"]
    assert np.abs(alone.rate).max() < 1e-6 and alone.distance.max() < 1e-6


# Lesson 2


def test_hold_for_half_a_round_leaves_room_for_the_hand() -> None:
    (half,) = said("02", "Half a lap takes π/1.5 = # s.")
    (lost,) = said("02", "Every hold costs its own length and # s.")
    (begun,) = said("02", "From the start you are # s behind already.")
    for late in (-0.1, 0.0, 0.1):
        end = 2.0 + value(half) - value(lost) - value(begun) + late
        do = [Action(at=2.0, hold=True), Action(at=end, hold=False)]
        follower = play(8.0, do, speed=1.5)["follower"]
        point = 50 * np.exp(1.5j * follower.t[-1])
        assert abs(complex(*follower.y[-1]) - point) > 99


def test_near_the_path_and_far_from_the_timetable() -> None:
    follower = shown("02", "Near the path, far from the timetable")["follower"]
    point = RADIUS * 1e3 * np.exp(1j * TURN * follower.t)
    lag = np.abs(follower.y @ [1, 1j] - point)
    assert_stated(said("02", "Within a second the gap is # mm"), [float(lag[1000])])
    (most,) = said("02", "The gap swings between nearly nothing and # mm, two times.")
    assert_stated([most], [float(lag[3000:5000].max())])
    assert lag[3300:5000].min() < 0.5
    assert np.count_nonzero(np.diff(lag[3000:5000] > 50)) == 4
    assert_stated(
        said("02", "- **After.** The gap is # mm, and it stays that wide."), [float(lag[7000])]
    )
    most, after, within = said(
        "02",
        "never further than # mm from its circle. Before the hold it was at 0.00 mm, and from"
        " # s on within # mm again.",
    )
    assert_stated([most], [follower.largest(0, 8)])
    assert follower.largest(0, 3) < 0.005
    assert follower.largest(value(after), 8) <= value(within) < 2 * follower.at(value(after))


def test_tip_lets_go() -> None:
    follower = shown("02", "The tip lets go")["follower"]
    gone = np.linalg.norm(follower.y - [70, 0], axis=1)
    assert_stated(said("02", "it comes to rest # mm from where it began"), [gone[3900]])
    sentence = "comes to rest # mm from the tip but only # mm from the path"
    assert_stated(said("02", sentence), [gone[5450], follower.at(5.45)])
    assert_stated(
        said("02", "First gently: # mm. Then again, hard: # mm"), [gone[1950], gone[5450]]
    )


# Lesson 3


def test_torque_at_the_edge() -> None:
    follower = shown("03", "Pushed towards the edge")["follower"]
    peaks = [float(follower.torque[follower.during(a + 1, a + 3)].max()) for a in range(0, 15, 3)]
    assert_stated(said("03", "from one second after each move on: **#, #, #, #, # N m**"), peaks)
    for rho, peak in zip([333, 363, 383, 393], peaks, strict=False):
        assert_stated(said("03", f"| {rho} mm | # | # | # |")[2:], [peak])
    assert_stated(said("03", "| 397 mm | | | # |"), peaks[4:])  # the rest is derived
    for after in range(3, 16, 3):  # "Three seconds after each move"
        assert follower.at(after - 0.01) < 0.001


def test_what_the_circle_needs_outwards_at_its_farthest_point() -> None:
    text = "$v^2/r = #$ m/s² there. But the whole arm also turns about its base, and that alone "
    needed, turning, left = said(
        "03", text + "provides $v^2/\\rho = #$ m/s² of it. What δ has to give is about # m/s²"
    )
    squared = (TURN * RADIUS) ** 2
    for rho in (0.333, 0.383):
        assert_stated([needed, turning], [squared / RADIUS, squared / rho])
        assert_stated([left], [squared / RADIUS - squared / rho])


def test_cost_of_a_bulge() -> None:
    dear, cheap = (
        play(5.0, [Action(at=0.5, move=move)])["follower"] for move in ((5, 32, 32), (7, -32, 32))
    )
    stated = said("03", "at the upper right costs # N m, the one at the upper left #.")
    assert_stated(stated, [float(bulge.torque[3000:].max()) for bulge in (dear, cheap)])


def test_weight_that_nobody_told_of() -> None:
    both = shown("03", "A weight that nobody told them about")
    follower, tracker = both["follower"], both["tracker"]
    told = said("03", "the tracker # mm off at most, the follower #.")
    assert_stated(told, [tracker.largest(2, 5), follower.largest(2, 5)])
    told = said("03", "from 3 s to 5 s, between # and # mm/s; the tracker's only between # and #.")
    speeds = [run.speed[run.during(3, 5)] for run in (follower, tracker)]
    assert_stated(told, [float(x) for own in speeds for x in (own.min(), own.max())])
    assert_stated(said("03", "it is up to # mm off, below"), [tracker.largest(6, 12)])
    (below,) = said("03", "It came to rest #° below the right-hand end, on the circle.")
    assert follower.distance[-1] < 0.001 and abs(follower.rate[-1]) < 0.001
    assert_stated([below], [360 - float(np.degrees(follower.place[-1])) % 360])
    assert_stated(said("03", "push all the time, with # N m"), [float(follower.torque[-1])])
    leans, share = said("03", r"$0.98\,\mathrm{N}\cdot\cos #° = #$ N: there the follower stands")
    assert_stated([share], [0.98 * float(np.cos(np.radians(value(leans))))])
    assert value(leans) == pytest.approx(360 - np.degrees(follower.place[-1]) % 360, abs=0.1)
    creeps, stands = said("03", "With # kg it creeps over; with # it stands.")
    for weight, turns in ((creeps, True), (stands, False)):
        run = play(30.0, [], payload=value(weight))["follower"]
        assert (run.place[-1] > TURN) == turns


def test_weight_carried_round() -> None:
    drive, off = said("03", "K5 = # gets it round, but still # mm off.")
    run = play(8.0, [], payload=0.1, K5=value(drive))["follower"]
    assert run.speed[5000:].mean() > 250
    assert_stated([off], [run.largest(5, 8)])


# Lesson 4


def test_all_pulls_decay_alike() -> None:
    follower = shown("04", "A small pull and a large one")["follower"]
    after = (0.0, 0.1, 0.2, 0.35)
    for row, let_go in (("first", 3.5), ("second", 6.0), ("third", 11.0)):
        left = [follower.at(let_go + seconds, "across") for seconds in after]
        assert_stated(said("04", f"| {row} | # | # | # | # |"), left)
        shares = [100 * rest / left[0] for rest in left[1:]]
        assert_stated(said("04", "| share | 100 % | # % | # % | # % |"), shares)


def test_swing_is_the_same_with_and_without_the_trip() -> None:
    stated = said("04b", "It swings: #, +#, #, +#, # mm")
    follower = shown("04b", "Two things at once")["follower"]
    assert_stated(stated, [follower.at(2.0, "across"), *turning_points(follower.across[2000:])[:4]])
    (same,) = said("04b", "the two curves are the same to # mm")
    apart = {
        robot: float(np.abs(run.across[2000:3990] - run.across[6000:7990]).max())
        for robot, run in shown("04b", "Two things at once").items()
    }
    assert apart["follower"] < value(same) < apart["tracker"]


def test_any_function_that_is_zero_on_the_path_keeps_it_and_returns_in_its_own_way() -> None:
    """Zero on the same set, so the same path is kept; off it, the way back is another one."""
    jumps = [Action(at=at, set={"speed": speed}) for at, speed in ((1.0, -TURN), (2.0, 9))]
    pull = [Action(at=1.0, pull=(30.0, 0.0)), Action(at=2.0, release=True)]
    left = []
    for across in ("distance", "level_set"):
        assert play(3.0, jumps, across=across, **PD)["follower"].distance.max() < 0.01
        back = play(2.2, pull, speed=0.0, across=across, **PD)["follower"]
        left.append(back.at(2.1) / back.at(2.0))
    assert abs(left[0] - left[1]) > 0.01


def test_lab_shows_the_poles_of_the_table() -> None:
    for gains, names in ((("400", "40"), ("K1", "K2")), (("25", "10"), ("K4", "K5"))):
        table = said("04b", f"| {names[0]} = {gains[0]}, {names[1]} = {gains[1]} | #, # |")
        shown_as = channels(FiveBarParameters(task="position", **PD))[names[0] == "K4"].pole_words()
        assert [value(pole) for pole in shown_as.split(", ")] == [value(pole) for pole in table]
    fast, slow = said("04b", "| K1 = 400, K2 = 200 | #, # |")[::-1]
    sampled, exact = said(
        "04b", "a thousand times a second: # instead of #; the others are as here"
    )
    stated = channels(FiveBarParameters(K2=200, **PD))[0].pole_words().split(", ")
    assert exact == fast
    assert_stated([sampled, slow], [float(pole) for pole in stated])
    assert_stated([fast, slow], sorted(np.roots([1, 200, 400]).real))


def test_gain_and_coarse_encoders() -> None:
    both = shown("04b", "How much gain?")
    stated = said(
        "04b",
        "the follower is off by up to #, #, #, # mm; the tracker by #, #, #, #. (At # s, when",
    )
    off = [both[name].largest(a + 0.5, a + 4) for name in ("follower", "tracker") for a in STAGES]
    assert_stated(stated[:8], off)
    first, *later = off[:4]
    still = said(
        "04b", "when the second stage begins, the follower is still # mm off from the first"
    )
    assert_stated(still, [both["follower"].largest(4.0, 4.5)])
    assert_stated(said("04b", "In the first stage the follower is up to # mm off"), [first])
    assert_stated(said("04b", "with K1 = 100 it was # mm off"), [first])
    assert_stated(said("04b", "For one stage: # mm. Then # mm and # mm."), later)
    assert_stated(said("04b", "Yes: #, then #, # and # mm. Between"), [first, *later])
    assert_stated(said("04b", "The follower was #, # and # mm off."), later)


def test_what_a_step_of_the_encoder_looks_like() -> None:
    step, parameters = TURN / 500, FiveBarParameters()
    held_for = parameters.encoder_filter + 1 / parameters.control_rate
    jump = step / held_for
    stated = said("04b", "looks like a jump of # mrad in # ms, # rad/s")
    assert_stated(stated, [1e3 * step, 1e3 * held_for, jump])
    stated = said("04b", "Link 1 is # m long, so that is # m/s at the end-point")
    assert_stated(stated, [0.2, 0.2 * jump])
    for gain in (40, 200):
        (asked,) = said("04b", f"#\\ \\mathrm{{m/s^2}} & K_2 = {gain}\\")
        assert_stated([asked], [gain * 0.2 * jump])


@pytest.mark.parametrize("place", ["0", "3.14"])
def test_gain_at_rest(place: str) -> None:
    cheap: dict[str, Any] = {"encoder_counts": 1000, "observer_time": 0.0, "task": "position", **PD}
    rest = [
        play(8.0, [], target=float(place), K1=k1, K2=k2, **cheap)
        for k1, k2 in ((400, 40), (1600, 80), (2500, 200))
    ]
    off = [both["follower"].largest(4, 8) for both in rest]
    torque = [float(both["follower"].torque[4000:].max()) for both in rest]
    stated = said(
        "04b",
        f"at θ = {place}: off by | # mm | # mm | # mm | "
        "| … and torque up to | # N m | # N m | **# N m**",
    )
    assert_stated(stated, [*off, *torque])
