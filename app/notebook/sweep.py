"""`onpath.sweep`: runs for all combinations of robots, paths, laws and settings, as a table."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from onpath.app.common.result_folder import ResultFolder, key_of
from onpath.app.common.workers import Job
from onpath.app.notebook.display import cell
from onpath.app.notebook.run import Run, data_frame, written
from onpath.app.notebook.simulate import entry_named, law_of, planned
from onpath.models.closed_loop.simulation import kind_of
from onpath.models.paths.curves import Curve
from onpath.models.studies import experiments
from onpath.models.studies.arena import run_under
from onpath.models.studies.experiments import Experiment, check_own_law, of_stopped
from onpath.models.studies.unused import unused_text

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from pandas import DataFrame

NESTED = {"start": 1, "velocity": 1, "hold": 1, "push": 1, "wall": 1, "profile": 2}
"""Arguments that are sequences, and how deep: those that are deeper are several."""
SEVERAL = list, tuple, range, np.ndarray
SMALL = 20.0  # [s] of simulated time below which processes are not worth their start
SHOWN = 40  # rows of a table in a cell
MOST_LINES = 12  # lines of a picture up to which they are named
LOST = "the process that simulated it has died"

Trial = tuple[Experiment, str]
"""An experiment, and the name of a law."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class SweepResult:
    """The runs of a sweep as a table; printed as such.

    Attributes:
        varied: names of the arguments that several values were given for.
        table: a row for each run that has been finished: the values of `varied`, the numbers of
            `Run.summary`, and `reason`, why it stopped, or "". A run that was stopped has infinite
            distances, so that it never wins.
        trials: what each row is of.
    """

    varied: tuple[str, ...]
    table: list[dict[str, Any]]
    trials: list[Trial]

    def __len__(self) -> int:
        return len(self.table)

    def run(self, row: int) -> Run:
        """The whole run of a row, which is computed again, to the same bits.

        Raises:
            IndexError: there is no such row.
            ValueError: no run is possible, as the row's reason says.
        """
        experiment, law = self.trials[row]
        experiments.check_path(experiment.robot(), experiment.curve())
        return Run(experiment, experiments.run(experiment, law))

    def to_dataframe(self) -> DataFrame:
        """The table as a data frame.

        Raises:
            ImportError: pandas is not installed; `pip install "onpath[pandas]"` does that.
        """
        return data_frame(self.table)

    def plot(self, file: str | Path | None = None, *, y: str = "max_distance_m") -> Figure:
        """Plot a number of the table over the setting with the most values, a line for each other.

        Runs that were stopped are crosses at the upper edge.

        Args:
            file: the file to write, with a name ending in .png, .svg or .pdf.
            y: the column.

        Raises:
            ValueError: there is no such column of numbers, or the file cannot be written.
        """
        return written(self._figure(y), file)

    def _figure(self, y: str) -> Figure:
        from onpath.app.exports.figures import ShownFigure  # slow to import

        numbers = [name for name in (self.table or [{}])[0] if name not in (*self.varied, "reason")]
        if y not in numbers:
            raise ValueError(f"y: expected one of {', '.join(numbers)}, got {y!r}")
        x = max(self.varied, key=self._spread, default="")
        numeric = x != "" and self._spread(x) > 0
        lines = dict[tuple[Any, ...], list[tuple[Any, float]]]()
        for number, row in enumerate(self.table):
            others = tuple(str(row[name]) for name in self.varied if not numeric or name != x)
            value = math.nan if row[y] is None else float(row[y])
            at = row[x] if numeric else " ".join(others) or number
            lines.setdefault(others if numeric else (), []).append((at, value))
        figure = ShownFigure(figsize=(8, 4.5), layout="constrained")
        axes = figure.subplots()
        scale, unit = (1e3, "mm") if y.endswith("_m") else (1.0, y.rpartition("_")[2])
        for label, points in lines.items():
            points.sort(key=lambda point: point[0] if numeric else 0)
            ats, values = [at for at, _ in points], np.array([value for _, value in points])
            finite = np.where(np.isfinite(values), scale * values, np.nan)
            name = ", ".join(label) if len(lines) <= MOST_LINES else None
            (line,) = axes.plot(ats, finite, "o-" if numeric else "o", label=name, markersize=4)
            stopped = [at for at, value in points if math.isinf(value)]
            edge = axes.get_xaxis_transform()
            axes.plot(stopped, [0.98] * len(stopped), "x", color=line.get_color(), transform=edge)
        axes.set_xlabel(x if numeric else "")
        axes.set_ylabel(f"{y.rpartition('_')[0].replace('_', ' ')}  [{unit}]")
        axes.grid(alpha=0.25)
        if 1 < len(lines) <= MOST_LINES:
            axes.legend(frameon=False)
        return figure

    def _spread(self, name: str) -> int:
        """The number of values of an argument, if all are numbers; else 0."""
        values = {row[name] for row in self.table}
        return len(values) if all(isinstance(v, int | float) for v in values) else 0

    def _lines(self) -> list[list[str]]:
        """The table as text: names, and the first rows."""
        names = list(self.table[0]) if self.table else [*self.varied]
        shown = [[_text(row[name]) for name in names] for row in self.table[:SHOWN]]
        return [names, *shown]

    def _rest(self) -> str:
        return f"{len(self)} runs" + (f", {SHOWN} shown" if len(self) > SHOWN else "")

    def __repr__(self) -> str:
        lines = self._lines()
        widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
        told = (
            "  ".join(text.ljust(width) for text, width in zip(line, widths, strict=True)).rstrip()
            for line in lines
        )
        return "\n".join([*told, self._rest()])

    def _repr_html_(self) -> str:
        names, *rows = self._lines()
        return cell(head=names, rows=rows, caption=self._rest())


