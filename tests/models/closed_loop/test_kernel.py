"""Laws of the closed loop: what the linearization promises, what limits and forces do to it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import casadi as ca
import numpy as np
import pytest
from numpy.typing import NDArray

from onpath.models.arrays import Array
from onpath.models.closed_loop.kernel import build_kernel
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loops import CompiledLoop, InterpretedLoop
from onpath.models.control.laws.law import ControlAction, Memory, View
from onpath.models.control.laws.registry import LAWS
from onpath.models.layout import Fields
from onpath.models.paths.curves import Curve, chebyshev_curve, circle, ellipse, segment
from onpath.models.paths.frames import Plane
from onpath.models.systems.five_bar_robot import RIGID_FIVE_BAR
from tests.bench.reference import LANES, reference_loop
from tests.support.rig import DEFAULTS, FOLLOWING, TRACKING, Rig, end_point

BOTH = pytest.mark.parametrize("kind", [FOLLOWING, TRACKING], ids=lambda kind: kind.law)
CIRCLE = circle(0.05)
TURN = 2 * np.pi


def second_order(k1: float, k2: float, x: float, rate: float, t: NDArray[Any]) -> NDArray[Any]:
    """x(t) of x'' = -k1 x - k2 x', from its poles."""
    poles = np.roots([1.0, k2, k1]).astype(complex)
    poles[1] += 1e-7 * (poles[0] == poles[1])
    weights = np.linalg.solve(np.vstack([np.ones(2), poles]), np.array([x, rate]))
    return np.real(np.exp(np.outer(t, poles)) @ weights)


# What the linearization promises ------------------------------------------------------------------


@pytest.mark.parametrize("k1, k2", [(400.0, 40.0), (400.0, 10.0), (100.0, 60.0)])
@pytest.mark.parametrize("level_set", [False, True])
def test_across_the_path_the_poles_are_as_chosen(
    rig: Rig, k1: float, k2: float, level_set: bool
) -> None:
    kind = replace(FOLLOWING, level_set=level_set)
    deviations = []
    for dt in (1e-4, 1e-5):
        start = rig.state(kind, np.array([0.06, 0.004]), np.array([0.05, 0.1]), theta=0.07)
        ticks = round(0.4 / dt)
        log = rig.run(kind, CIRCLE, start, ticks, K1=k1, K2=k2, dt=dt)
        xi, rate = log["xi"][:, 0], log["xi_rate"][:, 0]
        expected = second_order(k1, k2, xi[0], rate[0], dt * np.arange(ticks))
        deviations.append(np.abs(xi - expected).max() / np.abs(xi).max())
    assert deviations[0] < 3e-3
    assert deviations[1] < 0.15 * deviations[0]


def test_along_the_path_the_speed_decays_with_k5_whatever_happens_across(rig: Rig) -> None:
    dt = 1e-5
    start = rig.state(FOLLOWING, np.array([0.062, 0.0]), np.array([0.1, 0.0]))
    log = rig.run(FOLLOWING, CIRCLE, start, 40_000, dt=dt)
    expected = TURN * (1 - np.exp(-10 * dt * np.arange(40_000)))
    assert log["theta_rate"][:, 0] == pytest.approx(expected, abs=2e-3)


@BOTH
@pytest.mark.parametrize("closed", [True, False])
def test_logged_speed_is_that_of_the_closest_point(rig: Rig, kind: Kind, closed: bool) -> None:
    kind = replace(kind, closed=closed)
    bent = chebyshev_curve(np.array([[0.0, 0.0], [0.05, 0.0], [0.0, 0.02], [0.0, 0.01]]))
    curve = ellipse((0.07, 0.03), (0.0, 0.01)) if closed else bent
    log = rig.run(kind, curve, rig.on_path(kind, curve, -1.0, 0.5), 400)
    theta, rate = log["theta"][:, 0], log["theta_rate"][:, 0]
    expected = rate * np.linalg.norm(curve.at(theta, 1), axis=1)
    grid, step = np.linspace(-3.1, 3.1, 2001, retstep=True)
    lengths = np.linalg.norm(curve.at(grid, 1), axis=1)
    bend = np.abs(np.diff(lengths, 2)).max() / step**2
    half = np.abs(rate) * 0.5e-3  # a tick: so far Taylor's series is used
    neglected = bend / 2 * half**2 * np.abs(rate)
    assert np.ptp(expected) > 0.02
    assert np.all(np.abs(log["speed"][:, 0] - expected) <= 1.1 * neglected + 1e-12)


