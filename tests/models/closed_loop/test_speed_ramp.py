"""The speed reference that changes at a limited rate, with the feedforward of (19)."""

from __future__ import annotations

import numpy as np
import pytest

from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.paths.curves import circle, segment
from tests.support.rig import FOLLOWING, TRACKING, Rig

BOTH = pytest.mark.parametrize("kind", [FOLLOWING, TRACKING], ids=lambda kind: kind.law)
CIRCLE = circle(0.05)


@BOTH
@pytest.mark.parametrize("ramp", [3.0, 30.0])
def test_from_rest_the_motion_is_that_of_the_ramp(rig: Rig, kind: Kind, ramp: float) -> None:
    wanted = 6.0
    log = rig.run(kind, CIRCLE, rig.on_path(kind, CIRCLE, 0.0, 0.0), 3000, speed=wanted, ramp=ramp)
    t = 1e-3 * np.arange(3000)
    speed = np.minimum(ramp * t, wanted)
    place = np.where(t < wanted / ramp, ramp * t**2 / 2, wanted * t - wanted**2 / (2 * ramp))
    assert log["speed_ref"][:, 0] == pytest.approx(speed, abs=1e-9)
    assert log["theta_rate"][:, 0] == pytest.approx(speed, abs=6e-3)
    assert log["theta"][:, 0] == pytest.approx(place, abs=2e-3)
    assert CIRCLE.nearest(log["y"])[1].max() < 2e-6


def test_a_ramp_removes_the_start_up_error_of_the_tracker(rig: Rig) -> None:
    """At rest on the path, a reference that moves at once is an error; a ramp is none."""
    start = rig.on_path(TRACKING, CIRCLE, 0.0, 0.0)
    at_once, ramped = (
        CIRCLE.nearest(rig.run(TRACKING, CIRCLE, start, 2000, ramp=ramp)["y"])[1].max()
        for ramp in (0, 20)
    )
    assert at_once > 2e-3 > 1000 * ramped


def test_without_the_feedforward_the_speed_lags(rig: Rig) -> None:
    """(19) without its second term follows a ramp with the lasting error ramp / K5."""
    start = rig.on_path(FOLLOWING, CIRCLE, 0.0, 0.0)
    changes = {"speed": 12.0, "ramp": 4.0, "K5": 10.0}
    log = rig.run(FOLLOWING, CIRCLE, start, 2000, **changes)
    settings, lagging = rig.settings(FOLLOWING, **changes | {"ramp": 0}), [start]
    layout, speeds = rig.kernel(FOLLOWING).settings, list[float]()
    for tick in range(2000):  # the same reference as a staircase, whose steps have no rate
        layout.unpack(settings)["speed"][:] = 4e-3 * tick
        state, row = rig.loop(FOLLOWING).run(lagging[-1], settings, CIRCLE.table(), 1)
        lagging.append(state)
        speeds.append(float(rig.kernel(FOLLOWING).log.unpack(row)["theta_rate"][0, 0]))
    assert 8.0 - speeds[-1] == pytest.approx(4.0 / 10.0, rel=0.02)
    assert abs(8.0 - log["theta_rate"][-1, 0]) < 0.01


@BOTH
def test_a_ramp_that_is_switched_on_begins_at_the_current_speed(rig: Rig, kind: Kind) -> None:
    start = rig.on_path(kind, CIRCLE, 0.0, 0.0)
    loop = rig.loop(kind)
    state, _ = loop.run(start, rig.settings(kind, speed=6.0), CIRCLE.table(), 1500)
    settings = rig.settings(kind, speed=-6.0, ramp=8.0)
    log = rig.kernel(kind).log.unpack(loop.run(state, settings, CIRCLE.table(), 2000)[1])
    expected = np.maximum(6.0 - 8e-3 * np.arange(2000), -6.0)
    assert log["speed_ref"][:, 0] == pytest.approx(expected, abs=1e-9)
    assert log["theta_rate"][:, 0] == pytest.approx(expected, abs=2e-2)
    assert CIRCLE.nearest(log["y"])[1].max() < 5e-6


@BOTH
def test_on_an_open_curve_it_still_stops_at_the_end(rig: Rig, kind: Kind) -> None:
    kind, line = Kind(kind.law, closed=False), segment((-0.05, 0.0), (0.05, 0.01))
    start = rig.on_path(kind, line, -3.0, 0.0)
    log = rig.run(kind, line, start, 6000, speed=3.0, ramp=2.0)
    assert log["theta"][-1, 0] == pytest.approx(np.pi, abs=1e-2)
    assert abs(log["theta_rate"][-1, 0]) < 1e-2
