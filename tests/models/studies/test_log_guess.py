"""Guesses which columns of a log are what, and long logs in few rows."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.models.studies.log_guess import guessed_columns
from onpath.models.studies.log_motion import LoggedMotion, thinned
from onpath.models.studies.record_file import quantities
from onpath.models.systems.catalogue import ROBOTS

WAYS = (
    ("t_s", "q{}_rad", "tau{}_Nm"),
    ("time", "actual_q_{}", "actual_torque_{}"),
    ("Zeit [ms]", "Achse {} [°]", "Drehmoment {} [Nm]"),
    ("%time", "field.position{}", "field.effort{}"),
    ("timestamp_ns", "/joint_states/position.{}", "/joint_states/effort.{}"),
    ("Time (s)", "Joint {} (deg)", "Torque {} (mNm)"),
    ("t", "q{}_deg", "tau{}"),
)
OTHERS = ("state", "", "qd{}", "field.velocity{}", "Joint {} velocity (deg/s)", "current_{}", "I{}")


@given(
    st.sampled_from(["five_bar", "spatial_arm", "seven_axes"]),
    st.sampled_from(WAYS),
    st.sampled_from([0, 1]),
    st.randoms(use_true_random=False),
)
def test_columns_are_recognised_by_their_names(robot, way, first, draw) -> None:
    """In any order, counted from 0 or 1, among others; or not at all."""
    entry = ROBOTS[robot]
    made = entry.make(entry.parameters())
    n = made.system.n
    if way[0] == "t_s":
        first = 1  # as OnPath counts
    true = {"t": way[0]}
    true |= {f"q{i + 1}": way[1].format(i + first) for i in range(n)}
    true |= {f"tau{i + 1}": way[2].format(i + first) for i in range(n)}
    names = [*true.values(), *(each.format(i) for each in OTHERS for i in range(n))]
    draw.shuffle(names)
    found = guessed_columns(made, list(dict.fromkeys(names)))
    assert found.columns == true
    assert ("deg" in way[1] or "°" in way[1]) == (found.units.get("q1") == "deg")


def test_columns_with_the_joints_names_are_recognised() -> None:
    entry = ROBOTS["seven_axes"]
    made = entry.make(entry.parameters())
    assert made.chain is not None
    joints = [joint.name for joint in made.chain.joints]
    kinds = "velocity", "effort", "position"
    names = ["__time", *(f"/joint_states/{j}/{k}" for k in kinds for j in reversed(joints))]
    found = guessed_columns(made, names).columns
    for i, joint in enumerate(joints, 1):
        assert found[f"q{i}"] == f"/joint_states/{joint}/position"
        assert found[f"tau{i}"] == f"/joint_states/{joint}/effort"
    assert set(guessed_columns(made, joints).columns) == {f"q{i + 1}" for i in range(7)}


def test_columns_without_names_are_time_angles_and_torques() -> None:
    entry = ROBOTS["five_bar"]
    made = entry.make(entry.parameters())
    found = guessed_columns(made, ["1", "2", "3", "4", "5"])
    assert found.columns == {"t": "1", "q1": "2", "q2": "3", "tau1": "4", "tau2": "5"}
    assert not guessed_columns(made, ["1", "2", "3", "4", "5", "6"]).columns
    assert set(quantities(made)) >= set(found.columns)


@given(st.integers(2, 3000), st.floats(1e-4, 0.05), st.integers(3, 1500), st.integers(0, 99))
def test_a_thinned_log_is_the_same_motion(rows, dt, most, seed) -> None:
    """Straight lines stay what they are, and torques keep their integral."""
    rng = np.random.default_rng(seed)
    t = dt * np.arange(rows)
    slope, u = rng.normal(size=2), rng.normal(size=(rows, 2))
    y, rate = t[:, None] * slope, np.tile(slope, (rows, 1))
    found = thinned(LoggedMotion(t=t, y=y, y_rate=rate, u=u, force=0 * u), most, 1 / 60)
    count = len(found.t)
    step = found.t[1] - found.t[0]
    assert count <= most and found.t == pytest.approx(step * np.arange(count))
    assert step >= min(1 / 60, rows * dt / 2) - 1e-9 or step == pytest.approx(dt)
    inside = found.t <= t[-1]
    assert found.y[inside] == pytest.approx(found.t[inside, None] * slope)
    assert np.allclose(found.y_rate, slope)
    whole = np.concatenate([[[0.0, 0.0]], dt * np.cumsum(u, axis=0)])
    ends = dt * np.arange(rows + 1)
    for k in range(2):
        end = np.interp(count * step, ends, whole[:, k])
        assert step * found.u[:, k].sum() == pytest.approx(end, abs=1e-8)
