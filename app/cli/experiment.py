"""`onpath experiment` and `onpath zero-dynamics`, which reproduce results of the paper."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

from onpath.app.cli.assignments import assignments
from onpath.app.cli.laws import laws_named
from onpath.app.cli.options import Repeated
from onpath.app.cli.robot_options import NO_OPTIONS, FileOptions
from onpath.app.common.atomic_file import check_file, check_plot, whole_file
from onpath.app.exports.summary_text import finite, summary_lines

if TYPE_CHECKING:
    from onpath.models.closed_loop.trajectory import Trajectory
    from onpath.models.robot_files.guesses import Guess
    from onpath.models.studies.experiments import Experiment


@dataclass(frozen=True)
class ExperimentCommand:
    """Run one of the paper's experiments and print a report."""

    name: Annotated[str, tyro.conf.Positional]
    """position, obstruction or flexible (flexible link only)."""
    robot: str = ""
    """Name of the robot, or its URDF or MJCF file; by default the paper's."""
    path: str | None = None
    """Path: a preset, "circle R", "ellipse A B", "closed Z1 Z2 Z1 Z2 ...", "open ...", "segment
    ...", "implicit EXPRESSION" (of z1 and z2, 0 on the path; followed by its distance, or with
    --set across=level_set by the expression), or JSON with points; in metres. Or @FILE with such a
    text, points (CSV), a drawing (SVG) or G-code, and perhaps options: "@logo.svg fit=0.1
    centre=0,0.01 corners=round radius=0.01 nearest"; also scale=, turn=90, unit=mm,
    part=1,3, layer=2, open, closed."""
    law: Repeated = ()
    """A law: a name; all; both (trajectory_tracking and path_following); or one of your own, as
    "across = -K1*xi - K2*dxi; along = -K5*(dtheta - speed)", or in a Python file, my_law.py:Name.
    Repeat, or put commas between, for more. By default both."""
    profile: str | None = None
    """Wanted speed over time, linear between points, as 0:0,1:6.28,4:6.28 in s and rad/s."""
    set: Repeated = ()
    """Set any parameter or part of the schedule, as name=value; repeat for more."""
    csv: Path | None = None
    """Write every millisecond to this CSV file, with the joint angles as measured beside the true
    ones if sensors are not exact."""
    plot: Path | None = None
    """Draw the paper's figures to this .png, .svg or .pdf file."""
    log: Path | None = None
    """Draw the log of a real arm with --plot, on the axes of the runs; a file as for identify."""
    column: Repeated = ()
    """A column of the log, as for identify; repeat for more."""
    unit: Repeated = ()
    """Unit of a column of the log, as for identify; repeat for more."""
    json: bool = False
    """Print a summary as JSON."""
    file_options: FileOptions = NO_OPTIONS

    def run(self) -> None:
        """Simulate, then write and print the requested output."""
        check_plot(self.plot)
        check_file(self.csv, (".csv",), "--csv")

        from onpath.app.exports.figures import draw_experiment
        from onpath.app.notebook.arguments import curve_of
        from onpath.models.closed_loop.trajectory import write_csv
        from onpath.models.control.laws.own import law_title
        from onpath.models.control.laws.registry import LAWS
        from onpath.models.studies.experiments import (
            beyond_limits,
            experiments,
            forecast_text,
            never_held,
            path_remark,
            run,
            summary,
        )
        from onpath.models.studies.unused import unused_text
        from onpath.models.systems.parameter_specs import unknown_name

        known = experiments(self.file_options.name_of(self.robot))
        if self.name not in known:
            raise unknown_name(self.name, list(known), what="experiment")
        chosen = known[self.name]
        if self.path is not None:
            path = curve_of("--path", self.path, chosen.robot())
            chosen = chosen.along(path, self.path)
        times = {} if self.profile is None else {"profile": self.profile}
        given = assignments(self.set) | times
        suitable = [name for name, law in LAWS.items() if law.suits(chosen.robot().system)]
        laws = list(dict.fromkeys(laws_named(self.law or ("both",), suitable)))
        chosen = chosen.with_values(given)
        remark = path_remark(chosen.curve())
        for text in (remark, unused_text(chosen, laws, given), forecast_text(chosen, laws)):
            if text:
                print(f"onpath: {text}", file=sys.stderr)
        logged = self._logged(chosen)
        runs = [run(chosen, name) for name in laws]
        result = summary(chosen, runs)
        if self.csv:
            with (
                whole_file(self.csv) as scratch,
                scratch.open("w", encoding="utf-8", newline="") as file,
            ):
                write_csv(file, chosen.robot(), runs, guesses=chosen.entry.guesses)
        if self.plot:
            with whole_file(self.plot) as scratch:
                draw_experiment(chosen, runs + logged, scratch)
        for each in runs:
            if text := beyond_limits(each, chosen.robot()):
                print(f"onpath: {law_title(each.law)}: {text}", file=sys.stderr)
        reasons = {each.law: each.reason or never_held(chosen, each) for each in runs}
        if self.json:
            print(json.dumps(finite(result), indent=2))
        else:
            print(_table(result, reasons, chosen.entry.guesses))

    def _logged(self, experiment: Experiment) -> list[Trajectory]:
        """What is drawn of the log."""
        from onpath.app.common.user_files import user_file
        from onpath.models.studies.log_motion import read_motions

        if self.log is None:
            return []
        if self.plot is None:
            raise ValueError("--log is drawn beside the runs: add --plot and a file")
        columns = assignments(self.column, "--column")
        units = assignments(self.unit, "--unit")
        return read_motions(user_file(self.log), experiment, columns, units)


