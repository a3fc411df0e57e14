"""An arm that stands still, and measures as a plant elsewhere does."""

from __future__ import annotations

import socket
import struct
import threading
import time
from types import TracebackType
from typing import Self

import numpy as np

from onpath.app.plant.datagrams import Measured, measurement
from onpath.models.paths.curves import circle
from onpath.models.systems.catalogue import ROBOTS

PATIENCE = 60.0  # [s]; only ends a test that would hang


class StillArm:
    """A two-link arm beside its path, which measures from its entry to its exit.

    Args:
        port: of the controller on this machine.

    Attributes:
        codes: of the torques that it was given.
    """

    def __init__(self, port: int) -> None:
        self.codes, self._port = list[int](), port
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
        q, number = robot.rest(robot.frame.lift(circle(0.03).at(np.array(0.0)))), 0
        begun = time.monotonic()
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as arm:
            arm.connect(("127.0.0.1", self._port))
            arm.settimeout(0.05)
            while not self._ends.wait(0.01):
                number += 1
                now = Measured(number, time.monotonic() - begun, q, np.zeros(2))
                try:
                    arm.send(measurement(now))
                    self.codes.append(struct.unpack_from("<4sIq", arm.recv(999))[2])
                except OSError:  # nobody answers
                    continue
                if self.codes[-1]:
                    self._has_ended.set()
