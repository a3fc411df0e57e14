"""The invitations of the first minute: each once, after the one before has been followed."""

from __future__ import annotations

import json
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest

from onpath.app.lab import commands as c
from onpath.app.lab.commands.command_codec import command_from
from onpath.app.lab.lab import Lab
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.page import first_minute
from onpath.app.page.first_minute import INVITATIONS, FirstMinute
from onpath.app.server.built_in_course import built_in_course
from tests.support.lab import do, loop_cache, new_lab, run


class Guest:
    """A browser that keeps something, and what it is shown."""

    def __init__(self, kept: str, patch: pytest.MonkeyPatch) -> None:
        self.kept = kept
        storage = SimpleNamespace(set_item=lambda key, value: setattr(self, "kept", value))

        def ask(client: Any, key: str, answer: Callable[[str], None]) -> None:
            answer(self.kept)

        patch.setattr(first_minute, "ask_item", ask)
        client: Any = SimpleNamespace(local_storage=storage)
        self.part = FirstMinute(client, "01")

    def after(self, lab: Lab, seconds: float) -> str:
        """Which invitation is shown when the lab has run for some seconds; empty: none."""
        for _ in range(round(10 * seconds) + 1):
            self.part.follow(take_page_snapshot(lab, 1.0))
            run(lab, 0.1)
        shown = self.part.shown
        return "" if shown is None else shown.name


@pytest.fixture
def guest(monkeypatch: pytest.MonkeyPatch) -> Callable[[str], Guest]:
    return lambda kept: Guest(kept, monkeypatch)


def test_a_newcomer_is_led_from_a_hold_to_a_pull_to_a_bent_path(
    guest: Callable[[str], Guest],
) -> None:
    course = built_in_course()
    lab, new = Lab(loop_cache(), course=course), guest("")
    assert new.after(lab, 0.2) == "hold"
    do(lab, c.Hold(True))
    assert new.after(lab, 0.5) == ""
    assert new.after(lab, 4.0) == "let_go"
    do(lab, c.Hold(False))
    assert new.after(lab, 0.5) == ""
    assert new.after(lab, 4.0) == "pull"
    do(lab, c.MoveHand(0.01, 0.0))
    assert new.after(lab, 0.5) == ""
    do(lab, c.Release())
    assert new.after(lab, 4.0) == "bend"
    do(lab, c.MovePoint(2, 1.2 * lab.simulation.editor.points()[2]))
    assert new.after(lab, 4.0) == "lesson"
    do(lab, c.OpenLesson(next(iter(course.lessons))))
    assert new.after(lab, 4.0) == "" and new.kept == str(len(INVITATIONS))


@pytest.mark.parametrize("kept", ["0", "", "6", "-1", "x" * 2000, "١", "2"])
def test_the_stored_number_of_invitations_is_used_if_it_is_valid(
    kept: str, guest: Callable[[str], Guest]
) -> None:
    expected = "pull" if kept == "2" else "hold"
    assert guest(kept).after(new_lab(), 4.0) == expected


def test_a_user_who_has_seen_all_invitations_is_shown_none(guest: Callable[[str], Guest]) -> None:
    assert guest(str(len(INVITATIONS))).after(new_lab(), 4.0) == ""


def test_a_reset_does_not_stop_the_invitations(guest: Callable[[str], Guest]) -> None:
    lab, again = new_lab(3.0), guest("2")
    assert again.after(lab, 1.0) == ""
    do(lab, c.Reset())
    assert again.after(lab, 4.0) == "pull"


def test_the_button_of_an_invitation_has_a_command_that_the_lab_takes(
    guest: Callable[[str], Guest],
) -> None:
    course = built_in_course()
    for number, invitation in enumerate(INVITATIONS):
        new = guest(str(number))
        new.part._lesson = next(iter(course.lessons))
        lab = new_lab(0.0)
        do(lab, c.Hold(invitation.name == "let_go"))
        assert new.after(lab, 4.0) == invitation.name
        act = new.part.shown.act if new.part.shown else None
        if act is not None:
            command_from(json.dumps(act))
        assert (act is None) == (invitation.name in ("pull", "bend"))
