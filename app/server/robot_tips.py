"""Robots of the server's own files with another tip, built when somebody chooses it."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from typing_extensions import override

from onpath.app.common.newcomer import NEWCOMER
from onpath.app.common.presses import Presses
from onpath.app.common.robot_files import (
    GivenFile,
    ReadFile,
    add_read,
    built_with,
    given_file,
    read_file,
)
from onpath.app.exports.export_process import ExportError, ExportProcess
from onpath.app.lab.commands import ChooseRobot
from onpath.app.lab.lab import Command, Lab
from onpath.app.lab.robot_settings import RobotSettings
from onpath.app.server.robot_shapes import prepare_shapes
from onpath.app.simulation.simulation_thread import SimulationThread
from onpath.models.control.settable import with_values
from onpath.models.errors import CodedError, Message
from onpath.models.robot_files.xml_elements import shown
from onpath.models.systems.catalogue import robot_named

LONGEST = 60.0  # [s] that reading a file may take
Post = Callable[[Command], None]


class RobotTips:
    """The tips suggested by the files with which the server was started.

    A robot is built once, one at a time, and is the same for all labs of the server.

    Args:
        thread: adds robots to the catalogue, between two frames.
    """

    def __init__(self, thread: SimulationThread) -> None:
        self._thread, self._one_at_a_time = thread, threading.Lock()

    def choose(self, robot: str, tip: str, post: Post) -> None:
        """Give a lab the robot with another tip; if it fails, the lab keeps its own and is told.

        Args:
            robot: a robot of the file.
            post: of the lab.

        Raises:
            CodedError: no file suggests this tip.
        """
        given = given_file(robot)
        if given is None or tip not in given.tips:
            raise CodedError("robots.no_such_tip")
        wanted = given.with_tip(tip)

        def tell(message: Message) -> None:
            post(Remark(message))

        name = built_with(wanted)
        if not name:
            if self._one_at_a_time.locked():
                tell(Message("robots.waiting"))
            with self._one_at_a_time:
                name = built_with(wanted) or self._built(wanted, tell)
        if name:
            post(_ChooseBuilt(name))

    def _built(self, wanted: GivenFile, tell: Callable[[Message], None]) -> str:
        """Build a robot; returns its name, or "" if it has been told why it is not possible."""
        file, tip = shown(wanted.file.name), shown(wanted.tip)
        tell(Message("robots.reading", {"file": file, "tip": tip}))
        process = ExportProcess()
        try:
            found = process.call(LONGEST, _read, wanted)
        except ExportError as error:
            found = Message("robots.not_read", {"reason": str(error).splitlines()[-1][:200]})
        finally:
            process.stop()
        if isinstance(found, Message):
            tell(Message("robots.not_built", {"file": file, "tip": tip, "reason": found}))
            return ""
        tell(Message("robots.shapes", {"tip": tip}))
        prepare_shapes(found.source.chain)
        return self._thread.call(partial(add_read, found)).name


def _read(given: GivenFile) -> ReadFile | Message:
    """What a process reads: the robot, or why there is none."""
    try:
        return read_file(given.file, given.options)
    except CodedError as error:
        return error.message


@dataclass(frozen=True, slots=True)
class TipPressed(Command):
    """Choose the tip that was pressed in the picture, as one press of its tab.

    Attributes:
        choose: see `PageContext.choose_tip`.
    """

    robot: str
    tip: str
    choose: Callable[[str, str], None]
    presses: Presses

    @override
    def apply(self, lab: Lab) -> None:
        def act() -> None:
            try:
                self.choose(self.robot, self.tip)
            except CodedError as error:
                lab.post(Remark(error.message))

        if not self.presses.run(act):
            Remark(Message("error.hurry")).apply(lab)


@dataclass(frozen=True, slots=True)
class Remark(Command):
    """Show how far the building of a robot is, or why there is none."""

    text: Message | str

    @override
    def apply(self, lab: Lab) -> None:
        text = self.text
        lab.remark(text if isinstance(text, str) else lab.words.sentence(text))


@dataclass(frozen=True, slots=True)
class _ChooseBuilt(Command):
    """Choose a robot that was built after the lab was opened; it starts slowly, as others do."""

    name: str

    @override
    def apply(self, lab: Lab) -> None:
        entry, simulation = robot_named(self.name), lab.simulation
        if entry is not simulation.entry:
            slow = with_values(entry.parameters(), NEWCOMER)
            simulation.earlier.setdefault(self.name, RobotSettings(slow))
        ChooseRobot(self.name).apply(lab)
