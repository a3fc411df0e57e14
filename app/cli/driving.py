"""A terminal beside a plant: says what the controller does, and takes what is typed."""

from __future__ import annotations

import csv
import signal
import sys
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Thread

import numpy as np

from onpath.app.common.atomic_file import whole_file
from onpath.app.common.end_signals import END_SIGNALS
from onpath.app.notebook.arguments import curve_of
from onpath.app.plant.controller_process import ControllerProcess
from onpath.app.plant.plant_link import PlantReport
from onpath.models.control.settable import value_of, with_values
from onpath.models.controller.functions import STOPPED
from onpath.models.paths.distance import path_distance
from onpath.models.studies.record_file import quantities
from onpath.models.systems.robots import Robot

EVERY = 0.1  # [s] between two questions to the controller
TOLD = 1.0  # [s] between two lines; also without a measurement, after which the plant is gone
NOT_SAFE = (
    "This is no safety function. Around a real arm there must be a stop that cuts the power, and"
    " its maker's limits of speed and force; keep out of its reach."
)
Change = Callable[[], PlantReport]


class Driving:
    """Asks a controller beside a plant, says what it does, and takes what is typed.

    Attributes:
        rows: t, q, v and torque of each measurement up to now, if they are kept.
    """

    def __init__(self, beside: ControllerProcess, at_fault: str, *, keeps: bool = True) -> None:
        self._beside, self._at_fault, self._keeps = beside, at_fault, keeps
        self._wanted = SimpleQueue[Change]()
        self._told = time.monotonic()
        self.rows = list[tuple[float, ...]]()

    def run(self) -> int:
        """Go on until Enter or Ctrl-C, or until it ends itself; the exit code."""
        beside = self._beside
        for number in END_SIGNALS:
            signal.signal(number, lambda *_: self._wanted.put(beside.stop))
        host, port = beside.address
        print(NOT_SAFE)
        print(f"It waits for a plant at udp://{host}:{port}. Enter or Ctrl-C stops it.")
        print("While it runs, type K1=900, path=circle or law=NAME.", flush=True)
        if sys.stdin is not None:
            Thread(target=self._read, name="typed", daemon=True).start()
        report = self._until_end()
        if not report.started:
            print("It has ended. No plant has sent a measurement.", flush=True)
            return 0
        print(f"It has ended: {report.reason}. Its torque is now: {self._at_fault}.")
        print(_counted(report), flush=True)
        silent = self._until_silent(report)
        print(
            "The plant is silent." if silent else "The plant gets no torque any more.", flush=True
        )
        return 0 if report.code == STOPPED else 1

    def _until_end(self) -> PlantReport:
        report = self._beside.report()
        while not report.code:
            change = self._next()
            if change == self._beside.stop and not report.started:
                return report
            report = self._changed(change)
            self._keep(report)
            if report.started and time.monotonic() - self._told > TOLD:
                self._told = time.monotonic()
                print(self._state(report), flush=True)
        return report

    def _until_silent(self, report: PlantReport) -> bool:
        """Let it give the torque for a fault until the plant is silent, or somebody stops again.

        Returns:
            whether the plant is silent.
        """
        answered, since = report.answered, time.monotonic()
        while time.monotonic() - since < TOLD:
            if self._next() == self._beside.stop:
                return False
            now = self._beside.report()
            self._keep(now)
            if now.answered != answered:
                answered, since = now.answered, time.monotonic()
        return True

    def _keep(self, report: PlantReport) -> None:
        if self._keeps:
            self.rows += report.rows

    def _next(self) -> Change:
        """The next change that is wanted; if none is within `EVERY`, only a report."""
        try:
            return self._wanted.get(timeout=EVERY)
        except Empty:
            return self._beside.report

    def _changed(self, change: Change) -> PlantReport:
        try:
            return change()
        except ValueError as error:
            _complain(error)
            return self._beside.report()

    def _read(self) -> None:
        """Read what is typed. Nothing that takes long delays the stop or the next report."""
        with ThreadPoolExecutor(1, "changes") as slow:
            for line in sys.stdin:
                if text := line.strip():
                    slow.submit(self._want, text)
                else:
                    self._wanted.put(self._beside.stop)

    def _want(self, text: str) -> None:
        try:
            self._wanted.put(self._change_in(text))
        except (ValueError, OSError) as error:
            _complain(error)

    def _change_in(self, text: str) -> Change:
        """What a typed line asks for."""
        name, equals, value = (part.strip() for part in text.partition("="))
        if not equals:
            raise ValueError(f"{text}: expected NAME=VALUE, path=... or law=...")
        if name == "law":
            return partial(self._beside.use, value)
        if name == "path":
            return partial(self._beside.follow, curve_of("path", value, self._beside.robot))
        changed = with_values(self._beside.parameters, {name: value})
        return partial(self._beside.set, **{name: value_of(changed, name)})

    def _state(self, report: PlantReport) -> str:
        """A line about the last second."""
        robot, acting = self._beside.robot, self._beside.controllers[report.law]
        place = robot.endpoint(np.array(report.q))[None]
        away = 1e3 * path_distance(robot.frame, acting.curve, place)[0]
        late = f"at most {1e3 * report.late:.2f} ms late"
        return f"{report.answered} answers, {late}, {away:.2f} mm from the path, {report.law}"


def _complain(error: Exception) -> None:
    print(f"onpath: {error}", file=sys.stderr, flush=True)


def _counted(report: PlantReport) -> str:
    """What has become of the datagrams."""
    parts = [
        f"{report.answered} measurements were answered, at most {1e3 * report.latest:.2f} ms late",
        f"{report.repeated} came twice or too late for their place",
        f"{report.foreign} came from another sender",
        f"{report.unreadable} datagrams were none",
    ]
    return "; ".join(parts)


def write_log(file: Path, robot: Robot, rows: Sequence[tuple[float, ...]]) -> None:
    """Write t, q, v and torque as CSV, with the names of `quantities`, for onpath identify.

    Raises:
        OSError: it cannot be written.
    """
    names = quantities(robot)
    places = robot.system.coordinate_names
    parts = [name.rpartition("_") for name in places]
    rates = [f"{name}_rate_{unit}_s" for name, _, unit in parts]
    torques = [column for name, column in names.items() if name.startswith("tau")]
    with whole_file(file) as scratch, scratch.open("w", encoding="utf-8", newline="") as opened:
        writer = csv.writer(opened)
        writer.writerow([names["t"], *places, *rates, *torques])
        writer.writerows([f"{number:.9g}" for number in row] for row in rows)
