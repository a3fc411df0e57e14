"""Runs the rounds of an arena, and writes its page, table and figures."""

from __future__ import annotations

import csv
import os
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.progress import track

from onpath.app.common.atomic_file import check_writable, whole_file
from onpath.app.common.own_laws import only_here
from onpath.app.exports.arena_page import Contents, arena_page, csv_rows, markdown
from onpath.app.exports.arena_work import FigureJob, Job, Processes, simulate, write_figure
from onpath.assets.messages import languages
from onpath.lessons.words import Words
from onpath.models.control.laws.law import OwnGain
from onpath.models.control.laws.registry import law_named
from onpath.models.studies.arena import Result, Row, Trial, complete, entrants, trials_of
from onpath.models.systems.catalogue import robot_named

NO_MOTION = "it does not move along a path, as laws in an arena do"


@dataclass(frozen=True, slots=True, kw_only=True)
class ArenaOptions:
    """The arguments of an arena, from the command line or from Python.

    Attributes:
        laws: names of the laws that enter besides OnPath's.
        robots: their names.
        only: whether OnPath's laws that were not asked for are left out.
        rounds: their number, 1 or more.
        seed: of the random numbers, 0 or more.
        processes: number of processes; 0: one for each processor.
        html: the page; its live figures are in a folder beside it. None: no page.
        csv: all runs, one per line; None: no such file.
        figures: whether there are live figures.
        language: of the page and of the tables.
        command: the call or command line, as the page shows it.
    """

    laws: Sequence[str]
    robots: Sequence[str]
    only: bool
    rounds: int
    seed: int
    processes: int
    html: Path | None
    csv: Path | None
    figures: bool
    language: str
    command: str


class Arena:
    """The trials of an arena, with the results so far.

    Raises:
        ValueError: an option is not possible.
    """

    def __init__(self, options: ArenaOptions) -> None:
        for file in filter(None, (options.html, options.csv)):
            check_writable(file)
        if options.language not in languages():
            raise ValueError(f"language {options.language}: there are {', '.join(languages())}")
        if options.rounds < 1 or options.processes < 0 or options.seed < 0:
            raise ValueError("rounds, processes or seed: the number is too small")
        if options.only and not options.laws:
            raise ValueError("only: give laws to compare")
        _check_gains(options.laws)
        self._options, self._words = options, Words(options.language)
        self._rows = {robot: self._entrants(robot) for robot in options.robots}
        self._trials = trials_of(tuple(self._rows), options.rounds, options.seed)
        self._results = list[Result]()
        self._figures = dict[tuple[str, str], str]()

    def _entrants(self, robot: str) -> list[Row]:
        """The rows of a robot.

        Raises:
            ValueError: there is no such robot, or a law asked for cannot enter.
        """
        robot_named(robot)
        rows = entrants(robot, self._options.laws, self._options.only)
        for law in set(self._options.laws) - {law for law, _ in rows}:
            why = f"it does not suit {robot}" if law_named(law).travels else NO_MOTION
            raise ValueError(f"{law}: {why}")
        return rows

    def run(self, after_round: Callable[[int], None] = lambda _: None) -> bool:
        """Run all rounds, and write the files after each, and on Ctrl-C.

        Args:
            after_round: called with the number of each round, from 0.

        Returns:
            Whether it was finished, not interrupted.
        """
        processes = Processes(self._options.processes or os.cpu_count() or 1)
        try:
            for number, trials in enumerate(self._trials):
                title = f"round {number + 1} of {len(self._trials)}"
                for results in self._each(processes, simulate, self._jobs(trials), title):
                    self._results += results
                self._write()
                after_round(number)
            self._write_figures(processes)
        except KeyboardInterrupt:
            self._write()
            return False
        finally:
            processes.stop()
        return True

    @property
    def contents(self) -> Contents:
        """The results of the trials that all rows of a robot have finished."""
        return Contents(
            rows=self._rows,
            results=complete(self._rows, self._results),
            command=self._options.command,
            figures=self._figures,
            planned=sum(map(len, self._trials)),
        )

    @property
    def text(self) -> str:
        """The tables in Markdown; "" if no trial has been finished."""
        return markdown(self.contents, self._words)

    def _jobs(self, trials: Sequence[Trial]) -> list[Job]:
        """The jobs of a round, robot by robot."""
        jobs = list[Job]()
        for robot, rows in self._rows.items():
            own = tuple(trial for trial in trials if trial.robot == robot)
            for law in dict.fromkeys(law for law, _ in rows):
                jobs.append(Job(tuple(row for row in rows if row[0] == law), own))
        return jobs

    def _each(
        self, processes: Processes, work: Callable[[Any], Any], jobs: Sequence[Any], title: str
    ) -> Iterator[Any]:
        """The results of jobs as they come, with a progress bar.

        Laws that only this process knows run in it.
        """
        here = [job for job in jobs if only_here(job.law)]
        others = [job for job in jobs if not only_here(job.law)]
        yield from track(
            chain(processes.each(work, others), map(work, here)),
            title,
            len(jobs),
            console=Console(stderr=True),
            transient=True,
            disable=not sys.stderr.isatty(),
        )

    def _write(self) -> None:
        """Write page and CSV, if there is anything to write."""
        options, contents = self._options, self.contents
        if not contents.results:
            return
        if options.html:
            with whole_file(options.html) as path:
                path.write_text(arena_page(contents, self._words), encoding="utf-8")
        if options.csv:
            with (
                whole_file(options.csv) as path,
                path.open("w", encoding="utf-8", newline="") as file,
            ):
                csv.writer(file).writerows(csv_rows(contents))

    def _write_figures(self, processes: Processes) -> None:
        """Write a figure for each robot and law, and the page, which links to them."""
        html = self._options.html
        if html is None or not self._options.figures:
            return
        folder, jobs = html.with_name(f"{html.stem}-figures"), list[FigureJob]()
        for robot, results in self.contents.results.items():
            for number, law in enumerate(dict.fromkeys(law for law, _ in self._rows[robot])):
                if law_named(law).called is None:
                    name = law if law.isidentifier() else f"law-{number}"
                    file, trial = folder / f"{robot}-{name}.html", results[0].trial
                    jobs.append(FigureJob(file, law, trial, self._words.language))
        for job in self._each(processes, write_figure, jobs, "figures"):
            self._figures[job.trial.robot, job.law] = f"{folder.name}/{job.file.name}"
        self._write()


def _check_gains(laws: Sequence[str]) -> None:
    """Refuse laws whose gains have one name and differ, such as two versions of one law.

    Raises:
        ValueError: there are two.
    """
    known = dict[str, tuple[str, OwnGain]]()
    for law in laws:
        for gain in law_named(law).own_gains:
            other, same = known.setdefault(gain.name, (law, gain))
            if same != gain:
                raise ValueError(f"{law} has another gain {gain.name!r} than {other}: rename it")
