"""What belongs to one robot of a lab, whether it is in use or not."""

from __future__ import annotations

from typing import NamedTuple

from onpath.app.lab.path_editor import PathEditor
from onpath.models.closed_loop.obstacles import Wall
from onpath.models.closed_loop.start import ON_PATH, Start
from onpath.models.systems.parameters import Parameters


class RobotSettings(NamedTuple):
    """The settings that a robot keeps while another one is used; see `app.lab.simulation`."""

    parameters: Parameters
    editor: PathEditor | None = None
    start: Start = ON_PATH
    wall: Wall | None = None
