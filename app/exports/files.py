"""Exported files as bytes, made from plain data in any process."""

from __future__ import annotations

import io
from base64 import b64encode
from collections.abc import Sequence
from datetime import datetime

from onpath.app.common.templates import render
from onpath.app.exports.replay import replay
from onpath.app.lab.lesson_state import LessonState
from onpath.app.lab.segments import HistoryCopy, Segment
from onpath.app.lab.shown_log import ShownLog
from onpath.lessons.course import Course
from onpath.lessons.progress import Progress
from onpath.lessons.words import Words
from onpath.models.closed_loop.trajectory import write_csv
from onpath.models.robot_files.guesses import Guess
from onpath.models.studies.log_motion import log_trajectory
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.law_parameters import LEVEL_SET
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot

FILM = 10.0  # [s] of the lab that a film shows


def csv_file(robot: str, parameters: Parameters, history: HistoryCopy) -> bytes:
    """Every millisecond of the history as CSV.

    Args:
        robot: name in the catalogue.
    """
    entry = ROBOTS[robot]
    return csv_bytes(entry.make(parameters), history.segments(), entry.guesses)


def picture_file(
    robot: str,
    parameters: Parameters,
    history: HistoryCopy,
    language: str,
    path: str = "circle",
    log: ShownLog | None = None,
) -> bytes:
    """The plots of the history as PNG.

    Args:
        robot: name in the catalogue.
        path: name of the present path.
        log: of a real arm, drawn over them.
    """
    from onpath.app.exports.history_figure import draw_history  # only this file needs Matplotlib

    machine, segments, logged = ROBOTS[robot].make(parameters), history.segments(), None
    if log is not None:
        is_level_set = parameters.across == LEVEL_SET
        curve = segments[-1].curve
        logged = log_trajectory(log.motion, machine.frame, curve, level_set=is_level_set)
    return draw_history(replay(machine, segments), Words(language), parameters, robot, path, logged)


def film_file(
    robot: str, parameters: Parameters, history: HistoryCopy, language: str, path: str = "circle"
) -> bytes:
    """A standalone page with the scene of the last seconds, and their plots in a fold.

    Args:
        robot, path: see `picture_file`.
    """
    from onpath.app.exports.history_figure import draw_history
    from onpath.app.exports.recording import record_scene  # only this file needs viser

    machine, segments = ROBOTS[robot].make(parameters), last_seconds(history.segments(), FILM)
    words = Words(language)
    picture = draw_history(replay(machine, segments), words, parameters, robot, path)
    plots = render("report/film_plots.html", words=words, picture=b64encode(picture).decode())
    return record_scene(machine, segments, words) + plots.encode()  # browsers append it to the body


def lines_file(robot: str, parameters: Parameters, history: HistoryCopy, language: str) -> bytes:
    """The lines that the robots have written on the present path, as PNG.

    Args:
        robot: name in the catalogue.
    """
    from onpath.app.exports.written_lines import draw_written  # only figures need Matplotlib

    machine, segments = ROBOTS[robot].make(parameters), history.segments()
    curve = segments[-1].curve
    begin = next((i for i in range(len(segments), 0, -1) if segments[i - 1].curve is not curve), 0)
    return draw_written(replay(machine, segments[begin:]), machine.frame, curve, Words(language))


def report_file(course: Course, progress: Progress, code: str, made: datetime) -> bytes:
    """The lesson report as a page."""
    from onpath.app.exports.report import report

    return report(LessonState(course, progress), code, made)


def csv_bytes(robot: Robot, history: list[Segment], guesses: Sequence[Guess] = ()) -> bytes:
    """Every millisecond of the history as CSV, one side after the other.

    Args:
        guesses: about the robot.
    """
    file = io.StringIO()
    runs = [(side, run) for side, parts in replay(robot, history).items() for run in parts]
    trajectories, sides = [run for _, run in runs], [side for side, _ in runs]
    write_csv(file, robot, trajectories, sides, guesses)
    return file.getvalue().encode()


def last_seconds(history: list[Segment], seconds: float) -> list[Segment]:
    """The last seconds of a history."""
    end = history[-1].time
    return [s for s in history if s.time >= end - seconds]
