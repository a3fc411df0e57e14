"""Laws of the closed loop on space curves: invariance, decay as the gains say, the same bits."""

from __future__ import annotations

import dataclasses
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.models.arrays import Array
from onpath.models.closed_loop.kernel import Kernel, build_kernel
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loops import CompiledLoop, InterpretedLoop
from onpath.models.closed_loop.simulation import (
    FREE,
    Push,
    brake_at,
    first_state,
    kernel_of,
    kind_of,
    settings_vector,
    time_step,
)
from onpath.models.closed_loop.translated_loop import translate_loop
from onpath.models.control.laws.registry import LAWS
from onpath.models.control.poles import channels
from onpath.models.control.settable import with_values
from onpath.models.paths.curve_blend import blend
from onpath.models.paths.curves import Curve, circle, segment
from onpath.models.paths.distance import path_distance
from onpath.models.paths.path_design import presets
from onpath.models.paths.space_curves import saddle
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.spatial_arm import SPATIAL_ARM, SpatialParameters
from tests.support.suitable_laws import laws_for

ARM, DEFAULTS = SPATIAL_ARM, SpatialParameters(K3=0.0)
SADDLE = saddle(circle(0.05), 0.03)
NEAR = 2e-5  # [m], what sampling leaves of a law that is exact
SUITABLE = laws_for("spatial_arm")
AT_REST = [name for name in SUITABLE if LAWS[name].pace in ("none", "free")]


def start(
    curve: Curve, theta: float, rate: float, off: Array, off_rate: Array | None = None
) -> tuple[Array, Array]:
    """Configuration and velocity with the end-point off σ(θ), moving with σ'(θ) θ' + off_rate."""
    y = curve.at(np.array(theta)) + off
    q, h = ARM.rest(y), 1e-6
    columns = [(ARM.endpoint(q + h * e) - ARM.endpoint(q - h * e)) / (2 * h) for e in np.eye(3)]
    wanted = rate * curve.at(np.array(theta), 1) + (0.0 if off_rate is None else off_rate)
    return q, np.linalg.solve(np.column_stack(columns), wanted).astype(np.float64)


def log_of(
    law: str, parameters: SpatialParameters, curve: Curve, state: Array, seconds: float
) -> dict[str, Array]:
    kernel = kernel_of(ARM, kind_of(law, parameters, curve))
    settings = settings_vector(ARM, kernel, parameters, curve, FREE)
    ticks = round(seconds / time_step(parameters))
    _, rows = InterpretedLoop(kernel).run(state, settings, curve.table(), ticks)
    return kernel.log.unpack(rows)


@pytest.mark.parametrize("theta", [-2.0, 0.3, 1.7])
def test_on_the_curve_with_the_velocity_along_it_it_stays_there(theta: float) -> None:
    """Whatever speed is wanted: ξ is what the sampling leaves, and falls with its square."""
    kernel = kernel_of(ARM, kind_of("path_following", DEFAULTS, SADDLE))
    q, v = start(SADDLE, theta, 5.0, np.zeros(3))
    state = first_state(ARM, kernel, SADDLE, q, v)
    kernel.state.unpack(state)["theta_rate"][:] = 5.0
    for speed in (6.0, -4.0):
        off = list[float]()
        for rate in (1000, 2000):
            own = replace(DEFAULTS, speed=speed, control_rate=rate)
            log = log_of("path_following", own, SADDLE, state, 1.0)
            off.append(float(path_distance(ARM.frame, SADDLE, log["y"]).max()))
            assert log["theta_rate"][-1, 0] == pytest.approx(speed, rel=5e-3)
        assert off[0] < 1e-5
        assert off[1] < 0.35 * off[0]


