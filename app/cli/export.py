"""`onpath export`: pages that need no server."""

from __future__ import annotations

import sys
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro

from onpath.app.cli.assignments import assignments
from onpath.app.cli.export_lesson import ExportLesson
from onpath.app.cli.export_site import ExportSite
from onpath.app.cli.path_option import path_name, read_path
from onpath.app.cli.robot_options import NO_OPTIONS, FileOptions


@dataclass(frozen=True)
class ExportFigure:
    """Write one or two robots that can be held back, pulled, paused and reset, as one page."""

    file: Annotated[Path, tyro.conf.Positional]
    """The .html file to write."""
    robot: str = "five_bar"
    """Name of the robot, or its URDF or MJCF file."""
    file_options: FileOptions = NO_OPTIONS
    law: Annotated[tuple[str, ...], tyro.conf.UseAppendAction] = ()
    """A control law, also my_law.py:Name; give it twice for two robots. By default tracking beside
    path following."""
    path: Annotated[tuple[str, ...], tyro.conf.UseAppendAction] = ()
    """A path, such as circle or "ellipse 0.07 0.04", or @FILE with options, as for onpath
    experiment; repeat for more to choose from."""
    slider: Annotated[tuple[str, ...], tyro.conf.UseAppendAction] = ()
    """A parameter that readers may change; repeat for more. By default the speed and gains."""
    control: Annotated[tuple[str, ...], tyro.conf.UseAppendAction] = ()
    """What else they may do or see: hold, pull, drag (points of the path), run, step, reset, path,
    plot, poles; repeat for more. By default all that are possible."""
    choice: Annotated[tuple[str, ...], tyro.conf.UseAppendAction] = ()
    """A further law, which readers may choose for each robot; repeat for more."""
    set: Annotated[tuple[str, ...], tyro.conf.UseAppendAction] = ()
    """Set any parameter of the robot as name=value; repeat for more. Without speed and ramp, the
    robots move as slowly as in a new lab: speed=2, ramp=4."""
    title: str = ""
    """Title above the figure."""
    language: str = "en"
    """Language of the page."""

    def run(self) -> None:
        """Write the page, and print its size."""
        from onpath.app.notebook.figure import PATHS, figure
        from onpath.models.control.settable import with_values
        from onpath.models.control.sides import DEFAULT_LAWS

        given = assignments(self.set)
        entry = self.file_options.entry_of(self.robot)
        robot = entry.make(with_values(entry.parameters(), given))
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", UserWarning)
            written = figure(
                self.file,
                robot=entry,
                laws=self.law or tuple(DEFAULT_LAWS.values()),
                paths={path_name(each): read_path(each, robot) for each in self.path} or PATHS,
                sliders=self.slider or None,
                controls=self.control or None,
                choices=self.choice,
                title=self.title,
                language=self.language,
                **given,
            )
        for each in caught:
            print(f"onpath: {each.message}", file=sys.stderr)
        print(f"{written}: {written.stat().st_size / 1e3:.0f} kB, needs no server")


ExportAction = (
    Annotated[ExportFigure, tyro.conf.subcommand("figure")]
    | Annotated[ExportSite, tyro.conf.subcommand("site")]
    | Annotated[ExportLesson, tyro.conf.subcommand("lesson")]
)


@dataclass(frozen=True)
class ExportCommand:
    """Write pages that need no server: they open from a folder, a web server or an iframe."""

    do: Annotated[ExportAction, tyro.conf.arg(name="")]

    def run(self) -> None:
        """Run the chosen action."""
        self.do.run()
