"""Predictive path following stops at a wall that it knows; predictive tracking slides along it.

After Arbo, Grøtli and Gravdahl, "On model predictive path following and trajectory tracking for
industrial robots" (2017, arXiv 1703.02279), beside two laws that do not know of the wall.
"""

import time

import casadi as ca
import numpy as np

import onpath

STEPS, STEP = 12, 0.015  # the horizon, 12 intervals of 15 ms
RADIUS, WALL, UNTIL = 0.05, 0.03, 2.0  # [m], and [s] when it is taken away
WEIGHTS = {"following": (1e6, 1.0, 0.0), "tracking": (0.0, 0.0, 1e6)}  # across, speed, place
EFFORT, MARGIN = 1e-5, 1e-3
COLUMN, ROW = np.mgrid[:STEPS, :STEPS]
RATE = STEP * (COLUMN >= ROW)  # of accelerations: the rates after each interval
PLACE = STEP**2 * np.maximum(COLUMN - ROW + 0.5, 0)  # and the places


def programme(across, speed, place):
    """A solver for the accelerations, of theta and xi, on a circle."""
    a, now, wanted = ca.SX.sym("a", STEPS, 2), ca.SX.sym("now", 2, 2), ca.SX.sym("wanted", STEPS, 2)
    ahead = STEP * np.arange(1, STEPS + 1)
    free = ca.repmat(now[0, :], STEPS, 1) + ca.DM(ahead) @ now[1, :]
    theta, xi = ca.horzsplit(free + ca.DM(PLACE) @ a)
    rate = now[1, 0] + ca.DM(RATE) @ a[:, 0]
    y = (RADIUS - xi) * ca.horzcat(ca.cos(theta), ca.sin(theta))
    clock = RADIUS * ca.horzcat(ca.cos(wanted[:, 0]), ca.sin(wanted[:, 0]))
    cost = across * ca.sumsqr(xi) + speed * ca.sumsqr(rate - wanted[:, 1])
    cost += place * ca.sumsqr(y - clock) + EFFORT * (
        ca.sumsqr(RADIUS * a[:, 0]) + ca.sumsqr(a[:, 1])
    )
    given = ca.vertcat(ca.vec(now), ca.vec(wanted))
    quiet = {"print_header": False, "print_iteration": False, "print_status": False}
    options = {"qpsol": "qrqp", "qpsol_options": {"print_iter": False, "print_header": False}}
    problem = {"x": ca.vec(a), "p": given, "f": cost, "g": y[:, 1]}
    return ca.nlpsol("solver", "sqpmethod", problem, {**quiet, **options, "print_time": False})


class PredictivePathFollowing:
    """Is on its path, behind the wall, and then at the wanted speed."""

    aim, spent = "following", []

    def __init__(self):
        self.solver, self.guess = programme(*WEIGHTS[self.aim]), np.zeros(2 * STEPS)

    def __call__(self, now):
        begin = time.perf_counter()
        known = [[now.theta, now.xi[0]], [now.theta_rate, now.xi_rate[0]]]
        clock = now.speed * (now.t + STEP * np.arange(1, STEPS + 1))
        given = np.concatenate([np.ravel(known, "F"), clock, np.full(STEPS, now.speed)])
        top = WALL - MARGIN if now.t < UNTIL else np.inf
        found = self.solver(x0=self.guess, p=given, ubg=top)["x"].full()[:, 0]
        self.guess = found
        self.spent.append(time.perf_counter() - begin)
        return found[[0, STEPS]]


class PredictiveTracking(PredictivePathFollowing):
    """Is behind the wall, and then as near as possible to a point that a clock moves on."""

    aim, spent = "tracking", []


if __name__ == "__main__":
    wall, runs = (0, UNTIL, (0, WALL), -np.pi / 2), []
    predictive = PredictivePathFollowing, PredictiveTracking
    for law in (*predictive, "path_following", "trajectory_tracking"):
        runs.append(onpath.simulate(law=law, control_rate=100, speed=2, wall=wall, duration=4))
        print(runs[-1])
    for law in predictive:
        print(f"{law.aim}: {1e3 * np.median(law.spent):.2f} ms, at most {1e3 * max(law.spent):.1f}")
    runs[0].plot(*runs[1:]).savefig("predictive.png")
