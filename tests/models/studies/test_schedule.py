"""Start, hold, wall, path and speed profile: what the runs do with them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from onpath.models.closed_loop.profile_shapes import profile_of
from onpath.models.closed_loop.speed_profile import SpeedProfile, profile_from
from onpath.models.closed_loop.trajectory import Trajectory
from onpath.models.paths.curves import ellipse
from onpath.models.studies.experiments import experiments, never_held, run, summary
from onpath.models.systems.five_bar_parameters import FiveBarParameters

FOLLOWING, TRACKING = "path_following", "trajectory_tracking"
BOTH = pytest.mark.parametrize("law", [FOLLOWING, TRACKING])
FREE: dict[str, Any] = {"hold_from": 0, "hold_to": 0}


def ran(law: str = FOLLOWING, name: str = "obstruction", **values: Any) -> Trajectory:
    return run(experiments()[name].with_values(values), law)


def off_circle(trajectory: Trajectory) -> np.ndarray:
    return np.abs(np.linalg.norm(trajectory.fields["y"], axis=1) - 0.05)


# Start --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("along", "across"), [(0.3, 0.0), (0.0, -0.2), (-0.1, 0.1)])
def test_it_starts_where_and_as_it_is_told(along: float, across: float) -> None:
    values: dict[str, Any] = {
        "start_z1": 0.0,
        "start_z2": 0.04,
        "start_along": along,
        "start_across": across,
    }
    trajectory = ran(duration=0.02, **FREE, **values)
    fields = trajectory.fields
    assert fields["y"][0] == pytest.approx([0.0, 0.04])
    # At (0, r) the circle goes to the left, and its normal to the left of that points inwards
    step = (fields["y"][1] - fields["y"][0]) / 1e-3
    assert step == pytest.approx([-along, -across], abs=0.02)
    assert fields["xi"][0, 0] == pytest.approx(0.01, abs=1e-5)
    assert fields["xi_rate"][0, 0] == pytest.approx(across, abs=0.02)
    assert fields["theta_rate"][0, 0] * 0.04 == pytest.approx(along, abs=0.02)


def test_on_the_path_with_velocity_along_it_the_follower_stays_on_it() -> None:
    """Invariance: whatever the velocity is, and however wrong the reference."""
    for along in (-0.5, 0.2, 0.5):
        assert ran(duration=1.0, start_along=along, **FREE).distance.max() < 2e-6


def test_a_clock_that_is_ahead_takes_the_tracker_off_the_path_and_not_the_follower() -> None:
    at_speed: dict[str, Any] = {"start_along": 2 * np.pi * 0.05, "duration": 1.0, **FREE}
    tracker, follower = (ran(law, clock_offset=1.0, **at_speed) for law in (TRACKING, FOLLOWING))
    assert tracker.fields["theta_ref"][0, 0] == pytest.approx(1.0)
    assert ran(TRACKING, **at_speed).distance.max() < 2e-6
    assert follower.distance.max() < 2e-6
    assert tracker.distance.max() > 5e-3


# Hold ---------------------------------------------------------------------------------------------


@BOTH
@pytest.mark.parametrize("place", [-2.0, 0.5, 3.0])
def test_the_brake_waits_for_its_place(law: str, place: float) -> None:
    trajectory = ran(law, duration=3.0, hold_from=0.5, hold_to=1.0, hold_at=place)
    assert trajectory.held.sum() == 500
    begin = int(trajectory.held.argmax())
    theta = trajectory.fields["theta"][:, 0]
    assert 500 <= begin < 1600
    gap = (theta[[begin - 1, begin]] - place + np.pi) % (2 * np.pi) - np.pi
    assert gap[0] < 0 <= gap[1] < 0.01
    assert np.all(trajectory.fields["force"][~trajectory.held] == 0)


def test_the_brake_acts_where_the_place_is_first_passed_at_any_tick() -> None:
    """Also between two parts of a run, which is computed `CHUNK` ticks at a time."""
    theta = ran(duration=2.0, **FREE).fields["theta"][:, 0]
    random = np.random.default_rng(4)
    ticks = [600, 800, 1000, 1200, 1400, *random.integers(501, 1490, 10)]
    for tick in ticks:
        place = float(theta[tick - 1] + random.uniform(0.1, 0.9) * (theta[tick] - theta[tick - 1]))
        wrapped = (place + np.pi) % (2 * np.pi) - np.pi
        trajectory = ran(duration=1.6, hold_from=0.5, hold_to=0.55, hold_at=wrapped)
        assert trajectory.held.argmax() == tick, tick
        assert trajectory.held.sum() == 50 and len(trajectory.t) == 1600


def test_a_place_that_is_never_passed_holds_nothing_and_the_run_says_so() -> None:
    asked = {"duration": 0.5, "hold_from": 0.1, "hold_to": 0.2, "hold_at": -2.0}
    late = experiments()["obstruction"].with_values(asked)
    trajectory = run(late, FOLLOWING)
    assert not trajectory.held.any() and len(trajectory.t) == 500
    assert "did not pass θ = -2 rad" in never_held(late, trajectory)
    assert summary(late, [trajectory])["laws"][FOLLOWING]["never_held"] is True
    held = experiments()["obstruction"].with_values({"duration": 0.5, "hold_from": 0.1})
    assert never_held(held, run(held, FOLLOWING)) == ""


@pytest.mark.parametrize("direction", ["along", "across", "both"])
def test_the_brake_acts_in_its_directions_only(direction: str) -> None:
    values: dict[str, Any] = {"hold_from": 0.6, "hold_to": 1.6, "hold_direction": direction}
    trajectory = ran(TRACKING, duration=1.6, **values)
    held = trajectory.held
    theta = trajectory.fields["theta"][held][0, 0]
    tangent, normal = np.array([[-np.sin(theta), np.cos(theta)], [-np.cos(theta), -np.sin(theta)]])
    force = trajectory.fields["force"][held]
    sizes = np.abs(force @ tangent).max(), np.abs(force @ normal).max()
    # The force is computed from the state at the beginning of a tick, a little after it was held
    for size, acts in zip(sizes, (direction != "across", direction != "along"), strict=True):
        assert size > 1 if acts else size < 0.02 * max(sizes)


# Wall ---------------------------------------------------------------------------------------------


@BOTH
def test_a_wall_stands_for_its_time_and_pushes_towards_the_free_side(law: str) -> None:
    values: dict[str, Any] = {"wall_from": 0.5, "wall_to": 1.5, "wall_z1": 0.0, "wall_z2": 0.03}
    trajectory = ran(law, duration=2.0, **FREE, **values, wall_angle=-np.pi / 2)
    force, t = trajectory.fields["force"], trajectory.t
    there = (t > 0.4995) & (t < 1.4995)
    assert np.all(force[~there] == 0) and force[there][:, 1].min() < -1
    assert force[:, 1].max() <= 0 and np.abs(force[:, 0]).max() < 1e-9
    assert np.all(force[trajectory.fields["y"][:, 1] < 0.03] == 0)


# Path ---------------------------------------------------------------------------------------------


def test_an_experiment_on_another_path_starts_on_it_if_it_did_before() -> None:
    path = ellipse((0.06, 0.04))
    obstruction = experiments()["obstruction"].along(path).with_values({"duration": 0.1})
    trajectory = run(obstruction, FOLLOWING)
    assert trajectory.fields["y"][0] == pytest.approx([0.06, 0.0])
    assert trajectory.distance.max() < 1e-5
    position = experiments()["position"].along(path)
    assert np.array_equal(position.begin(), experiments()["position"].begin())


# Speed profile ------------------------------------------------------------------------------------


@BOTH
def test_the_speed_follows_its_profile(law: str) -> None:
    points = [(0.0, 0.0), (0.5, 6.0), (1.0, 6.0), (2.0, -6.0), (2.5, -6.0)]
    trajectory = ran(law, duration=3.0, profile=points, **FREE)
    wanted = np.interp(trajectory.t, *np.array(points).T)
    assert trajectory.fields["speed_ref"][:, 0] == pytest.approx(wanted, abs=1e-9)
    assert trajectory.fields["theta_rate"][:, 0] == pytest.approx(wanted, abs=0.02)
    assert off_circle(trajectory).max() < 5e-6


def test_there_and_back_ends_where_it_began() -> None:
    back = [(0, 0), (0.5, 4), (1.5, 4), (2.5, -4), (3.5, -4), (4, 0)]
    trajectory = ran(duration=4.5, profile=back, **FREE)
    theta = trajectory.fields["theta"][:, 0]
    assert theta.max() == pytest.approx(6.0, abs=0.01)  # ∫ of the profile until it turns
    assert theta[-1] == pytest.approx(0.0, abs=0.01)


def test_a_step_of_the_profile_is_a_new_reference_at_once() -> None:
    stepped = ran(duration=1.0, profile="0:6, 0.5:6, 0.5:-6", **FREE)
    turned = ran(duration=1.0, speed=6.0, reverse_at=0.5, **FREE)
    for name in ("q", "v", "u", "theta"):
        assert np.array_equal(stepped.fields[name], turned.fields[name])


def test_an_integral_over_a_profile_is_exact() -> None:
    """The clock of the tracker runs on the profile's integral, whatever the ticks."""
    trajectory = ran(TRACKING, duration=2.0, profile="0:1, 0.5:3, 1.5:-2", **FREE)
    expected = 0.5 * (1 + 3) / 2 + 1.0 * (3 - 2) / 2 - 2 * 0.499
    assert trajectory.fields["theta_ref"][-1, 0] == pytest.approx(expected, abs=1e-9)


