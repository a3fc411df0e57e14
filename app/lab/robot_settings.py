"""What belongs to one robot of a lab, whether it is in use or not."""

from __future__ import annotations

from typing import NamedTuple

from onpath.app.lab.path_editor import PathEditor
from onpath.models.closed_loop.lab_settings import LabSettings
from onpath.models.systems.parameters import Parameters


class RobotSettings(NamedTuple):
    """The settings that a robot keeps while another one is used; see `app.lab.simulation`.

    Attributes:
        own: the lab's own settings; only those that each robot has for itself count.
    """

    parameters: Parameters
    editor: PathEditor | None = None
    own: LabSettings = LabSettings()
