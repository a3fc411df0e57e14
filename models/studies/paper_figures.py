"""The paper's figures 2, 3, 5, 6 and 7 as experiments with the paper's settings.

Settings in the paper's text are used as given; those that it does not give (starts, most gains, the
time of the obstruction, the beam) are illustrative and listed as such.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from onpath.models.closed_loop.trajectory import Trajectory
from onpath.models.studies.experiments import Experiment, experiments, run, summary

FOLLOWING, SET_POINT = "path_following", "set_point"


@dataclass(frozen=True, slots=True)
class PaperFigure:
    """One of the paper's figures.

    Attributes:
        number: its number in the paper.
        title: a description.
        experiment: name of the experiment.
        values: settings that differ from the experiment's defaults.
        laws: the paper's law, and perhaps others for comparison, without an integral.
        given: the settings in the paper's text.
        illustrative: the other settings, with the values used.
    """

    number: int
    title: str
    experiment: str
    values: Mapping[str, Any]
    laws: tuple[str, ...]
    given: tuple[str, ...]
    illustrative: tuple[str, ...]

    def planned(self) -> Experiment:
        """The experiment with the figure's settings."""
        return experiments()[self.experiment].with_values(self.values)

    def runs(self) -> list[Trajectory]:
        """The runs of the figure, one per law."""
        first, *others = self.laws
        without_integral = self.planned().with_values({"K3": 0.0})
        return [run(self.planned(), first), *(run(without_integral, law) for law in others)]


_RIGID = {"across": "level_set", "K3": 1000.0}
_GAINS = "gains K1 400 1/s², K2 40 1/s, K3 1000 1/s³"
_CIRCLE = "circle of radius 0.05 m about the origin, s(y) = y1² + y2² - r² (15)"
_TO_A_PLACE = (_CIRCLE, "experiment 1: η₂¹ref = π/2, PID (18) with positive gains, (19)")
_START = (
    f"{_GAINS}, K4 25 1/s², K5 10 1/s",
    "start at rest, at 0.6 r in the direction -60°",
    "the robot's parameters",
)
_FLEXIBLE: dict[str, Any] = {
    "experiment": "flexible",
    "values": {"plant": "unit_modes", "alpha": 1.0, "across": "level_set", "K3": 1000.0},
    "laws": (FOLLOWING,),
    "given": (
        "r = 0.05 m, b = 0.1, d = 0.5 m in (23); the output is the tip itself (22)",
        "v = -5 (η₂² - η₂²ref) along, η₂²ref = 2 rad/s for t < 3 s, then -2 rad/s; PID across",
    ),
    "illustrative": (
        _GAINS,
        "the ellipse lies about y3 = 0 instead of ℓ1: another origin of y3",
        "the beam, with 3 modes, read with ∫φ² = 1 (plant unit_modes, see README)",
        "start at rest with the joints at home, off the path",
    ),
}
_ALL = (
    PaperFigure(
        2,
        "End-point in output space, stabilizing a position on the circle",
        experiment="position",
        values=_RIGID,
        laws=(FOLLOWING, SET_POINT),
        given=_TO_A_PLACE,
        illustrative=(*_START, "beside it: set-point regulation with the same K1 and K2, no K3"),
    ),
    PaperFigure(
        3,
        "Transformed states and torques, stabilizing a position on the circle",
        experiment="position",
        values=_RIGID,
        laws=(FOLLOWING,),
        given=_TO_A_PLACE,
        illustrative=_START,
    ),
    PaperFigure(
        5,
        "Transformed states and torques, with the output temporarily obstructed",
        experiment="obstruction",
        values=_RIGID,
        laws=(FOLLOWING,),
        given=(
            _CIRCLE,
            "experiment 2: η₂²ref = 2π rad/s, PID (18) with positive gains, (19)",
            "the end-point is held along the tangent and free in any other direction",
        ),
        illustrative=(
            f"{_GAINS}, K5 10 1/s",
            "held from 3 to 5 s, by a spring of 2 N/mm with a damper and at most 30 N",
            "start at rest on the circle",
            "the robot's parameters",
        ),
    ),
    PaperFigure(6, "Tip in output space, tracking a speed profile", **_FLEXIBLE),
    PaperFigure(7, "Transversal and tangential states, tracking a speed profile", **_FLEXIBLE),
)
FIGURES: Mapping[int, PaperFigure] = {figure.number: figure for figure in _ALL}
"""The figures that show results, by number; 1 and 4 are drawings of the robots."""


def figure_summary(figure: PaperFigure, runs: list[Trajectory]) -> dict[str, Any]:
    """The content of `--json`: what is shown, with which settings, and the numbers of the runs."""
    found = summary(figure.planned(), runs)
    return {
        "figure": figure.number,
        "title": figure.title,
        "experiment": figure.experiment,
        "settings": dict(figure.values),
        "given": list(figure.given),
        "illustrative": list(figure.illustrative),
        "laws": found["laws"],
    }
