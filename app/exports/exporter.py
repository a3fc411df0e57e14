"""What a user can take home: the last minute as CSV, the plots as a picture, a film."""

from __future__ import annotations

import io
import logging
import time
from collections.abc import Callable, Iterable
from concurrent.futures import Future, ThreadPoolExecutor
from datetime import datetime
from functools import partial
from itertools import groupby

import numpy as np
import viser

from onpath.app.common.error_log import log_error
from onpath.app.exports.recording import record_scene
from onpath.app.lab.history import Segment
from onpath.app.lab.lab import Lab
from onpath.app.lab.lesson_state import LessonState
from onpath.lessons.words import Words
from onpath.models.arrays import Array
from onpath.models.closed_loop.loops import InterpretedLoop
from onpath.models.closed_loop.simulation import kernel_of
from onpath.models.closed_loop.trajectory import Trajectory, join, record, write_csv
from onpath.models.systems.robots import Robot

log = logging.getLogger(__name__)
FILM = 10.0  # [s]
PATIENCE = 60.0  # [s] that somebody waits for a film, and for those of others before it
_films = ThreadPoolExecutor(1, "films")  # one at a time: many would slow each other and all labs


class Exporter:
    """Makes files in a thread of its own, from copies that the simulation thread hands it.

    One of each kind at a time: pressed again meanwhile, a button does nothing.
    """

    def __init__(self, client: viser.ClientHandle) -> None:
        self._client = client
        self._wanted: list[Callable[[Lab], None]] = []
        self._under_way: set[str] = set()
        self._film: Future[None] | None = None
        self._pool = ThreadPoolExecutor(1, "export")

    def csv(self) -> None:
        """Ask for the CSV of the last minute."""
        self._ask("onpath.csv", lambda robot, history, _: csv_bytes(robot, history))

    def picture(self) -> None:
        """Ask for a picture of the plots."""
        self._ask("onpath.png", png_bytes)

    def recording(self) -> None:
        """Ask for a standalone page with the scene of the last seconds."""
        until = time.monotonic() + PATIENCE

        def make(robot: Robot, history: list[Segment], words: Words) -> bytes:
            return record_scene(robot, _last(history, FILM), words, until)

        self._ask("onpath.html", make, film=True)

    def report(self, code: str = "") -> None:
        """Ask for the record of the lessons as a page.

        Args:
            code: of the session, for the page to bear; empty for none.
        """

        def start(lab: Lab) -> None:
            run = LessonState(lab.lessons.course, lab.lessons.progress)  # as it is now
            made = datetime.now()
            self._pool.submit(
                self._deliver,
                "onpath-report.html",
                run.words,
                lambda: report_bytes(run, code, made),
            )

        self._want("onpath-report.html", start)

    def submit(self, work: Callable[[], None]) -> None:
        """Do something else in this thread."""

        def guarded() -> None:
            try:
                work()
            except Exception as error:
                log_error(error)

        self._pool.submit(guarded)

    def serve(self, lab: Lab) -> None:
        """Start what was asked for; from the simulation thread."""
        while self._wanted:
            self._wanted.pop(0)(lab)

    def close(self) -> None:
        """Finish nothing more."""
        if self._film is not None:
            self._film.cancel()
        self._pool.shutdown(wait=False, cancel_futures=True)

    def _ask(
        self, name: str, make: Callable[[Robot, list[Segment], Words], bytes], film: bool = False
    ) -> None:
        def start(lab: Lab) -> None:
            robot, history, words = lab.session.robot, lab.session.history.all(), lab.words
            if not history:
                lab.show_message(words("export.nothing"), "warning")
                self._under_way.discard(name)
                return
            work = partial(make, robot, history, words)
            self._pool.submit(self._deliver, name, words, work, film)

        self._want(name, start)

    def _want(self, name: str, start: Callable[[Lab], None]) -> None:
        if name not in self._under_way:
            self._under_way.add(name)
            self._wanted.append(start)

    def _deliver(
        self, name: str, words: Words, make: Callable[[], bytes], film: bool = False
    ) -> None:
        note = self._client.add_notification(
            words("export.title"),
            words("export.making", name=name),
            loading=True,
            with_close_button=False,
        )
        finish = partial(self._finish, note, name, words, make)
        if film:
            self._film = _films.submit(finish)
        else:
            finish()

    def _finish(
        self, note: viser.NotificationHandle, name: str, words: Words, make: Callable[[], bytes]
    ) -> None:
        try:
            self._client.send_file_download(name, make(), save_immediately=True)
            note.body, note.loading = words("export.ready", name=name), False
            note.auto_close_seconds = 3.0
        except Exception as error:  # the user is told, the lab goes on
            log_error(error)
            note.body, note.loading = words("export.failed", name=name), False
        note.with_close_button = True
        self._under_way.discard(name)


