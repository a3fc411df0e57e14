"""The process of a controller that runs beside a plant: at the plant's rate, whatever else happens.

The plant is the clock: each of its measurements is answered at once. The process that has started
this one asks for reports, so that nothing here waits for it. If it asks no more, or is gone, the
controller ends with the torque chosen for a fault.
"""

from __future__ import annotations

import gc
import multiprocessing
import os
import signal
import socket
import threading
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from multiprocessing.connection import Connection, wait
from typing import Any

import numpy as np

from onpath.app.common.end_signals import END_SIGNALS
from onpath.app.common.own_laws import compiled_law
from onpath.app.notebook.controller import Controller, controller
from onpath.app.plant.datagrams import LARGEST
from onpath.app.plant.plant_link import SILENCE, PlantLink, PlantReport
from onpath.models.errors import Message
from onpath.models.paths.curves import Curve
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import RobotEntry

ASKED = 1.0  # [s] of silence, after which the process that asks, or an ended plant, counts as lost
LINGER = 10.0  # [s] for which a lost process's controller still answers
START = "spawn"  # so that it shares nothing with the process that starts it
PATIENCE = 60.0  # [s] for the controllers to be made
ANSWERS = 5.0  # [s] for an answer
GONE = "the controller's process has ended: the plant gets no torque"
Address = tuple[str, int]


@dataclass(frozen=True, slots=True, kw_only=True)
class ControllerPlan:
    """The controllers of a plant, as arguments of `onpath.controller`.

    Attributes:
        robot: of all.
        paths: by name; the first is followed first.
        laws: the first acts first.
        at_fault, fastest, settings: see there.
        silence: of the plant, in control intervals, after which it ends.
        asked: time without a request, after which the process that asks counts as lost, [s].
        own: the user's own laws among these, as on the command line; the process adds them.
    """

    robot: RobotEntry
    paths: Mapping[str, Curve]
    laws: Sequence[str]
    at_fault: str
    fastest: float
    settings: Mapping[str, Any] = field(default_factory=dict[str, Any])
    silence: int = SILENCE
    asked: float = ASKED
    own: Sequence[str] = ()

    def made(self) -> dict[str, Controller]:
        """The controllers by law."""
        return {
            law: controller(
                self.robot,
                self.paths,
                law,
                at_fault=self.at_fault,
                fastest=self.fastest,
                **self.settings,
            )
            for law in self.laws
        }


class ControllerProcess:
    """Starts a controller in a process of its own, and asks it: one question at a time.

    Args:
        plan: the controllers.
        address: where it listens for the plant; port 0 for any.

    Attributes:
        address: where it listens.
        controllers: by law, with the same settings, which do not run.
        robot: of all.

    Raises:
        ValueError: as `onpath.controller`.
        OSError: it cannot listen there.
    """

    def __init__(self, plan: ControllerPlan, address: Address) -> None:
        self.controllers = plan.made()
        self.robot = next(iter(self.controllers.values())).design.robot
        self._lock = threading.Lock()
        context = multiprocessing.get_context(START)
        self._connection, theirs = context.Pipe()
        self._process = context.Process(target=serve, args=(theirs, plan, address))
        self._process.start()
        theirs.close()
        try:
            self.address: Address = self._answered(PATIENCE)
        except (ValueError, OSError):
            self.close()
            raise
        except BaseException:  # such as Ctrl-C
            if self._connection.poll():  # it listens, so a plant may measure already
                self.leave()
            else:
                self.close()
            raise

    @property
    def parameters(self) -> Parameters:
        """The parameters of all controllers, as they are set."""
        return next(iter(self.controllers.values())).design.parameters

    def report(self) -> PlantReport:
        """What has happened. Without a report for `ASKED`, the controller ends.

        Raises:
            OSError: the process has ended.
        """
        return self._ask("report")

    def reason(self, report: PlantReport) -> Message | None:
        """Why it has ended; None: it has not."""
        return self.controllers[report.law].design.reason(report.code, np.array(report.q))

    def set(self, **settings: Any) -> PlantReport:
        """Change settings, as `Controller.set`."""
        for each in self.controllers.values():
            each.set(**settings)
        return self._ask("set", settings)

    def follow(self, path: Curve) -> PlantReport:
        """Follow another path, as `Controller.follow`."""
        for each in self.controllers.values():
            each.follow(path)
        return self._ask("follow", path)

    def use(self, law: str) -> PlantReport:
        """Let another of the laws act."""
        return self._ask("use", law)

    def stop(self) -> PlantReport:
        """End it: from now on the torque is the one that was chosen for a fault. Thread-safe."""
        return self._ask("stop")

    def close(self) -> None:
        """End the process, which then answers no more."""
        self._process.kill()
        self.leave()

    def leave(self) -> None:
        """Leave the plant the torque for a fault for up to `LINGER`, and wait until then."""
        self._connection.close()
        self._process.join()

    def _ask(self, what: str, *given: Any) -> PlantReport:
        with self._lock:
            try:
                self._connection.send((what, given))
            except OSError:
                raise OSError(GONE) from None
            return self._answered(ANSWERS)

    def _answered(self, patience: float) -> Any:
        try:
            answer = self._connection.recv() if self._connection.poll(patience) else OSError(GONE)
        except (EOFError, OSError):
            raise OSError(GONE) from None
        if isinstance(answer, Exception):
            raise answer
        return answer


