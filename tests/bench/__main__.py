"""Measure the speed of the closed loops and of the lab, or attack a server in use."""

from __future__ import annotations

import sys
from dataclasses import dataclass

import tyro

from tests.bench.crowd import ClientLoad
from tests.bench.lecture import bench_class
from tests.bench.tables import bench, bench_crowds, bench_soak

INTERRUPTED = 130
SOAKED = 40  # honest clients


@dataclass(frozen=True)
class Bench:
    """Measure the speed of the closed loops and of the lab, or attack a server in use."""

    quick: bool = False
    """Run fewer repetitions, and no clients."""
    clients: tuple[int, ...] = ()
    """Only measure a server with this many simulated browsers; several numbers run in turn."""
    seconds: float = 15.0
    """Duration of the measurement, once all browsers are shown moving robots."""
    minutes: int = 0
    """Measure a row per minute for this long, to see whether memory use is constant."""
    soak: int = 0
    """Attack a server for so many minutes while 40 simulated browsers (--clients) use labs."""

    students: int = 0
    """Measure a class of so many scripted students: votes, a push, reloading, kill
    -9, a tenth of the machine, a cable that is pulled."""
    row: str = ""
    """With --students: only the rows whose names begin so, such as "kill"."""

    def run(self) -> int:
        """Print the tables; return exit code 1 if a bound of the soak is broken.

        Raises:
            ValueError: the options do not go together.
        """
        if self.soak:
            if self.soak < 0 or len(self.clients) > 1 or self.quick or self.minutes:
                raise ValueError("--soak: expected minutes, and only --clients with one number")
            return bench_soak(self.clients[0] if self.clients else SOAKED, self.soak)
        if self.students:
            bench_class(self.students, self.row)
            return 0
        if self.minutes < 0:
            raise ValueError(f"--minutes {self.minutes}: expected 1 or more")
        if not self.clients and (self.seconds, self.minutes) != (15.0, 0):
            raise ValueError("--seconds and --minutes go with --clients")
        if self.clients and self.quick:
            raise ValueError("--quick leaves out what --clients asks for")
        seconds, rows = (60.0, self.minutes) if self.minutes else (self.seconds, 1)
        crowds = [ClientLoad(clients, seconds, rows) for clients in self.clients]
        if crowds:
            bench_crowds(crowds)
        else:
            bench(quick=self.quick)
        return 0


def run_command(arguments: list[str]) -> int:
    """Run one command line; return the exit code: 2 for wrong options, 130 if interrupted."""
    try:
        return tyro.cli(Bench, prog="python -m tests.bench", args=arguments).run()
    except KeyboardInterrupt:
        return INTERRUPTED
    except ValueError as error:
        print(f"bench: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(run_command(sys.argv[1:]))
