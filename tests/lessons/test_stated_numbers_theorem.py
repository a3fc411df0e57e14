"""What lesson 7b tells in numbers of the crossing and the hovercraft."""

from __future__ import annotations

import math

import numpy as np
import pytest

import onpath
from onpath.models.paths.path_design import presets
from onpath.models.systems.hovercraft import MASS, PLACES, hovercraft
from tests.support.stated_numbers import assert_stated, numbers, said, shown, text

pytestmark = pytest.mark.thorough

LESSON = "07b"
D, RADIUS, PACE = PLACES["front"], 0.05, 2.0  # [m], [m], [rad/s]


def test_when_the_hand_lets_go_the_pen_is_on_the_other_strand() -> None:
    motion = shown(LESSON, "On the wrong strand")["follower"]
    curve = presets()["figure of eight"].curve
    points = 1e3 * np.array([curve.at(place) for place in np.linspace(0, 2 * np.pi, 4001)])
    end = motion.y[motion.during(2.998, 3.0)][-1]
    assert np.linalg.norm(points - end, axis=1).min() < 0.5
    assert_stated(said(LESSON, "about # cm from the middle"), [float(np.linalg.norm(end)) / 10])
    assert motion.largest(5.0, 6.0) < 0.5  # it is back, and goes on
    assert motion.place[-1] > motion.place[motion.during(2.4, 2.41)][0] + 2.0


@pytest.mark.parametrize(
    ("pen", "sentence"),
    [("front", "the nose points #° further inwards"), ("behind", "the nose pointed #° away")],
)
def test_where_the_nose_points_after_some_laps(pen: str, sentence: str) -> None:
    run = onpath.simulate("hovercraft", "circle", duration=16.0, pen=pen, drag=0.5)
    travel = np.diff(hovercraft(pen).endpoint(run.q), axis=0)[-1]
    nose = np.array([math.cos(run.q[-1, 2]), math.sin(run.q[-1, 2])])
    angle = math.acos(travel @ nose / np.linalg.norm(travel))
    assert_stated(said(LESSON, sentence), [math.degrees(angle)])
    inwards = np.array([-travel[1], travel[0]]) @ nose
    assert (inwards > 0) == (pen == "front")


def test_at_which_drag_the_nose_points_along_the_path() -> None:
    run = onpath.simulate("hovercraft", "circle", duration=16.0, pen="front", drag=0.83)
    travel = np.diff(hovercraft("front").endpoint(run.q), axis=0)[-1]
    nose = np.array([math.cos(run.q[-1, 2]), math.sin(run.q[-1, 2])])
    assert math.acos(travel @ nose / np.linalg.norm(travel)) < math.radians(1)
    assert_stated(said(LESSON, "a drag of # N s/m. Try it"), [MASS * RADIUS * PACE / D])


def test_from_a_certain_drag_on_the_heading_cannot_keep_up() -> None:
    """The steady turn needs (c/m) d Ω, and the pendulum pulls with at most R Ω (Ω² + (c/m)²)^½."""
    (told,) = numbers(text(LESSON).partition(r"\sqrt{d^2 - R^2} = ")[2][:2])
    limit = RADIUS * PACE / math.sqrt(D**2 - RADIUS**2)
    assert abs(told - limit) < 0.05
    turns = []
    for drag in (0.95 * limit * MASS, 1.1 * limit * MASS):
        run = onpath.simulate("hovercraft", "circle", duration=30.0, pen="front", drag=drag)
        late = run.t > 15.0
        turns.append(abs(float(np.ptp(run.q[late, 2] - PACE * run.t[late]))) / (2 * math.pi))
    assert turns[0] < 0.05 < 0.9 < turns[1]
