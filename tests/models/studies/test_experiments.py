"""The figures that the experiments must show, and files that say what happened."""

from __future__ import annotations

import io
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from onpath.models.closed_loop.trajectory import Trajectory, header, write_csv
from onpath.models.control.laws.registry import NAMES
from onpath.models.control.settable import specs, value_of
from onpath.models.studies.experiments import experiments, run, summary
from onpath.models.systems.five_bar_parameters import FiveBarParameters
from tests.support.csv_columns import read_csv

KEYS = {
    "max_distance_m",
    "max_distance_while_held_m",
    "rms_distance_m",
    "final_speed_rad_s",
    "max_torque_Nm",
    "stopped_at_s",
    "never_held",
}
RADIUS = 0.05


def runs_of(name: str, **values: Any) -> dict[str, Trajectory]:
    chosen = experiments()[name].with_values({k: str(v) for k, v in values.items()})
    return {law: run(chosen, law) for law in NAMES}


@pytest.fixture(scope="module")
def obstruction() -> dict[str, Trajectory]:
    return runs_of("obstruction")


@pytest.fixture(scope="module")
def position() -> dict[str, Trajectory]:
    return runs_of("position")


def radius_error(trajectory: Trajectory) -> np.ndarray:
    """Distance to the circle, by hand."""
    return np.abs(np.linalg.norm(trajectory.fields["y"], axis=1) - RADIUS)


def figures(runs: dict[str, Trajectory], name: str = "obstruction") -> dict[str, dict[str, Any]]:
    return summary(experiments()[name], list(runs.values()))["laws"]


def test_held_back_the_follower_stays_on_the_circle_and_the_tracker_does_not(
    obstruction: dict[str, Trajectory],
) -> None:
    found = figures(obstruction)
    assert found["path_following"]["max_distance_m"] <= 0.003
    assert found["trajectory_tracking"]["max_distance_m"] >= 0.04
    for name, trajectory in obstruction.items():
        assert found[name]["max_distance_m"] == pytest.approx(radius_error(trajectory).max())
        held = trajectory.distance[trajectory.held]
        assert found[name]["max_distance_while_held_m"] == pytest.approx(held.max())
        assert found[name]["stopped_at_s"] is None
        assert found[name]["final_speed_rad_s"] == pytest.approx(2 * np.pi, rel=1e-3)
    # held, the follower rests and the tracker pulls
    end = obstruction["path_following"].held.nonzero()[0][-1]
    assert np.abs(obstruction["path_following"].fields["v"][end]).max() < 1e-4
    assert abs(obstruction["path_following"].fields["theta_rate"][end, 0]) < 1e-3
    assert abs(obstruction["path_following"].speed[end]) < 1e-4
    torque = {n: np.abs(t.fields["u"][t.held]).max() for n, t in obstruction.items()}
    assert torque["trajectory_tracking"] > 2 * torque["path_following"]


@pytest.mark.thorough
@pytest.mark.parametrize("robot", ["five_bar", "two_link_arm"])
def test_wherever_it_is_held_the_follower_ends_on_the_path(robot: str) -> None:
    """(18): the integral knows of no brake, and works against it."""
    chosen, ends = experiments(robot)["obstruction"], list[float]()
    for place in range(8):
        begin = 3 + place / 8
        times = {"hold_from": begin, "hold_to": begin + 2, "duration": begin + 5}
        followed = run(chosen.with_values(times), "path_following")
        assert followed.stopped_at is None and followed.distance.max() <= 5e-3
        assert followed.distance[-2000:].max() < 0.3e-3
        ends.append(1e3 * float(followed.distance[followed.held][-1]))
    assert max(ends) <= 0.02


def test_distance_in_the_file_is_that_of_the_coordinates_in_the_file(
    obstruction: dict[str, Trajectory],
) -> None:
    text = io.StringIO()
    write_csv(text, experiments()["obstruction"].robot(), list(obstruction.values()))
    text.seek(0)
    for columns in read_csv(text).values():
        expected = np.abs(np.hypot(columns["y1_m"], columns["y2_m"]) - RADIUS)
        assert np.abs(columns["distance_m"] - expected).max() < 1e-9


def test_hold_acts_from_three_to_five_seconds_along_the_tangent_only(
    obstruction: dict[str, Trajectory],
) -> None:
    for trajectory in obstruction.values():
        assert trajectory.t[0] == 0 and len(trajectory.t) == 8000
        assert np.array_equal(trajectory.held, (trajectory.t > 2.9995) & (trajectory.t < 4.9995))
        force = trajectory.fields["force"]
        assert np.all(force[~trajectory.held] == 0)
        theta = trajectory.fields["theta"][trajectory.held][0, 0]
        tangent = np.array([-np.sin(theta), np.cos(theta)])
        across = force[trajectory.held] @ [np.cos(theta), np.sin(theta)]
        along = force[trajectory.held] @ tangent
        assert np.abs(across).max() < 0.02 * np.abs(along).max()
        assert along[1] < -1  # it opposes the motion
        assert np.abs(along).max() <= 30 + 1e-9


