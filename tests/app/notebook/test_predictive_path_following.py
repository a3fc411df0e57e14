"""The example of predictive path following: its optimum, and what it does at a wall."""

from __future__ import annotations

import runpy
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import minimize

import onpath
from onpath.assets import asset_path

EXAMPLE = runpy.run_path(str(asset_path("examples/predictive_path_following.py")))
LAWS = EXAMPLE["PredictivePathFollowing"], EXAMPLE["PredictiveTracking"]
STEPS, STEP, RADIUS, WALL = (EXAMPLE[name] for name in ("STEPS", "STEP", "RADIUS", "WALL"))
TOP = WALL - EXAMPLE["MARGIN"]


def predicted(now: Any, accelerations: Any) -> tuple[Any, Any, Any]:
    """θ' and ξ after each interval, (STEPS, 2), and the places y, (STEPS, 2), step by step."""
    place, rate = np.array([now.theta, now.xi[0]]), np.array([now.theta_rate, now.xi_rate[0]])
    found = list[Any]()
    for each in np.reshape(accelerations, (2, STEPS)).T:
        place = place + STEP * rate + STEP**2 / 2 * each
        rate = rate + STEP * each
        away = RADIUS - place[1]
        found.append([rate[0], place[1], away * np.cos(place[0]), away * np.sin(place[0])])
    rows = np.array(found)
    return rows[:, 0], rows[:, 1], rows[:, 2:]


def cost(now: Any, accelerations: Any, aim: str) -> float:
    across, speed, place = EXAMPLE["WEIGHTS"][aim]
    rate, xi, y = predicted(now, accelerations)
    clock = now.speed * (now.t + STEP * np.arange(1, STEPS + 1))
    wanted = RADIUS * np.column_stack([np.cos(clock), np.sin(clock)])
    angular, radial = np.reshape(accelerations, (2, STEPS))
    effort = EXAMPLE["EFFORT"] * ((RADIUS * angular) ** 2 + radial**2).sum()
    aims = across * (xi**2).sum() + speed * ((rate - now.speed) ** 2).sum()
    return aims + place * ((y - wanted) ** 2).sum() + effort


@pytest.mark.parametrize("law", LAWS)
def test_its_programmes_are_solved(law: Any) -> None:
    """No better plan is near, found by another method in random states, which respect the wall."""
    random = np.random.default_rng(3)
    for _ in range(5):
        theta = random.uniform(-0.2, 0.5)
        now = SimpleNamespace(
            t=(theta + random.uniform(0, 0.3)) / 2,
            theta=theta,
            theta_rate=random.normal(2, 0.5),
            xi=random.normal(0, 1e-3, 1),
            xi_rate=random.normal(0, 0.02, 1),
            speed=2.0,
        )
        made = law()
        first = made(now)
        assert np.array_equal(first, made.guess[[0, STEPS]])
        assert predicted(now, made.guess)[2][:, 1].max() <= TOP + 1e-6
        better = minimize(
            lambda a, now=now: cost(now, a, law.aim),
            made.guess + random.normal(0, 0.05, 2 * STEPS),
            method="SLSQP",
            constraints={
                "type": "ineq",
                "fun": lambda a, now=now: TOP - predicted(now, a)[2][:, 1],
            },
        )
        assert cost(now, made.guess, law.aim) <= 1.001 * better.fun + 1e-9


def test_at_a_wall_that_it_knows_it_stops_on_its_path_and_tracking_leaves_it() -> None:
    """It stops where the circle meets the wall, 1 mm before it, and goes on when it is gone."""
    wall = (0, EXAMPLE["UNTIL"], (0, WALL), -np.pi / 2)
    given: dict[str, Any] = {"control_rate": 100, "speed": 2, "wall": wall, "duration": 2.3}
    following, tracking = (onpath.simulate(law=law, **given) for law in LAWS)
    before = following.t < EXAMPLE["UNTIL"]
    for run in (following, tracking):
        assert run.stopped_at is None and run.y[before, 1].max() < WALL
    assert following.max_distance < 1e-4
    assert abs(following.theta[before][-1] - np.arcsin(TOP / RADIUS)) < 1e-3
    assert abs(following.theta_rate[-1] - 2) < 0.02
    assert abs(tracking.max_distance - (RADIUS - TOP)) < 2e-4
    assert abs(tracking.theta[-1] - 2 * 2.3) % (2 * np.pi) < 0.02
