"""The two benches of a lab. A bench is a robot under a control law.

Both have the same robot, parameters and path.
"""

from __future__ import annotations

from collections.abc import Mapping

from onpath.models.control.laws.registry import NAMES, law_name, law_named
from onpath.models.errors import CodedError
from onpath.models.systems.parameter_specs import unknown_name
from onpath.models.systems.robots import RobotEntry

LEFT, RIGHT = "left", "right"
BENCHES = (LEFT, RIGHT)
"""Names of the benches, as they stand in the scene."""
DEFAULT_LAWS: dict[str, str] = dict(zip(BENCHES, NAMES, strict=True))
"""Bench -> control law of a new lab."""


def checked_laws(laws: Mapping[str, str], robot: RobotEntry) -> dict[str, str]:
    """Check the names of benches and of their control laws; a typed law is put on one line.

    Raises:
        ValueError: there is no such bench or law, a typed law cannot be read, or a law does not
            suit the robot.
    """
    for bench, name in laws.items():
        if bench not in BENCHES:
            raise unknown_name(bench, list(BENCHES), "bench")
        law = law_named(name)
        if not law.suits(robot.make(robot.parameters()).system):
            raise CodedError("error.law_does_not_suit", law=law.label)
    return {bench: law_name(name) for bench, name in laws.items()}
