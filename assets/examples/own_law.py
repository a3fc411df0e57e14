"""A custom law, compiled like all others; in the lab: onpath --law own_law.py:SlidingMode"""

import casadi as ca

import onpath


class SlidingMode:
    """Pulls back with 2 m/s², however near the path is."""

    gains = ("K4", "K5")

    def command(self, view):
        pull = 2 * ca.tanh((view.output.xi_rate + 20 * view.output.xi) / 0.02)
        return onpath.followed(view, onpath.tangential(view), -20 * view.output.xi_rate - pull)


if __name__ == "__main__":
    print(onpath.simulate(law=SlidingMode, hold=(1, 2), duration=3))
