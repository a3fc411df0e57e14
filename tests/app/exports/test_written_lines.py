"""The picture of what both robots have written."""

from __future__ import annotations

import io

import numpy as np
import pytest
from PIL import Image

from onpath.app.exports.files import lines_file
from onpath.app.exports.replay import replay
from onpath.app.exports.written_lines import REACHED, written_figure
from onpath.app.lab import commands as c
from onpath.lessons.words import Words
from onpath.models.control.sides import SIDES
from onpath.models.paths.spline_curves import SplineCurve
from tests.support.lab import FRAME, do, new_lab

T = np.linspace(0, 1, 400)
WORD = np.stack(
    [
        -0.06 + 0.12 * T + 0.012 * np.sin(10 * np.pi * T),
        -0.02 * np.cos(10 * np.pi * T) * (1 + 0.5 * np.sin(4 * np.pi * T)),
    ],
    axis=-1,
)
"""A joined-up word of five loops, [m]."""


@pytest.mark.thorough
def test_a_name_is_written_twice_and_the_pen_returns_unseen() -> None:
    lab = new_lab()
    simulation = lab.simulation
    do(lab, c.ChoosePath("ellipse"), c.DrawPath(WORD))
    curve = simulation.editor.design.curve
    assert isinstance(curve, SplineCurve) and curve.closed and len(curve.raised) == 1
    for held in (False, True, False):
        do(lab, c.Hold(held))
        for _ in range(round(2.4 / FRAME)):
            lab.advance(FRAME)

    machine, segments = simulation.robot, simulation.history.all()
    segments = [each for each in segments if each.curve is segments[-1].curve]
    runs = replay(machine, segments)
    figure = written_figure(runs, machine.frame, curve, Words("en"))
    titles = ["Trajectory tracking", "Path following"]
    assert [axis.get_title() for axis in figure.axes] == titles
    for axis, side in zip(figure.axes, SIDES, strict=True):
        wanted, written, rings = (np.array(line.get_xydata()) / 1e3 for line in axis.lines)
        (run,) = runs[side]
        begin = int((run.distance < REACHED).argmax())
        down = curve.draws(run.fields["theta"][begin:, 0])
        assert 0.5 < down.mean() < 1  # it went round at least once, and back with the pen raised
        assert np.array_equal(np.isnan(written[:, 0]), ~down)
        np.testing.assert_allclose(written[down], run.fields["y"][begin:][down], atol=1e-12)
        assert np.isnan(wanted).any() and len(rings) == 1
        caught = int(run.held.argmax())
        np.testing.assert_allclose(rings[0], run.fields["y"][caught], atol=1e-12)

    content = lines_file(
        simulation.entry.name, simulation.parameters, simulation.history.copy(), "de"
    )
    assert Image.open(io.BytesIO(content)).format == "PNG"