def test_position_goes_to_the_circle_then_along_it_then_stops(
    position: dict[str, Trajectory],
) -> None:
    follower = position["path_following"]
    distance = radius_error(follower)
    assert np.abs(distance - follower.distance).max() < 1e-9
    arrived = int(np.argmax(distance <= 5e-4))
    assert distance[0] == pytest.approx(0.02) and 0 < follower.t[arrived] < 1.0
    assert distance[arrived:].max() < 0.2 * distance[0]  # across it once, until the integral is 0
    assert distance[follower.t > 1.2].max() <= 5e-4
    without = runs_of("position", K3=0)["path_following"]
    assert radius_error(without)[arrived + 300 :].max() <= 5e-4
    angle = np.unwrap(np.arctan2(*follower.fields["y"].T[::-1]))
    assert abs(angle[-1] - math.pi / 2) <= 0.01
    assert np.linalg.norm(follower.fields["v"][-1]) < 1e-3
    # it travels: the angle only grows, through all that lies between, never across
    assert np.diff(angle).min() > -1e-6
    assert angle[-1] - angle[arrived] > 1.5
    assert figures(position, "position")["path_following"]["max_distance_while_held_m"] is None


def test_every_controller_has_exactly_the_promised_keys(obstruction: dict[str, Trajectory]) -> None:
    result = summary(experiments()["obstruction"], list(obstruction.values()))
    assert set(result) == {"experiment", "laws"}
    assert result["experiment"] == "obstruction"
    assert list(result["laws"]) == list(obstruction)
    for values in result["laws"].values():
        assert set(values) == KEYS


def test_csv_has_a_row_per_millisecond_and_controller_and_comes_back(
    obstruction: dict[str, Trajectory],
) -> None:
    robot = experiments()["obstruction"].robot()
    file = io.StringIO()
    write_csv(file, robot, obstruction.values())
    lines = file.getvalue().splitlines()
    assert lines[0] == (
        "t_s,law,q1_rad,q2_rad,q1_rate_rad_s,q2_rate_rad_s,y1_m,y2_m,"
        "theta_rad,theta_rate_rad_s,xi1_m,xi1_rate_m_s,theta_ref_rad,theta_rate_ref_rad_s,"
        "distance_m,tau1_Nm,tau2_Nm,force1_N,force2_N,held"
    )
    assert lines[0].split(",") == header(robot) and len(lines) == 1 + 2 * 8000
    file.seek(0)
    back = read_csv(file)
    assert list(back) == list(obstruction)
    for name, columns in back.items():
        fields = obstruction[name].fields
        assert np.allclose(columns["t_s"], np.arange(8000) * 1e-3, atol=1e-9, rtol=0)
        for column, values in (
            ("q2_rad", fields["q"][:, 1]),
            ("y1_m", fields["y"][:, 0]),
            ("theta_rad", fields["theta"][:, 0]),
            ("distance_m", obstruction[name].distance),
            ("tau2_Nm", fields["u"][:, 1]),
            ("force1_N", fields["force"][:, 0]),
            ("q1_rate_rad_s", fields["v"][:, 0]),
            ("theta_rate_rad_s", fields["theta_rate"][:, 0]),
            ("xi1_m", fields["xi"][:, 0]),
            ("xi1_rate_m_s", fields["xi_rate"][:, 0]),
            ("theta_ref_rad", fields["theta_ref"][:, 0]),
            ("held", obstruction[name].held),
        ):
            assert np.allclose(columns[column], values, rtol=1e-8, atol=1e-12), column
        assert columns["theta_rate_ref_rad_s"] == pytest.approx(2 * np.pi)
        moved = np.linalg.norm(np.diff(fields["y"], axis=0), axis=1).sum()
        if name == "path_following":  # on a circle, r θ' is how fast the end-point goes
            turned = np.abs(columns["theta_rate_rad_s"]).sum() * 1e-3
            assert RADIUS * turned == pytest.approx(moved, rel=1e-2)


def test_times_in_the_file_are_even_hours_after_the_start(
    obstruction: dict[str, Trajectory],
) -> None:
    run = obstruction[NAMES[0]]
    file, late = io.StringIO(), replace(run, t=run.t + 12_345.0)
    write_csv(file, experiments()["obstruction"].robot(), [late])
    file.seek(0)
    assert np.diff(read_csv(file)[NAMES[0]]["t_s"]) == pytest.approx(1e-3, abs=1e-9)


