"""The work of an arena's processes: simulating, and writing figures."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path
from queue import SimpleQueue
from typing import Any

from onpath.app.exports.export_process import ExportDied, ExportProcess
from onpath.app.exports.standalone.figure_choice import chosen
from onpath.app.exports.standalone.figure_page import figure_page
from onpath.lessons.words import Words
from onpath.models.studies.arena import Result, Row, Trial, paths_of, results_of
from onpath.models.studies.path_text import curve_from_text

LONGEST = 900.0  # [s] for a job


@dataclass(frozen=True, slots=True)
class Job:
    """The trials of one robot for the rows of one law."""

    rows: tuple[Row, ...]
    trials: tuple[Trial, ...]

    @property
    def law(self) -> str:
        """Its name."""
        return self.rows[0][0]

    def failed(self, reason: str) -> list[Result]:
        """The results if the process has failed: all runs are stopped."""
        return [
            Result(law, remedy, trial, stopped_at_s=0.0, reason=reason)
            for law, remedy in self.rows
            for trial in self.trials
        ]


@dataclass(frozen=True, slots=True)
class FigureJob:
    """A figure of a law, at the torque limit of a trial."""

    file: Path
    law: str
    trial: Trial
    language: str


class Processes:
    """Several processes that work in parallel.

    Args:
        count: how many.
    """

    def __init__(self, count: int) -> None:
        self._all = [ExportProcess() for _ in range(count)]

    def each(self, work: Callable[[Any], Any], jobs: Sequence[Any]) -> Iterator[Any]:
        """The results of `work(job)` for all jobs, in the order in which they are finished.

        Raises:
            ExportError: a job has failed.
        """
        free = SimpleQueue[ExportProcess]()
        for process in self._all:
            free.put(process)

        def do(job: Any) -> Any:
            process = free.get()
            try:
                return process.call(LONGEST, work, job)
            except ExportDied as error:
                if not isinstance(job, Job):
                    raise
                return job.failed(str(error))
            finally:
                free.put(process)

        with ThreadPoolExecutor(len(self._all), "arena") as pool:
            futures = [pool.submit(do, job) for job in jobs]
            try:
                for future in as_completed(futures):
                    yield future.result()
            except BaseException:
                pool.shutdown(wait=False, cancel_futures=True)
                self.stop()
                raise

    def stop(self) -> None:
        """End all processes."""
        for process in self._all:
            process.stop()


def simulate(job: Job) -> list[Result]:
    """The results of a job."""
    return [result for row in job.rows for result in results_of(row, job.trials)]


def write_figure(job: FigureJob) -> FigureJob:
    """Write a figure: the robot of a trial under a law, on each of its paths; return the job."""
    values = {"torque_limit": job.trial.values["torque_limit"]}
    figure = chosen(
        job.trial.robot,
        laws=[job.law],
        paths={name: curve_from_text(name) for name in paths_of(job.trial.robot)},
        values=values,
    )
    job.file.parent.mkdir(parents=True, exist_ok=True)
    job.file.write_text(figure_page(figure, Words(job.language)), encoding="utf-8")
    return job
