"""A plant elsewhere in a lab that all pages of a server show; one of them drives."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass
from hmac import compare_digest
from secrets import token_hex

from onpath.app.channel.plant_messages import DrivePlant
from onpath.app.lab.commands import SetLanguage
from onpath.app.lab.lab import Lab
from onpath.app.plant.lab_plant import LabPlant, PlantChoice
from onpath.app.server.visit import Visit
from onpath.app.simulation.scheduled_lab import ScheduledLab
from onpath.app.viser_adapter.request_filter import is_loopback
from onpath.models.errors import Message


@dataclass(frozen=True, slots=True)
class ShownLab:
    """The lab of the plant, as a page shows it; see `LabFeed`.

    Attributes:
        number: 0 on the page that drives; see `PageKey.student`.
    """

    scheduled: ScheduledLab
    number: int

    def find(self) -> tuple[ScheduledLab, int]:
        """The lab, and the number."""
        return self.scheduled, self.number


class PlantDesk:
    """Who drives the plant: the first page on this machine whose address has the key.

    Attributes:
        scheduled: the lab of the plant.
        plant: drives it.
        key: of the page that drives.
    """

    def __init__(self, lab: Lab, choice: PlantChoice) -> None:
        self.key = token_hex(8)
        self.scheduled, self.plant = ScheduledLab(lab), LabPlant(lab, choice)
        self.scheduled.display = self.plant
        self._driver: Visit | None = None
        self._lock = threading.Lock()

    def sit(self, visit: Visit) -> bool:
        """Let a page drive if it may, until its visit ends; whether it does. Thread-safe."""
        knows = compare_digest(visit.hello.drives.encode(), self.key.encode())
        with self._lock:
            if not (knows and is_loopback(visit.address)) or self._driver not in (None, visit):
                return False
            self._driver = visit
        visit.at_end(lambda: self._leave(visit))
        if visit.language:
            self.scheduled.lab.post(SetLanguage(visit.language))
        return True

    def shown(self, drives: bool) -> ShownLab:
        """The lab for a page."""
        return ShownLab(self.scheduled, 0 if drives else 1)

    def hear(self, message: DrivePlant) -> None:
        """Take a message of the page that drives. On the event loop."""
        act: dict[str, Callable[[], None]] = {
            "start": lambda: self.plant.start(message.at_fault),
            "stop": self.plant.stop,
            "beat": self.plant.beat,
        }
        act[message.what]()

    def _leave(self, visit: Visit) -> None:
        with self._lock:
            if self._driver is visit:
                self._driver = None
                self.plant.stop(Message("plant.page_lost"))
