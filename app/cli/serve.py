"""`onpath serve`, the default command."""

from __future__ import annotations

import gc
import logging
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from threading import Thread
from typing import TYPE_CHECKING, Literal
from urllib.parse import urlsplit

from onpath.app.cli.assignments import assignments
from onpath.app.cli.options import Repeated
from onpath.app.cli.robot_options import NO_OPTIONS, FileOptions

if TYPE_CHECKING:
    from onpath.app.classroom.classroom import Classroom
    from onpath.app.lab.shown_log import ShownLog
    from onpath.app.plant.lab_plant import PlantChoice
    from onpath.models.paths.path_design import PathDesign
    from onpath.models.systems.robots import RobotEntry

SHORTEST_HANG = 1.0  # [s], least value of --hang


@dataclass(frozen=True)
class Serve:
    """Serve the lab in the browser."""

    host: str = "127.0.0.1"
    """Address to listen on; 0.0.0.0 allows connections from other machines."""
    port: int = 8080
    """Port to listen on."""
    open: bool = False
    """Open the lab in the default browser."""
    robot: str = "five_bar"
    """Robot with which a lab begins: its name, or its URDF or MJCF file."""
    path: str | None = None
    """The path of new labs, or @FILE with options, as for onpath experiment."""
    law: Repeated = ()
    """A law of your own in a Python file, as my_law.py:Name; repeat for more. They are in the menu
    of laws, and the robot on the right begins with the first. Not with --classroom."""
    set: Repeated = ()
    """Set a parameter of the robot, or one of the lab's own settings, of new labs, as name=value;
    repeat for more."""
    log: Path | None = None
    """Draw the log of a real arm over the plots of new labs; a file as for onpath identify."""
    column: Repeated = ()
    """A column of the log, as for identify; repeat for more."""
    unit: Repeated = ()
    """Unit of a column of the log, as for identify; repeat for more."""
    lessons: Path | None = None
    """A folder with lessons of your own, shown after the built-in ones."""
    database: str | None = None
    """URL of the database for the labs; by default a file in your data folder. One with a password
    must be given in the environment, ONPATH_DATABASE: other users see command lines. If one that is
    given cannot be used, the lab does not start; the same holds behind a proxy (--origin)."""
    keep_days: int = 365
    """After this number of days without use, a lab is deleted."""
    keep_class_days: int = 7
    """After this number of days without a change, a class is deleted, with its nicknames; its
    teacher may choose fewer."""
    most_labs: int = 100_000
    """If the database holds more labs, the least recently used are deleted, but none in use."""
    classroom: bool = False
    """Open a class, and print its address for the students and where the teacher's key is; both
    stay the same. With teachers' keys in the environment, ONPATH_TEACHER_KEY, each has a class
    instead."""
    privacy_url: str = ""
    """Address of your privacy notice, https://example.org/privacy, shown where a nickname is asked
    for."""
    course_url: str = ""
    """Address of the course as pages (onpath export site), https://example.org/course, to which
    browsers without WebGL are led."""
    origin: Repeated = ()
    """Address of the page behind a proxy, https://lab.example.org; repeat for more."""
    trusted_proxy: Repeated = ()
    """Proxy on another machine to trust, such as 10.0.0.7 or 10.0.0.0/8; repeat for more."""
    socket: Path | None = None
    """Listen on this Unix socket instead, for your own proxy, such as Jupyter's."""
    most_clients: int = 80
    """Maximum number of browsers, 15 of 16 of them from one network; further ones wait."""
    hang_seconds: float = 10.0
    """A process whose simulation or network hangs for this time answers 503 at /health, and is
    started again after twice this time; time when it gets no processor does not count. 0 for
    never."""
    plant: str | None = None
    """Drive a plant elsewhere, which stands in the place of the robot on the right: the address of
    this machine where its controller listens once it is started on the page, udp://HOST:PORT, see
    app/plant/README.md. Not a safety function. One page drives, whose address is printed; all
    others watch. With it, --law names the laws that can act on it: by default path_following."""
    at_fault: Literal["zero", "hold", "damp"] = "zero"
    """Torque of the plant after the end: none, the last one, or against the velocities."""
    fastest: float = 100.0
    """Largest rate of a joint of the plant, above which a measurement ends it, in rad/s, or m/s of
    one that slides."""
    open_to_others: bool = False
    """Allow a --host or an address of --plant that other machines can reach: they may watch the
    page, and whoever sends a measurement first is the plant."""
    log_level: Literal["debug", "info", "warning", "error"] = "info"
    """Lowest level of log messages."""
    file_options: FileOptions = NO_OPTIONS

    def run(self) -> int | None:
        """Serve until Ctrl-C; return exit code 1 if the database cannot be used."""
        if self.most_clients < 1:
            raise ValueError(f"--most-clients {self.most_clients}: expected 1 or more")
        if self.hang_seconds and self.hang_seconds < SHORTEST_HANG:
            raise ValueError(f"--hang-seconds {self.hang_seconds:g}: expected 1 or more, or 0")
        if self.privacy_url and not _is_web_address(self.privacy_url):
            raise ValueError(f"--privacy-url {self.privacy_url}: expected https://… or http://…")
        if self.course_url and not _is_web_address(self.course_url):
            raise ValueError(f"--course-url {self.course_url}: expected https://… or http://…")
        for origin in self.origin:
            if not _is_origin(origin):
                raise ValueError(
                    f"--origin {origin}: expected a web address without a path, such as"
                    " https://lab.example.org"
                )
        gc.disable()  # a collection finds nothing while modules are imported; see SimulationThread
        try:
            return self._serve()
        finally:
            gc.enable()

    def _serve(self) -> int | None:
        from onpath.app.viser_adapter.viser_parts import check_viser

        level = getattr(logging, self.log_level.upper())
        logging.basicConfig(level=level, format="%(levelname)s %(name)s: %(message)s")
        logging.getLogger("websockets").setLevel(max(level, logging.WARNING))
        check_viser()  # before the other imports, which may fail with another viser

        from onpath.app.classroom.class_opening import given_keys, open_classes
        from onpath.app.server.lab_server import serve
        from onpath.app.server.server_options import ServerOptions
        from onpath.app.storage.database_url import database_url
        from onpath.app.storage.engine import NotKept
        from onpath.app.storage.expiry import Retention

        entry = self.file_options.entry_of(self.robot)
        laws, plant = self._laws(entry), None
        if self.plant is not None:
            plant = self._plant(self.plant, entry, laws)
        keys = given_keys()
        classrooms = open_classes(keys) if self.classroom else []
        try:
            serve(
                self.host,
                self.port,
                self.lessons,
                database_url(self.database),
                open_browser=self.open and self.socket is None,
                ready=partial(print_classes, classrooms, key_is_known=bool(keys)),
                drives=_tell_driver,
                options=ServerOptions(
                    robot=entry,
                    path=self._path(entry),
                    law=laws[0] if laws else "",
                    settings=self._settings(entry),
                    log=self._logged(entry),
                    plant=plant,
                    classrooms=classrooms,
                    most_clients=self.most_clients,
                    retention=Retention(self.keep_days, self.most_labs, self.keep_class_days),
                    hang_seconds=self.hang_seconds,
                    privacy_url=self.privacy_url,
                    course_url=self.course_url,
                    allowed_origins=self.origin,
                    trusted_proxies=self.trusted_proxy,
                    unix_socket=self.socket,
                ),
            )
        except NotKept as error:
            print(f"onpath: {error}", file=sys.stderr)
            return 1
        return None

    def _plant(self, address: str, entry: RobotEntry, laws: tuple[str, ...]) -> PlantChoice:
        """The plant that the lab is to drive.

        Raises:
            ValueError: its address is none, or other machines can reach it or the page and that is
                not wanted; another option contradicts it; or its motors have no limits.
        """
        from onpath.app.cli.control import plant_address
        from onpath.app.plant.lab_plant import PlantChoice
        from onpath.app.viser_adapter.request_filter import is_loopback
        from onpath.models.control.settable import specs, with_values

        others = ("classroom", "lessons", "database", "origin", "trusted_proxy", "socket")
        for name in others:
            if getattr(self, name):
                raise ValueError(f"--plant: not with --{name.replace('_', '-')}")
        if not (is_loopback(self.host) or self.open_to_others):
            raise ValueError(
                f"--host {self.host}: other machines can reach it, and watch a plant:"
                " use 127.0.0.1, or add --open-to-others"
            )
        given = {
            name: v for name, v in self._settings(entry).items() if name in specs(entry.parameters)
        }
        if with_values(entry.parameters(), given).torque_limit == 0:
            raise ValueError("a plant needs limits: --set torque_limit=... in N m")
        return PlantChoice(
            address=plant_address(address, open_to_others=self.open_to_others),
            laws=laws or ("path_following",),
            at_fault=self.at_fault,
            fastest=self.fastest,
            own=tuple(self.law),
        )

    def _laws(self, entry: RobotEntry) -> tuple[str, ...]:
        """Add the user's own laws, and return the names.

        Raises:
            ValueError: one of them has an error that a loop of this robot shows.
        """
        from onpath.app.common.own_laws import compiled_law
        from onpath.models.closed_loop.simulation import kernel_of, kind_of
        from onpath.models.paths.curves import circle

        if self.law and self.classroom:
            raise ValueError(
                "--law: a class has the laws of OnPath only; serve it without --classroom"
            )
        names = [compiled_law(text) for text in self.law]
        parameters = entry.parameters()
        for name in names:
            kernel_of(entry.make(parameters), kind_of(name, parameters, circle(0.05)))
        return tuple(names)

    def _settings(self, entry: RobotEntry) -> dict[str, str]:
        """The settings of new labs.

        Raises:
            ValueError: an unknown name or a bad value.
        """
        from onpath.models.closed_loop.lab_settings import lab_specs
        from onpath.models.systems.parameter_specs import checked, unknown_name

        given, known = assignments(self.set), lab_specs(entry.parameters)
        for name, value in given.items():
            if name not in known:
                raise unknown_name(name, list(known), "setting")
            checked(known[name], name, value)
        return given

    def _logged(self, entry: RobotEntry) -> ShownLog | None:
        """The log over the plots of new labs.

        Raises:
            ValueError, OSError: it cannot be read, or is not one of this robot.
        """
        from onpath.app.common.user_files import user_file
        from onpath.app.lab.shown_log import read_shown_log

        columns = assignments(self.column, "--column")
        units = assignments(self.unit, "--unit")
        if self.log is None and (columns or units):
            raise ValueError("--column and --unit are those of a log: add --log and a file")
        if self.log is None:
            return None
        return read_shown_log(user_file(self.log), entry, columns, units)

    def _path(self, entry: RobotEntry) -> PathDesign | None:
        """The path of new labs; None: the usual one."""
        from onpath.app.notebook.arguments import curve_of, path_name
        from onpath.models.paths.drawing_design import from_curve
        from onpath.models.paths.path_design import presets
        from onpath.models.studies.experiments import check_path, path_remark

        if self.path is None:
            return None
        robot = entry.make(entry.parameters())
        if self.path in presets():
            return presets(robot.radius)[self.path]
        curve = curve_of("--path", self.path, robot)
        check_path(robot, curve, f"--path {path_name(self.path)}")
        if remark := path_remark(curve):
            print(f"onpath: {remark}", file=sys.stderr)
        return from_curve(curve)