def sweep(
    robot: Any = "five_bar",
    path: Any = "circle",
    law: Any = "path_following",
    *,
    folder: str | Path | None = None,
    **settings: Any,
) -> SweepResult:
    """Simulate all combinations of robots, paths, laws and settings; a row of a table for each.

    More than a few runs are shared among processes by joblib, one for each processor; with

        with joblib.parallel_config("dask"):
            result = onpath.sweep(...)

    among those of a cluster, whose processes must have this version of OnPath. Laws and robots that
    are objects of this process are sent there. The same arguments give the same bits everywhere.

    Args:
        robot, path, law: each one, as for `onpath.simulate`, or a list of several.
        folder: a folder in which the row of each finished run is kept, by all that determines the
            run. A sweep that was interrupted goes on where it was, and one that is extended
            simulates what is new. A law counts by its code and numbers, not by modules that it
            imports. None: nothing is kept.
        settings: all other arguments of `onpath.simulate`, each one value or a list of several,
            such as K1=[400, 900], duration=2, hold=[None, (1, 2)].

    Raises:
        ValueError: an argument that `onpath.simulate` would refuse, whatever the others are. A
            combination that is not possible, such as a path that a robot cannot follow, is a row
            with the reason.
        OSError: the folder cannot be made, or written.

    Warns:
        UserWarning: a setting that has no effect in any of the runs; and an interrupted sweep,
            whose result has the rows of the finished runs.

    >>> import onpath
    >>> result = onpath.sweep(K1=[400, 900], hold=(0.2, 0.6), duration=1)
    >>> [row["K1"] for row in result.table], result.varied
    ([400, 900], ('K1',))
    >>> result.table[1]["max_distance_m"] < result.table[0]["max_distance_m"]
    True
    >>> result.run(1).summary()["max_distance_m"] == result.table[1]["max_distance_m"]
    True
    """
    kept = ResultFolder(folder)
    robots = [entry_named(each) for each in _values("robot", robot)]
    laws = [law_of(each) for each in _values("law", law)]
    given = {"robot": robots, "path": _values("path", path), "law": laws}
    given |= {name: _values(name, value) for name, value in settings.items()}
    asked = {"robot": robot, "path": path, "law": law, **settings}
    varied = tuple(name for name, value in asked.items() if _is_several(name, value))
    shown = {name: _labels(name, values) for name, values in given.items() if name in varied}
    trials, rows = list[Trial](), list[dict[str, Any]]()
    unused: str | None = None
    for choice in product(*(range(len(values)) for values in given.values())):
        chosen = {name: given[name][i] for name, i in zip(given, choice, strict=True)}
        experiment, name, values = planned(**chosen)
        if unused is None or unused:
            told = unused_text(experiment, [name], values)
            unused = told if unused in (None, told) else ""
        check_own_law(experiment, name)
        trials.append((experiment, name))
        row = {each: shown[each][i] for each, i in zip(given, choice, strict=True) if each in shown}
        rows.append(row)
    if unused:
        warnings.warn(unused, UserWarning, stacklevel=2)
    found = dict[int, dict[str, Any]]()
    try:
        for number, numbers in _simulated(trials, kept):
            found[number] = numbers
    except KeyboardInterrupt:
        left = f"{len(found)} of {len(trials)} runs are finished"
        more = "" if folder is None else f"; the same call goes on from {folder}"
        warnings.warn(f"interrupted: {left}{more}", UserWarning, stacklevel=2)
    done = sorted(found)
    table = [rows[number] | found[number] for number in done]
    return SweepResult(varied, table, [trials[number] for number in done])


