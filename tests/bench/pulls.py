"""The table of pulls in README.md: `python -m tests.bench.pulls --write` draws it again.

Every robot is pulled, braked and walled in at random, with encoders and noise, on every preset
path and on one from a file. It takes some minutes of processor time.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cache

import tyro

from onpath.models.errors import Message
from onpath.models.path_files.placing import Placing
from onpath.models.path_files.reading import path_in
from onpath.models.paths.curve_faults import curve_faults
from onpath.models.paths.curves import Curve
from onpath.models.paths.path_design import presets
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import Parameters
from tests.support.checkout import ROOT
from tests.support.pulls import Result, parameters_of, troubled, untouched

README = ROOT / "README.md"
BEGIN, END = "<!-- made by `python -m tests.bench.pulls --write` -->", "<!-- end -->"
FILE, FROM_FILE = ROOT / "tests" / "data" / "leaf.svg", "from a file"
LAW = "path_following"
RATES = (1000, 250, 100)
SENSORS = {"encoder_counts": 2000.0, "sensor_noise": 1e-4}
COUNT, SEED = 8, 2026  # of each robot on each path at each rate


@dataclass
class Cell:
    """What became of the runs of a robot at a control rate.

    Attributes:
        caution: why it is not run at all, which the lab says before.
        untouched: largest distance of a run that nobody touches, from 1 s on, [m].
        idle: paths on which it stops untouched, or which it cannot follow.
        results: of the pulls.
    """

    caution: Message | None = None
    untouched: float = 0.0
    idle: list[str] = field(default_factory=list[str])
    results: list[Result] = field(default_factory=list[Result])

    @property
    def stops(self) -> int:
        """How many pulls ended in a stop."""
        return sum(each.fault is not None for each in self.results)

    @property
    def late(self) -> float:
        """Largest distance from 1.5 s after the release on, of runs that did not stop, [m]."""
        return max((each.late for each in self.results if each.fault is None), default=0.0)

    def text(self) -> str:
        """As it stands in the table."""
        if self.caution is not None:
            return "—"
        return f"{self.stops} of {len(self.results)}, {1e3 * self.late:.1f} mm"


@cache
def paths() -> dict[str, Curve]:
    """The preset paths, and one from a file, by name."""
    drawn = path_in(FILE, Placing(fit=0.1, centre=(0.0, 0.0))).curve
    return {name: design.curve for name, design in presets().items()} | {FROM_FILE: drawn}


def parameters(robot: str, rate: int) -> Parameters:
    """The settings of a column."""
    return parameters_of(robot, control_rate=rate, **SENSORS)


def drawn(robot: str, rate: int, count: int = COUNT, names: Sequence[str] = ()) -> Cell:
    """Pull a robot `count` times on each path.

    Args:
        names: of the paths; none: all.
    """
    chosen, entry = parameters(robot, rate), ROBOTS[robot]
    cell = Cell(caution=entry.caution(chosen))
    if cell.caution is not None:
        return cell
    margin = entry.make(chosen).margin
    for name in names or paths():
        curve = paths()[name]
        far = None if curve_faults(margin, curve) else untouched(robot, chosen, LAW, curve)
        if far is None:
            cell.idle.append(name)
            continue
        cell.untouched = max(cell.untouched, far)
        cell.results += troubled(robot, chosen, LAW, SEED, count, curve)
    return cell


def table(cells: dict[tuple[str, int], Cell]) -> Iterator[str]:
    """The lines of the table."""
    yield "| robot | " + " | ".join(f"{rate} Hz" for rate in RATES) + " |"
    yield "|---" * (1 + len(RATES)) + "|"
    for robot in dict.fromkeys(robot for robot, _ in cells):
        texts = [cells[robot, rate].text() for rate in RATES]
        yield " | ".join([f"| `{robot}`", *texts]) + " |"


def shown() -> dict[tuple[str, int], tuple[int, int, float] | None]:
    """What README.md says: stops, pulls and the distance [mm]; None for a dash."""
    text = README.read_text("utf-8").partition(BEGIN)[2].partition(END)[0]
    found = dict[tuple[str, int], tuple[int, int, float] | None]()
    for line in text.strip().splitlines()[2:]:
        robot, *cells = (each.strip(" `") for each in line.strip("|").split("|"))
        for rate, cell in zip(RATES, cells, strict=True):
            words = cell.replace(",", "").split()
            told = None if cell == "—" else (int(words[0]), int(words[2]), float(words[3]))
            found[robot, rate] = told
    return found


@dataclass(frozen=True)
class Pulls:
    """Draw the table of pulls in README.md."""

    count: int = COUNT
    """Pulls of each robot on each path at each rate."""
    robot: tuple[str, ...] = ()
    """Only these robots."""
    write: bool = False
    """Replace the table in README.md, too."""

    def run(self) -> None:
        """Draw, print, and perhaps write."""
        cells = dict[tuple[str, int], Cell]()
        for robot in self.robot or ROBOTS:
            for rate in RATES:
                cell = cells[robot, rate] = drawn(robot, rate, self.count)
                untouched = f"untouched {1e3 * cell.untouched:.2f} mm"
                skipped = f", not on {', '.join(cell.idle)}" if cell.idle else ""
                print(f"{robot}, {rate} Hz: {cell.text()}, {untouched}{skipped}", file=sys.stderr)
        lines = "\n".join(table(cells))
        print(lines)
        if self.write:
            before, _, rest = README.read_text("utf-8").partition(BEGIN)
            after = rest.partition(END)[2]
            README.write_text(f"{before}{BEGIN}\n\n{lines}\n\n{END}{after}", "utf-8")


if __name__ == "__main__":
    tyro.cli(Pulls, prog="python -m tests.bench.pulls").run()
