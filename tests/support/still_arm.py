"""An arm that measures as a plant elsewhere does, whatever torque it is given."""

from __future__ import annotations

import socket
import threading
from types import TracebackType
from typing import Self

import numpy as np

from onpath.app.plant.datagrams import Measured
from onpath.models.arrays import Array
from onpath.models.paths.curves import circle
from onpath.models.systems.catalogue import ROBOTS
from tests.support.plant_end import measurement, torque_in

PATIENCE = 60.0  # [s]; only ends a test that would hang


class StillArm:
    """A two-link arm that stands still or goes round a circle, from its entry to its exit.

    Its clock is a count of its measurements, so that a busy machine makes none of them late.

    Args:
        port: of the controller on this machine.
        interval: from one measurement to the next by its clock, [s].
        speed: along the circle, [rad/s].

    Attributes:
        codes, torques: that it was given.
    """

    def __init__(self, port: int, interval: float = 0.02, speed: float = 0.0) -> None:
        self.codes, self.torques, self._port = list[int](), list[Array](), port
        self._interval, self._speed = interval, speed
        self._ends, self._has_ended = threading.Event(), threading.Event()
        self._thread = threading.Thread(target=self._run)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *_: type[BaseException] | BaseException | TracebackType | None) -> None:
        self._ends.set()
        self._thread.join()

    def wait_for_an_end(self) -> None:
        """Return when a torque has come with a code."""
        assert self._has_ended.wait(PATIENCE)

    def _run(self) -> None:
        robot = ROBOTS["two_link_arm"].make(ROBOTS["two_link_arm"].parameters())
        count = round(2 * np.pi / (self._interval * self._speed)) if self._speed else 1
        theta = 2 * np.pi * np.arange(count) / count
        places = [robot.rest(robot.frame.lift(circle(0.03).at(each))) for each in theta]
        number = 0
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as arm:
            arm.connect(("127.0.0.1", self._port))
            arm.settimeout(0.05)
            while not self._ends.wait(self._interval / 2):
                number += 1
                before, place = places[(number - 1) % count], places[number % count]
                rate = (place - before) / self._interval
                now = Measured(number, number * self._interval, place, rate)
                try:
                    arm.send(measurement(now))
                    answer = torque_in(arm.recv(999), 2)
                except OSError:  # nobody answers
                    continue
                assert answer is not None
                self.codes.append(answer[1])
                self.torques.append(answer[2])
                if self.codes[-1]:
                    self._has_ended.set()
