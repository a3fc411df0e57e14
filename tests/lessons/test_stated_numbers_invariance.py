"""What lesson 5 and the READMEs tell in numbers of the rigid robot, replayed every millisecond."""

from __future__ import annotations

from functools import cache

import casadi as ca
import numpy as np
import pytest

from onpath.models.arrays import Array
from onpath.models.studies.experiments import experiments, run
from tests.support.one_robot import (
    FAST,
    FOLLOWER,
    LENGTH,
    TRACKER,
    Driven,
    at,
    held_at,
    largest,
    most_and_rest,
)
from tests.support.stated_numbers import assert_stated, said, stated_in_readme, value

pytestmark = pytest.mark.thorough

LESSON = "05"


# Commands do not take it off ----------------------------------------------------------------------


@cache
def reversed_at_2_s(law: str, speed: float, k5: float = 10.0) -> Driven:
    return Driven(law, speed=speed, K5=k5).run(2.0).set(speed=-speed).run(4.0)


@cache
def jumps(law: str) -> list[float]:
    """Largest distances: from the start, and after the jumps at 2, 4, 6 and 8 s."""
    robot = Driven(law, speed=FAST).run(2.0)
    for begin, speed in ((2.0, -FAST), (4.0, 0.0), (6.0, 12.0), (8.0, -12.0)):
        robot.set(speed=speed).run(begin + 2)
    return [largest(robot.distance, begin, begin + 2) for begin in (0.0, 2.0, 4.0, 6.0, 8.0)]


def test_reversals() -> None:
    follower = [reversed_at_2_s(FOLLOWER, v).distance.max() for v in (FAST, 12.0)]
    tracker = [largest(reversed_at_2_s(TRACKER, v).distance, 2, 4) for v in (FAST, 12.0)]
    texts = said(
        LESSON,
        "A reversal at full speed throws the tracker # mm off the circle."
        " From # to # rad/s it is # mm. The follower is at most # mm off in both.",
    )
    assert_stated(texts, [tracker[0], 12, -12, tracker[1], max(follower)])


def test_four_jumps() -> None:
    start, *tracker = jumps(TRACKER)
    assert_stated(said(LESSON, "with the tracker: #, #, # and # mm."), tracker)
    texts = said(LESSON, "at every jump: by # mm at 2 s, # mm at 4 s, # mm at 6 s and # mm at 8 s.")
    assert_stated(texts, tracker)
    assert_stated(said(LESSON, "even at the very start, by # mm"), [start])
    assert_stated(said(LESSON, "Yes: # mm, and that little"), [max(jumps(FOLLOWER))])


def test_a_reversal_takes_half_a_second_and_a_harder_k5_takes_nothing_off_the_path() -> None:
    said(LESSON, "After *Reverse* it needs about half a second")
    rate = reversed_at_2_s(FOLLOWER, FAST).log("theta_rate")[:, 0]
    assert 0.4 < 1e-3 * int(np.argmax(rate < -0.98 * FAST)) - 2 < 0.6
    k5, within = said(
        LESSON,
        "with K5 = #, ten times as hard, a full reversal still leaves the follower within # mm.",
    )
    robot = reversed_at_2_s(FOLLOWER, FAST, value(k5))
    assert_stated([within], [robot.distance.max()])


# A velocity across --------------------------------------------------------------------------------


@cache
def snatched(law: str) -> Driven:
    """Pulled outwards, then inwards, and let go where it crosses the circle."""
    robot = Driven(law, speed=0.0, K3=0.0).run(0.2).pull(40, 0).run(1.0).pull(-100, 0)
    return robot.run(1.05).let_go().run(2.0)


def test_the_hand_lets_go_at_585_mm_s_just_past_the_circle() -> None:
    robot = Driven(FOLLOWER, speed=0.0, K3=0.0).run(0.2).pull(40, 0).run(1.0)
    robot.pull(-100, 0).run(1.05)
    plant = robot.robot.plant(robot.parameters)
    with_rate = robot.robot.system.with_rate(robot.robot.system.output)
    y, rate = (np.array(part).ravel() for part in with_rate(robot.q, robot.v, plant))
    speed = 1e3 * abs(rate @ y) / np.linalg.norm(y)
    (stated,) = said(LESSON, "The velocity is # mm/s, straight across the circle.")
    assert speed == pytest.approx(value(stated), abs=2.5)
    assert stated == said(LESSON, "you expected the controller to stop # mm/s in no time.")[0]
    texts = said(
        LESSON,
        "For your # mm/s it is # mm. You have seen #, because the hand let go # mm after the "
        "circle.",
    )
    peak, past = largest(snatched(FOLLOWER).distance, 1.06, 2), float(50 - 1e3 * np.linalg.norm(y))
    assert_stated(texts, [value(stated), value(stated) / (20 * float(np.e)), peak, past])
    assert past > 0


