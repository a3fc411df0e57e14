"""The command line: `onpath` serves the lab, its subcommands run without a browser."""

from __future__ import annotations

import contextlib
import io
import json
import logging
import os
import re
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import tyro

if TYPE_CHECKING:
    from app.database import Records
    from app.room import Room

COMMANDS = ("serve", "experiment", "zero-dynamics", "lessons", "bench", "forget")


@dataclass(frozen=True)
class Serve:
    """Serve the lab in the browser."""

    host: str = "127.0.0.1"
    """Address to listen on; 0.0.0.0 lets other machines in."""
    port: int = 8080
    """Port to listen on."""
    open: bool = False
    """Open the lab in the default browser."""
    lessons: Path | None = None
    """A folder with lessons of your own, shown after the built-in ones."""
    database: str | None = None
    """URL of a database that keeps the labs; a file in your data folder if not given."""
    classroom: bool = False
    """Open a class: prints a code for the students and a key for the teacher."""
    origin: Annotated[tuple[str, ...], tyro.conf.UseAppendAction] = ()
    """Address of the page behind a proxy, https://lab.example.org; repeat for more."""
    socket: Path | None = None
    """Listen on this Unix socket instead, for a proxy of your own such as Jupyter's."""
    most_clients: int = 64
    """So many browsers at once in each process; the next ones are told to wait."""
    workers: int = 1
    """So many processes, which share the port and the database."""
    successive_ports: bool = False
    """Each worker has a port of its own, from --port on, for a proxy in front."""
    log_level: Literal["debug", "info", "warning", "error"] = "info"
    """How much to log."""

    def run(self) -> None:
        """Serve until Ctrl-C."""
        if self.most_clients < 1:
            raise ValueError(f"--most-clients {self.most_clients}: expected 1 or more")
        from app.workers import is_worker

        if self.workers != 1:
            self._supervise()
            return
        from app.handing import handed
        from app.server import serve

        worker = is_worker()
        level = getattr(logging, self.log_level.upper())
        logging.basicConfig(level=level, format="%(levelname)s %(name)s: %(message)s")
        logging.getLogger("websockets").setLevel(max(level, logging.WARNING))
        serve(
            self.host,
            self.port,
            self.lessons,
            self.database,
            open_browser=self.open,
            open_class=_opener(silent=worker) if self.classroom else None,
            most_clients=self.most_clients,
            allowed_origins=self.origin,
            unix_socket=self.socket,
            share_port=worker,
            listener=handed(self.host, self.port),
        )

    def _supervise(self) -> None:
        from app.workers import check, supervise

        check(self)
        if not self.classroom:
            supervise(self)
            return
        from app.class_opening import KEY, class_of_workers

        with class_of_workers(self.database) as (room, is_new):
            _print_class(room.code, room.key if is_new else None)
            supervise(self, {KEY: room.key})


def _opener(silent: bool) -> Callable[[Records], Room]:
    """What opens a class in a database; it prints code and key unless somebody else does."""
    from app.class_opening import given_key, open_class

    key = given_key()

    def opened(records: Records) -> Room:
        room = open_class(records, key)
        if not silent:
            _print_class(room.code, room.key if key is None else None)
        return room

    return opened


def _print_class(code: str, key: str | None) -> None:
    """What to tell students and teacher, whatever is logged; a key that was given is known."""
    from app.codes import shown

    print(f"class code:    {code.upper()}     for the students, under Class")
    if key is not None:
        print(f"teacher's key: {shown(key)}     under Class, Teacher; tell it nobody")
    sys.stdout.flush()


@dataclass(frozen=True)
class Experiment:
    """Run one of the paper's experiments and report."""

    name: Annotated[str, tyro.conf.Positional]
    """position, obstruction or flexible."""
    controller: Literal["path_following", "trajectory_tracking", "both"] = "both"
    """Which controller to run."""
    set: Annotated[tuple[str, ...], tyro.conf.UseAppendAction] = ()
    """name=value, for any parameter; repeat for more."""
    csv: Path | None = None
    """Write every millisecond to this CSV file."""
    plot: Path | None = None
    """Draw the paper's figures to this .png, .svg or .pdf file."""
    json: bool = False
    """Print a summary as JSON."""

    def run(self) -> None:
        """Simulate, then write and print what was asked for."""
        from app.figures import draw_experiment
        from models.controllers import NAMES
        from models.experiments import experiments, run, summary
        from models.parameters import unknown_name
        from models.trajectory import write_csv

        known = experiments()
        if self.name not in known:
            raise unknown_name(self.name, list(known), what="experiment")
        _check_plot(self.plot)
        if self.csv:
            _check_writable(self.csv)
        chosen = known[self.name].with_values(_assignments(self.set))
        names = NAMES if self.controller == "both" else (self.controller,)
        runs = [run(chosen, name) for name in names]
        result = summary(chosen, runs)
        if self.csv:
            with _whole_file(self.csv) as path, path.open("w", newline="") as file:
                write_csv(file, chosen.robot(), runs)
        if self.plot:
            with _whole_file(self.plot) as path:
                draw_experiment(chosen, runs, path)
        reasons = {r.controller: r.reason for r in runs}
        print(json.dumps(result, indent=2) if self.json else _table(result, reasons))


