"""`onpath sweep`: runs for all combinations of robots, paths, laws and settings."""

from __future__ import annotations

import csv
import json
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from onpath.app.cli.assignments import assignments
from onpath.app.cli.options import Repeated
from onpath.app.cli.robot_options import NO_OPTIONS, FileOptions
from onpath.app.common.atomic_file import check_file, check_plot, whole_file


@dataclass(frozen=True)
class SweepCommand:
    """Simulate all combinations of robots, paths, laws and settings; print a row for each."""

    robot: Repeated = ()
    """Name of a robot, or its URDF or MJCF file. Repeat, or put commas between, for more. By
    default five_bar."""
    path: Repeated = ()
    """A path, or @FILE with options, as for onpath experiment; repeat for more. By default circle.
    """
    law: Repeated = ()
    """A law: a name; all; both; one of your own, typed, or as my_law.py:Name; repeat for more. By
    default both."""
    set: Repeated = ()
    """A setting with its values, as K1=400,900; repeat for more."""
    hold: tuple[float, float] | None = None
    """Hold the robot back from the first of these times to the second, in seconds."""
    duration: float = 8.0
    """Simulated time, in seconds."""
    folder: Path | None = None
    """Keep finished rows in this folder: a sweep that was interrupted goes on where it was."""
    csv: Path | None = None
    """Write the table to this CSV file."""
    plot: Path | None = None
    """Draw the largest distance over the setting with the most values to this .png, .svg or .pdf
    file."""
    json: bool = False
    """Print the table as JSON."""
    file_options: FileOptions = NO_OPTIONS

    def run(self) -> None:
        """Simulate, then write and print the table."""
        check_plot(self.plot)
        check_file(self.csv, (".csv",), "--csv")

        from onpath.app.cli.laws import laws_named
        from onpath.app.exports.summary_text import finite
        from onpath.app.notebook.arguments import named_by_command
        from onpath.app.notebook.sweep import sweep
        from onpath.models.control.laws.registry import LAWS

        given = assignments(self.set, form="name=value,value")
        values = {name: [_value(each) for each in text.split(",")] for name, text in given.items()}
        with named_by_command():
            result = sweep(
                _one_or_several(self.file_options.names_of(self.robot or ("five_bar",))),
                _one_or_several(self.path or ("circle",)),
                _one_or_several(laws_named(self.law or ("both",), list(LAWS))),
                hold=self.hold,
                duration=self.duration,
                folder=self.folder,
                **{name: _one_or_several(each) for name, each in values.items()},
            )
        if self.csv:
            with (
                whole_file(self.csv) as scratch,
                scratch.open("w", encoding="utf-8", newline="") as file,
            ):
                names = dict.fromkeys(name for row in result.table for name in row)
                writer = csv.DictWriter(file, list(names))
                writer.writeheader()
                writer.writerows(result.table)
        if self.plot:
            result.plot(self.plot)
        print(json.dumps(finite(result.table), indent=2) if self.json else result)


def _one_or_several(values: Sequence[Any]) -> Any:
    return values[0] if len(values) == 1 else list(values)


def _value(text: str) -> float | str:
    """A value as Python takes it."""
    for kind in (int, float):
        with suppress(ValueError):
            return kind(text)
    return text.strip()