def test_both_robots_swing_through_and_come_back() -> None:
    pulled, begin = said(LESSON, "distance to the circle: # mm from # s to 1 s, zero at 1.05 s")
    for law in (FOLLOWER, TRACKER):
        reached = snatched(law).distance[round(1e3 * value(begin)) : 1000]
        assert np.abs(reached - value(pulled)).max() < 0.5
    texts = said(
        LESSON,
        "50 ms later it is # mm off on the other side. Then it turns round, and after"
        " another 0.3 s less than # mm are left.",
    )
    distance = snatched(FOLLOWER).distance
    assert_stated(texts[:1], [at(distance, 1.1)])
    assert largest(distance, 1.4, 2) < value(texts[1]) < 2 * at(distance, 1.4)
    both = [largest(snatched(law).distance, 1.06, 2) for law in (FOLLOWER, TRACKER)]
    assert_stated(said(LESSON, "The two robots do nearly the same here, # and # mm."), both)
    (through,) = said(LESSON, "It goes through: v₀/(20 e) gives # mm on the other side")
    assert_stated([through], [100 / (20 * np.e)])


def test_the_paper_s_first_experiment() -> None:
    logs = dict[str, Driven]()
    for law in (FOLLOWER, TRACKER):
        robot = Driven(law, task="position", target=-1.05, K3=0.0).run(2.0).pull(-15, 26).run(4.0)
        logs[law] = robot.let_go().set(target=1.57).run(7.0)
    (inside,) = said(LESSON, "first brings both end-points # mm into the circle")
    assert_stated([inside], [at(logs[FOLLOWER].distance, 3.999)])
    texts = said(LESSON, "It is # mm off after 0.2 s, # mm after 0.4 s, and by then")
    assert_stated(texts, [at(logs[FOLLOWER].distance, t) for t in (4.2, 4.4)])
    stated = said(LESSON, "after 0.4 s, when it was # mm off, more than half of the way along")
    assert stated == texts[1:]
    assert said(LESSON, "it is the quicker one: after 0.2 s it was # mm off") == texts[:1]
    (near,) = said(LESSON, "Across it was within # mm after 0.2 s, whatever it did along")
    assert at(logs[FOLLOWER].distance, 4.2) < value(near)
    place = logs[FOLLOWER].log("theta")[:, 0]
    assert at(place, 4.4) - at(place, 4.0) > (1.57 - at(place, 4.0)) / 2
    top = np.array([0.0, 0.05])
    sentences = (
        (FOLLOWER, "slower and slower, and is there after about # s."),
        (TRACKER, "The tracker gets to the top as well, after # s"),
    )
    for law, sentence in sentences:
        away = np.linalg.norm(logs[law].log("y") - top, axis=1)
        arrived = 1e-3 * int(np.flatnonzero(away > 1e-3)[-1]) - 4
        assert arrived == pytest.approx(value(said(LESSON, sentence)[0]), abs=0.15)


# Forces do ----------------------------------------------------------------------------------------


def mobility(robot: Driven, q: Array) -> Array:
    """J M^-1 J^T, (2, 2), [1/kg]."""
    s = robot.robot.system
    jacobian = ca.jacobian(s.output, s.q)
    matrix = jacobian @ ca.solve(s.mass, jacobian.T)
    function = ca.Function("mobility", [s.q, s.v, s.parameters], [matrix])
    return function(q, 0 * q, robot.robot.plant(robot.parameters)).full()