def test_position_task_settles_on_its_target_by_the_shorter_way(rig: Rig) -> None:
    dt = 1e-5
    start = rig.on_path(FOLLOWING, CIRCLE, -3.0, 0.0)
    changes = {"position": 1, "target": 3.0, "dt": dt}
    log = rig.run(FOLLOWING, CIRCLE, start, 60_000, **changes)
    gap = (log["theta"][:, 0] - 3.0 + np.pi) % (2 * np.pi) - np.pi
    expected = second_order(25, 10, 2 * np.pi - 6.0, 0.0, dt * np.arange(60_000))
    assert gap == pytest.approx(expected, abs=1e-3)


def test_tracking_error_has_the_poles_chosen_in_both_coordinates(rig: Rig) -> None:
    dt = 1e-5
    start = rig.state(TRACKING, np.array([0.058, -0.006]))
    log = rig.run(TRACKING, CIRCLE, start, 40_000, dt=dt)
    t = dt * np.arange(40_000)
    reference = CIRCLE.at(log["theta_ref"][:, 0])
    first = -TURN * CIRCLE.at(np.zeros(1), 1)[0]
    for i, offset in enumerate((0.008, -0.006)):
        expected = second_order(400, 40, offset, first[i], t)
        assert log["y"][:, i] - reference[:, i] == pytest.approx(expected, abs=3e-5)


@BOTH
def test_integral_action_removes_the_error_of_a_wrong_model(rig: Rig, kind: Kind) -> None:
    start = rig.state(kind, np.array([0.05, 0.0]))
    changes = {"plant": rig.spoiled, "position": 1, "target": 0, "speed": 0}
    distance = {}
    for k3 in (0.0, 1500.0):
        log = rig.run(kind, CIRCLE, start, 4000, K3=k3, **changes)
        distance[k3] = CIRCLE.nearest(log["y"][-1:])[1][0]
    assert distance[0.0] > 2e-3
    assert distance[1500.0] < 0.05 * distance[0.0]


@pytest.mark.parametrize("kind", [FOLLOWING, replace(FOLLOWING, level_set=True), TRACKING])
@pytest.mark.parametrize(
    "curve",
    [CIRCLE, ellipse((0.06, 0.04), (0.005, 0.0)), ellipse((0.06, 0.035), (0.0, 0.005), 0.6)],
)
def test_path_is_invariant(rig: Rig, kind: Kind, curve: Curve) -> None:
    conic = curve.conic()
    assert conic is not None
    level = dict(zip(("level_centre", "level_weights", "level_constant"), conic, strict=True))
    start = rig.on_path(kind, curve, 0.4, TURN)
    log = rig.run(kind, curve, start, 3000, **level)
    assert curve.nearest(log["y"])[1].max() < 1e-6


@pytest.mark.thorough
def test_random_paths_are_invariant(rig: Rig, random_curve: Callable[[int], Curve]) -> None:
    for seed in range(12):
        curve = random_curve(seed)
        start = rig.on_path(FOLLOWING, curve, -2.0, 3.0)
        log = rig.run(FOLLOWING, curve, start, 2500, speed=3.0)
        assert log["theta"][-1, 0] - log["theta"][0, 0] > 6.5
        assert curve.nearest(log["y"])[1].max() < 1e-6


# Fairness -----------------------------------------------------------------------------------------


