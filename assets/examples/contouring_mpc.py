"""Model-predictive contouring with torque limits: a quadratic programme in every interval."""

import casadi as ca
import numpy as np

import onpath

STEPS, STEP = 8, 0.015  # the horizon, 8 intervals of 15 ms
MILLIMETRE, EFFORT = 1e-3, 1e-5
COLUMN, ROW = np.mgrid[:STEPS, :STEPS]
RATE = STEP * (COLUMN >= ROW)  # of accelerations: the rates after each interval
PLACE = STEP**2 * np.maximum(COLUMN - ROW + 0.5, 0)  # and the places


class Contouring:
    """Is soon at the wanted speed and near the path, with torques that the motors have.

    It minimises the sum of |xi|^2 / mm^2, (theta' - speed)^2 and little effort, with the torques'
    dependence on the accelerations as it is now. With more motors than outputs, or at a place where
    the robot needs more than its limits, there may be no solution, and the run stops.
    """

    solver = None

    def __call__(self, now):
        p, ahead = 1 + now.xi.size, STEP * np.arange(1, STEPS + 1)
        across, along = np.diag([0] + [1] * (p - 1)), np.diag([1] + [0] * (p - 1))
        h = np.kron(PLACE.T @ PLACE / MILLIMETRE**2, across) + np.kron(RATE.T @ RATE, along)
        xi = now.xi + np.outer(ahead, now.xi_rate)  # without acceleration
        g = PLACE.T @ np.insert(xi, 0, 0, axis=1) / MILLIMETRE**2
        g[:, 0] += RATE.sum(axis=0) * (now.theta_rate - now.speed)
        h += EFFORT * np.eye(len(h))
        a = np.kron(np.eye(STEPS), now.torque_gain)
        low, high = (np.tile(s * now.torque_limit - now.torque, STEPS) for s in (-1, 1))
        if self.solver is None:
            shapes = {"h": ca.Sparsity.dense(*h.shape), "a": ca.Sparsity.dense(*a.shape)}
            self.solver = ca.conic("solver", "daqp", shapes)
        found = self.solver(h=h, g=g.ravel(), a=a, lba=low, uba=high)
        return found["x"].full()[:p, 0]


if __name__ == "__main__":
    run = onpath.simulate(law=Contouring, control_rate=100, torque_limit=1, hold=(3, 5))
    print(run)
    print("largest torque:", abs(run.torque).max(), "N m")
