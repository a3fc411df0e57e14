"""`onpath figure`: a page with one or two robots that needs no server."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro

from onpath.app.cli.assignments import assignments
from onpath.app.cli.options import Repeated
from onpath.app.cli.paper import NAMES
from onpath.app.cli.robot_options import NO_OPTIONS, FileOptions
from onpath.app.common.atomic_file import check_file


@dataclass(frozen=True)
class FigureCommand:
    """Write a live figure: a page with one or two robots to hold back, pull, pause and reset."""

    file: Annotated[Path, tyro.conf.Positional]
    """The .html file to write."""
    robot: str = "five_bar"
    """Name of the robot, or its URDF or MJCF file."""
    path: Repeated = ()
    """A path, such as circle or "ellipse 0.07 0.04", or @FILE with options, as for onpath
    experiment. Repeat, or put commas between, for more to choose from."""
    law: Repeated = ()
    """A control law: a name; both; one of your own, as "across = …; along = …", or my_law.py:Name.
    Give it twice for two robots. By default both: tracking beside path following."""
    slider: Repeated = ()
    """A setting that readers may change; repeat for more. By default the speed and gains."""
    control: Repeated = ()
    """What else they may do or see: hold, pull, drag (points of the path), run, step, reset, path,
    plot, poles; repeat for more. By default all that are possible."""
    choice: Repeated = ()
    """A further law, which readers may choose for each robot; repeat for more."""
    set: Repeated = ()
    """Set any parameter of the robot as name=value; repeat for more. Without speed and ramp, the
    robots move as slowly as in a new lab: speed=2, ramp=4."""
    title: str = ""
    """Title above the figure."""
    language: str = "en"
    """Language of the page."""
    log: Path | None = None
    """Draw the log of a real arm over the plots; a file as for onpath identify."""
    column: Repeated = ()
    """A column of the log, as for identify; repeat for more."""
    unit: Repeated = ()
    """Unit of a column of the log, as for identify; repeat for more."""
    file_options: FileOptions = NO_OPTIONS

    def run(self) -> None:
        """Write the page, and print its size."""
        if str(self.file) in NAMES:
            raise ValueError(f"the paper's figures are drawn by onpath paper {self.file}")
        check_file(self.file, (".html",), "figure")

        from onpath.app.cli.laws import laws_named
        from onpath.app.notebook.arguments import curve_of, path_name
        from onpath.app.notebook.figure import PATHS, figure
        from onpath.models.control.settable import value_of, with_values

        given = assignments(self.set)
        entry = self.file_options.entry_of(self.robot)
        parameters = with_values(entry.parameters(), given)
        robot = entry.make(parameters)
        settings = {name: value_of(parameters, name) for name in given}
        laws = laws_named(self.law or ("both",), (), calls=False)
        paths = {path_name(each): curve_of("--path", each, robot) for each in self.path}
        made = figure(
            entry,
            paths or PATHS,
            laws,
            sliders=self.slider or None,
            controls=self.control or None,
            choices=laws_named(self.choice, (), calls=False),
            title=self.title,
            language=self.language,
            log=self.log,
            columns=assignments(self.column, "--column"),
            units=assignments(self.unit, "--unit"),
            **settings,
        )
        file = made.save(self.file)
        print(f"{file}: {file.stat().st_size / 1e3:.0f} kB, needs no server")