def test_both_controllers_get_the_identical_force(rig: Rig) -> None:
    rng = np.random.default_rng(0)
    loops = [InterpretedLoop(rig.kernel(kind)) for kind in (FOLLOWING, TRACKING)]
    largest = 0.0
    for _ in range(300):
        y = 0.05 * rng.normal(size=2).clip(-1.5, 1.5)
        state = rig.state(FOLLOWING, y, rng.normal(size=2))
        changes = {
            "hand_active": rng.integers(2),
            "hand_target": 0.1 * rng.normal(size=2),
            "hold_active": rng.integers(2),
            "hold_anchor": y + 0.01 * rng.normal(size=2),
            "plant": rig.spoiled,
        }
        settings = rig.settings(FOLLOWING, **changes)
        forces = [
            loop.layouts.log.unpack(loop.run(state, settings, CIRCLE.table(), 1)[1])["force"]
            for loop in loops
        ]
        assert forces[0].tobytes() == forces[1].tobytes()
        largest = max(largest, float(np.abs(forces[0]).max()))
    assert largest > 15


def test_layouts_do_not_depend_on_the_controller(rig: Rig) -> None:
    first, second = rig.kernel(FOLLOWING), rig.kernel(TRACKING)
    assert (first.state, first.settings, first.log) == (second.state, second.settings, second.log)


@BOTH
def test_force_moves_the_end_point_as_newton_says(rig: Rig, kind: Kind) -> None:
    start = rig.state(kind, np.array([0.05, 0.0]))
    target = np.array([0.07, 0.01])
    log = rig.run(kind, CIRCLE, start, 2, hand_active=1, hand_target=target, torque_limit=0)
    assert log["force"][0] == pytest.approx(300 * (target - (0.05, 0.0)))
    q = log["q"][0]
    lever = 0.2 * np.array([[-np.sin(q[0]), np.sin(q[1])], [np.cos(q[0]), -np.cos(q[1])]])
    expected = np.linalg.solve(np.diag([0.0226, 0.0120]), lever.T @ log["force"][0])
    assert log["v"][1] / 1e-3 == pytest.approx(expected, rel=5e-3)


def test_hand_saturates_and_hold_acts_along_its_tangent_only(rig: Rig) -> None:
    start = rig.state(FOLLOWING, np.array([0.05, 0.0]))
    far = rig.run(FOLLOWING, CIRCLE, start, 1, hand_active=1, hand_target=(3.0, 4.0))
    assert far["force"][0] == pytest.approx(15 * np.array([2.95, 4.0]) / np.hypot(2.95, 4.0))
    tangent = np.array([0.6, 0.8])
    for anchor, size in (((0.049, 0.0), -1.2), ((0.05, 0.1), 30.0)):
        changes = {"hold_active": 1, "hold_anchor": anchor, "hold_tangent": tangent}
        held = rig.run(FOLLOWING, CIRCLE, start, 1, **changes)
        assert held["force"][0] == pytest.approx(size * tangent)


def test_held_follower_stays_and_held_tracker_is_torn_off(rig: Rig) -> None:
    distance = {}
    for kind in (FOLLOWING, TRACKING):
        start = rig.on_path(kind, CIRCLE, 0.0, TURN)
        anchor = {"hold_active": 1, "hold_anchor": (0.05, 0.0), "hold_tangent": (0.0, 1.0)}
        log = rig.run(kind, CIRCLE, start, 2000, **anchor)
        distance[kind] = CIRCLE.nearest(log["y"])[1].max()
    assert distance[FOLLOWING] < 3e-3
    assert distance[TRACKING] > 4e-2


# Realism ------------------------------------------------------------------------------------------


@BOTH
def test_torque_never_exceeds_its_limit(rig: Rig, kind: Kind) -> None:
    start = rig.state(kind, np.array([0.09, 0.03]))
    free = rig.run(kind, CIRCLE, start, 1000)
    limited = rig.run(kind, CIRCLE, start, 1000, torque_limit=0.2)
    assert np.abs(free["u"]).max() > 0.4
    assert np.abs(limited["u"]).max() == 0.2


def integral(rig: Rig, kind: Kind, state: Array, ticks: int, **changes: object) -> Array:
    after, _ = rig.loop(kind).run(state, rig.settings(kind, **changes), CIRCLE.table(), ticks)
    return rig.kernel(kind).state.unpack(after)["integral"]


@BOTH
def test_integral_grows_unless_a_torque_saturates(rig: Rig, kind: Kind) -> None:
    memory = (1e-3, 2e-3)
    start = rig.state(kind, np.array([0.07, 0.01]), integral=memory)
    moved = integral(rig, kind, start, 1, K3=50) - memory
    assert abs(moved[0]) == pytest.approx(1e-3 * 0.02, rel=0.1)
    assert integral(rig, kind, start, 30, K3=50, torque_limit=1e-3) == pytest.approx(memory, abs=0)