def serve(connection: Connection, plan: ControllerPlan, address: Address) -> None:
    """Answer a plant until nobody needs that any more; the main function of the process."""
    for number in END_SIGNALS:  # of the terminal, say; the process that has started it handles them
        signal.signal(number, signal.SIG_IGN)
    try:
        for law in plan.own:
            compiled_law(law)
        controllers = plan.made()
        _warm_up(plan.made())
        with socket.socket(_family(address), socket.SOCK_DGRAM) as plant:
            plant.bind(address)
            plant.setblocking(False)
            gc.collect()
            gc.disable()  # a collection would take longer than a control interval
            _come_first()
            connection.send(plant.getsockname()[:2])
            link = PlantLink(controllers, plan.silence)
            _Serving(connection, link, plant, plan.asked).run()
    except (ValueError, OSError) as error:
        with suppress(OSError):  # the process that asks is gone
            connection.send(error)


class _Serving:
    """The loop of the process."""

    def __init__(
        self, connection: Connection, link: PlantLink, plant: socket.socket, most: float
    ) -> None:
        self._connection, self._link, self._plant = connection, link, plant
        self._most = most  # [s] without a request
        self._asked = time.monotonic()
        self._until: float | None = None  # when it ends because nobody is there to end it

    def run(self) -> None:
        """Serve until the process that asks is gone, and the plant, too."""
        waiting: list[Connection | socket.socket] = [self._connection, self._plant]
        while not self._is_over():
            ready = wait(waiting, self._patience())
            if self._plant in ready:
                self._measurement()
            if self._connection in ready and not self._request():
                waiting.remove(self._connection)
                self._until = time.monotonic() + LINGER
                self._stop()
            self._check()

    def _is_over(self) -> bool:
        if self._until is None:
            return False
        now, link = time.monotonic(), self._link
        return not link.started or now > link.heard + ASKED or now > self._until

    def _patience(self) -> float:
        """Time until something has to be done if nothing comes, [s]."""
        now, silent = time.monotonic(), self._link.silent_at
        return max(0.0, min(ASKED, ASKED if silent is None else silent - now))

    def _measurement(self) -> None:
        try:
            datagram, sender = self._plant.recvfrom(LARGEST)
        except OSError:  # the plant's socket has been closed: it is silent
            return
        known = self._link.started
        if answer := self._link.received(datagram, sender, time.monotonic()):
            if not known:
                self._plant.connect(sender)  # the system leaves out all others, also floods
            self._send(answer)
            self._link.sent(time.monotonic())

    def _check(self) -> None:
        """End it if the plant is silent, or nobody asks."""
        now, silent = time.monotonic(), self._link.silent_at
        if silent is not None and now >= silent and not wait([self._plant], 0):
            self._send(self._link.fall_silent())
        if now - self._asked > self._most:
            self._stop()

    def _request(self) -> bool:
        """Do what is asked; whether the process that asks is still there."""
        try:
            what, given = self._connection.recv()
            self._asked = time.monotonic()
            self._connection.send(self._done(what, given))
        except (EOFError, OSError):
            return False
        return True

    def _done(self, what: str, given: tuple[Any, ...]) -> PlantReport | Exception:
        link = self._link
        try:
            match what, given:
                case "set", (settings,):
                    link.set(**settings)
                case "follow", (curve,):
                    link.follow(curve)
                case "use", (law,):
                    link.use(law)
                case "stop", ():
                    self._stop()
                case _:
                    pass
        except ValueError as error:
            return error
        return link.report()

    def _stop(self) -> None:
        if self._link.started and not self._link.ended:
            self._send(self._link.stop())

    def _send(self, answer: bytes) -> None:
        with suppress(OSError):  # the plant is not there
            self._plant.send(answer)


def _warm_up(controllers: Mapping[str, Controller]) -> None:
    """Do once what takes longer the first time, with controllers that are thrown away."""
    for each in controllers.values():
        robot = each.design.robot
        for tick, (name, curve) in enumerate(each.design.paths.items()):
            q = robot.rest(robot.frame.lift(curve.at(np.array(curve.begin))))
            each.step(tick * each.interval, q)
            each.follow(name)
            each.set()
            each.stop()


def _come_first() -> None:
    """Run before all usual processes, where the system lets its user do that."""
    with suppress(AttributeError, OSError):
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(1))


def _family(address: Address) -> socket.AddressFamily:
    return socket.AF_INET6 if ":" in address[0] else socket.AF_INET
