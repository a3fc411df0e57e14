"""A comparison of laws for the page: one law at a time."""

from __future__ import annotations

from onpath.models.paths.curves import Curve
from onpath.models.studies.comparison import Contest, Outcome, compare
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import Parameters


def outcomes_of(
    robot: str, parameters: Parameters, curve: Curve, law: str, obstruction: str
) -> list[Outcome]:
    """The outcomes of one law under one obstruction, at all places."""
    (found,) = compare(Contest(ROBOTS[robot], parameters, curve), [law], [obstruction])
    return found
