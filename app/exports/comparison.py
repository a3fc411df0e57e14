"""A comparison of laws for the page: one law at a time, with a picture of all results so far."""

from __future__ import annotations

import io

from onpath.lessons.words import Words
from onpath.models.paths.curves import Curve
from onpath.models.studies.comparison import Contest, Outcome, compare
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import Parameters

Results = dict[tuple[str, str], list[Outcome]]


def outcomes_of(
    robot: str, parameters: Parameters, curve: Curve, law: str, obstruction: str
) -> list[Outcome]:
    """The outcomes of one law under one obstruction, at all places; see `compared`."""
    (found,) = compare(Contest(ROBOTS[robot], parameters, curve), [law], [obstruction])
    return found


def compared(
    robot: str,
    parameters: Parameters,
    curve: Curve,
    earlier: Results,
    law: str,
    obstruction: str,
    language: str,
) -> tuple[Results, bytes]:
    """The results with one law added, and their picture as PNG.

    Args:
        robot: name in the catalogue.
        curve: the path, closed.
        earlier: results of the laws compared so far.
        law: a law that suits the robot.
    """
    from onpath.app.exports.figures_comparison import comparison_figure

    contest = Contest(ROBOTS[robot], parameters, curve)
    (found,) = compare(contest, [law], [obstruction])
    results = {**earlier, (law, obstruction): found}
    file = io.BytesIO()
    comparison_figure(results, Words(language)).savefig(file, format="png", dpi=60)
    return results, file.getvalue()
