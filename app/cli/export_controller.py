"""`onpath export controller`: a control law as C, for a robot that is elsewhere."""

from __future__ import annotations

import shlex
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

import tyro

from onpath.app.cli.assignments import assignments
from onpath.app.cli.options import Repeated
from onpath.app.cli.robot_options import NO_OPTIONS, FileOptions
from onpath.app.common.atomic_file import check_file


@dataclass(frozen=True)
class ExportController:
    """Write a control law as C99: from measurements to torques, as in the lab, bit by bit."""

    file: Annotated[Path, tyro.conf.Positional]
    """The .c file to write. Beside it stand NAME.h, which tells how to use it, and NAME_replay.c,
    which replays runs of the lab and compares the torques."""
    robot: str = "five_bar"
    """Name of the robot, or its URDF or MJCF file."""
    path: Repeated = ()
    """A path, such as circle or "ellipse 0.07 0.04", or @FILE with options, as for onpath
    experiment. Repeat for more that can be followed in turn. By default the circle."""
    law: str = "path_following"
    """A control law: a name; or one of your own, as "across = …; along = …", or in CasADi,
    my_law.py:Name. A law that is a Python function is refused."""
    at_fault: Literal["zero", "hold", "damp"] = "zero"
    """Torque after a measurement has been refused: none, the last one, or against the
    velocities."""
    fastest: float = 100.0
    """Largest rate of a joint, above which a measurement is refused, in rad/s, or m/s of one that
    slides."""
    set: Repeated = ()
    """Set any parameter of the robot as name=value; repeat for more."""
    file_options: FileOptions = NO_OPTIONS

    def run(self) -> None:
        """Write the files, and print what they are."""
        check_file(self.file, (".c",), "export controller")

        from onpath.app.notebook.arguments import curve_of, path_name
        from onpath.app.notebook.controller import controller
        from onpath.models.control.settable import value_of, with_values

        given = assignments(self.set)
        entry = self.file_options.entry_of(self.robot)
        parameters = with_values(entry.parameters(), given)
        robot = entry.make(parameters)
        settings = {name: value_of(parameters, name) for name in given}
        named = {path_name(each): each for each in self.path or ("circle",)}
        paths = {name: curve_of("--path", each, robot) for name, each in named.items()}
        made = controller(
            entry, paths, self.law, at_fault=self.at_fault, fastest=self.fastest, **settings
        )
        target = made.save(self.file)
        print(f"{target}: {made.operations:,} operations in a tick")
        replay = target.with_name(f"{target.stem}_replay.c")
        files = shlex.join([str(target), str(replay)])
        print(f"compare it with the lab: cc -std=c99 -O2 {files} -lm && ./a.out")
        if parameters.torque_limit == 0:
            print("onpath: its torques have no limit: --set torque_limit=...", file=sys.stderr)