@dataclass(frozen=True)
class ZeroDynamics:
    """Exponents of the flexible link's internal dynamics against alpha and number of modes."""

    at: tuple[float, float] = (0.0, 0.0)
    """y2 and y3 of the tip at rest, in metres."""
    set: Annotated[tuple[str, ...], tyro.conf.UseAppendAction] = ()
    """name=value, for rho, plant, frequency, zeta; repeat for more."""
    plot: Path | None = None
    """Draw exponents and critical alpha to this .png, .svg or .pdf file."""
    json: bool = False
    """Print the table as JSON."""

    def run(self) -> None:
        """Compute, then print and draw."""
        from app.figures_flexible import draw_zero_dynamics
        from app.zero_dynamics import as_json, as_table, changed_all, study

        _check_plot(self.plot)
        result = study(changed_all(_assignments(self.set)), self.at)
        if self.plot:
            with _whole_file(self.plot) as path:
                draw_zero_dynamics(result, path)
        print(json.dumps(as_json(result), indent=2) if self.json else as_table(result))


@dataclass(frozen=True)
class Lessons:
    """List the lessons, or check lessons of your own."""

    do: Annotated[Literal["list", "check"], tyro.conf.Positional]
    """list or check."""
    folder: Annotated[Path | None, tyro.conf.Positional] = None
    """A folder of lessons; the built-in ones if there is none."""

    def run(self) -> int:
        """Print; exit code 1 when something is wrong."""
        from lessons.course import BUILT_IN, read_course

        course, problems = read_course([self.folder or BUILT_IN])
        if self.do == "list":
            for name, versions in course.lessons.items():
                facts = course.lesson(name, "en").front
                print(f"{name:30s} {facts.minutes:3d} min  {','.join(versions):8s} {facts.title}")
        for problem in problems:
            print(problem, file=sys.stderr)
        if self.do == "check" and not problems:
            print(f"{len(course.lessons)} lessons, nothing wrong")
        return 1 if problems else 0


@dataclass(frozen=True)
class Bench:
    """Measure the speed of the closed loops and of the lab."""

    quick: bool = False
    """Fewer repetitions, no clients."""
    clients: tuple[int, ...] = ()
    """Only this: how a server bears so many simulated browsers; several numbers, one by one."""
    workers: int = 1
    """So many processes serve them."""
    seconds: float = 15.0
    """So long is measured, once all browsers are shown moving robots."""
    minutes: int = 0
    """A row every minute for so long, to see whether memory stays flat."""

    def run(self) -> None:
        """Print the table."""
        from app.bench import bench, bench_crowds
        from app.bench_crowd import Crowd

        if self.minutes < 0:
            raise ValueError(f"--minutes {self.minutes}: expected 1 or more")
        if not self.clients and (self.workers, self.seconds, self.minutes) != (1, 15.0, 0):
            raise ValueError("--workers, --seconds and --minutes go with --clients")
        if self.clients and self.quick:
            raise ValueError("--quick leaves out what --clients asks for")
        seconds, rows = (60.0, self.minutes) if self.minutes else (self.seconds, 1)
        crowds = [Crowd(clients, self.workers, seconds, rows) for clients in self.clients]
        if crowds:
            bench_crowds(crowds)
        else:
            bench(quick=self.quick)


@dataclass(frozen=True)
class Forget:
    """Delete every lab that is kept. There is no way back."""

    database: str | None = None
    """URL of the database; the file in your data folder if not given."""

    def run(self) -> None:
        """Delete, and say how much."""
        from app.forget import forget

        gone = forget(self.database)
        print(f"deleted: {gone.labs} labs, {len(gone.files)} files moved aside as broken")


def main() -> None:
    """Entry point of `onpath`."""
    sys.exit(run_command(sys.argv[1:]))


def run_command(arguments: list[str]) -> int:
    """Run one command line; returns the exit code.

    That is 0, or 2 with one line on standard error, or 1 for lessons with something wrong.
    """
    if not arguments or arguments[0] not in (*COMMANDS, "-h", "--help"):
        if arguments and not arguments[0].startswith("-"):
            print(f"onpath: {unknown_command(arguments[0])}", file=sys.stderr)
            return 2
        arguments = ["serve", *arguments]
    try:
        return _parse(arguments).run() or 0
    except BrokenPipeError:
        return 0
    except (ValueError, OSError) as error:
        print(f"onpath: {_one_line(str(error))}", file=sys.stderr)
        return 2


