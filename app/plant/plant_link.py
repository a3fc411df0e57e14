"""Which datagrams of a plant count, and when it ends: without sockets, threads or a clock."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from onpath.app.notebook.controller import Controller, GivenPath
from onpath.app.plant.datagrams import Measured, measured_in, torque_datagram
from onpath.models.systems.parameter_specs import unknown_name

SILENCE = 2  # control intervals
DRIFT = 1e-3  # by which the clocks of plant and controller may differ


@dataclass(frozen=True, slots=True, eq=False)
class PlantReport:
    """What has happened up to now.

    Attributes:
        law: in use.
        started: whether a measurement has come.
        code: 0, or why it has ended.
        reason: the same in a sentence, or "".
        q: as measured last, n numbers.
        theta, theta_ref: of the closest point of the path, and of the reference point, [rad].
        answered: measurements that got a torque.
        repeated: measurements that came twice or after a later one.
        foreign: datagrams from another sender than the first.
        unreadable: datagrams without a measurement.
        late: from the time of a measurement to its torque, the longest since the last report,
            [s], compared with the fastest measurement.
        latest: the longest since the start, [s].
        rows: t, q, v and torque of each measurement since the last report, as
            Python's floats: NumPy's take eighty times as long on their way to another process.
    """

    law: str
    started: bool = False
    code: int = 0
    reason: str = ""
    q: tuple[float, ...] = ()
    theta: float = np.nan
    theta_ref: float = np.nan
    answered: int = 0
    repeated: int = 0
    foreign: int = 0
    unreadable: int = 0
    late: float = 0.0
    latest: float = 0.0
    rows: tuple[tuple[float, ...], ...] = ()


class PlantLink:
    """Answers a plant's measurements with torques.

    Only the first sender of a finite measurement counts, and only measurements with increasing
    sequence numbers. A measurement that the controller refuses, one that is late, and silence end
    it for good: from then on the torque is what was chosen for a fault.

    Lateness is the time between a measurement and its torque, compared with the fastest
    measurement, because the clocks of plant and controller have nothing in common.

    Args:
        controllers: by the name of their law, at least one, which have not been started. They have
            the same robot, path and settings. The first one acts.
        silence: control intervals without a measurement, or by which one may be late.
    """

    def __init__(self, controllers: Mapping[str, Controller], silence: int = SILENCE) -> None:
        self._controllers, self._silence = controllers, silence
        self._report = PlantReport(next(iter(controllers)))
        self._sender: Hashable = None
        self._last: Measured | None = None
        self._heard = self._offset = 0.0
        self._rows = list[tuple[float, ...]]()

    @property
    def ended(self) -> bool:
        """Whether it has ended, so that all torques are those for a fault."""
        return self._acting.code != 0

    @property
    def silent_at(self) -> float | None:
        """When the silence of the plant ends it, [s] of the given times; None: it cannot."""
        if self._last is None or self.ended:
            return None
        return self._heard + self._silence * self._acting.interval

    @property
    def started(self) -> bool:
        """Whether a measurement has come."""
        return self._last is not None

    @property
    def heard(self) -> float:
        """When the last measurement came, [s] of the given times."""
        return self._heard

    def received(self, datagram: bytes, sender: Hashable, now: float) -> bytes | None:
        """The answer to a datagram; None: it has none.

        Args:
            sender: its address.
            now: when it was read, [s] of any clock that does not jump.
        """
        given = measured_in(datagram, self._acting.design.robot.system.n)
        if given is None or (self._last is None and not given.finite):
            self._count("unreadable")
        elif self._last is not None and sender != self._sender:
            self._count("foreign")
        elif self._last is not None and given.sequence <= self._last.sequence:
            self._count("repeated")
        else:
            self._sender = sender
            return self._answer(given, now)
        return None

    def sent(self, now: float) -> None:
        """Note when the last answer was sent."""
        assert self._last is not None
        late, report = now - self._last.t - self._offset, self._report
        if late > report.late:  # not if the time is no number
            self._report = replace(report, late=late, latest=max(report.latest, late))

    def fall_silent(self) -> bytes:
        """End it because the plant is silent; the torque for that."""
        return self._end("late")

    def stop(self) -> bytes:
        """End it because somebody wants that, after the first measurement; the torque for that."""
        return self._end("stopped")

    def set(self, **settings: float | str) -> None:
        """Change settings from the next evaluation on, as `Controller.set`."""
        for each in self._controllers.values():
            each.set(**settings)

    def follow(self, path: GivenPath) -> None:
        """Follow another path, as `Controller.follow`."""
        for each in self._controllers.values():
            each.follow(path)

    def use(self, law: str) -> None:
        """Let another law act, from where the robot is, unless it has ended.

        Raises:
            ValueError: there is no such law.
        """
        if law not in self._controllers:
            raise unknown_name(law, [*self._controllers], "law")
        if self.ended or law == self._report.law:
            return
        old, new, last = self._acting, self._controllers[law], self._last
        if last is not None:
            new.start(last.t, last.q, old.v, old.theta)
        self._report = replace(self._report, law=law)

    def report(self) -> PlantReport:
        """What has happened; the rows and `late` are reset."""
        acting, last = self._acting, self._last
        told = replace(
            self._report,
            started=last is not None,
            code=acting.code,
            reason=acting.reason,
            q=() if last is None else tuple(last.q.tolist()),
            theta=acting.theta,
            theta_ref=acting.theta_ref,
            rows=tuple(self._rows),
        )
        self._rows = []
        self._report = replace(self._report, late=0.0)
        return told

    @property
    def _acting(self) -> Controller:
        return self._controllers[self._report.law]

    def _answer(self, given: Measured, now: float) -> bytes:
        acting, last, offset = self._acting, self._last, now - given.t
        if last is None:
            self._offset = offset
        elif last.t < given.t < np.inf:
            self._offset = min(offset, self._offset + DRIFT * (now - self._heard))
            if offset - self._offset > self._silence * acting.interval:
                acting.stop("late")
        torque = acting.step(given.t, given.q, given.v)
        self._last, self._heard = given, now
        self._count("answered")
        self._rows.append((given.t, *given.q.tolist(), *acting.v.tolist(), *torque.tolist()))
        return torque_datagram(given.sequence, acting.code, torque)

    def _end(self, reason: str) -> bytes:
        acting, last = self._acting, self._last
        assert last is not None
        acting.stop(reason)
        unknown = np.full_like(last.q, np.nan)  # so "damp" is 0: nobody knows the velocities
        torque = acting.step(last.t, unknown)
        return torque_datagram(last.sequence, acting.code, torque)

    def _count(self, what: str) -> None:
        self._report = replace(self._report, **{what: getattr(self._report, what) + 1})
