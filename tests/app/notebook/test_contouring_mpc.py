"""The example of model-predictive contouring: its optimum, its torques and its motion."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.optimize import lsq_linear

import onpath
from onpath.models.control.laws.python_law import Now, law_in
from tests.support.checkout import ROOT

LAW = f"{ROOT / 'assets' / 'examples' / 'contouring_mpc.py'}:Contouring"
HELD: dict[str, Any] = {"law": LAW, "control_rate": 100, "hold": (2, 3), "duration": 5}


@pytest.mark.parametrize("robot", ["five_bar", "spatial_arm", "rod_gantry", "seven_axes"])
def test_a_function_knows_the_torques_of_its_command(robot: str) -> None:
    random, wanted = np.random.default_rng(4), list[Any]()

    def law(now: Now) -> Any:
        command = -now.K2 * np.append(now.theta_rate - 1, now.xi_rate)
        command += random.normal(size=command.size) - now.K1 * np.append(0, now.xi)
        wanted.append(now.torque + now.torque_gain @ command)
        assert (now.torque_limit > 0).all()
        return command

    run = onpath.simulate(robot, law=law, duration=0.3)
    _, *asked = wanted  # the first call, before the run, checks what is returned
    np.testing.assert_allclose(run.torque, asked, rtol=1e-9, atol=1e-9)


def test_its_programmes_are_solved() -> None:
    """Against least squares with bounds on the torques, in random states."""
    given, random = list[dict[str, Any]](), np.random.default_rng(1)
    made = law_in(LAW).called
    assert made is not None
    law: Any = made()
    law(a_state(random))
    solver = law.solver

    def recorded(**values: Any) -> Any:
        given.append(values)
        return solver(**values)

    law.solver = recorded
    bound = 0
    for _ in range(200):
        first = law(now := a_state(random))
        values = given.pop()
        h, g, a = (np.asarray(values[name]) for name in ("h", "g", "a"))
        root = np.linalg.cholesky(h).T
        per_torque = np.linalg.inv(a)
        found = lsq_linear(
            root @ per_torque,
            -np.linalg.solve(root.T, g),
            (values["lba"], values["uba"]),
            method="bvls",
            tol=1e-14,
        )
        free = np.linalg.solve(root.T, g) @ np.linalg.solve(root.T, g)

        def cost(x: Any, h: Any = h, g: Any = g, free: Any = free) -> Any:
            """Above that of the optimum without limits."""
            return x @ h @ x + 2 * g @ x + free

        exact, solved = per_torque @ found.x, solver(**values)["x"].full()[:, 0]
        assert cost(solved) <= 1.001 * cost(exact) + 1e-6 * free
        np.testing.assert_array_equal(first, solved[:2])
        torque = now.torque + now.torque_gain @ first
        assert (np.abs(torque) <= now.torque_limit + 1e-6).all()
        bound += (np.abs(torque) > now.torque_limit - 1e-6).any()
    assert bound > 20


def a_state(random: np.random.Generator) -> Now:
    """A state near the path of a robot with two motors, at whose limits the optimum often is."""
    numbers = dict.fromkeys(("K1", "K2", "K3", "K4", "K5", "t"), 0.0)
    none = np.zeros(2)
    return Now(
        interval=0.01,
        q=none,
        v=none,
        y=none,
        y_rate=none,
        theta=0.0,
        theta_rate=random.normal(6, 2),
        xi=random.normal(0, 0.005, 1),
        xi_rate=random.normal(0, 0.1, 1),
        speed=6.0,
        torque=random.normal(0, 0.1, 2),
        torque_gain=random.normal(0, 0.01, (2, 2)),
        torque_limit=np.full(2, 0.5),
        **numbers,
    )


@pytest.mark.thorough
@pytest.mark.parametrize("limit", [0.2, 0.3, 1.0])
def test_it_uses_the_torque_that_there_is_and_no_more(limit: float) -> None:
    run = onpath.simulate(torque_limit=limit, **HELD)
    assert run.stopped_at is None
    assert limit - 1e-4 < np.abs(run.torque).max() <= limit + 1e-9


@pytest.mark.thorough
@pytest.mark.parametrize("robot", ["five_bar", "two_link_arm", "spatial_arm"])
def test_it_follows_its_path_free_held_and_released(robot: str) -> None:
    """Within 0.02, 0.5 and 0.5 mm, and at its speed in the end."""
    run = onpath.simulate(robot, torque_limit=1.5, **HELD)
    distance = np.abs(run.distance)
    assert run.stopped_at is None
    for since, until, bound in [(1.5, 2, 2e-5), (2, 3, 5e-4), (3, 5, 5e-4), (4, 5, 2e-5)]:
        assert distance[(since <= run.t) & (run.t < until)].max() < bound
    assert abs(run.theta_rate[-1] - 2 * np.pi) < 0.05
