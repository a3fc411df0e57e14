"""Every law of the menu runs on drawings, from their beginning to their end."""

from __future__ import annotations

import numpy as np
import pytest

from onpath.app.lab.loops.law_changes import suits
from onpath.models.control.laws.registry import LAWS
from onpath.models.paths.spline_fit import spline_through
from onpath.models.studies.arena import run_under
from onpath.models.studies.experiments import on_path
from onpath.models.systems.catalogue import ROBOTS
from tests.support.cases import drawn

PAIRS = [
    (name, law)
    for name, entry in ROBOTS.items()
    for law in LAWS
    if suits(law, entry.make(entry.parameters()), entry.parameters())
]
LOOSE = {"set_point": 20e-3, "contouring": 3e-3}  # [m], what they give up between their points
SOFT = {"rod_gantry": 1e-3}  # [m], and this robot


@pytest.mark.parametrize("closed", [True, False])
@pytest.mark.parametrize(("name", "law"), [*drawn(PAIRS, 6), ("five_bar", "maneuvering")])
def test_each_law_follows_a_drawing_from_its_beginning(name: str, law: str, closed: bool) -> None:
    entry, rng = ROBOTS[name], np.random.default_rng(len(law) + len(name))
    parameters = entry.parameters()
    robot = entry.make(parameters)
    strokes = [0.7 * robot.radius * rng.uniform(-1, 1, (4, 2)) for _ in range(1 if closed else 2)]
    experiment = on_path(entry, parameters, spline_through(strokes, closed))
    found = run_under(experiment.with_values({"duration": 1.5}), law)
    assert found.stopped_at is None
    assert found.distance.max() < LOOSE.get(law, SOFT.get(name, 5e-4))
