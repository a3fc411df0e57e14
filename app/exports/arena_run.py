"""Runs the rounds of an arena, and writes its page, table and figures."""

from __future__ import annotations

import csv
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from joblib import parallel_config

from onpath.app.common.atomic_file import check_writable, whole_file
from onpath.app.common.result_folder import ResultFolder, key_of
from onpath.app.common.workers import Job
from onpath.app.exports.arena_page import Contents, arena_page, csv_rows, markdown
from onpath.app.exports.arena_work import Entry, FigureJob, figure_of, lost, simulated
from onpath.assets.messages import languages
from onpath.lessons.words import Words
from onpath.models.control.laws.law import OwnGain
from onpath.models.control.laws.registry import law_named
from onpath.models.studies.arena import (
    Result,
    Row,
    Trial,
    complete,
    entrants,
    result_from,
    trials_of,
)
from onpath.models.studies.experiments import check_own_law
from onpath.models.systems.catalogue import robot_named

NO_MOTION = "it does not move along a path, as laws in an arena do"


@dataclass(frozen=True, slots=True, kw_only=True)
class ArenaOptions:
    """The arguments of an arena, from the command line or from Python.

    Attributes:
        laws: names of the laws that enter besides OnPath's.
        robots: their names.
        only: whether OnPath's laws that were not asked for are left out.
        settings: parameters of the robots in all trials, by name.
        rounds: their number, 1 or more.
        seed: of the random numbers, 0 or more.
        processes: number of processes; 0: what joblib is set to, or one for each processor.
        folder: in which finished runs are kept, so that an interrupted arena goes on; None: none.
        html: the page; its live figures are in a folder beside it. None: no page.
        csv: all runs, one per line; None: no such file.
        figures: whether there are live figures.
        language: of the page and of the tables.
        command: the call or command line, as the page shows it.
    """

    laws: Sequence[str]
    robots: Sequence[str]
    only: bool
    settings: Mapping[str, Any]
    rounds: int
    seed: int
    processes: int
    folder: Path | None
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
        self._trials = trials_of(tuple(self._rows), options.rounds, options.seed, options.settings)
        for robot in self._rows:
            first = next(trial for trial in self._trials[0] if trial.robot == robot)
            experiment = first.experiment(remedy=False)
            for law in options.laws:
                check_own_law(experiment, law)
        self._results, self._kept = list[Result](), ResultFolder(options.folder)
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
        count = self._options.processes
        chosen: AbstractContextManager[Any] = (
            parallel_config("loky", n_jobs=count) if count else nullcontext()
        )
        try:
            with chosen:
                for number, trials in enumerate(self._trials):
                    self._run(trials, f"round {number + 1} of {len(self._trials)}")
                    self._write()
                    after_round(number)
                self._write_figures()
        except KeyboardInterrupt:
            self._write()
            return False
        return True

    def _run(self, trials: Sequence[Trial], title: str) -> None:
        """Add the results of a round."""
        wanted, keys = list[Entry](), list[str]()
        for robot, rows in self._rows.items():
            for row in rows:
                for trial in (trial for trial in trials if trial.robot == robot):
                    key = self._key(row, trial) if self._kept.keeps else ""
                    known = self._kept.find(key)
                    if known is None:
                        wanted.append((row, trial))
                        keys.append(key)
                    else:
                        self._results.append(result_from(known, row, trial))
        job = Job(
            items=wanted,
            kinds=[(trial.robot, row, trial.condition) for row, trial in wanted],
            work=simulated,
            lost=lost,
            laws=self._options.laws,
            robots=[robot_named(robot) for robot in self._rows],
            title=title,
        )
        for i, result in job.results():
            self._kept.keep(keys[i], result.data())
            self._results.append(result)

    def _key(self, row: Row, trial: Trial) -> str:
        law, remedy = row
        return key_of(trial.experiment(bool(remedy)), law, "arena", trial.obstruction)

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

    def _write_figures(self) -> None:
        """Write a figure for each robot and law, and the page, which links to them."""
        html = self._options.html
        if html is None or not self._options.figures:
            return
        folder, wanted = html.with_name(f"{html.stem}-figures"), list[FigureJob]()
        for robot, results in self.contents.results.items():
            for law in dict.fromkeys(law for law, _ in self._rows[robot]):
                if law_named(law).called is None:
                    wanted.append(FigureJob(law, results[0].trial, self._words.language))
        job = Job(
            items=wanted,
            kinds=[each.law for each in wanted],
            work=figure_of,
            lost=lambda _: "",
            laws=self._options.laws,
            robots=[robot_named(robot) for robot in self._rows],
            title="figures",
        )
        for i, page in job.results():
            law, robot = wanted[i].law, wanted[i].trial.robot
            name = law if law.isidentifier() else f"law-{self._number(robot, law)}"
            folder.mkdir(parents=True, exist_ok=True)
            file = folder / f"{robot}-{name}.html"
            if page:
                file.write_text(page, encoding="utf-8")
                self._figures[robot, law] = f"{folder.name}/{file.name}"
        self._write()

    def _number(self, robot: str, law: str) -> int:
        """The place of a law among those of a robot."""
        return [*dict.fromkeys(each for each, _ in self._rows[robot])].index(law)


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
