"""`onpath experiment` and `onpath zero-dynamics`, which reproduce results of the paper."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

import tyro

from onpath.app.common.atomic_file import check_plot, check_writable, whole_file
from onpath.app.exports.summary_text import summary_lines


@dataclass(frozen=True)
class ExperimentCommand:
    """Run one of the paper's experiments and print a report."""

    name: Annotated[str, tyro.conf.Positional]
    """position, obstruction or flexible (flexible link only)."""
    robot: str = ""
    """Name of the robot; by default the paper's."""
    controller: Literal["path_following", "trajectory_tracking", "both"] = "both"
    """Which controller to run."""
    set: Annotated[tuple[str, ...], tyro.conf.UseAppendAction] = ()
    """Set any parameter, as name=value; repeat for more."""
    csv: Path | None = None
    """Write every millisecond to this CSV file."""
    plot: Path | None = None
    """Draw the paper's figures to this .png, .svg or .pdf file."""
    json: bool = False
    """Print a summary as JSON."""

    def run(self) -> None:
        """Simulate, then write and print the requested output."""
        from onpath.app.exports.figures import draw_experiment
        from onpath.models.closed_loop.trajectory import write_csv
        from onpath.models.control.laws import NAMES
        from onpath.models.studies.experiments import experiments, run, summary
        from onpath.models.systems.parameters import unknown_name

        known = experiments(self.robot)
        if self.name not in known:
            raise unknown_name(self.name, list(known), what="experiment")
        check_plot(self.plot)
        if self.csv:
            check_writable(self.csv)
        chosen = known[self.name].with_values(_assignments(self.set))
        names = NAMES if self.controller == "both" else (self.controller,)
        runs = [run(chosen, name) for name in names]
        result = summary(chosen, runs)
        if self.csv:
            with whole_file(self.csv) as path, path.open("w", newline="") as file:
                write_csv(file, chosen.robot(), runs)
        if self.plot:
            with whole_file(self.plot) as path:
                draw_experiment(chosen, runs, path)
        reasons = {r.controller: r.reason for r in runs}
        print(json.dumps(result, indent=2) if self.json else _table(result, reasons))


@dataclass(frozen=True)
class ZeroDynamicsCommand:
    """Compute exponents of the flexible link's internal dynamics for alpha and number of modes."""

    at: tuple[float, float] = (0.0, 0.0)
    """y2 and y3 of the tip at rest, in metres."""
    set: Annotated[tuple[str, ...], tyro.conf.UseAppendAction] = ()
    """Set rho, plant, frequency or zeta, as name=value; repeat for more."""
    plot: Path | None = None
    """Draw exponents and critical alpha to this .png, .svg or .pdf file."""
    json: bool = False
    """Print the table as JSON."""

    def run(self) -> None:
        """Compute, draw and print the result."""
        from onpath.app.exports.figures_flexible import draw_zero_dynamics
        from onpath.app.exports.zero_dynamics import as_json, as_table, changed_all, study

        check_plot(self.plot)
        result = study(changed_all(_assignments(self.set)), self.at)
        if self.plot:
            with whole_file(self.plot) as path:
                draw_zero_dynamics(result, path)
        print(json.dumps(as_json(result), indent=2) if self.json else as_table(result))


def _assignments(pairs: tuple[str, ...]) -> dict[str, str]:
    values: dict[str, str] = {}
    for pair in pairs:
        name, equals, value = pair.partition("=")
        if not equals or not name or not value:
            raise ValueError(f"--set {pair}: expected name=value")
        values[name.strip()] = value.strip()
    return values


def _table(result: dict, reasons: dict[str, str]) -> str:
    """The summary as text."""
    lines = [result["experiment"]]
    for controller, values in result["controllers"].items():
        lines.append(f"  {controller.replace('_', ' ')}")
        lines += [f"    {line}" for line in summary_lines(values)]
        if reasons[controller]:
            lines.append(f"    {reasons[controller]}")
    return "\n".join(lines)
