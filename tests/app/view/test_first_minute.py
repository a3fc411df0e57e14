"""The invitations of the first minute: each once, after the one before has been followed."""

from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.lab import commands as c
from onpath.app.lab.commands.command_codec import command_from
from onpath.app.lab.lab import Lab
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.server.built_in_course import built_in_course
from onpath.app.view.captions import Captions
from onpath.app.view.first_minute import INVITATIONS, PAUSE, READ, FirstMinute
from onpath.app.view.narration import Narration
from onpath.lessons.words import ENGLISH
from onpath.models.control.sides import RIGHT, SIDES
from tests.support.lab import do, loop_cache, new_lab, run


class Guest:
    """A browser that keeps something, and what it is shown."""

    def __init__(self, kept: str) -> None:
        self.kept = kept
        self.part = FirstMinute("01", kept, lambda value: setattr(self, "kept", value))

    def after(self, lab: Lab, seconds: float) -> str:
        """Which invitation is shown when the lab has run for some seconds; empty: none."""
        for _ in range(round(10 * seconds) + 1):
            self.part.follow(take_page_snapshot(lab, 1.0))
            run(lab, 0.1)
        shown = self.part.shown
        return "" if shown is None else shown.name


@pytest.mark.thorough
def test_a_newcomer_is_led_from_a_hold_to_a_pull_to_a_bent_path() -> None:
    course = built_in_course()
    lab, new = Lab(loop_cache(), course=course), Guest("")
    assert new.after(lab, 0.2) == "hold"
    do(lab, c.Hold(True))
    assert new.after(lab, 0.5) == ""
    assert new.after(lab, 4.0) == "let_go"
    do(lab, c.Hold(False))
    assert new.after(lab, 0.5) == ""
    assert new.after(lab, 4.0) == "pull"
    do(lab, c.MoveHand(0.01, 0.0))
    assert new.after(lab, 0.1) == "pulled"
    assert new.after(lab, READ + PAUSE) == "pulled"  # as long as one pulls, and after it
    do(lab, c.Release())
    assert new.after(lab, READ - 0.5) == "pulled"
    assert new.after(lab, 0.8) == ""
    assert new.after(lab, PAUSE) == "bend"
    do(lab, c.MovePoint(2, 1.2 * lab.simulation.editor.points()[2]))
    assert new.after(lab, 4.0) == "lesson"
    do(lab, c.OpenLesson(next(iter(course.lessons))))
    assert new.after(lab, 4.0) == "" and new.kept == str(len(INVITATIONS))


@pytest.mark.parametrize("kept", ["0", "", "6", "-1", "x" * 2000, "١", "2"])
def test_the_stored_number_of_invitations_is_used_if_it_is_valid(kept: str) -> None:
    expected = "pull" if kept == "2" else "hold"
    assert Guest(kept).after(new_lab(), 4.0) == expected


def test_a_user_who_has_seen_all_invitations_is_shown_none() -> None:
    assert Guest(str(len(INVITATIONS))).after(new_lab(), 4.0) == ""


def test_a_reset_does_not_stop_the_invitations() -> None:
    lab, again = new_lab(3.0), Guest("2")
    assert again.after(lab, 1.0) == ""
    do(lab, c.Reset())
    assert again.after(lab, 4.0) == "pull"


def test_the_button_of_an_invitation_has_a_command_that_the_lab_takes() -> None:
    course = built_in_course()
    for number, invitation in enumerate(INVITATIONS):
        new = Guest(str(number))
        new.part._lesson = next(iter(course.lessons))
        lab = new_lab(0.0)
        do(lab, c.Hold(invitation.name == "let_go"))
        assert new.after(lab, 4.0) == invitation.name
        act = new.part.shown.act if new.part.shown else None
        if act is not None:
            command_from(json.dumps(act))
        assert (act is not None) == (invitation.name == "lesson")


@pytest.mark.thorough
@settings(max_examples=6, deadline=None)
@given(
    begun=st.floats(0.5, 6.0),
    side=st.sampled_from(SIDES),
    angle=st.floats(0, 2 * np.pi),
    far=st.floats(0.03, 0.2),
)
def test_the_explanation_of_a_pull_is_true(
    begun: float, side: str, angle: float, far: float
) -> None:
    """A hand that keeps still holds back; one that pulls outwards takes both off the path."""
    lab = new_lab(begun)
    tip = lab.simulation.runs[side].shown()["y"].copy()
    do(lab, c.Grab(side, tip))
    still = distances(lab, 3.0)
    assert still[:, 1].max() < 4e-3 and still[:, 0].max() > 15e-3
    assert abs(take_page_snapshot(lab, 1.0).robots[RIGHT].speed) < 2e-3  # it waits
    do(lab, c.Release(), c.Reset())
    run(lab, begun)
    frame = lab.simulation.robot.frame
    outside = (0.05 + far) * np.array([np.cos(angle), np.sin(angle)])
    do(lab, c.Grab(side, frame.lift(outside)))
    assert (distances(lab, 3.0).max(axis=0) > 5e-3).all()
    do(lab, c.Release())
    run(lab, 1.5)
    assert distances(lab, 0.1).max() < 2e-3


def distances(lab: Lab, seconds: float) -> np.ndarray:
    """How far the robots are from the path, from the left, every tenth of a second, [m]."""
    found = list[list[float]]()
    for _ in range(round(10 * seconds)):
        run(lab, 0.1)
        found.append([each.distance for each in take_page_snapshot(lab, 1.0).robots.values()])
    return np.array(found)


def test_a_newcomer_reads_nothing_of_integral_action() -> None:
    lab, captions = new_lab(1.0), Captions(ENGLISH)
    do(lab, c.Grab(RIGHT, lab.simulation.robot.frame.lift(np.array([0.1, 0.0]))))
    run(lab, 3.0)
    snapshot = take_page_snapshot(lab, 1.0)
    assert "integral" in captions.follow(snapshot)[RIGHT]
    quiet = {"speaks": False, "sounds": False}
    for kept in range(len(INVITATIONS) + 1):
        narration = Narration(ENGLISH, quiet, captions, Guest(str(kept)).part)
        narration.follow(snapshot)
        is_over = kept == len(INVITATIONS)
        assert ("integral" in captions.follow(snapshot)[RIGHT]) == is_over
