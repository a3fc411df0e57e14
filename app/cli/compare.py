"""`onpath compare`: all control laws under the same obstructions."""

from __future__ import annotations

import csv
import json
import math
import sys
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from onpath.app.cli.options import Repeated
from onpath.app.cli.robot_options import NO_OPTIONS, FileOptions
from onpath.app.common.atomic_file import check_file, check_plot, whole_file
from onpath.app.exports.summary_text import STOPPED, finite

if TYPE_CHECKING:
    from onpath.models.robot_files.guesses import Guess
    from onpath.models.studies.comparison import Contest, Outcome

    Results = dict[tuple[str, str], list[Outcome]]


@dataclass(frozen=True)
class CompareCommand:
    """Compare control laws: the same robot, path, gains and obstructions for all of them."""

    robot: str = "five_bar"
    """Name of the robot, or its URDF or MJCF file."""
    path: str | None = None
    """A closed path, or @FILE with options, as for onpath experiment; by default a circle."""
    law: Repeated = ()
    """A law to compare: a name; all; both; or one of your own, as "across = …; along = …", or in a
    Python file, my_law.py:Name. Repeat, or put commas between, for more. By default all that suit
    the robot."""
    obstruction: Repeated = ()
    """An obstruction; repeat for more. By default all. Those with weak motors run twice: with the
    remedy of at_limit and, as NAME_cut, without it."""
    radius: float | None = None
    """Radius of the circle to follow, in metres; 0.05 by default."""
    set: Repeated = ()
    """Set any parameter, as name=value; repeat for more."""
    csv: Path | None = None
    """Write all outcomes, a row for each run, to this CSV file."""
    plot: Path | None = None
    """Draw contour error against delay to this .png, .svg or .pdf file."""
    json: bool = False
    """Print all outcomes as JSON."""
    file_options: FileOptions = NO_OPTIONS

    def run(self) -> None:
        """Simulate, then write and print the requested output."""
        from onpath.app.cli.assignments import assignments
        from onpath.models.control.laws.own import law_title
        from onpath.models.studies.comparison import as_data, beyond_efforts, by_law, row_of
        from onpath.models.studies.experiments import forecast_text, on_path, path_remark
        from onpath.models.studies.unused import unused_text
        from onpath.models.systems.guessed_numbers import with_mark

        check_plot(self.plot)
        check_file(self.csv, (".csv",), "--csv")
        contest = self._contest()
        laws, guesses = _laws(self.law, contest), contest.entry.guesses
        plain = on_path(contest.entry, contest.parameters, contest.curve)
        given = assignments(self.set)
        remark = path_remark(contest.curve)
        for text in (remark, unused_text(plain, laws, given), forecast_text(plain, laws)):
            if text:
                print(f"onpath: {text}", file=sys.stderr)
        results = self._results(contest, laws)
        if self.csv:
            with whole_file(self.csv) as path, path.open("w", encoding="utf-8", newline="") as file:
                rows = [row_of(outcome) for outcomes in results.values() for outcome in outcomes]
                writer = csv.writer(file)
                writer.writerow(with_mark(name, guesses) for name in rows[0])
                writer.writerows(row.values() for row in rows)
        if self.plot:
            from onpath.app.exports.figures_comparison import draw_comparison

            with whole_file(self.plot) as path:
                draw_comparison(results, path)
        for law, outcomes in by_law(results).items():
            if beyond := beyond_efforts(contest.robot, outcomes):
                print(f"onpath: {law_title(law)}: {beyond}", file=sys.stderr)
        data = finite(as_data(contest, results)) if self.json else None
        print(json.dumps(data, indent=2) if self.json else table(results, guesses))

    def _contest(self) -> Contest:
        from onpath.app.cli.assignments import assignments
        from onpath.app.notebook.arguments import curve_of
        from onpath.models.control.settable import with_values
        from onpath.models.paths.curves import circle
        from onpath.models.studies.comparison import Contest
        from onpath.models.studies.experiments import check_path
        from onpath.models.systems.parameters import rise_of

        entry = self.file_options.entry_of(self.robot)
        radius = entry.radius if self.radius is None else self.radius
        if not 0.005 <= radius <= 0.12:
            raise ValueError(f"--radius {radius:g}: expected 0.005 to 0.12 m")
        if self.radius is not None and self.path is not None:
            raise ValueError(f"--radius {radius:g}: the path is given, and has no radius to set")
        parameters = with_values(entry.parameters(), assignments(self.set))
        if parameters.speed == 0 or parameters.task != "speed":
            raise ValueError("a comparison needs a speed along the path other than 0")
        if parameters.speed_profile != "constant":
            raise ValueError("speed_profile: a comparison is at a constant speed")
        if rise_of(parameters):
            raise ValueError("rise: a comparison is on a plane path")
        robot = entry.make(parameters)
        curve = circle(radius) if self.path is None else curve_of("--path", self.path, robot)
        if not curve.closed:
            raise ValueError(f"--path {self.path}: a comparison needs a closed path")
        check_path(robot, curve, f"--path {self.path}" if self.path else "")
        return Contest(entry, parameters, curve)

    def _results(self, contest: Contest, laws: list[str]) -> Results:
        from rich.console import Console
        from rich.progress import track

        from onpath.models.studies.comparison import OBSTRUCTIONS, compare, with_cut

        obstructions = with_cut(_known(self.obstruction, list(OBSTRUCTIONS), "obstruction"))
        pairs = compare(contest, laws, obstructions)
        console = Console(stderr=True)
        shown = track(
            pairs,
            "comparing",
            total=len(laws) * len(obstructions),
            console=console,
            transient=True,
            disable=not sys.stderr.isatty(),
        )
        return {(each[0].law, each[0].obstruction): each for each in shown}


