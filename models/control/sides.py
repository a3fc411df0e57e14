"""The two sides of a lab. A side is a robot under a control law.

Both have the same robot, parameters and path.
"""

from __future__ import annotations

from collections.abc import Mapping

from onpath.models.control.laws.registry import NAMES, law_name, law_named
from onpath.models.errors import CodedError
from onpath.models.systems.parameter_specs import unknown_name
from onpath.models.systems.robots import RobotEntry

LEFT, RIGHT = "left", "right"
SIDES = (LEFT, RIGHT)
"""Names of the sides, as they stand in the scene."""
DEFAULT_LAWS: dict[str, str] = dict(zip(SIDES, NAMES, strict=True))
"""Side -> control law of a new lab."""


def checked_laws(laws: Mapping[str, str], robot: RobotEntry) -> dict[str, str]:
    """Check the names of sides and of their control laws; a typed law is put on one line.

    Raises:
        ValueError: there is no such side or law, a typed law cannot be read, or a law does not
            suit the robot.
    """
    for side, name in laws.items():
        if side not in SIDES:
            raise unknown_name(side, list(SIDES), "side")
        law = law_named(name)
        if not law.suits(robot.make(robot.parameters()).system):
            raise CodedError("error.law_does_not_suit", law=law.label)
    return {side: law_name(name) for side, name in laws.items()}
