"""The lab of a new user."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from onpath.app.common.newcomer import NEWCOMER
from onpath.app.lab.commands.settings import SetByProcess
from onpath.app.lab.lab import Lab
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.shown_log import ShownLog
from onpath.app.lab.simulation import RobotSettings
from onpath.lessons.course import Course
from onpath.models.control.settable import with_values
from onpath.models.control.sides import RIGHT
from onpath.models.paths.path_design import PathDesign
from onpath.models.systems.catalogue import FIVE_BAR, ROBOTS, RobotEntry


def new_lab(
    loop_cache: LoopCache,
    course: Course,
    robot: RobotEntry = FIVE_BAR,
    path: PathDesign | None = None,
    law: str = "",
    settings: Mapping[str, str] = MappingProxyType({}),
    log: ShownLog | None = None,
) -> Lab:
    """A lab whose robots all start slowly; lessons and files keep the usual speed.

    Args:
        robot: the robot at first.
        path: the path at first, which this robot must be able to follow; None: the robot's circle.
        law: the law of the robot on the right at first; "": path following.
        settings: values of settings at first, by name.
        log: drawn over the plots at first; None: none.
    """
    lab = Lab(loop_cache, robot, course)
    lab.log = log
    simulation = lab.simulation
    for name, entry in tuple(ROBOTS.items()):
        simulation.earlier[name] = RobotSettings(with_values(entry.parameters(), NEWCOMER))
    simulation.set_parameters(simulation.earlier.pop(simulation.entry.name).parameters)
    if path is not None:
        simulation.editor.commit(path)
        simulation.editor.settle()
        simulation.editor.forget_edits()
        simulation.reset()
    if law:
        simulation.reset({RIGHT: law})
    for name, value in settings.items():
        lab.post(SetByProcess(name, value))
    return lab
