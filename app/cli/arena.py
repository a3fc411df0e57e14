"""`onpath arena`: all control laws, and the user's, through the same trials."""

from __future__ import annotations

import csv
import os
import shlex
import sys
import time
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

from onpath.app.common.atomic_file import check_writable, whole_file

if TYPE_CHECKING:
    from onpath.app.exports.arena_page import Contents
    from onpath.app.exports.arena_work import FigureJob, Job, Processes
    from onpath.lessons.words import Words
    from onpath.models.studies.arena import Result, Row, Trial

INTERRUPTED = 130


@dataclass(frozen=True)
class ArenaCommand:
    """Run all control laws, and yours, through the same trials; write a page and a CSV file.

    The first round has every obstruction once, on the circle with an exact model. Further rounds
    have random paths and conditions. The page is written after each round and on Ctrl-C.
    """

    law: Annotated[tuple[str, ...], tyro.conf.Positional] = ()
    """Your laws, as my_law.py:Name, or typed: "across = …; along = …"."""
    robot: Annotated[tuple[str, ...], tyro.conf.UseAppendAction] = ()
    """Name of a robot; repeat for more. By default the five-bar and the two-link arm."""
    only: bool = False
    """Compare only the laws given, which may also be names of OnPath's laws."""
    rounds: int = 3
    """Number of rounds."""
    seed: int = 1
    """Seed of the random numbers: the same seed gives the same trials."""
    processes: int = 0
    """Number of processes; 0: one for each processor."""
    html: Path = Path("arena.html")
    """The page. Its live figures are in a folder beside it, NAME-figures."""
    csv: Path = Path("arena.csv")
    """All runs, one per line."""
    figures: bool = True
    """Write a live figure of each law on each robot, unless a law is a Python function."""
    language: str = "en"
    """Language of the page."""

    def run(self) -> int:
        """Simulate and write; return 130 if it was interrupted."""
        from onpath.app.exports.arena_work import Processes
        from onpath.lessons.words import Words
        from onpath.models.studies.arena import trials_of

        began, rows = time.monotonic(), self._rows()
        trials, words = trials_of(tuple(rows), self.rounds, self.seed), Words(self.language)
        shown = _Report(self, rows, planned=sum(map(len, trials)), words=words)
        processes = Processes(self.processes or os.cpu_count() or 1)
        try:
            for number, each in enumerate(trials):
                title = f"round {number + 1} of {self.rounds}"
                shown.take(_results(processes, rows, each, title))
                shown.write()
                if number == 0 < self.rounds - 1:
                    told = words("arena.first", seconds=f"{time.monotonic() - began:.0f}")
                    print(f"onpath: {told}\n\n{shown.text()}\n", file=sys.stderr)
            if self.figures:
                shown.add_figures(processes)
                shown.write()
        except KeyboardInterrupt:
            done = shown.write()
            told = "arena.interrupted" if done else "arena.nothing"
            print(f"onpath: {words(told, html=str(self.html))}", file=sys.stderr)
            print(shown.text(), end="\n" if done else "")
            return INTERRUPTED
        finally:
            processes.stop()
        print(shown.text())
        told = words("arena.written", html=str(self.html), csv=str(self.csv))
        print(f"onpath: {told}", file=sys.stderr)
        return 0

    def _rows(self) -> dict[str, list[Row]]:
        """The rows of each robot.

        Raises:
            ValueError: an option is not possible.
        """
        from onpath.app.common.own_laws import law_given
        from onpath.assets.messages import languages
        from onpath.models.studies.arena import ROBOT_NAMES, entrants
        from onpath.models.systems.catalogue import ROBOTS
        from onpath.models.systems.parameter_specs import unknown_name

        for file in (self.html, self.csv):
            check_writable(file)
        if self.language not in languages():
            raise ValueError(f"--language {self.language}: there are {', '.join(languages())}")
        if self.rounds < 1 or self.processes < 0 or self.seed < 0:
            raise ValueError("--rounds, --processes or --seed: the number is too small")
        if self.only and not self.law:
            raise ValueError("--only: give laws to compare")
        laws = [law_given(text) for text in self.law]
        rows: dict[str, list[Row]] = {}
        for robot in self.robot or ROBOT_NAMES:
            if robot not in ROBOTS:
                raise unknown_name(robot, list(ROBOTS), "robot")
            rows[robot] = entrants(robot, laws, self.only)
            if missing := set(laws) - {law for law, _ in rows[robot]}:
                raise ValueError(f"{min(missing)}: it does not suit {robot}, or is not for motion")
        return rows