def _laws(asked: tuple[str, ...], contest: Contest) -> list[str]:
    """The laws asked for, or all; each typed law on one line.

    Raises:
        ValueError: one of them does not exist, or cannot be compared.
    """
    from onpath.app.cli.laws import laws_named
    from onpath.models.control.laws.registry import law_named

    names = dict.fromkeys(laws_named(asked or ("all",), contest.laws(), calls=False))
    for name in names:
        if not contest.admits(name):
            suits = law_named(name).suits(contest.robot.system)
            does_not = f"suit {contest.robot.name}" if not suits else "take part in a comparison"
            raise ValueError(f"{name}: it does not {does_not}")
    return list(names)


def _known(names: tuple[str, ...], known: list[str], what: str) -> list[str]:
    """The names asked for, or all.

    Raises:
        ValueError: one of them does not exist, or cannot be compared.
    """
    from onpath.models.systems.parameter_specs import unknown_name

    for name in names:
        if name not in known:
            raise unknown_name(name, known, what)
    return list(dict.fromkeys(names)) or known


def law_columns(laws: Iterable[str]) -> dict[str, str]:
    """The laws' names in the table: typed laws are called `own`, or `own 1`, `own 2` and so on."""
    from onpath.models.control.laws.own import OWN, is_text

    names = list(laws)
    typed = [law for law in names if is_text(law)]
    numbered = {law: f"{OWN} {i + 1}" if len(typed) > 1 else OWN for i, law in enumerate(typed)}
    return {law: numbered.get(law, law) for law in names}


def table(results: Results, guesses: Sequence[Guess] = ()) -> str:
    """The worst distance [mm] and delay [s] of every law under every obstruction.

    Args:
        guesses: about the robot; what rests on them is marked.
    """
    from onpath.models.systems.guessed_numbers import with_mark

    laws = law_columns(dict.fromkeys(law for law, _ in results))
    obstructions = list(dict.fromkeys(name for _, name in results))
    lines = [f"{short}: {law}" for law, short in laws.items() if short != law]
    for name, title, cell in (
        ("max_distance_m", "largest distance from the path, worst place  [mm]", _distance),
        ("delay_s", "delay at the end, worst place  [s]", _delay),
    ):
        lines += [
            with_mark(title, guesses, name),
            " " * 20 + "".join(f"{each:>19s}" for each in obstructions),
        ]
        lines += [
            f"  {short:18s}" + "".join(f"{cell(results[law, each]):>19s}" for each in obstructions)
            for law, short in laws.items()
        ]
        lines.append("")
    lines.append(f"{STOPPED}: a run diverged at one of the places; see --json for all measures.")
    if any(name.endswith("_cut") for name in obstructions):
        lines.append("_cut: torques are cut at the limit. Without it the remedy at_limit acts.")
    return "\n".join(lines)


def _distance(outcomes: list[Outcome]) -> str:
    return _worst(outcomes, lambda outcome: 1000 * outcome.max_distance_m, ".2f")


def _delay(outcomes: list[Outcome]) -> str:
    return _worst(outcomes, lambda outcome: outcome.delay_s, ".2f")


def _worst(outcomes: list[Outcome], value: Callable[[Outcome], float], form: str) -> str:
    worst = max(map(value, outcomes), key=abs) + 0.0
    return STOPPED if math.isinf(worst) else f"{worst:{form}}"