@BOTH
@pytest.mark.parametrize(
    "push",
    [
        {"hold_active": 1, "hold_anchor": (0.06, 0.01), "hold_tangent": (0.6, 0.8)},
        {"hand_active": 1, "hand_target": (0.09, -0.02)},
    ],
    ids=["brake", "hand"],
)
def test_integral_knows_nothing_of_brake_and_hand(
    rig: Rig, kind: Kind, push: dict[str, object]
) -> None:
    start = rig.state(kind, np.array([0.07, 0.01]), integral=(1e-3, 2e-3))
    free, pushed = (integral(rig, kind, start, 1, K3=50, **own) for own in ({}, push))
    assert free.tobytes() == pushed.tobytes() and free[0] != 1e-3


@BOTH
def test_without_integral_gain_nothing_collects(rig: Rig, kind: Kind) -> None:
    start = rig.state(kind, np.array([0.07, 0.01]), integral=(1e-3, -5e-4))
    assert np.all(integral(rig, kind, start, 1, K3=0) == 0.0)


def test_switch_of_the_tracker_s_integral_is_the_tracker_s_alone(rig: Rig) -> None:
    place = np.array([0.07, 0.01])
    for kind, collects in ((TRACKING, False), (FOLLOWING, True)):
        start = rig.state(kind, place, integral=(1e-3, 2e-3))
        after = integral(rig, kind, start, 1, K3=50, tracker_integral=0)
        assert np.any(after != 0.0) == collects


@pytest.mark.parametrize("kind", [FOLLOWING, TRACKING, replace(FOLLOWING, encoder=True)])
def test_torque_is_held_between_the_controller_s_ticks(rig: Rig, kind: Kind) -> None:
    start = rig.state(kind, np.array([0.06, 0.0]))
    u = rig.run(kind, CIRCLE, start, 400, hold_ticks=8)["u"].reshape(-1, 8, 2)
    assert np.all(u == u[:, :1])
    assert np.all(np.any(np.diff(u[:, 0], axis=0) != 0, axis=1))


@pytest.mark.thorough
def test_slower_control_is_worse(rig: Rig) -> None:
    start = rig.on_path(FOLLOWING, CIRCLE, 0.0, TURN)
    worst = [
        CIRCLE.nearest(rig.run(FOLLOWING, CIRCLE, start, 2000, hold_ticks=ticks)["y"])[1].max()
        for ticks in (1, 4, 16)
    ]
    assert worst[0] < worst[1] < worst[2]


@BOTH
def test_finer_and_faster_encoders_come_closer_to_exact_sensing(rig: Rig, kind: Kind) -> None:
    with_encoder = replace(kind, encoder=True)
    start = rig.on_path(kind, CIRCLE, 0.3, TURN)
    gaps = []
    for dt in (1e-3, 1e-4, 1e-5):
        ticks = round(0.5 / dt)
        exact = rig.run(kind, CIRCLE, start, ticks, dt=dt)["y"]
        changes = {"dt": dt, "encoder_step": 2 * dt**2, "encoder_filter": dt}
        gaps.append(
            np.abs(rig.run(with_encoder, CIRCLE, start, ticks, **changes)["y"] - exact).max()
        )
    assert gaps[1] < 0.2 * gaps[0]
    assert gaps[2] < 0.2 * gaps[1]


def test_coarse_encoders_shake_the_torque(rig: Rig) -> None:
    kind = replace(FOLLOWING, encoder=True)
    start = rig.on_path(kind, CIRCLE, 0.3, TURN)
    shake = []
    for step in (1e-5, 1e-4, 1e-3):
        u = rig.run(kind, CIRCLE, start, 1000, encoder_step=step)["u"]
        shake.append(np.abs(np.diff(u, axis=0)).max())
    assert shake[0] < shake[1] < shake[2]


