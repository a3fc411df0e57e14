"""Pulls off drawings, as in README.md of this folder: `python -m tests.bench.drawing_pulls FILE...`

Every robot is pulled, braked and walled in at random, with encoders and noise, on the given files,
on a leaf and on ten signatures. It takes an hour of processor time.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

import tyro

from onpath.models.path_files.placing import Placing
from onpath.models.path_files.reading import path_in
from onpath.models.paths.curve_faults import curve_faults
from onpath.models.paths.curves import Curve
from onpath.models.paths.drawing_design import drawn
from onpath.models.systems.catalogue import ROBOTS
from tests.bench.pulls import FILE, LAW, RATES, parameters
from tests.support.drawings import signature
from tests.support.pulls import Result, troubled

SIZES = (0.12, 0.1, 0.08, 0.06)  # [m]; the first one that a robot can follow
SIGNATURES, COUNT, SEED = 10, 34, 2026  # COUNT pulls of a robot on a drawing at a rate


def drawings(files: tuple[Path, ...]) -> list[Callable[[float], Curve]]:
    """Makers of the drawings of a size, [m]."""
    of_files = [partial(_of_file, file) for file in (FILE, *files)]
    return of_files + [partial(_signed, seed) for seed in range(SIGNATURES)]


def _of_file(file: Path, size: float) -> Curve:
    return path_in(file, Placing(fit=size, centre=(0.0, 0.0))).curve


def _signed(seed: int, size: float) -> Curve:
    return drawn(signature(seed, size)).curve


def pulled(robot: str, rate: int, made: Callable[[float], Curve], seed: int) -> list[Result]:
    """What became of a robot's pulls on a drawing; nothing if it can follow it at no size."""
    chosen, entry = parameters(robot, rate), ROBOTS[robot]
    margin = entry.make(chosen).margin
    curve = next((c for c in map(made, SIZES) if not curve_faults(margin, c)), None)
    return [] if curve is None else troubled(robot, chosen, LAW, seed, COUNT, curve)


def main(files: tuple[Path, ...] = ()) -> None:
    """Print a row for each robot: stops of all pulls, and the largest distance after 1.5 s."""
    print("| robot | " + " | ".join(f"{rate} Hz" for rate in RATES) + " |")
    print("|---" * (1 + len(RATES)) + "|")
    for robot, entry in ROBOTS.items():
        cells = list[str]()
        for rate in RATES:
            if entry.caution(parameters(robot, rate)) is not None:
                cells.append("—")
                continue
            results = [
                result
                for number, made in enumerate(drawings(files))
                for result in pulled(robot, rate, made, SEED + number)
            ]
            stops = sum(result.fault is not None for result in results)
            late = max((r.late for r in results if r.fault is None), default=0.0)
            cells.append(f"{stops} of {len(results)}, {1e3 * late:.1f} mm")
        print(f"| `{robot}` | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    tyro.cli(main, prog="python -m tests.bench.drawing_pulls")