def _tell_driver(address: str) -> None:
    """Print the address of the page that drives a plant."""
    print(f"drive:         {address}     on this machine; STOP is there, or Esc", flush=True)


def _is_web_address(text: str) -> bool:
    """Whether a text is a web address with a host, which is safe in a link."""
    try:
        parts = urlsplit(text)
    except ValueError:
        return False
    plain = text.isprintable() and not any(c.isspace() or c == "\\" for c in text)
    return plain and parts.scheme in ("http", "https") and bool(parts.hostname)


def _is_origin(text: str) -> bool:
    """Whether a text is what a browser sends as the origin of a page."""
    if not _is_web_address(text):
        return False
    parts = urlsplit(text)
    try:
        _ = parts.port
    except ValueError:  # not a number from 0 to 65535
        return False
    plain = parts.path in ("", "/") and "?" not in text and "#" not in text
    return plain and "@" not in parts.netloc


def print_classes(classrooms: Sequence[Classroom], site: str, *, key_is_known: bool) -> None:
    """Print the address and code of each class, and in a terminal a QR code of the address.

    Args:
        site: the address at which other devices open the lab.
        key_is_known: whether the teacher's key has been given. If not, it is told where it is: a
            terminal, which is often on a projector, shows it only when somebody asks.
    """
    from onpath.app.common.access_codes import shown
    from onpath.app.common.qr_code import qr_text
    from onpath.app.server.site_address import is_local
    from onpath.app.viser_adapter.addresses import class_address

    for number, room in enumerate(classrooms, start=1):
        address = f"{site}{class_address(room.code)}"
        of = f"     of teacher's key {number}" if len(classrooms) > 1 else ""
        print(f"class:         {address}     class code {room.code.upper()}{of}")
        if is_local(site):
            print("               Only this computer can open it: --host 0.0.0.0 lets others in.")
        elif len(classrooms) == 1 and _can_show(code := qr_text(address)):
            print(code)
        if not key_is_known:
            tell_key(shown(room.key))
    print(end="", flush=True)  # does nothing without a standard output


def tell_key(key: str) -> None:
    """Say where the teacher's key is; show it in a terminal when Enter is pressed there.

    A key that no file has is printed at once, since nobody could find it.
    """
    from onpath.app.classroom.class_opening import key_file

    try:
        is_kept = key_file().read_text("utf-8", errors="replace").strip() == key
    except OSError:
        is_kept = False
    if not is_kept:
        print(f"teacher's key: {key}     there, under Class, Teacher; tell it nobody")
        return
    print(f"teacher's key: in {key_file()}")
    if sys.stdin is not None and sys.stdin.isatty() and sys.stdout is not None:
        print("               Press Enter to show it here: turn the projector away first.")
        Thread(target=_show_when_asked, args=(key,), name="key", daemon=True).start()


def _show_when_asked(key: str) -> None:
    if sys.stdin.readline():
        print(f"teacher's key: {key}     there, under Class, Teacher; tell it nobody", flush=True)


def _can_show(text: str) -> bool:
    """Whether the output is a terminal that can show a text."""
    if sys.stdout is None:  # closed by who has started the lab
        return False
    try:
        text.encode(sys.stdout.encoding or "ascii")
    except UnicodeEncodeError:
        return False
    return sys.stdout.isatty()
