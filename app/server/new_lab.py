"""The lab that a newcomer finds."""

from __future__ import annotations

from onpath.app.lab.lab import Lab
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.session import Belongings
from onpath.lessons.course import Course
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import changed

GENTLE = {"speed": 2.0, "ramp": 4.0}
"""Along the path, [rad/s]: an end-point on the usual circle does 0.1 m/s, so that a hand can catch
it. And how it is reached, [rad/s²]: with a ramp, both robots are on the path from the beginning."""


def new_lab(store: LoopCache, course: Course) -> Lab:
    """A lab whose robots all begin slowly; lessons and files have the usual speed."""
    lab = Lab(store, course=course)
    session = lab.session
    for name, entry in ROBOTS.items():
        parameters = entry.lab
        for parameter, value in GENTLE.items():
            parameters = changed(parameters, parameter, value)
        session.earlier[name] = Belongings(parameters)
    session.set_parameters(session.earlier.pop(session.entry.name).parameters)
    return lab
