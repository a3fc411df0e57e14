"""A law with memory in plain Python, called in every control interval: no haste after a hold."""

import onpath


class Patient:
    """Path following that gains 0.5 rad/s at a time."""

    def __init__(self):
        self.speed = 0.0

    def __call__(self, now):
        self.speed = min(now.theta_rate + 0.5, now.speed)
        along = -now.K5 * (now.theta_rate - self.speed)
        return along, -now.K1 * now.xi[0] - now.K2 * now.xi_rate[0]


if __name__ == "__main__":
    print(onpath.simulate(law=Patient, hold=(1, 2), duration=3))
