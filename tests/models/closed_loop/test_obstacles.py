"""A brake in one or two directions, and a wall: forces that the control laws do not know."""

from __future__ import annotations

import numpy as np
import pytest

from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.paths.curves import circle
from tests.support.rig import FOLLOWING, TRACKING, Rig

BOTH = pytest.mark.parametrize("kind", [FOLLOWING, TRACKING], ids=lambda kind: kind.law)
CIRCLE = circle(0.05)
PLACE, NORMAL = np.array([0.0, 0.03]), np.array([0.6, -0.8])


@pytest.mark.parametrize("second", [0.0, 1.0])
def test_a_brake_holds_in_its_directions_and_in_no_other(rig: Rig, second: float) -> None:
    start = rig.state(FOLLOWING, np.array([0.05, 0.0]), np.array([0.1, 0.2]))
    anchor = np.array([0.049, -0.002])
    changes = {"hold_active": 1, "hold_anchor": anchor, "hold_tangent": (0.0, 1.0)}
    held = rig.run(FOLLOWING, CIRCLE, start, 1, **changes, hold_normal=(second, 0.0))
    expected = -2000 * (np.array([0.05, 0.0]) - anchor) - 40 * np.array([0.1, 0.2])
    assert held["force"][0] == pytest.approx(expected * (second, 1.0))


@BOTH
def test_a_wall_pushes_only_while_it_is_pressed_and_never_pulls(rig: Rig, kind: Kind) -> None:
    wall = {"wall_active": 1, "wall_place": PLACE, "wall_normal": NORMAL}
    log = rig.run(kind, CIRCLE, rig.on_path(kind, CIRCLE, 0.0, 0.0), 4000, **wall)
    depth = (PLACE - log["y"]) @ NORMAL
    along = np.array([-NORMAL[1], NORMAL[0]])
    assert np.all(log["force"][depth <= 0] == 0)
    assert (log["force"] @ NORMAL).min() >= 0 and np.abs(log["force"] @ along).max() < 1e-12
    assert (log["force"] @ NORMAL).max() > 1 and 0 < (depth > 0).sum() < 4000
    assert depth.max() < 0.02


def test_a_wall_out_of_the_way_changes_nothing(rig: Rig) -> None:
    start = rig.on_path(FOLLOWING, CIRCLE, 0.0, 0.0)
    wall = {"wall_active": 1, "wall_place": (0.0, 0.06), "wall_normal": (0.0, -1.0)}
    free = rig.run(FOLLOWING, CIRCLE, start, 1500)
    beside = rig.run(FOLLOWING, CIRCLE, start, 1500, **wall)
    assert all(np.array_equal(free[name], beside[name]) for name in free)


def test_a_wall_takes_energy_from_what_hits_it(rig: Rig) -> None:
    """Thrown at a wall without any torque, the end-point comes back no faster than it came."""
    start = rig.state(FOLLOWING, np.array([0.0, 0.02]), np.array([0.0, 0.4]))
    wall = {"wall_active": 1, "wall_place": (0.0, 0.03), "wall_normal": (0.0, -1.0)}
    balanced = rig.system.parameter_names
    frictionless = rig.balanced.copy()
    frictionless[[balanced.index("b1"), balanced.index("b2")]] = 0.0
    changes = {"torque_limit": 0.0, "plant": frictionless, "dt": 1e-4}
    log = rig.run(FOLLOWING, CIRCLE, start, 3000, **wall, **changes)
    power = (log["force"] * np.gradient(log["y"], 1e-4, axis=0)).sum(-1)
    mass = np.array([0.0226, 0.0120])
    energy = 0.5 * (mass * log["v"] ** 2).sum(-1)
    assert power.sum() * 1e-4 == pytest.approx(energy[-1] - energy[0], abs=0.02 * energy[0])
    assert energy[-1] < 0.9 * energy[0] and log["force"][-1] == pytest.approx([0, 0])