def test_a_profile_is_read_from_text_and_pairs_alike() -> None:
    expected = SpeedProfile((0.0, 1.5), (0.0, 6.28))
    assert profile_from(" 0:0 , 1.5 : 6.28 ") == profile_from([(0, 0), (1.5, 6.28)]) == expected


@pytest.mark.parametrize(
    "value", ["", "1", "0:0:0", "a:b", "1:0, 0:0", "0:nan", "-1:0", "0:0, 601:0", 3, [(0,)], []]
)
def test_an_invalid_profile_is_refused(value: Any) -> None:
    with pytest.raises(ValueError, match="profile"):
        experiments()["obstruction"].with_values({"profile": value})


def test_a_ramp_removes_the_start_up_error_as_the_readme_says() -> None:
    at_once, ramped = (ran(TRACKING, duration=4.0, ramp=ramp, **FREE) for ramp in (0, 10))
    assert at_once.distance.max() == pytest.approx(2.4e-3, abs=5e-5)
    assert ramped.distance.max() < 1e-6


# Shapes of the parameters -------------------------------------------------------------------------


def wanted_at(shape: str, t: np.ndarray, speed: float, period: float) -> np.ndarray:
    """The speed that the help promises, written independently."""
    share = t / period
    if shape == "ramp_up":
        return speed * np.minimum(share, 1.0)
    if shape == "sine":
        return speed * (1 + np.sin(2 * np.pi * share) / 2)
    return speed * np.interp(share % 1, [0, 0.1, 0.5, 0.6, 1], [0, 1, 1, 0, 0])


