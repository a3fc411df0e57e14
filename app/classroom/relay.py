"""Between a teacher's page in one process and a student's lab in another; a thread of its own."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import msgspec

from onpath.app.classroom.mirror import Mirror
from onpath.app.classroom.moment import Moment, tell
from onpath.app.classroom.watches import Watches
from onpath.app.common.error_log import log_warning
from onpath.app.common.periodic import Periodic
from onpath.app.lab.commands import ReportState
from onpath.app.lab.lab import Lab
from onpath.app.simulation.simulation_thread import ScheduledLab, SimulationThread
from onpath.app.storage.records import NotKept

SEND_INTERVAL = 0.125  # [s]
SELDOM = 4  # looks until labs are asked for again, or it is looked whether any are


class Relay:
    """Tells of the labs here that others ask for, and mirrors those elsewhere that are asked for.

    Args:
        find: the lab of a session code, if it lives in this process.
        wanted: which labs that live elsewhere the teachers look at: session codes by client.
        make: a new lab, for a mirror.
        simulation: advances the mirrors.

    Attributes:
        rounds: looks, from their start to their stop.
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
        """What a teacher's page shows of a lab that lives elsewhere, once there is anything."""
        code, mirror = self._mirrors.get(client, ("", None))
        return mirror if code == session else None

    def look(self) -> None:
        """Once: tell, and be told."""
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
        """What the labs said after the last look; they are asked again."""
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
        told = self._watches.told(codes) if codes else {}
        mirrors = {c: mine for c, mine in self._mirrors.items() if wanted.get(c) == mine[0]}
        for client, code in wanted.items():
            if code not in told:
                continue
            if client in mirrors:
                mirrors[client][1].tell(told[code])
                continue
            try:
                mirrors[client] = code, Mirror(self._make(), told[code])
            except ValueError as error:
                log_warning("a student's lab cannot be shown: %s", error)
        self._run({mirror for _, mirror in mirrors.values()})
        self._mirrors = mirrors

    def _run(self, wanted: set[Mirror]) -> None:
        """Have these advanced, and no others."""
        running = {mirror for _, mirror in self._mirrors.values()}
        for mirror in running - wanted:
            self._simulation.remove(mirror)
        for mirror in wanted - running:
            self._simulation.add(mirror)