@dataclass(frozen=True)
class ZeroDynamicsCommand:
    """Compute the exponents of the zero dynamics, of a robot with fewer motors than coordinates."""

    robot: str = "flexible"
    """Name of the robot, or its URDF or MJCF file. For the flexible one, the table has alpha and
    the number of modes."""
    at: tuple[float, float] = (0.0, 0.0)
    """Place of the end-point at rest in the path's plane, in metres; for the flexible robot, y2
    and y3."""
    set: Repeated = ()
    """Set a parameter as name=value; repeat for more."""
    plot: Path | None = None
    """Draw exponents and critical alpha of the flexible robot to this .png, .svg or .pdf file."""
    json: bool = False
    """Print the table as JSON."""
    file_options: FileOptions = NO_OPTIONS

    def run(self) -> None:
        """Compute, draw and print the result."""
        from onpath.app.exports.figures_flexible import draw_zero_dynamics
        from onpath.app.exports.zero_dynamics import as_json, as_table, changed_all, study
        from onpath.models.systems.catalogue import FLEXIBLE

        check_plot(self.plot)
        if self.robot != FLEXIBLE.name:
            self._of_robot()
            return
        result = study(changed_all(assignments(self.set)), self.at)
        if self.plot:
            with whole_file(self.plot) as path:
                draw_zero_dynamics(result, path)
        print(json.dumps(as_json(result), indent=2) if self.json else as_table(result))

    def _of_robot(self) -> None:
        from onpath.app.exports.zero_dynamics import robot_json, robot_study, robot_table

        entry = self.file_options.entry_of(self.robot)
        if self.plot:
            raise ValueError("--plot: only the zero dynamics of the flexible robot are drawn")
        result = robot_study(entry, assignments(self.set), self.at)
        if isinstance(result, str):
            print(json.dumps({"robot": self.robot, "exponents_1_s": []}) if self.json else result)
        else:
            print(json.dumps(robot_json(result), indent=2) if self.json else robot_table(result))


def _table(result: dict, reasons: dict[str, str], guesses: Sequence[Guess]) -> str:
    """The summary as text."""
    from onpath.models.control.laws.own import law_title

    lines = [result["experiment"]]
    for law, values in result["laws"].items():
        lines.append(f"  {law_title(law)}")
        lines += [f"    {line}" for line in summary_lines(values, guesses)]
        if reasons[law]:
            lines.append(f"    {reasons[law]}")
    return "\n".join(lines)