def frame(degrees: float) -> tuple[Array, Array]:
    """Unit vectors of the circle at a place: tangent, and outwards."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([-s, c]), np.array([c, s])


@pytest.mark.parametrize("degrees", range(0, 360, 60))
def test_a_force_adds_to_the_acceleration_across_what_the_formula_says(degrees: int) -> None:
    """xi_1 by brute force, its second difference with and without F, under the same torque."""
    robot, h = Driven(), 1e-4
    s, plant = robot.robot.system, robot.robot.plant(robot.parameters)
    rng = np.random.default_rng(degrees)
    q, v = robot.robot.rest(0.05 * frame(degrees)[1]), rng.normal(size=2)
    u, force = rng.normal(size=2), rng.normal(size=2)
    acceleration = ca.Function("a", [s.q, s.v, s.tau, s.parameters], [s.acceleration])
    jacobian = ca.Function("j", [s.q, s.parameters], [ca.jacobian(s.output, s.q)])(q, plant)
    pushed = u + np.array(jacobian).T @ force

    def second_rate(tau: Array) -> float:
        """Of the distance outwards, of a motion with the acceleration of this instant."""
        a = np.array(acceleration(q, v, tau, plant)).ravel()
        ways = [q + t * v + t**2 / 2 * a for t in (-h, 0.0, h)]
        before, now, after = (np.linalg.norm(robot.robot.endpoint(way)) for way in ways)
        return float(before - 2 * now + after) / h**2

    added = second_rate(pushed) - second_rate(u)
    assert added == pytest.approx(frame(degrees)[1] @ mobility(robot, q) @ force, abs=1e-5)


@pytest.mark.parametrize("degrees", range(0, 360, 45))
def test_at_rest_against_the_brake_the_spring_across_stands_against_that(degrees: int) -> None:
    """Within 2.5 %: looking half a tick ahead, it foresees a motion that the brake forbids."""
    robot = held_at(degrees, K3=0.0)
    y, xi, force = (robot.log(name)[-1] for name in ("y", "xi", "force"))
    assert np.abs(robot.v).max() < 1e-3
    side = np.sign(xi[0] * (np.linalg.norm(y) - 0.05))  # N points to where xi_1 > 0
    across = side * y / np.linalg.norm(y) @ mobility(robot, robot.q) @ force
    assert 400 * xi[0] == pytest.approx(across, rel=0.025)


def test_the_effective_mass_is_larger_sideways() -> None:
    texts = said(
        LESSON,
        "At #°, for instance, its *effective mass* (the green ellipse) is # kg sideways and #",
    )
    robot = Driven()
    q = robot.robot.rest(0.05 * frame(value(texts[0]))[1])
    masses = 1 / np.diag(mobility(robot, q))
    assert_stated(texts[1:], masses.tolist())


def test_at_four_places_a_push_along_the_path_gives_nothing_across() -> None:
    robot, degrees = Driven(), np.arange(0, 360, 0.25)
    nudge = list[float]()
    for each in degrees:
        tangent, outwards = frame(each)
        nudge.append(float(outwards @ mobility(robot, robot.robot.rest(0.05 * outwards)) @ tangent))
    signs = np.sign(nudge)
    places = degrees[np.flatnonzero(signs != np.roll(signs, 1))]
    texts = said(
        LESSON, "(the axes of the ellipse, the *principal directions*): near #°, #°, #° and #°."
    )
    assert len(places) == 4
    assert np.abs(places - [value(text) for text in texts]).max() < 1
    (near,) = said(LESSON, "with the usual gains less than # mm at those four places")
    assert max(most_and_rest(value(text))[0] for text in texts) < value(near)


def test_round_the_circle() -> None:
    follower = [most_and_rest(degrees) for degrees in range(0, 360, 6)]
    most, _ = (max(column) for column in zip(*follower, strict=True))
    assert_stated(said(LESSON, "at those four places and # mm at the worst one."), [most])
    assert_stated(said("06", "it swings out by at most # mm and is then back"), [most])
    assert_stated(said("01", "makes it swing out, by up to # mm."), [most])
    tracker = [most_and_rest(degrees, TRACKER)[0] for degrees in range(0, 360, 12)]
    texts = stated_in_readme("the place: # to # mm for the follower, # to # mm for the tracker.")
    assert_stated(texts, [min(follower)[0], most, min(tracker), max(tracker)])


@cache
def let_go_again(degrees: int) -> tuple[float, float, float, float]:
    """Largest distances from 0.5 s of a hold on, at the end of its 2 s, after it, and 1 s later."""
    begin = held_at(degrees).time - LENGTH
    robot = Driven(speed=FAST).run(begin).hold().run(begin + 2.0).let_go().run(begin + 4.0)
    off = robot.distance[round(1e3 * begin) :]
    return largest(off, 0.5, 2), at(off, 1.999), largest(off, 2, 4), largest(off, 3, 4)


def test_the_integral_brings_it_back_to_the_path_against_the_brake() -> None:
    """Each place within the stated number, and the worst one not far below it."""
    told = said(
        LESSON,
        "Half a second after the catch the follower is at most # mm off, after two seconds # mm",
    ) + said(
        LESSON, "That takes the follower up to # mm off, and at most # mm are left after one second"
    )
    worst = [max(each) for each in zip(*map(let_go_again, range(0, 360, 6)), strict=True)]
    for text, measured in zip(told, worst, strict=True):
        assert value(text) / 2 < measured <= value(text)
    within = said("06", "is then back within # mm of the circle")[0]
    later = said("06", "the follower gets up to # mm off, and within # mm after")
    assert [within, *later] == told[1:]
    asked = said("06", "Once let go, the follower gets up to # mm off: that is what")
    assert asked == later[:1]
    assert said("01", "after two seconds of holding it is within # mm of the circle") == [within]
    readme = "the follower ends within # mm of the circle,"
    assert stated_in_readme(readme) == [within]
    readme = "when let go, it is up to # mm off, and within # mm after one second."
    assert stated_in_readme(readme) == told[2:]


def test_without_k5_the_follower_stays_where_it_starts() -> None:
    robot = Driven(FOLLOWER, speed=FAST, K5=0.0).run(3.0)
    assert abs(robot.place) < 1e-9 and robot.distance.max() < 1e-9


def test_round_the_circle_as_lesson_1_tells_it() -> None:
    round_the_circle = [most_and_rest(degrees, K3=0.0) for degrees in range(0, 360, 6)]
    stated = [max(column) for column in zip(*round_the_circle, strict=True)][::-1]
    told = said(
        LESSON, "come to rest less than # mm off at the four places, and # mm off at the worst one"
    )
    for (near,) in (said("01", "the follower comes to rest within # mm of it"), told[:1]):
        assert max(most_and_rest(place, K3=0.0)[1] for place in (22, 113, 173, 243)) < value(near)
    assert_stated(told[1:], stated[:1])
    sentence = "it comes to rest # mm off, and as the brake catches it, it even swings out to # mm"
    assert_stated(said("01", sentence), stated)


def test_the_readme_s_experiment() -> None:
    texts = stated_in_readme(
        "held back from # to # s, the follower is never further than # mm from the circle and the"
        " tracker # mm. These values hold for the places of the robots at # s;"
    )
    chosen = experiments()["obstruction"]
    most = [1e3 * float(run(chosen, who).distance.max()) for who in (FOLLOWER, TRACKER)]
    begin, end = chosen.schedule.hold_from, chosen.schedule.hold_to
    assert_stated(texts, [begin, end, *most, begin])


@pytest.mark.parametrize("degrees", range(30, 360, 60))
def test_what_the_hint_says_of_k5_and_k1(degrees: int) -> None:
    said(
        LESSON,
        "At a given place, K5 = 2 instead of 10 takes only a quarter off it,",
    )
    said(LESSON, "Four times K1 more than halves it.")
    most = most_and_rest(degrees)[0]
    softer, stiffer = most_and_rest(degrees, K5=2.0), most_and_rest(degrees, K1=1600.0, K2=80.0)
    assert softer[0] / most == pytest.approx(3 / 4, abs=0.06)
    assert stiffer[0] / most < 1 / 2


def test_a_softer_k5_costs_time_afterwards() -> None:
    slow, quick, percent = said(
        LESSON, "and the follower then needs # s instead of # s to # % of its speed."
    )
    for k5, stated in ((2.0, slow), (10.0, quick)):
        robot = Driven(speed=FAST, K5=k5).run(3.0).hold().run(5.2).let_go().run(8.2)
        rate = robot.log("theta_rate")[5200:, 0]
        assert_stated([stated], [1e-3 * int(np.argmax(rate > value(percent) / 100 * FAST))])