def test_dry_friction_slows_the_follower_and_takes_energy(rig: Rig) -> None:
    start = rig.on_path(FOLLOWING, CIRCLE, 0.0, TURN)
    free, rubbing = (
        rig.run(FOLLOWING, CIRCLE, start, 1000, coulomb=c, torque_limit=0) for c in (0.0, 0.1)
    )
    energy = [(log["v"] ** 2) @ np.array([0.0226, 0.0120]) / 2 for log in (free, rubbing)]
    assert np.all(np.diff(energy[1]) <= 1e-15)
    assert energy[1][-1] < 0.1 * energy[0][-1]


# Open curves --------------------------------------------------------------------------------------


@pytest.mark.thorough
@pytest.mark.parametrize(
    "curve",
    [
        segment((-0.04, -0.03), (0.05, 0.03)),
        chebyshev_curve(np.array([[0.0, 0.0], [0.05, 0.0], [0.0, 0.02], [0.0, 0.01]])),
    ],
    ids=["segment", "bent"],
)
@pytest.mark.parametrize("speed", [2.0, -2.0])
def test_both_stop_at_the_end_of_an_open_curve(rig: Rig, curve: Curve, speed: float) -> None:
    end = np.sign(speed) * np.pi
    for kind in (replace(FOLLOWING, closed=False), replace(TRACKING, closed=False)):
        start = rig.on_path(kind, curve, -end / 2, speed)
        log = rig.run(kind, curve, start, 8000, speed=speed)
        place = log["theta_ref" if kind.law == "trajectory_tracking" else "theta"][:, 0]
        assert np.abs(place).max() <= np.pi + 1e-3
        assert place[-1] == pytest.approx(end, abs=1e-3)
        assert log["y"][-1] == pytest.approx(curve.at(end), abs=2e-5)
        assert np.abs(log["v"][-1]).max() < 1e-3
        if kind.law == "path_following":
            assert curve.nearest(log["y"])[1].max() < 2e-5


# One tick after the other -------------------------------------------------------------------------


@BOTH
def test_same_input_same_bytes(rig: Rig, kind: Kind) -> None:
    start = rig.state(kind, np.array([0.06, 0.02]))
    settings = rig.settings(kind, K3=20, hand_active=1, coulomb=0.01)
    for loop in (rig.loop(kind), InterpretedLoop(rig.kernel(kind))):
        once, twice = (loop.run(start, settings, CIRCLE.table(), 500) for _ in range(2))
        assert once[0].tobytes() == twice[0].tobytes() and once[1].tobytes() == twice[1].tobytes()


@BOTH
def test_stopping_and_going_on_changes_nothing(rig: Rig, kind: Kind) -> None:
    start, settings = rig.state(kind, np.array([0.06, 0.02])), rig.settings(kind, K3=20)
    loop, table = rig.loop(kind), CIRCLE.table()
    whole, rows = loop.run(start, settings, table, 137)
    middle, before = loop.run(start, settings, table, 50)
    end, after = loop.run(middle, settings, table, 87)
    assert end.tobytes() == whole.tobytes()
    assert np.vstack([before, after]).tobytes() == rows.tobytes()


def test_row_tells_the_instant_a_tick_begins(rig: Rig) -> None:
    y = np.array([0.06, 0.02])
    start = rig.state(FOLLOWING, y, np.array([0.1, -0.1]), theta=0.3217)
    log = rig.run(FOLLOWING, CIRCLE, start, 1, plant=rig.spoiled)
    q = RIGID_FIVE_BAR.rest(y)
    assert log["q"][0] == pytest.approx(q, abs=0) and log["y"][0] == pytest.approx(y)
    assert log["y"][0] == pytest.approx(end_point(q), abs=1e-16)
    assert log["theta"][0] == pytest.approx(np.arctan2(0.02, 0.06), abs=5e-6)
    assert log["xi"][0] == pytest.approx(
        0.05 - np.hypot(*y), abs=5e-6
    )  # left of the curve is inside


@pytest.fixture(scope="module")
def hand_written(
    rig: Rig, tmp_path_factory: pytest.TempPathFactory
) -> dict[int, CompiledLoop | None]:
    """The loop in C by its number of lanes; see `reference_loop`."""
    folder, kernel = tmp_path_factory.mktemp("reference"), rig.kernel(FOLLOWING)
    return {lanes: reference_loop(kernel, folder, lanes) for lanes in LANES}


