"""Exports that a user requests: CSV, a picture of the plots, a recording, a report."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from datetime import datetime
from typing import Any, Protocol

from onpath.app.common.error_log import log_error
from onpath.app.exports.comparison import outcomes_of
from onpath.app.exports.export_process import ExportProcess, ExportStopped
from onpath.app.exports.files import csv_file, film_file, lines_file, picture_file, report_file
from onpath.app.lab.lab import Lab
from onpath.lessons.words import Words
from onpath.models.studies.comparison import Outcome

PATIENCE = 120.0  # [s] that a file may take, including the files queued before it
process = ExportProcess()
_queue = ThreadPoolExecutor(1, "exports")
"""Passes one file at a time to the process, on behalf of all tabs."""


class Delivery(Protocol):
    """Tells a page of its files, and brings them to it. Called in any thread."""

    def making(self, name: str, words: Words) -> None:
        """A file is being made."""

    def ready(self, name: str, content: bytes, words: Words) -> None:
        """The file has been made."""

    def failed(self, name: str, words: Words) -> None:
        """The file, or what is called so, could not be made."""


class Exporter:
    """Creates files in another process from copies made by the simulation thread.

    A tab makes one file at a time; further requests are refused with a message.

    Args:
        delivery: brings them to the tab.
    """

    def __init__(self, delivery: Delivery) -> None:
        self._delivery = delivery
        self._wanted: list[Callable[[Lab], None]] = []
        self._under_way = self._refuses = False
        self._latest: Future[None] | None = None

    def csv(self) -> None:
        """Request the CSV file of the last minute."""
        self._ask("onpath.csv", csv_file)

    def picture(self) -> None:
        """Request a picture of the plots."""
        self._ask("onpath.png", picture_file, in_words=True, names_path=True, with_log=True)

    def lines(self) -> None:
        """Request a picture of what the robots have written."""
        self._ask("onpath-lines.png", lines_file, in_words=True)

    def recording(self) -> None:
        """Request a standalone page with the scene of the last seconds."""
        self._ask("onpath.html", film_file, in_words=True, names_path=True)

    def outcomes(
        self,
        laws: Sequence[str],
        obstruction: str,
        show: Callable[[Mapping[str, list[Outcome]]], None],
        refuse: Callable[[str], None],
    ) -> None:
        """Request a comparison of laws, with the lab's robot, parameters and path.

        Args:
            show: called with the outcomes so far, by law, after each law.
            refuse: called with the reason if there is no comparison.
        """

        def start(lab: Lab) -> None:
            simulation, words = lab.simulation, lab.words
            parameters, curve = simulation.parameters, simulation.editor.curve
            if not curve.closed or parameters.task != "speed" or parameters.speed == 0:
                self._under_way = False
                refuse(words("compare.path"))
                return

            def work() -> None:
                found = dict[str, list[Outcome]]()
                try:
                    for law in laws:
                        what = simulation.entry.name, parameters, curve, law, obstruction
                        found[law] = process.call(PATIENCE, outcomes_of, *what)
                        show(dict(found))
                except ExportStopped:
                    return  # the server is stopping
                except Exception as error:  # reported to the user; the lab continues
                    log_error(error)
                    refuse(words("export.failed", name=words("compare.title")))
                self._under_way = False

            with suppress(RuntimeError):  # the interpreter is shutting down
                self._latest = _queue.submit(work)

        if self._under_way:
            self._wanted.append(lambda lab: refuse(lab.words("export.busy")))
        else:
            self._want(start)

    def report(self, code: str = "") -> None:
        """Request the lesson report as a page.

        Args:
            code: lab code shown on the page; empty for none.
        """
        name = "onpath-report.html"

        def start(lab: Lab) -> None:
            run = lab.lessons
            self._submit(name, lab.words, report_file, run.course, run.told, code, datetime.now())

        self._want(start)

    def serve(self, lab: Lab) -> None:
        """Start the requested exports. Called on the simulation thread."""
        while self._wanted:
            self._wanted.pop(0)(lab)

    def close(self) -> None:
        """Start no further exports."""
        if self._latest is not None:
            self._latest.cancel()

    def _ask(
        self,
        name: str,
        make: Callable[..., bytes],
        in_words: bool = False,
        names_path: bool = False,
        with_log: bool = False,
    ) -> None:
        def start(lab: Lab) -> None:
            simulation, words = lab.simulation, lab.words
            history = simulation.history.copy()
            if not history:
                lab.show_message(words("export.nothing"), "warning")
                self._under_way = False
                return
            arguments: list[Any] = [simulation.entry.name, simulation.parameters, history]
            if in_words:
                arguments.append(words.language)
            if names_path:
                arguments.append(simulation.editor.design.name)
            if with_log:
                arguments.append(lab.shown_log)
            self._submit(name, words, make, *arguments)

        self._want(start)

    def _want(self, start: Callable[[Lab], None]) -> None:
        if not self._under_way:
            self._under_way = True
            self._wanted.append(start)
        elif not self._refuses:
            self._refuses = True
            self._wanted.append(self._refuse)

    def _refuse(self, lab: Lab) -> None:
        self._refuses = False
        lab.show_message(lab.words("export.busy"), "warning")

    def _submit(self, name: str, words: Words, make: Callable[..., bytes], *arguments: Any) -> None:
        deadline = time.monotonic() + PATIENCE
        self._delivery.making(name, words)

        def work() -> None:
            try:
                content = process.call(deadline - time.monotonic(), make, *arguments)
                self._delivery.ready(name, content, words)
            except ExportStopped:
                return  # the server is stopping
            except Exception as error:  # reported to the user; the lab continues
                log_error(error)
                self._delivery.failed(name, words)
            self._under_way = False

        with suppress(RuntimeError):  # the interpreter is shutting down
            self._latest = _queue.submit(work)