def csv_bytes(robot: Robot, history: list[Segment]) -> bytes:
    """Every millisecond of the history as CSV."""
    file = io.StringIO()
    write_csv(file, robot, replay(robot, history).values())
    return file.getvalue().encode()


def png_bytes(robot: Robot, history: list[Segment], words: Words) -> bytes:
    """A picture of the plots of the history."""
    from onpath.app.exports.figures import draw_history  # see app/server/lazy_imports.py

    return draw_history(replay(robot, history), words)


def report_bytes(run: LessonState, code: str, made: datetime) -> bytes:
    """The record of the lessons as a page."""
    from onpath.app.exports.report import report  # see app/server/lazy_imports.py

    return report(run, code, made)


def replay(robot: Robot, history: list[Segment]) -> dict[str, Trajectory]:
    """The history computed again, tick by tick, from its checkpoints and inputs.

    While a robot stands still after a divergence there is nothing of it.

    Raises:
        ValueError: all of them stood still all the time.
    """
    found = {name: _replayed(robot, name, history) for name in history[0].drives}
    runs = {name: join(name, parts) for name, parts in found.items() if parts}
    if not runs:
        raise ValueError("both robots stood still: there is nothing to show")
    return runs


def _replayed(robot: Robot, name: str, history: list[Segment]) -> list[Trajectory]:
    loops: dict[object, InterpretedLoop] = {}
    parts: list[Trajectory] = []
    runs = groupby(history, key=lambda s: (id(s.curve), s.dt, s.drives[name].kind))
    for (_, dt, kind), group in runs:
        stretches = [s for s in group if not s.drives[name].frozen]
        if not stretches:
            continue
        kernel = kernel_of(robot, kind)
        loop = loops.setdefault(kind, InterpretedLoop(kernel))
        segments = [(rows, s.curve, held) for s, rows, held in _rows(loop, name, stretches)]
        times = np.concatenate([s.time + dt * np.arange(s.ticks, dtype=float) for s in stretches])
        parts.append(record(robot, kernel.log, name, merged(segments), dt, times).thinned())
    return parts


def _rows(
    loop: InterpretedLoop, name: str, stretches: list[Segment]
) -> Iterable[tuple[Segment, Array, bool]]:
    for stretch in stretches:
        drive = stretch.drives[name]
        table = stretch.curve.table()
        rows = loop.run(drive.state, drive.settings, table, stretch.ticks)[1]
        held = loop.kernel.settings.unpack(drive.settings)["hold_active"][0] > 0
        yield stretch, rows, bool(held)


def merged(segments: list) -> list:
    """Consecutive segments of one curve and hold as one, so that distances are found at once."""
    result: list = []
    for (_, held), group in groupby(segments, key=lambda s: (id(s[1]), s[2])):
        members = list(group)
        result.append((np.concatenate([rows for rows, _, _ in members]), members[0][1], held))
    return result


def _last(history: list[Segment], seconds: float) -> list[Segment]:
    end = history[-1].time
    return [s for s in history if s.time >= end - seconds]
