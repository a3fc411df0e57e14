"""`onpath experiment` and `onpath zero-dynamics`, which reproduce results of the paper."""

from __future__ import annotations

import json
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

from onpath.app.cli.assignments import assignments
from onpath.app.cli.path_option import read_path
from onpath.app.cli.robot_options import NO_OPTIONS, FileOptions
from onpath.app.common.atomic_file import check_plot, check_writable, whole_file
from onpath.app.exports.summary_text import finite, summary_lines

if TYPE_CHECKING:
    from onpath.models.systems.robots import Robot


@dataclass(frozen=True)
class ExperimentCommand:
    """Run one of the paper's experiments and print a report."""

    name: Annotated[str, tyro.conf.Positional]
    """position, obstruction or flexible (flexible link only)."""
    robot: str = ""
    """Name of the robot, or its URDF or MJCF file; by default the paper's."""
    file_options: FileOptions = NO_OPTIONS
    law: Annotated[str, tyro.conf.arg(aliases=("--controller",))] = "both"
    """Laws to run: names with commas between, all, or both (trajectory_tracking and
    path_following); or a law of your own, as "across = -K1*xi - K2*dxi; along = -K5*(dtheta -
    speed)", or in a Python file, as my_law.py:Name."""
    path: str | None = None
    """Path: a preset, "circle R", "ellipse A B", "closed Z1 Z2 Z1 Z2 ...", "open ...", "segment
    ...", "implicit EXPRESSION" (of z1 and z2, 0 on the path; followed by its distance, or with
    --set across=level_set by the expression), or JSON with points; in metres. Or @FILE with such a
    text, points (CSV), a drawing (SVG) or G-code, and perhaps options: "@logo.svg fit=0.1
    centre=0,0.01 corners=round radius=0.01 nearest"; also scale=, unit=mm, part=2, open, closed."""
    profile: str | None = None
    """Wanted speed over time, linear between points, as 0:0,1:6.28,4:6.28 in s and rad/s."""
    set: Annotated[tuple[str, ...], tyro.conf.UseAppendAction] = ()
    """Set any parameter or part of the schedule, as name=value; repeat for more."""
    csv: Path | None = None
    """Write every millisecond to this CSV file, with the joint angles as measured beside the true
    ones if sensors are not exact."""
    plot: Path | None = None
    """Draw the paper's figures to this .png, .svg or .pdf file."""
    json: bool = False
    """Print a summary as JSON."""

    def run(self) -> None:
        """Simulate, then write and print the requested output."""
        from onpath.app.exports.figures import draw_experiment
        from onpath.models.closed_loop.trajectory import write_csv
        from onpath.models.control.laws.own import law_title
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
        check_plot(self.plot)
        if self.csv:
            check_writable(self.csv)
        chosen = known[self.name]
        if self.path is not None:
            chosen = chosen.along(read_path(self.path, chosen.robot()), self.path)
        times = {} if self.profile is None else {"profile": self.profile}
        given, laws = assignments(self.set) | times, laws_named(self.law, chosen.robot())
        chosen = chosen.with_values(given)
        remark = path_remark(chosen.curve())
        for text in (remark, unused_text(chosen, laws, given), forecast_text(chosen, laws)):
            if text:
                print(f"onpath: {text}", file=sys.stderr)
        runs = [run(chosen, name) for name in laws]
        result = summary(chosen, runs)
        if self.csv:
            with whole_file(self.csv) as path, path.open("w", encoding="utf-8", newline="") as file:
                write_csv(file, chosen.robot(), runs)
        if self.plot:
            with whole_file(self.plot) as path:
                draw_experiment(chosen, runs, path)
        for each in runs:
            if text := beyond_limits(each, chosen.robot()):
                print(f"onpath: {law_title(each.law)}: {text}", file=sys.stderr)
        reasons = {each.law: each.reason or never_held(chosen, each) for each in runs}
        print(json.dumps(finite(result), indent=2) if self.json else _table(result, reasons))


@dataclass(frozen=True)
class ZeroDynamicsCommand:
    """Compute the exponents of the zero dynamics, of a robot with fewer motors than coordinates."""

    robot: str = "flexible"
    """Name of the robot. For the flexible one, the table has alpha and the number of modes."""
    at: tuple[float, float] = (0.0, 0.0)
    """Place of the end-point at rest in the path's plane, in metres; for the flexible robot, y2
    and y3."""
    set: Annotated[tuple[str, ...], tyro.conf.UseAppendAction] = ()
    """Set a parameter as name=value; repeat for more."""
    plot: Path | None = None
    """Draw exponents and critical alpha of the flexible robot to this .png, .svg or .pdf file."""
    json: bool = False
    """Print the table as JSON."""

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
        from onpath.models.systems.catalogue import robot_named

        entry = robot_named(self.robot)
        if self.plot:
            raise ValueError("--plot: only the zero dynamics of the flexible robot are drawn")
        result = robot_study(entry, assignments(self.set), self.at)
        if isinstance(result, str):
            print(json.dumps({"robot": self.robot, "exponents_1_s": []}) if self.json else result)
        else:
            print(json.dumps(robot_json(result), indent=2) if self.json else robot_table(result))


def laws_named(text: str, robot: Robot) -> list[str]:
    """The laws that a text asks for: "all", "both", a typed law, or names with commas between.

    "all" are all laws that suit the robot. A name may be FILE.py:NAME.

    Raises:
        ValueError: an unknown name, or a text that is not a law.
    """
    from onpath.app.common.own_laws import law_given
    from onpath.models.control.laws.own import is_text
    from onpath.models.control.laws.python_law import IN_FILE
    from onpath.models.control.laws.registry import LAWS, NAMES
    from onpath.models.systems.parameter_specs import unknown_name

    if text in ("all", "both"):
        suitable = [name for name, law in LAWS.items() if law.suits(robot.system)]
        return suitable if text == "all" else list(NAMES)
    if is_text(text):
        return [law_given(text)]
    given = dict.fromkeys(name.strip() for name in text.split(","))
    names = [law_given(name) if IN_FILE.fullmatch(name) else name for name in given]
    for name in names:
        if name not in LAWS:
            raise unknown_name(name, [*LAWS, "all", "both"], "law")
    return names


def _table(result: dict, reasons: dict[str, str]) -> str:
    """The summary as text."""
    from onpath.models.control.laws.own import law_title

    lines = [result["experiment"]]
    for law, values in result["laws"].items():
        lines.append(f"  {law_title(law)}")
        lines += [f"    {line}" for line in summary_lines(values)]
        if reasons[law]:
            lines.append(f"    {reasons[law]}")
    return "\n".join(lines)
