"""A loop has the gains of its own law alone, so a law that is added later changes none."""

from __future__ import annotations

from dataclasses import replace

import casadi as ca
import numpy as np
import pytest

from onpath.app.exports.standalone.figure_choice import chosen
from onpath.models.closed_loop.loop_vectors import loop_layouts
from onpath.models.closed_loop.simulation import kind_of
from onpath.models.control.laws.law import ControlAction, Law, View, own_gain
from onpath.models.control.laws.path_following import followed, tangential
from onpath.models.control.laws.registry import LAWS, OWN_GAINS, add_law, law_named
from onpath.models.paths.curves import circle
from onpath.models.studies.arena import run_under
from onpath.models.studies.experiments import experiments
from onpath.models.systems.catalogue import ROBOTS


def pulled(view: View) -> ControlAction:
    across: ca.SX = -view.own_gains["added_pull"] * view.output.xi - 40 * view.output.xi_rate
    return followed(view, tangential(view), across)


ADDED = Law(
    name="added_law",
    label="Added",
    text="",
    source="",
    command=pulled,
    own_gains=(own_gain("added_pull", 300.0, "1/s²", (0, 900, 1), "pull", label="Pull"),),
)


@pytest.mark.parametrize("robot", ["five_bar", "spatial_arm"])
def test_the_settings_of_a_loop_have_the_gains_of_its_law(robot: str) -> None:
    add_law(ADDED)
    entry, curve = ROBOTS[robot], circle(0.05)
    machine, parameters = entry.make(entry.parameters()), entry.parameters()
    for name, law in LAWS.items():
        if not law.suits(machine.system):
            continue
        layouts = loop_layouts(machine.system, kind_of(name, parameters, curve))
        own = {gain.name for gain in law.own_gains}
        assert layouts.settings.slices.keys() & OWN_GAINS.keys() == own


def test_a_law_added_later_changes_no_loop() -> None:
    """A loop that has been built before takes the settings that are made afterwards."""
    experiment = experiments("five_bar")["obstruction"].with_values({"duration": 0.5})
    before = run_under(experiment, "waiting_clock")
    later = replace(
        ADDED,
        name="added_later",
        own_gains=(replace(ADDED.own_gains[0], name="later_pull"),),
    )
    add_law(later)
    after = run_under(experiment, "waiting_clock")
    assert all(np.array_equal(before.fields[name], after.fields[name]) for name in before.fields)


def test_the_laws_of_a_figure_share_one_vector() -> None:
    laws, more = ["waiting_clock", "path_following"], ["disturbance_observer"]
    figure = chosen("five_bar", laws, paths={"circle": circle(0.05)}, choices=more)
    (curve,) = figure.paths.values()
    own = {gain.name for law in (*laws, *more) for gain in law_named(law).own_gains}
    assert len(own) == 3
    layouts = [figure.kernel(law, curve).settings for law in figure.every_law]
    assert all(each == layouts[0] and own <= each.slices.keys() for each in layouts)
    vectors = [figure.settings(law, curve) for law in figure.every_law]
    assert all(np.array_equal(each, vectors[0]) for each in vectors)