@pytest.mark.parametrize("off", [(0.0, 0.0, 4e-3), (3e-3, 1e-3, -3e-3)])
def test_both_components_of_xi_decay_as_the_poles_say(off: tuple[float, float, float]) -> None:
    """From rest at a wanted speed of 0: ξ(t) = (1 + p t) e^(-p t) ξ(0), both poles at p = 20."""
    parameters = replace(DEFAULTS, speed=0.0)
    (across, _) = channels(parameters)
    assert across.poles.real == pytest.approx([-20.0, -20.0], abs=0.5)
    kernel = kernel_of(ARM, kind_of("path_following", parameters, SADDLE))
    q, v = start(SADDLE, 0.8, 0.0, np.array(off))
    log = log_of("path_following", parameters, SADDLE, first_state(ARM, kernel, SADDLE, q, v), 0.4)
    t = 1e-3 * np.arange(400)
    expected = np.outer((1 + 20 * t) * np.exp(-20 * t), log["xi"][0])
    assert np.abs(log["xi"] - expected).max() < 3e-3 * np.abs(off).max()
    distance = path_distance(ARM.frame, SADDLE, log["y"])
    assert np.linalg.norm(log["xi"], axis=1) == pytest.approx(distance, abs=2e-5)


def moving_at(law: str, theta: float, speed: float, off: Array, off_rate: Array) -> Array:
    """A state beside σ(θ) that has the wanted speed, as the law would have it from then on."""
    parameters = replace(DEFAULTS, speed=speed)
    kernel = kernel_of(ARM, kind_of(law, parameters, SADDLE))
    q, v = start(SADDLE, theta, speed, off, off_rate)
    state = first_state(ARM, kernel, SADDLE, q, v)
    known = {"theta_rate": speed, "speed_ref": speed, "theta_ref": theta, "clock_rate": speed}
    for name, field in kernel.state.unpack(state).items():
        if name in known:
            field[:] = known[name]
    return state


@pytest.mark.parametrize("law", [name for name in SUITABLE if name not in AT_REST])
def test_every_law_leads_along_the_saddle(law: str) -> None:
    state = moving_at(law, 0.3, 5.0, np.zeros(3), np.zeros(3))
    log = log_of(law, replace(DEFAULTS, speed=5.0), SADDLE, state, 1.0)
    assert np.ptp(log["theta"]) > 4.0
    assert np.ptp(log["y"][:, 2]) > 0.05
    limit = 1.5e-3 if law == "velocity_field" else NEAR  # it leads back with a finite speed
    assert path_distance(ARM.frame, SADDLE, log["y"]).max() < limit


@pytest.mark.parametrize("law", AT_REST)
def test_laws_that_rest_hold_the_end_point_on_the_saddle(law: str) -> None:
    q, v = start(SADDLE, 0.3, 0.0, np.zeros(3))
    parameters = replace(DEFAULTS, target=0.3, task="position")
    kernel = kernel_of(ARM, kind_of(law, parameters, SADDLE))
    log = log_of(law, parameters, SADDLE, first_state(ARM, kernel, SADDLE, q, v), 0.5)
    assert path_distance(ARM.frame, SADDLE, log["y"]).max() < NEAR


def axes_at(theta: float) -> Array:
    """The axes (T, n1, n2) at a point of the saddle, as columns."""
    tangent = SADDLE.at(np.array(theta), 1)
    tangent /= np.linalg.norm(tangent)
    left = np.array([-tangent[1], tangent[0], 0.0]) / np.hypot(tangent[0], tangent[1])
    up = np.cross(tangent, left)
    return np.column_stack([tangent, left, up]).astype(np.float64)