class _Report:
    """The results so far, and the files that they are written to."""

    def __init__(
        self, command: ArenaCommand, rows: dict[str, list[Row]], planned: int, words: Words
    ) -> None:
        self._command, self._rows, self._planned, self._words = command, rows, planned, words
        self._results: list[Result] = []
        self._figures: dict[tuple[str, str], str] = {}

    def take(self, results: Iterable[list[Result]]) -> None:
        """Add results as they come."""
        for each in results:
            self._results += each

    def _contents(self) -> Contents:
        from onpath.app.exports.arena_page import Contents
        from onpath.models.studies.arena import complete

        return Contents(
            rows=self._rows,
            results=complete(self._rows, self._results),
            command=shlex.join(["onpath", "arena", *sys.argv[2:]]),
            figures=self._figures,
            planned=self._planned,
        )

    def write(self) -> bool:
        """Write page and CSV; return whether there is anything to write."""
        from onpath.app.exports.arena_page import arena_page, csv_rows

        contents = self._contents()
        if not contents.results:
            return False
        with whole_file(self._command.html) as path:
            path.write_text(arena_page(contents, self._words), encoding="utf-8")
        with (
            whole_file(self._command.csv) as path,
            path.open("w", encoding="utf-8", newline="") as file,
        ):
            csv.writer(file).writerows(csv_rows(contents))
        return True

    def text(self) -> str:
        """The tables in Markdown."""
        from onpath.app.exports.arena_page import markdown

        return markdown(self._contents(), self._words)

    def add_figures(self, processes: Processes) -> None:
        """Write a figure for each robot and law."""
        from onpath.app.exports.arena_work import FigureJob, write_figure
        from onpath.models.control.laws.registry import law_named

        folder = self._command.html.with_name(f"{self._command.html.stem}-figures")
        jobs: list[FigureJob] = []
        for robot, results in self._contents().results.items():
            laws = list(dict.fromkeys(law for law, _ in self._rows[robot]))
            for number, law in enumerate(laws):
                if law_named(law).called is None:
                    name = law if law.isidentifier() else f"law-{number}"
                    file, trial = folder / f"{robot}-{name}.html", results[0].trial
                    jobs.append(FigureJob(file, law, trial, self._words.language))
                    self._figures[robot, law] = f"{folder.name}/{file.name}"
        for _ in _progress(processes.each(write_figure, jobs), "figures", len(jobs)):
            pass


def _results(
    processes: Processes, rows: dict[str, list[Row]], trials: Sequence[Trial], title: str
) -> Iterator[list[Result]]:
    """The results of a round, robot by robot, as they come."""
    from onpath.app.exports.arena_work import Job, simulate

    jobs: list[Job] = []
    for robot, each in rows.items():
        own = tuple(trial for trial in trials if trial.robot == robot)
        jobs += [
            Job(tuple(row for row in each if row[0] == law), own)
            for law in dict.fromkeys(law for law, _ in each)
        ]
    yield from _progress(processes.each(simulate, jobs), title, len(jobs))


def _progress(done: Iterable, title: str, total: int) -> Iterable:
    from rich.console import Console
    from rich.progress import track

    console = Console(stderr=True)
    hidden = not sys.stderr.isatty()
    return track(done, title, total, console=console, transient=True, disable=hidden)