@BOTH
@pytest.mark.parametrize("shape", ["ramp_up", "sine", "stop_and_go"])
def test_the_speed_follows_the_shape_that_a_parameter_chooses(law: str, shape: str) -> None:
    values: dict[str, Any] = {"speed": 5.0, "speed_profile": shape, "profile_period": 1.3}
    trajectory = ran(law, duration=4.0, **FREE, **values)
    wanted = wanted_at(shape, trajectory.t, 5.0, 1.3)
    inside = 0.5 * 5.0 * 0.005  # of the straight pieces of the sine
    assert trajectory.fields["speed_ref"][:, 0] == pytest.approx(wanted, abs=inside)
    late = trajectory.t > 1.5  # the sine begins at its mean, the robot at rest
    rates = trajectory.fields["theta_rate"][:, 0]
    assert rates[late] == pytest.approx(wanted[late], abs=0.05)
    assert off_circle(trajectory)[late].max() < 1e-4


def test_a_shape_is_fed_forward() -> None:
    """With the feedforward of (19), the speed along the path is right however small K5 is."""
    values: dict[str, Any] = {"speed_profile": "stop_and_go", "profile_period": 1.0, "K5": 0.5}
    trajectory = ran(FOLLOWING, duration=3.0, speed=4.0, **FREE, **values)
    wanted = wanted_at("stop_and_go", trajectory.t, 4.0, 1.0)
    assert trajectory.fields["theta_rate"][:, 0] == pytest.approx(wanted, abs=0.05)


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"profile": "0:3", "speed_profile": "sine"}, "speed_profile: the profile says the speed"),
        ({"profile": "0:3", "speed": 2.0}, "speed: the profile says the speed"),
        ({"profile": "0:3", "ramp": 2.0}, "ramp: the profile says the speed"),
        ({"hold_from": 5, "hold_to": 9}, "hold_from .5 s.: the run ends at 4 s"),
        ({"wall_from": 4, "wall_to": 9}, "wall_from .4 s.: the run ends at 4 s"),
        ({"reverse_at": 4}, "reverse_at .4 s.: the run ends at 4 s"),
        ({"hold_at": 1.0}, "hold_at: it needs an interval, hold_from and hold_to"),
        ({"hold_direction": "both"}, "hold_direction: it needs an interval"),
        ({"push_z1": 0.01, "push_from": 1, "push_to": 1}, "push_z1: it needs an interval"),
        ({"wall_angle": 0.5}, "wall_angle: it needs an interval"),
    ],
)
def test_what_nothing_uses_is_refused(values: dict[str, Any], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        experiments()["position"].with_values(values)


def test_the_sign_of_the_speed_turns_a_shape_round() -> None:
    forth, back = (
        ran(duration=2.0, speed=speed, speed_profile="stop_and_go", **FREE) for speed in (4.0, -4.0)
    )
    assert forth.fields["speed_ref"] == pytest.approx(-back.fields["speed_ref"], abs=1e-12)


@pytest.mark.parametrize("period", [0.5, 1.234567, 2.0, 20.0])
@pytest.mark.parametrize("dt", [1e-3, 5e-4])
def test_the_parts_of_a_shape_follow_each_other_without_a_gap(period: float, dt: float) -> None:
    for shape in ("ramp_up", "sine", "stop_and_go"):
        chosen = FiveBarParameters(speed_profile=shape, profile_period=period)
        profile, tick, speed = profile_of(chosen), 0, None
        assert profile is not None
        while tick < 45 / dt:
            leg = profile.leg(tick, dt)
            assert leg.begin == tick
            assert speed is None or leg.first == pytest.approx(speed, abs=1e-9)
            if leg.end is None:
                break
            assert leg.end > tick and profile.leg(leg.end - 1, dt) == leg
            tick, speed = leg.end, leg.last