@pytest.mark.parametrize("axis", [0, 1, 2], ids=["along", "left", "up"])
def test_contouring_decays_in_the_turning_frame_as_its_gains_say(axis: int) -> None:
    theta, speed, size, h = 0.3, 5.0, 5e-4, 1e-5
    own = np.eye(3)[axis] * size
    turning = (axes_at(theta + h) - axes_at(theta - h)) / (2 * h) * speed
    state = moving_at("contouring", theta, speed, axes_at(theta) @ own, turning @ own)
    parameters = with_values(DEFAULTS, {"speed": speed, "contour_ratio": 0.1})
    log = log_of("contouring", parameters, SADDLE, state, 0.4)
    angles = log["theta_ref"][:, 0]
    gaps = log["y"] - SADDLE.at(angles)
    errors = np.stack([axes_at(angle).T @ gap for angle, gap in zip(angles, gaps, strict=True)])
    pole = 20 * np.sqrt(0.1 if axis == 0 else 1.0)
    t = np.arange(len(angles)) * 1e-3
    expected = np.outer((1 + pole * t) * np.exp(-pole * t), own)
    assert np.abs(errors - expected).max() < 0.02 * size


@cache
def compiled(kernel: Kernel) -> CompiledLoop:
    """Curves of one kind and all forces share a loop."""
    return translate_loop(kernel)


@pytest.mark.thorough
@settings(max_examples=10)
@given(law=st.sampled_from(SUITABLE), shape=st.sampled_from(["saddle", "clover", "open"]))
def test_the_compiled_loop_gives_the_same_bits(law: str, shape: str) -> None:
    """Free and held, closed and open, blended from the plane, several robots in one call."""
    shapes = {
        "saddle": blend(circle(0.05), SADDLE, 0.3),
        "clover": saddle(presets()["clover"].curve, 0.02),
        "open": saddle(segment((-0.06, -0.02), (0.06, 0.03)), 0.02),
    }
    curve, parameters = shapes[shape], replace(DEFAULTS, K3=1000.0)
    other_path = SADDLE if curve.closed else saddle(segment((-0.05, 0.0), (0.06, 0.0)), 0.01)
    q, v = start(curve, 0.4, 3.0, np.array([1e-3, 0.0, 2e-3]))
    brake = brake_at(ARM, curve, ARM.endpoint(q), 0.4)
    for push in (FREE, Push(hold=brake), Push(hand=np.array([0.05, 0.02, 0.04]))):
        kernel = kernel_of(ARM, kind_of(law, parameters, curve, push))
        state = first_state(ARM, kernel, curve, q, v)
        settings = settings_vector(ARM, kernel, parameters, curve, push)
        inputs = [state, state], [settings, settings], [curve.table(), other_path.table()], 150
        slow, fast = (
            loop.run_many(*inputs) for loop in (InterpretedLoop(kernel), compiled(kernel))
        )
        for one, other in zip(slow, fast, strict=True):
            assert np.isfinite(one).all()
            assert np.array_equal(one, other)


@pytest.mark.parametrize("law", ["path_following", "trajectory_tracking"])
def test_held_back_on_the_saddle_only_the_tracker_leaves_it(law: str) -> None:
    kernel = kernel_of(ARM, kind_of(law, DEFAULTS, SADDLE))
    q, v = start(SADDLE, 0.0, 6.0, np.zeros(3))
    state = first_state(ARM, kernel, SADDLE, q, v)
    brake = brake_at(ARM, SADDLE, ARM.endpoint(q), 0.0)
    settings = settings_vector(ARM, kernel, DEFAULTS, SADDLE, Push(hold=brake))
    _, rows = InterpretedLoop(kernel).run(state, settings, SADDLE.table(), 1000)
    off = path_distance(ARM.frame, SADDLE, kernel.log.unpack(rows)["y"]).max()
    assert off < 6e-3 if law == "path_following" else off > 0.04


def test_a_robot_without_a_space_frame_refuses_a_space_curve() -> None:
    for name in ("five_bar", "flexible"):
        entry = ROBOTS[name]
        robot = entry.make(entry.parameters())
        with pytest.raises(ValueError, match="space curve"):
            build_kernel(robot.system, robot.frame, Kind("path_following", space=True))
    kind = Kind("path_following", space=True)
    for other in (dataclasses.replace(kind, level_set=True), replace(kind, output="composite")):
        with pytest.raises(ValueError, match="space curve"):
            build_kernel(ARM.system, ARM.frame, other)