def unknown_command(name: str) -> str:
    """What to say to a command that does not exist."""
    return f"unknown command {name!r}: there are {', '.join(COMMANDS)}"


def _parse(arguments: list[str]) -> Serve | Experiment | ZeroDynamics | Lessons | Bench | Forget:
    complaint = io.StringIO()
    try:
        with contextlib.redirect_stderr(complaint):
            return tyro.cli(
                Annotated[Serve, tyro.conf.subcommand("serve")]
                | Annotated[Experiment, tyro.conf.subcommand("experiment")]
                | Annotated[ZeroDynamics, tyro.conf.subcommand("zero-dynamics")]
                | Annotated[Lessons, tyro.conf.subcommand("lessons")]
                | Annotated[Bench, tyro.conf.subcommand("bench")]
                | Annotated[Forget, tyro.conf.subcommand("forget")],
                prog="onpath",
                description=__doc__,
                args=arguments,
            )
    except SystemExit as stop:
        if stop.code in (0, None):
            raise
        raise ValueError(_unboxed(complaint.getvalue())) from None


def _unboxed(text: str) -> str:
    """A framed message without its frame, title and pointers to the help, on one line."""
    _, *sections = re.split(r"[\u2500-]{5,}", re.sub(r"\x1b\[[0-9;]*m", "", text))
    lines = [_one_line(re.sub(r"[\u2500-\u257f]", " ", section)) for section in sections]
    pointers = ("For full helptext", "Argument helptext")
    kept = [line for line in lines if line and not line.startswith(pointers)]
    return " ".join(kept) or _one_line(text)


def _one_line(text: str) -> str:
    return " ".join(text.split())


def _assignments(pairs: tuple[str, ...]) -> dict[str, str]:
    values: dict[str, str] = {}
    for pair in pairs:
        name, equals, value = pair.partition("=")
        if not equals or not name or not value:
            raise ValueError(f"--set {pair}: expected name=value")
        values[name.strip()] = value.strip()
    return values


def _check_plot(path: Path | None) -> None:
    """Complain of a picture that cannot be made.

    Raises:
        ValueError: an unknown kind of file, or nothing can be written there.
    """
    if path is None:
        return
    if path.suffix not in (".png", ".svg", ".pdf"):
        raise ValueError(f"--plot {path}: expected a name ending in .png, .svg or .pdf")
    _check_writable(path)


def _check_writable(path: Path) -> None:
    """Complain before the work is done, not after it.

    Raises:
        ValueError: nothing can be written there.
    """
    if path.is_dir():
        raise ValueError(f"{path}: that is a folder")
    if not path.parent.is_dir():
        raise ValueError(f"{path}: no folder {path.parent}")
    if not os.access(path.parent, os.W_OK):
        raise ValueError(f"{path}: nothing can be written to {path.parent}")


@contextlib.contextmanager
def _whole_file(path: Path):
    """A scratch file that takes the name `path` only once it is complete."""
    handle, scratch = tempfile.mkstemp(dir=path.parent, suffix=path.suffix)
    os.close(handle)
    try:
        yield Path(scratch)
        os.chmod(scratch, 0o644)
        os.replace(scratch, path)
    finally:
        Path(scratch).unlink(missing_ok=True)


def _table(result: dict, reasons: dict[str, str]) -> str:
    """The summary for a reader."""
    rows: list[tuple[str, str, Callable[[float], str]]] = [
        ("max_distance_m", "max distance", lambda v: f"{v * 1e3:.2f} mm"),
        ("max_distance_while_held_m", "max distance while held", lambda v: f"{v * 1e3:.2f} mm"),
        ("rms_distance_m", "rms distance", lambda v: f"{v * 1e3:.3f} mm"),
        ("final_speed_rad_s", "final speed", lambda v: f"{v + 0.0:.3f} rad/s"),
        ("max_torque_Nm", "max torque", lambda v: f"{v:.3f} N m"),
        ("diverged_at_s", "diverged at", lambda v: f"{v:.3f} s"),
    ]
    lines = [result["experiment"]]
    for controller, values in result["controllers"].items():
        lines.append(f"  {controller.replace('_', ' ')}")
        for key, title, show in rows:
            if values[key] is not None:
                lines.append(f"    {title:26s} {show(values[key])}")
        if reasons[controller]:
            lines.append(f"    {reasons[controller]}")
    return "\n".join(lines)


if __name__ == "__main__":
    main()
