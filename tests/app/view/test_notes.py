"""What a form says of poles, of α, of the link's bending, of the wall and of what is drawn."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.lab.snapshots.page_snapshot import parameters_of
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.server.page_form import TURNED, PageForm
from onpath.app.view.lab_form import form_of, values_in
from onpath.app.view.notes import alpha_note, rank_note, tube_note
from onpath.app.view.poles import WARNS, poles_of
from onpath.lessons.action_schema import StepSetup
from onpath.lessons.course import NO_LESSONS
from onpath.lessons.words import ENGLISH, Words
from onpath.models.control.poles import channels
from onpath.models.control.sides import LEFT, RIGHT
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.five_bar_parameters import FiveBarParameters
from tests.support.lab import do, loop_cache, new_lab, run

BOTH = ((LEFT, "tracker"), (RIGHT, "path_following"))


@given(k1=st.floats(0, 2500), k2=st.floats(0, 200), k5=st.floats(0, 100))
def test_the_lines_warn_of_what_grows_and_the_points_are_the_poles(
    k1: float, k2: float, k5: float
) -> None:
    parameters = replace(FiveBarParameters(), K1=k1, K2=k2, K5=k5)
    found = channels(parameters)
    text, points = poles_of(parameters, ((RIGHT, "path_following"),), (), ENGLISH)
    assert [line.startswith(WARNS) for line in text.split("\n")] == [not x.stable for x in found]
    poles = [(each.name, pole) for each in found for pole in each.poles.tolist()]
    for line, (name, pole) in zip(points.split("\n"), poles, strict=True):
        channel, real, imaginary = line.split()
        assert channel == name
        assert float(real) == pytest.approx(pole.real, rel=1e-5)
        assert float(imaginary) == pytest.approx(pole.imag, rel=1e-5)


@pytest.mark.parametrize("language", ["en", "de"])
def test_poles_that_vary_along_the_path_are_those_of_a_place(language: str) -> None:
    words, lab = Words(language), new_lab(0.5)
    do(lab, c.ChooseLaw(LEFT, "contouring"), c.ChooseLaw(RIGHT, "virtual_constraint"))
    do(lab, c.ChoosePath("ellipse"), c.Set("tracker_integral", "on"))
    run(lab, 1.0)
    snapshot = take_page_snapshot(lab, 1.0)
    lines = str(values_in(snapshot, {}, (), words)["poles"]).split("\n")
    contour_across, contour_along, wire_across, wire_along = lines
    for side, line in ((LEFT, contour_across), (RIGHT, wire_along)):
        assert f"θ = {np.degrees(snapshot.places.of[side].theta) % 360:.0f}°" in line
    assert "θ" not in contour_along + wire_across
    assert words("behaviour.free") in wire_along and WARNS not in wire_along


def test_alpha_has_its_limit_which_is_computed_and_warns_beyond() -> None:
    entry = ROBOTS["flexible"]
    lab = Lab(loop_cache(), entry)
    do(lab, c.SetRunning(False), c.Set("output", "redefined"), c.Set("alpha", 0.9))
    setup = StepSetup(controls=("flexible",))
    (group,) = form_of(take_page_snapshot(lab, 1.0), setup, ENGLISH).groups
    names = [field.name for field in group.fields]
    assert names[:6] == ["output", "alpha", "alpha_note", "deflection", "pull", "larger"]
    assert {"modes", "rho", "zeta", "tip_damping"} < {*names}
    form, told = PageForm(lab.post, lambda work: work(), set()), dict[str, object]()
    link, snapshot = entry.flexible_link, take_page_snapshot(lab, 1.0)
    assert link is not None
    joints = TURNED * np.round(snapshot.joints[: link.joints] / TURNED)
    critical = link.critical_alpha(parameters_of(snapshot), joints)
    for message in form.news(snapshot, None, NO_LESSONS, ENGLISH):
        told |= getattr(message, "values", {})
    assert told["critical_alpha"] == pytest.approx(critical)
    assert f"{critical:.2f}" in str(told["alpha_note"]) and WARNS in str(told["alpha_note"])
    assert "mm" in str(told["deflection"])


@given(alpha=st.floats(-1, 1), critical=st.floats(0, 1) | st.just(math.inf) | st.none())
def test_alpha_warns_from_its_limit_on(alpha: float, critical: float | None) -> None:
    text = alpha_note(alpha, critical, 3, 0.01, ENGLISH)
    assert (WARNS in text) == (critical is not None and alpha > critical)
    assert ("3 modes, each with ζ = 0.01" in text) == (critical is not None)
    assert "nan" not in text and "inf" not in text


def test_the_wall_pushes_and_the_form_says_how_hard() -> None:
    lab = new_lab(0.5)
    assert values_in(take_page_snapshot(lab, 1.0), {}, (), ENGLISH)["wall_forces"] == ""
    do(lab, c.Set("wall", True))
    run(lab, 3.0)
    snapshot = take_page_snapshot(lab, 1.0)
    text = str(values_in(snapshot, {}, (), ENGLISH)["wall_forces"])
    assert max(snapshot.wall_forces.values()) > 0.1
    assert all(f"{force:.1f} N" in text for force in snapshot.wall_forces.values())


def test_notes_on_drawings_have_their_numbers() -> None:
    assert "straight" in tube_note(math.inf, ENGLISH, (0.01, 15.0))
    assert "50.0 mm" in tube_note(0.05, ENGLISH) and "every" not in tube_note(0.05, ENGLISH)
    assert "every 10 mm" in tube_note(0.05, ENGLISH, (0.01, 15.0))
    assert rank_note(0.123, 0.5, ENGLISH).startswith("0 … 0.123") and "α" not in rank_note(
        0.1, None, ENGLISH
    )
    assert "0,123" in rank_note(0.123, 0.5, Words("de")) and "α = 0,5" in rank_note(
        0.1, 0.5, Words("de")
    )
