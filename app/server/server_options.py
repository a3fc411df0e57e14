"""The options of a lab server."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from onpath.app.classroom.classroom import Classroom
from onpath.app.lab.shown_log import ShownLog
from onpath.app.plant.lab_plant import PlantChoice
from onpath.app.storage.expiry import Retention
from onpath.app.storage.records import Records
from onpath.app.viser_adapter.limits import Limits
from onpath.lessons.course import Course
from onpath.models.paths.path_design import PathDesign
from onpath.models.systems.catalogue import FIVE_BAR, RobotEntry

MOST_CLIENTS = 80  # a class of sixty from one network, its teacher and walls, and some who reload
USUAL_RETENTION = Retention()


@dataclass(frozen=True, slots=True, kw_only=True)
class ServerOptions:
    """What a `LabServer` serves, to whom, and where it stores it.

    Attributes:
        course: the lessons; the built-in ones if None.
        records: where labs are stored; None stores nothing.
        classrooms: the classes that students may join.
        most_clients: maximum number of clients; others wait. A teacher is always admitted.
        retention: how long labs are kept, and how many; defaults to that of the command line.
        hang_seconds: see `Watchdog`; 0 for no watchdog.
        privacy_url: the address of the site's privacy notice, if it has one.
        robot: with which a new lab begins.
        path, law, settings, log: those of new labs; see `new_lab`.
        plant: a plant elsewhere in the lab that all pages show; None: each page has its own lab.
        limits, allowed_origins, trusted_proxies, unix_socket, course_url: see `make_server`.
    """

    course: Course | None = None
    records: Records | None = None
    classrooms: Sequence[Classroom] = ()
    most_clients: int = MOST_CLIENTS
    retention: Retention = USUAL_RETENTION
    hang_seconds: float = 0.0
    privacy_url: str = ""
    robot: RobotEntry = FIVE_BAR
    path: PathDesign | None = None
    law: str = ""
    settings: Mapping[str, str] = field(default_factory=dict[str, str])
    log: ShownLog | None = None
    plant: PlantChoice | None = None
    limits: Limits = Limits()
    allowed_origins: tuple[str, ...] = ()
    trusted_proxies: tuple[str, ...] = ()
    unix_socket: Path | None = None
    course_url: str = ""


USUAL = ServerOptions()
