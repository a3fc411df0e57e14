"""The work of an arena's processes: simulating, and making figures."""

from __future__ import annotations

from dataclasses import dataclass

from onpath.app.exports.standalone.figure_choice import chosen
from onpath.app.exports.standalone.figure_page import figure_page
from onpath.lessons.words import Words
from onpath.models.studies.arena import Result, Row, Trial, paths_of, result_of
from onpath.models.studies.path_text import curve_from_text
from onpath.models.systems.catalogue import ROBOTS

Entry = tuple[Row, Trial]
"""A row of the table, and what happens to it."""


@dataclass(frozen=True, slots=True)
class FigureJob:
    """A figure of a law, at the torque limit of a trial."""

    law: str
    trial: Trial
    language: str


def simulated(entry: Entry) -> Result:
    """The result of a row in a trial."""
    return result_of(*entry)


def lost(entry: Entry) -> Result:
    """The result if the process has died: the run is stopped."""
    (law, remedy), trial = entry
    return Result(law, remedy, trial, stopped_at_s=0.0, reason="the process that ran it has died")


def figure_of(job: FigureJob) -> str:
    """The page of a figure: the robot of a trial under a law, on each of its paths."""
    values = {"torque_limit": job.trial.values["torque_limit"]}
    radius = ROBOTS[job.trial.robot].radius
    figure = chosen(
        job.trial.robot,
        laws=[job.law],
        paths={name: curve_from_text(name, radius) for name in paths_of(job.trial.robot)},
        values=values,
    )
    return figure_page(figure, Words(job.language))