@pytest.mark.parametrize("rate", [50, 2000])
def test_rows_are_a_millisecond_apart_whatever_the_control_rate(rate: int) -> None:
    for trajectory in runs_of("obstruction", control_rate=rate, duration=0.2).values():
        assert np.allclose(trajectory.t, np.arange(200) * 1e-3, atol=1e-12)
        changes = np.any(np.diff(trajectory.fields["u"], axis=0) != 0, axis=1)
        assert changes.sum() == pytest.approx(min(rate, 1000) * 0.2 - 1, abs=1)


def test_divergence_is_reported_and_nothing_after_it_is_told() -> None:
    runs = runs_of("obstruction", K1=2500, K2=0, control_rate=50)
    for name, values in figures(runs).items():
        trajectory = runs[name]
        assert 0 < values["stopped_at_s"] < 8
        largest = ("max_distance_m", "max_distance_while_held_m", "rms_distance_m", "max_torque_Nm")
        assert [values[key] for key in largest] == [np.inf] * 4
        assert values["final_speed_rad_s"] is None
        assert trajectory.reason
        assert trajectory.t[-1] < values["stopped_at_s"] <= trajectory.t[-1] + 1.01e-3
        for array in (*trajectory.fields.values(), trajectory.distance, trajectory.speed):
            assert np.isfinite(array).all()


@pytest.mark.parametrize(
    ("hold_from", "hold_to", "held_ms"),
    [(0, 0, 0), (0.1, 0.1, 0), (0.1, 0.2, 100), (0.25, 9, 50), (0, 9, 300)],
)
def test_any_hold_window(hold_from: float, hold_to: float, held_ms: int) -> None:
    runs = runs_of("obstruction", duration=0.3, hold_from=hold_from, hold_to=hold_to)
    for trajectory in runs.values():
        assert len(trajectory.t) == 300 and trajectory.held.sum() == held_ms


def test_radius_and_duration_are_obeyed() -> None:
    for trajectory in runs_of("obstruction", r=0.03, duration=1.5).values():
        assert len(trajectory.t) == 1500
        assert np.linalg.norm(trajectory.fields["y"], axis=1) == pytest.approx(0.03, abs=2e-3)


def test_same_input_same_numbers() -> None:
    first, second = (runs_of("position", duration=0.3) for _ in range(2))
    for name in NAMES:
        for field, values in first[name].fields.items():
            assert np.array_equal(values, second[name].fields[field])


@pytest.mark.parametrize("name", specs(FiveBarParameters))
def test_every_parameter_can_be_set_and_matters_or_is_checked(name: str) -> None:
    spec, chosen = specs(FiveBarParameters)[name], experiments()["obstruction"]
    values = spec.options or (spec.low, spec.high)
    for value in values:
        assert value_of(chosen.with_values({name: str(value)}).parameters, name) == value
    step = (spec.high - spec.low) or 1.0
    bad = ("nan", "inf", "-inf", "", "1,5", str(spec.high + step), str(spec.low - step))
    for text in bad:
        with pytest.raises(ValueError, match=name):
            chosen.with_values({name: text})


@pytest.mark.parametrize("name", ["r", "duration", "hold_from", "hold_to"])
@pytest.mark.parametrize("text", ["nan", "inf", "-1", "1e9", "x", ""])
def test_schedule_is_checked_too(name: str, text: str) -> None:
    with pytest.raises(ValueError, match=name):
        experiments()["obstruction"].with_values({name: text})


def test_bounds_of_the_hold_are_set_together_in_any_order() -> None:
    for names in (("hold_from", "hold_to"), ("hold_to", "hold_from")):
        for times in ({"hold_from": "6", "hold_to": "7"}, {"hold_from": "1", "hold_to": "2"}):
            chosen = experiments()["obstruction"].with_values({n: times[n] for n in names})
            assert (chosen.schedule.hold_from, chosen.schedule.hold_to) == (
                float(times["hold_from"]),
                float(times["hold_to"]),
            )
    with pytest.raises(ValueError, match=r"hold_to.*before hold_from"):
        experiments()["obstruction"].with_values({"hold_to": "2"})


def test_unknown_names_are_answered() -> None:
    with pytest.raises(ValueError, match=r"hold_form.*did you mean.*hold_from"):
        experiments()["obstruction"].with_values({"hold_form": "1"})
    with pytest.raises(ValueError, match="path_following"):
        run(experiments()["position"], "pathfollowing")
