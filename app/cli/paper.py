"""`onpath paper`: a figure of the paper, with the paper's settings, or a map of the rank test."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import tyro

from onpath.app.cli.assignments import assignments
from onpath.app.cli.options import Repeated
from onpath.app.cli.robot_options import NO_OPTIONS, FileOptions
from onpath.app.common.atomic_file import check_plot, whole_file
from onpath.app.exports.summary_text import finite, summary_lines

if TYPE_CHECKING:
    from onpath.models.systems.parameters import Parameters
    from onpath.models.systems.robots import RobotEntry

RANK, CROSSING = "rank", "crossing"
NAMES = "2", "3", "5", "6", "7", RANK, CROSSING


@dataclass(frozen=True)
class PaperCommand:
    """Run what one of the paper's figures shows; print its settings and the numbers of the runs."""

    name: Annotated[str, tyro.conf.Positional]
    """2, 3, 5, 6 or 7; rank, the rank test (11) over the workspace of a robot; or crossing, three
    ways to follow a figure of eight."""
    robot: str = ""
    """Name of the robot, or its URDF or MJCF file, for rank; by default five_bar."""
    set: Repeated = ()
    """Set any parameter of the robot, for rank, as name=value; repeat for more."""
    plot: Path | None = None
    """Draw the figure to this .png, .svg or .pdf file."""
    json: bool = False
    """Print settings and numbers as JSON."""
    file_options: FileOptions = NO_OPTIONS

    def run(self) -> None:
        """Simulate or compute, then draw and print."""
        check_plot(self.plot)
        others = {RANK: (self._rank, _rank_text), CROSSING: (self._crossing, _crossing_text)}
        compute, as_text = others.get(self.name, (self._repeated, _text))
        result = compute()
        print(
            json.dumps(finite(result), indent=2, ensure_ascii=False)
            if self.json
            else as_text(result)
        )

    def _repeated(self) -> dict[str, Any]:
        from onpath.models.studies.paper_figures import FIGURES, figure_summary

        known = {str(number): figure for number, figure in FIGURES.items()}
        if self.name not in known:
            names = ", ".join([*known, RANK, CROSSING])
            raise ValueError(f"paper {self.name}: expected one of {names}")
        self._check_fixed("the paper's robot and settings")
        figure = known[self.name]
        runs = figure.runs()
        if self.plot:
            from onpath.app.exports.paper_figures import draw_paper_figure

            with whole_file(self.plot) as path:
                draw_paper_figure(figure, runs, path)
        return figure_summary(figure, runs)

    def _check_fixed(self, what: str) -> None:
        if self.robot or self.set:
            raise ValueError(f"paper {self.name} has {what}")

    def _crossing(self) -> dict[str, Any]:
        from onpath.app.exports.crossing_figure import crossing_summary, draw_crossing_figure
        from onpath.models.studies.crossing import crossing_runs, planned

        self._check_fixed("its own robot and settings")
        experiment = planned()
        runs = crossing_runs(experiment)
        if self.plot:
            with whole_file(self.plot) as path:
                draw_crossing_figure(experiment, runs, path)
        return crossing_summary(runs)

    def _rank(self) -> dict[str, Any]:
        from onpath.app.exports.rank_figure import draw_rank_figure, rank_summary
        from onpath.models.control.settable import changed
        from onpath.models.systems.catalogue import FIVE_BAR

        entry = self.file_options.entry_of(self.robot or FIVE_BAR.name)
        parameters = entry.parameters()
        for key, value in assignments(self.set).items():
            parameters = changed(parameters, key, value)
            if not _matters_at_rest(entry, parameters, key):
                raise ValueError(f"{key}: the rank test does not depend on it")
        if self.plot:
            with whole_file(self.plot) as path:
                draw_rank_figure(entry, parameters, path)
        return rank_summary(entry, parameters)


def _matters_at_rest(entry: RobotEntry, parameters: Parameters, name: str) -> bool:
    """Whether a parameter selects another robot, or changes the numbers of its model."""
    from onpath.models.control.settable import changed, specs

    spec, robot = specs(parameters)[name], entry.make(parameters)
    for value in spec.options or (spec.low, spec.high):
        other = changed(parameters, name, value)
        if entry.make(other) is not robot:
            return True
        if (robot.plant(other) != robot.plant(parameters)).any():
            return True
    return False


def _rank_text(result: dict[str, Any]) -> str:
    lines = [
        f"Rank test (11): {result['robot']}",
        f"  smallest singular value of (dh/dq) g_v  [{result['unit']}]",
        f"    with the end-point at home  {result['home']:g}",
        f"    largest in the path's plane {result['largest']:g}",
    ]
    return "\n".join(lines)


def _crossing_text(result: dict[str, Any]) -> str:
    from onpath.models.studies.crossing import WAYS

    lines = ["From rest at the crossing of a path, in three ways"]
    for key, numbers in result["runs"].items():
        first = numbers["first_jump_s"]
        when = "" if first is None else f", the first after {first:.2f} s"
        lines += [
            f"  {WAYS[key]}",
            f"    jumps of the closest point  {numbers['jumps']}{when}",
            f"    along the path at the end   {numbers['theta_at_end_rad']:.2f} rad",
        ]
    return "\n".join(lines)


def _text(result: dict[str, Any]) -> str:
    lines = [f"Figure {result['figure']}: {result['title']}", "  from the paper's text"]
    lines += [f"    {line}" for line in result["given"]]
    lines += ["  illustrative", *(f"    {line}" for line in result["illustrative"])]
    for law, values in result["laws"].items():
        lines += [f"  {law.replace('_', ' ')}", *(f"    {line}" for line in summary_lines(values))]
    return "\n".join(lines)
