"""How often stated intervals contain the truth: `python -m tests.bench.intervals`.

Logs of random motions are identified; in half of them the motors stick, which the estimate does not
assume. It takes some minutes of processor time.
"""

from __future__ import annotations

import sys
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import tyro

from tests.support.arm_logs import random_log, shares_allowed


@dataclass(frozen=True)
class Intervals:
    """Print how often the interval of each value contains the truth."""

    robots: Sequence[str] = ("five_bar", "two_link_arm")
    """Robots to identify."""
    count: int = 200
    """Logs of each robot with motors that stick, and half as many without."""

    def run(self) -> None:
        """Print the table."""
        print(f"{'robot':14s} {'value':8s} {'sticking':>10s} {'smooth':>10s}")
        for robot in self.robots:
            sticking, smooth = self._of(robot, True), self._of(robot, False)
            for name in sorted(sticking):
                print(f"{robot:14s} {name:8s} {_told(sticking[name])} {_told(smooth[name])}")

    def _of(self, robot: str, sticks: bool) -> dict[str, list[float]]:
        """Errors of each value relative to half of its interval."""
        found = defaultdict[str, list[float]](list)
        for seed in range(self.count if sticks else self.count // 2):
            log = random_log(robot, seed, sticks)
            try:
                shares = shares_allowed(robot, log) if log else {}
            except ValueError as error:
                if "hardly moves" not in str(error):
                    raise
                continue
            for name, share in shares.items():
                found[name].append(share)
        return found


def _told(shares: list[float]) -> str:
    inside = int(np.sum(np.array(shares) <= 1))
    return f"{inside:4d} of {len(shares):3d}"


if __name__ == "__main__":
    sys.exit(tyro.cli(Intervals).run())
