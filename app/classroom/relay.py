"""Exchanges the states of labs between processes.

A student's lab may live in one process, while the teacher's page that shows it lives in another.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import msgspec

from onpath.app.classroom.mirror import Mirror
from onpath.app.classroom.moment import Moment
from onpath.app.classroom.moment_of_lab import tell
from onpath.app.classroom.watches import Watches
from onpath.app.common.error_log import log_warning
from onpath.app.common.periodic import Periodic
from onpath.app.lab.commands import ReportState
from onpath.app.lab.lab import Lab
from onpath.app.simulation.simulation_thread import ScheduledLab, SimulationThread
from onpath.app.storage.records import NotKept

SEND_INTERVAL = 0.125  # [s]
SELDOM = 4  # rounds between requests for labs, and between reads of such requests


class Relay:
    """Publishes the labs here that other processes request, and mirrors requested labs of others.

    Args:
        watches: the requests and states in the database.
        find: session code -> the lab, if it lives in this process.
        wanted: returns which labs of other processes teachers look at: client -> session code.
        make: creates a lab for a mirror.
        simulation: advances the mirrors.

    Attributes:
        rounds: runs the exchange periodically.
    """

    def __init__(
        self,
        watches: Watches,
        find: Callable[[str], ScheduledLab | None],
        wanted: Callable[[], dict[int, str]],
        make: Callable[[], Lab],
        simulation: SimulationThread,
    ) -> None:
        self._simulation = simulation
        self._watches, self._find, self._wanted, self._make = watches, find, wanted, make
        self._asked: set[str] = set()
        self._heard: dict[str, Moment] = {}
        self._told: dict[str, Moment] = {}
        self._mirrors: dict[int, tuple[str, Mirror]] = {}
        self._looks = 0
        self.rounds = Periodic("relay", SEND_INTERVAL, self._try)

    def mirror(self, client: int, session: str) -> Mirror | None:
        """The mirror of a lab in another process, for a teacher's page; None until there is one."""
        code, mirror = self._mirrors.get(client, ("", None))
        return mirror if code == session else None

    def look(self) -> None:
        """One round: publish and receive."""
        if self._looks % SELDOM == 0:
            self._asked = self._watches.asked()
        self._tell()
        self._be_told()
        self._looks += 1

    def _try(self) -> None:
        try:
            self.look()
        except NotKept as error:
            log_warning("labs cannot be followed: %s", error)

    def _tell(self) -> None:
        """Publish the states that the labs reported since the last round, and ask them again."""
        heard, self._heard = self._heard, {}
        new = {code: now for code, now in heard.items() if now != self._told.get(code)}
        if new:
            texts = {code: msgspec.json.encode(now).decode() for code, now in new.items()}
            self._watches.tell(texts)
        self._told = {c: now for c, now in {**self._told, **new}.items() if c in self._asked}
        for code in self._asked:
            if (lab := self._find(code)) is not None:
                lab.lab.post(ReportState(partial(self._hear, code, lab)))

    def _hear(self, code: str, lab: ScheduledLab, _: Lab) -> None:
        self._heard[code] = tell(lab)

    def _be_told(self) -> None:
        wanted = self._wanted()
        codes = set(wanted.values())
        if codes and self._looks % SELDOM == 0:
            self._watches.ask(codes)
        published = self._watches.published(codes) if codes else {}
        mirrors = {c: mine for c, mine in self._mirrors.items() if wanted.get(c) == mine[0]}
        for client, code in wanted.items():
            if code not in published:
                continue
            if client in mirrors:
                mirrors[client][1].tell(published[code])
                continue
            try:
                mirrors[client] = code, Mirror(self._make(), published[code])
            except ValueError as error:
                log_warning("a student's lab cannot be shown: %s", error)
        self._run({mirror for _, mirror in mirrors.values()})
        self._mirrors = mirrors

    def _run(self, wanted: set[Mirror]) -> None:
        """Let the simulation thread advance these mirrors only."""
        running = {mirror for _, mirror in self._mirrors.values()}
        for mirror in running - wanted:
            self._simulation.remove(mirror)
        for mirror in wanted - running:
            self._simulation.add(mirror)