@pytest.mark.thorough
@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"hand_active": 1, "hand_target": (0.03, 0.02), "K3": 40},
        {"hold_active": 1, "hold_anchor": (0.05, 0.01), "hold_tangent": (0.0, 1.0)},
        {"position": 1, "target": 1.5, "coulomb": 0.02, "hold_ticks": 4},
        {"torque_limit": 0.8, "K3": 40, "hand_active": 1},
        {"ramp": 10.0},
        {"hold_active": 1, "hold_anchor": (0.05, 0.01), "hold_normal": (1.0, 0.0)},
        {"wall_active": 1, "wall_place": (0.0, 0.03), "wall_normal": (0.0, -1.0)},
    ],
    ids=["plain", "hand", "hold", "position", "saturated", "ramp", "both directions", "wall"],
)
@pytest.mark.parametrize("lanes", LANES)
def test_hand_written_c_loop_agrees(
    rig: Rig,
    random_curve: Callable[[int], Curve],
    hand_written: dict[int, CompiledLoop | None],
    changes: dict[str, object],
    lanes: int,
) -> None:
    reference = hand_written[lanes]
    if reference is None:
        pytest.skip("no C compiler, or no such lanes")
    settings = rig.settings(FOLLOWING, plant=rig.spoiled, **changes)
    for curve in (CIRCLE, random_curve(1), random_curve(2)):
        starts = [
            rig.state(
                FOLLOWING, np.array([0.052, 0.012]), np.array([0.1, 0.1]), theta=0.2 + 0.1 * i
            )
            for i in range(lanes)
        ]
        arguments = starts, [settings] * lanes, [curve.table()] * lanes, 1000
        for ours, theirs in zip(
            InterpretedLoop(rig.kernel(FOLLOWING)).run_many(*arguments),
            reference.run_many(*arguments),
            strict=True,
        ):
            assert np.abs(ours - theirs).max() < 1e-9


def test_unknown_controller_is_refused(rig: Rig) -> None:
    with pytest.raises(ValueError, match="unknown law 'pid'"):
        build_kernel(rig.system, Plane(), Kind("pid"))


def test_settings_are_checked_by_name_and_size(rig: Rig) -> None:
    layout, plant = rig.kernel(FOLLOWING).settings, rig.balanced
    missing = {"look_ahead": 5e-4, "plane": Plane().numbers}  # which the rig computes
    good = {**DEFAULTS, **missing, "plant": plant, "model": plant}
    assert layout.unpack(layout.pack(good))["hold_tangent"] == pytest.approx([0, 1])
    assert np.isnan(layout.pack({**good, "speed": np.nan})).sum() == 1  # checked where it came in
    for bad, message in (
        ({**good, "K9": 1}, "K9"),
        ({name: value for name, value in good.items() if name != "K1"}, "K1"),
        ({**good, "hold_anchor": (0, 0, 0)}, "hold_anchor: expected 2"),
        ({**good, "speed": (1.0, 2.0)}, "speed: expected 1 number"),
    ):
        with pytest.raises(ValueError, match=message):
            layout.pack(bad)


@pytest.mark.parametrize(
    "memory, kept, message",
    [
        ((("sum", 2),), {"sum": ca.SX(0)}, "has 1 numbers as sum, not 2"),
        ((("sum", 1),), {}, "has 0 numbers as sum, not 1"),
        ((), {"sum": ca.SX(0)}, "has sum, not in Law.memory"),
        ((("theta", 1),), {"theta": ca.SX(0)}, "memory cannot be named 'theta'"),
    ],
)
def test_a_laws_memory_is_checked_by_name_and_size(
    rig: Rig, memory: Memory, kept: Fields, message: str
) -> None:
    """What is wrong would shift or replace other fields of the state."""

    def command(view: View) -> ControlAction:
        return replace(LAWS["path_following"].command(view), memory=kept)

    law = replace(LAWS["path_following"], name="keeps", command=command, memory=memory)
    with pytest.MonkeyPatch.context() as patch, pytest.raises(ValueError, match=message):
        patch.setitem(LAWS, "keeps", law)
        build_kernel(rig.system, Plane(), Kind("keeps"))
