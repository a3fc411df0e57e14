"""What is said over each robot is what a run of the lab shows."""

from __future__ import annotations

import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.view.captions import Captions, spoken
from onpath.lessons.words import ENGLISH
from onpath.models.systems.catalogue import ROBOTS
from tests.support.lab import FOLLOWER, TRACKER, do, new_lab, run


def seen(lab: Lab, captions: Captions, seconds: float) -> dict[str, str]:
    """The captions at the end of some seconds, shown ten times a second."""
    said = captions.follow(take_page_snapshot(lab, 1.0))
    for _ in range(round(10 * seconds)):
        run(lab, 0.1)
        said = captions.follow(take_page_snapshot(lab, 1.0))
    return said


def number(caption: str) -> float:
    found = re.search(r"([\d.]+) mm", caption)
    assert found is not None, caption
    return float(found[1])


def test_what_a_hold_does_is_said_of_the_law_that_has_a_clock_and_of_the_one_without() -> None:
    lab, captions = new_lab(1.0), Captions(ENGLISH)
    assert seen(lab, captions, 0.5) == {TRACKER: "", FOLLOWER: ""}
    do(lab, c.Hold(True))
    held = seen(lab, captions, 2.0)
    most = {side: round(1e3 * run.max_distance) for side, run in lab.simulation.runs.items()}
    assert held[TRACKER] == f"torn off: up to {most[TRACKER]} mm" and most[TRACKER] > 40
    assert held[FOLLOWER].startswith("waits: ") and 0 < number(held[FOLLOWER]) <= 5
    do(lab, c.Hold(False))
    assert seen(lab, captions, 4.0) == {TRACKER: "", FOLLOWER: ""}


def test_captions_follow_the_law_not_the_side() -> None:
    lab, captions = new_lab(), Captions(ENGLISH)
    lab.simulation.change_law(TRACKER, "path_following")
    run(lab, 1.0)
    do(lab, c.Hold(True))
    held = seen(lab, captions, 1.0)
    assert all(caption.startswith("waits: ") for caption in held.values()), held


def test_a_distance_that_is_none_is_written_without_decimals() -> None:
    lab, captions = new_lab(), Captions(ENGLISH)
    do(lab, c.Set("speed", 0.0))
    run(lab, 0.5)
    do(lab, c.Hold(True))
    held = seen(lab, captions, 0.2)
    assert [caption.partition(" mm")[0].split()[-1] for caption in held.values()] == ["0", "0"]


def test_a_second_hold_is_measured_anew() -> None:
    lab, captions = new_lab(1.0), Captions(ENGLISH)
    do(lab, c.Hold(True))
    seen(lab, captions, 2.0)
    do(lab, c.Hold(False))
    seen(lab, captions, 4.0)
    do(lab, c.Hold(True))
    assert number(captions.follow(take_page_snapshot(lab, 1.0))[TRACKER]) < 5


def test_only_the_robot_that_is_held_back_is_said_to_be() -> None:
    lab, captions = new_lab(1.0), Captions(ENGLISH)
    do(lab, c.Set("copy", False), c.Hold(True, FOLLOWER))
    said = seen(lab, captions, 1.0)
    assert said[TRACKER] == "" and said[FOLLOWER].startswith("waits")


def test_a_stopped_robot_is_said_to_be_stopped() -> None:
    lab, captions = new_lab(0.5), Captions(ENGLISH)
    lab.simulation.runs[FOLLOWER].fields()["v"][:] = 500.0
    run(lab, 0.5)
    assert captions.follow(take_page_snapshot(lab, 1.0))[FOLLOWER] == "stopped"


def test_nothing_is_spoken_of_robots_that_have_no_caption() -> None:
    titles = {TRACKER: "One", FOLLOWER: "Other"}
    assert spoken({TRACKER: "", FOLLOWER: "waits: 2 mm"}, titles, ENGLISH) == "Other: waits: 2 mm."
    assert spoken({TRACKER: "", FOLLOWER: ""}, titles, ENGLISH) == ""


@pytest.mark.parametrize("side", [TRACKER, FOLLOWER])
def test_a_pull_is_said_and_ends(side: str) -> None:
    lab, captions = new_lab(1.0), Captions(ENGLISH)
    do(lab, *[c.MoveHand(0.01, 0.0)] * 3)
    said = seen(lab, captions, 0.5)
    assert said[side].startswith("pulled: ")
    do(lab, c.Release())
    assert not seen(lab, captions, 3.0)[side]


def test_a_newcomer_is_told_of_a_pull_but_not_of_integral_action() -> None:
    lab, captions, brief = new_lab(1.0), Captions(ENGLISH), Captions(ENGLISH)
    brief.brief = True
    do(lab, *[c.MoveHand(0.0, 0.02)] * 4)
    told = set[bool]()
    for _ in range(20):
        run(lab, 0.1)
        shown = take_page_snapshot(lab, 1.0)
        whole, first = captions.follow(shown)[FOLLOWER], brief.follow(shown)[FOLLOWER]
        assert first == whole.partition(", its integral")[0]
        told.add(first != whole)
    assert told == {False, True}


def test_the_end_of_an_open_path_is_said_and_not_that_of_a_closed_one() -> None:
    lab, captions = new_lab(1.0), Captions(ENGLISH)
    do(lab, c.ChoosePath("segment"))
    assert all("at the end" in said for said in seen(lab, captions, 6.0).values())
    do(lab, c.ChoosePath("circle"), c.Set("speed", 0.0))
    assert seen(lab, captions, 6.0) == {TRACKER: "", FOLLOWER: ""}


@settings(max_examples=3)
@given(robot=st.sampled_from(list(ROBOTS)))
def test_a_closed_path_has_no_end_at_which_a_robot_could_rest(robot: str) -> None:
    """Its first and last points may differ by rounding."""
    lab, captions = new_lab(), Captions(ENGLISH)
    do(lab, c.ChooseRobot(robot), c.Set("speed", 0.0))
    do(lab, c.Set("start_theta", 3.1415), c.Reset())
    assert take_page_snapshot(lab, 1.0).path.curve.closed
    assert seen(lab, captions, 0.3) == {TRACKER: "", FOLLOWER: ""}