def _simulated(trials: Sequence[Trial], kept: ResultFolder) -> Iterator[tuple[int, dict[str, Any]]]:
    """The number of each trial, and the numbers and the reason of its row, in any order."""
    keys = [key_of(*trial) for trial in trials] if kept.keeps else [""] * len(trials)
    wanted = list[int]()
    for number, key in enumerate(keys):
        known = kept.find(key)
        if known is None:
            wanted.append(number)
        else:
            yield number, known
    job = Job(
        items=[trials[number] for number in wanted],
        kinds=[_kind(trials[number]) for number in wanted],
        work=numbers_of,
        lost=lambda trial: _impossible(trial, LOST),
        laws=[law for _, law in trials],
        robots=(),  # they are in the trials
        title="sweep",
        is_small=sum(trials[number][0].schedule.duration for number in wanted) < SMALL,
    )
    for i, numbers in job.results():
        kept.keep(keys[wanted[i]], numbers)
        yield wanted[i], numbers


def numbers_of(trial: Trial) -> dict[str, Any]:
    """The numbers of a trial, and the reason why it stopped, or ""."""
    experiment, law = trial
    try:
        experiments.check_path(experiment.robot(), experiment.curve())
        moved = run_under(experiment, law)
    except ValueError as error:
        return _impossible(trial, str(error))
    run = Run(experiment, moved)
    numbers = {name: value for name, value in run.summary().items() if name != "never_held"}
    return {**numbers, "reason": run.reason}


def _impossible(trial: Trial, reason: str) -> dict[str, Any]:
    schedule = trial[0].schedule
    held = schedule.hold_from < schedule.hold_to
    return {**of_stopped(0.0, held), "reason": reason}


def _kind(trial: Trial) -> Any:
    """What trials that share a compiled loop have in common."""
    experiment, law = trial
    kind = kind_of(law, experiment.parameters, experiment.curve())
    return experiment.robot().core, kind


def _is_several(name: str, value: Any) -> bool:
    """Whether an argument has several values."""
    depth = NESTED.get(name, 0)
    for _ in range(depth):
        if not isinstance(value, SEVERAL) or not len(value):
            return False
        if isinstance(value, list) and any(each is None or isinstance(each, str) for each in value):
            return True
        value = value[0]
    return isinstance(value, SEVERAL)


def _values(name: str, value: Any) -> list[Any]:
    """The values of an argument.

    Raises:
        ValueError: there is none.
    """
    if not _is_several(name, value):
        return [value]
    values = value.tolist() if isinstance(value, np.ndarray) else list(value)
    if not values:
        raise ValueError(f"{name}: expected at least one value")
    return [each.item() if isinstance(each, np.generic) else each for each in values]


def _labels(name: str, values: Sequence[Any]) -> list[Any]:
    """What stands in the table for each of several values; equal texts are numbered."""
    if name == "robot":
        return [entry.name for entry in values]
    if name != "path":
        return [*values]
    texts = [repr(each) if isinstance(each, Curve) else str(each) for each in values]
    counts = {text: texts.count(text) for text in texts}
    return [
        f"{text} {texts[: i + 1].count(text)}" if counts[text] > 1 else text
        for i, text in enumerate(texts)
    ]


def _text(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.6g}"
    return "" if value is None else str(value)
