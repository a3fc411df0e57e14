"""The results of an arena: a page, the rows of a CSV file, and tables in Markdown."""

from __future__ import annotations

import math
import re
import shlex
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain

import numpy as np

from onpath.app.common.own_laws import as_given, only_here
from onpath.app.common.robot_files import robot_arguments
from onpath.app.common.templates import render
from onpath.lessons.labels import parameter_label, parameter_unit, path_label, robot_label
from onpath.lessons.sides import law_text, law_titles
from onpath.lessons.words import Words
from onpath.models.arrays import Array
from onpath.models.control.laws.own import is_text
from onpath.models.control.laws.registry import SHARED_GAINS, law_named
from onpath.models.control.settable import specs
from onpath.models.errors import Message
from onpath.models.studies.arena import (
    LARGER_IS_BETTER,
    MEASURES,
    OFF,
    Cell,
    Result,
    Row,
    Trial,
    stopped,
    table,
)
from onpath.models.studies.path_text import curve_from_text
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.guessed_numbers import (
    guessed_kinds,
    quantities_of,
    told_guesses,
    with_mark,
)
from onpath.models.systems.parameter_specs import Spec

SHOWN: dict[str, tuple[float, str, int]] = {
    "force_N": (1.0, "N", 2),
    "distance_m": (1e3, "mm", 2),
    "delay_s": (1.0, "s", 2),
    "energy_J": (1e3, "mJ", 1),
    "overshoot_m": (1e3, "mm", 2),
}
"""Measure -> factor, unit and decimals with which it is shown."""
BETTER = {name: "larger" for name in LARGER_IS_BETTER} | {"delay_s": "near_zero"}
"""What is better, if it is not a smaller value."""
MEASURE = "max_distance"
"""Any measure of the table: all rest on the same guesses."""
NO_BREAK = "\N{NO-BREAK SPACE}"
WIDTH, HEIGHT, MARGIN = 460, 150, 4  # of the picture over time
SIDE = 150  # of the picture of the plane


@dataclass(frozen=True, slots=True)
class Contents:
    """What a page shows.

    Attributes:
        rows: by robot.
        results: by robot, of the same trials for all rows.
        command: which made the page.
        figures: (robot, law) -> address of its figure, if there is one.
        planned: number of trials that were planned.
    """

    rows: Mapping[str, Sequence[Row]]
    results: Mapping[str, Sequence[Result]]
    command: str
    figures: Mapping[tuple[str, str], str]
    planned: int


def arena_page(contents: Contents, words: Words) -> str:
    """The page, with every run that is behind one of its numbers."""
    titles = law_titles([law for rows in contents.rows.values() for law, _ in rows], words)
    robots, runs = list[dict[str, object]](), list[dict[str, object]]()
    trials = dict[int, Trial]()
    for robot, results in contents.results.items():
        marks, tried = dict[int, str](), {each.trial.number: each.trial for each in results}
        robots.append(
            {
                "label": _marked_label(robot, words),
                "settings": _settings(robot, words),
                "guesses": told_guesses(ROBOTS[robot].guesses, words.language),
                "lines": _lines(robot, contents, titles, marks, words),
                "trials": len(tried),
            }
        )
        runs += [
            _run(results[i], mark, titles, contents, words) for i, mark in sorted(marks.items())
        ]
        trials |= tried
    return render(
        "arena/page.html",
        words=words,
        measures=[
            {
                "title": f"{words(f'arena.{name}')}  [{SHOWN[name][1]}]",
                "better": words(f"arena.better_{BETTER.get(name, 'smaller')}"),
                "text": words(f"arena.{name}_text"),
            }
            for name in MEASURES
        ],
        robots=robots,
        runs=runs,
        laws=[
            {
                "label": titles[law],
                "text": law_text(law, words),
                "source": law_named(law).source,
                "gains": ", ".join(
                    _setting(gain.name, gain.spec, gain.default, words)
                    for gain in law_named(law).own_gains
                ),
            }
            for law in titles
        ],
        trials=[described(trial, words) for trial in trials.values()],
        done=len(trials),
        planned=contents.planned,
        command=contents.command,
    )


def _marked_label(robot: str, words: Words) -> str:
    """A robot's label, with a mark if the numbers of its table rest on guesses."""
    label, guesses = robot_label(robot, words), ROBOTS[robot].guesses
    return with_mark(label, guesses, MEASURE, words.language)


def _limit(row: Row) -> str:
    return {None: "torques", False: "cut", True: "remedy"}[row[1]]


def _lines(
    robot: str,
    contents: Contents,
    titles: Mapping[str, str],
    marks: dict[int, str],
    words: Words,
) -> list[dict[str, object]]:
    """The rows of a robot's table, whose runs are marked to be shown."""
    results, lines = contents.results[robot], list[dict[str, object]]()
    for row, cells in table(contents.rows[robot], results).items():
        own = {i: each for i, each in enumerate(results) if each.row == row}
        stops = [i for i, each in own.items() if each.stopped_at_s is not None]
        lines.append(
            {
                "law": titles[row[0]],
                "own": law_named(row[0]).origin is not None or is_text(row[0]),
                "limit": words(f"arena.{_limit(row)}"),
                "cells": [_cell(robot, name, cells[name], marks, words) for name in MEASURES],
                "stops": words("arena.of", stops=len(stops), runs=len(own)),
                "links": [
                    {"mark": marks.setdefault(i, f"{robot}-{i}"), "trial": own[i].trial.number}
                    for i in stops[:3]
                ],
            }
        )
    return lines


def _cell(
    robot: str, name: str, cell: Cell, marks: dict[int, str], words: Words
) -> dict[str, object]:
    """A cell, whose run is marked to be shown."""
    if cell.worst is None or cell.of is None:
        return {"value": "–", "median": "", "rank": "", "link": ""}
    return {
        "value": _number(name, cell.worst, words),
        "median": "" if cell.median is None else _number(name, cell.median, words),
        "rank": cell.rank,
        "link": marks.setdefault(cell.of, f"{robot}-{cell.of}"),
    }


def _number(name: str, value: float, words: Words) -> str:
    """A number as it is shown; infinity in words."""
    if math.isinf(value):
        return words("arena.never" if name in LARGER_IS_BETTER else "arena.not_back")
    factor, _, decimals = SHOWN[name]
    return words.written(f"{round(factor * value, decimals) + 0.0:.{decimals}f}".replace("-", "−"))


def _told(name: str, value: float, words: Words) -> str:
    """A measure with its name and unit."""
    unit = "" if math.isinf(value) else f"{NO_BREAK}{SHOWN[name][1]}"
    return f"{words(f'arena.{name}')}: {_number(name, value, words)}{unit}"


def described(trial: Trial, words: Words) -> dict[str, object]:
    """What happens in a trial, in words with numbers."""
    values, points = trial.values, np.concatenate(_strokes(trial))
    sizes = np.ptp(points, axis=0)
    width, height = (f"{1e3 * size:.0f}" for size in sizes)
    shown = {name: words.number(value) for name, value in values.items()}
    begin, end = (words.number(time) for time in _acting(trial))
    if trial.obstruction == "hand":
        place = np.array([values["push_z1"], values["push_z2"]])
        shown["away"] = f"{1e3 * np.linalg.norm(points - place, axis=1).min():.0f}"
    limit = specs(ROBOTS[trial.robot].parameters)["torque_limit"]
    unit = parameter_unit("torque_limit", limit, words).replace(" ", NO_BREAK)
    path = path_label(trial.path, words)
    return {
        "number": trial.number,
        "robot": robot_label(trial.robot, words),
        "path": words("arena.sized", path=path, width=width, height=height),
        "obstruction": words(f"arena.{trial.obstruction}", begin=begin, end=end, **shown),
        "condition": words(f"arena.{trial.condition}", **shown),
        "torque_limit": f"{words.number(values['torque_limit'], 3)}{NO_BREAK}{unit}",
    }


def _strokes(trial: Trial) -> list[Array]:
    """Points of the path's lines in its plane, (n, 2) each, [m]."""
    return curve_from_text(trial.path, ROBOTS[trial.robot].radius).strokes()


def _acting(trial: Trial) -> tuple[float, float]:
    """The interval in which an obstruction acts, [s]; (0, 0) for weak motors."""
    values = trial.values
    name = {"pull": "pull", "brake": "hold", "hand": "push", "wall": "wall"}.get(trial.obstruction)
    return (values[f"{name}_from"], values[f"{name}_to"]) if name else (0.0, 0.0)


def _settings(robot: str, words: Words) -> str:
    """The settings that all laws have."""
    parameters = ROBOTS[robot].parameters()
    known = specs(parameters)
    gains = [_setting(n, known[n], getattr(parameters, n), words) for n in SHARED_GAINS]
    return words(
        "arena.settings",
        speed=words.number(parameters.speed),
        lap=words.number(2 * np.pi / abs(parameters.speed), 3),
        rate=f"{parameters.control_rate:g}",
        gains=", ".join(gains),
    )


def _setting(name: str, spec: Spec, value: float, words: Words) -> str:
    """A setting with its value and unit."""
    unit = parameter_unit(name, spec, words)
    told = f"{parameter_label(name, spec, words)} = {words.number(value)}"
    return f"{told}{NO_BREAK}{unit}" if unit else told


def command_of(result: Result) -> str:
    """The command that repeats a run; "" if its law is only known in this process."""
    trial = result.trial
    if only_here(result.law):
        return ""
    given = ["onpath", "experiment", "obstruction", *robot_arguments(trial.robot)]
    given += ["--path", trial.path, "--law", as_given(result.law)]
    for name, value in trial.settings(bool(result.remedy)).items():
        given += ["--set", f"{name}={value}"]
    return shlex.join(given)


def _run(
    result: Result, mark: str, titles: Mapping[str, str], contents: Contents, words: Words
) -> dict[str, object]:
    """What a page shows of a run."""
    trial, told = result.trial, result.reason
    given = {name: getattr(result, name) for name in MEASURES}
    values = [_told(name, value, words) for name, value in given.items() if value is not None]
    if result.stopped_at_s is not None:
        reason = told.text(words.language) if isinstance(told, Message) else told
        values = [words("arena.stopped", time=f"{result.stopped_at_s:.3f}", reason=reason)]
    return {
        "mark": mark,
        "law": titles[result.law],
        "limit": words(f"arena.{_limit(result.row)}"),
        **described(trial, words),
        "values": values,
        "command": command_of(result),
        "figure": contents.figures.get((trial.robot, result.law), ""),
        "recorded": law_named(result.law).called is not None,
        **_pictures(result, words),
    }


def _pictures(result: Result, words: Words) -> dict[str, object]:
    """Coordinates of the pictures of a run: the distance over time, and the path in its plane."""
    trial, shown = result.trial, result.shown
    lasts = trial.values["duration"]
    most = max(1.5 * OFF, float(shown[:, 1].max()) if len(shown) else 0.0)
    t = shown[:, 0] / lasts * WIDTH
    d = HEIGHT - MARGIN - shown[:, 1] / most * (HEIGHT - 2 * MARGIN)
    strokes = _strokes(trial)
    both = np.concatenate([*strokes, shown[:, 2:]])
    low, size = both.min(0), float(np.ptp(both, axis=0).max()) or 1.0
    scale = (SIDE - 2 * MARGIN) / size

    def placed(points: np.ndarray) -> str:
        moved = MARGIN + (points - low) * scale
        return _points(moved[:, 0], SIDE - moved[:, 1])

    begin, end = _acting(trial)
    z = MARGIN + (shown[:, 2:] - low) * scale
    return {
        "width": WIDTH,
        "height": HEIGHT,
        "side": SIDE,
        "distance": _points(t, d),
        "off": f"{HEIGHT - MARGIN - OFF / most * (HEIGHT - 2 * MARGIN):.1f}",
        "seconds": f"{lasts:g}",
        "scale": words(
            "arena.scale", lasts=words.number(lasts, 3), most=words.number(1e3 * most, 3)
        ),
        "begin": f"{begin / lasts * WIDTH:.1f}",
        "span": f"{(end - begin) / lasts * WIDTH:.1f}",
        "strokes": [placed(points) for points in strokes],
        "way": placed(shown[:, 2:]) if len(shown) else "",
        "xs": ";".join(f"{x:.1f}" for x in z[:, 0]),
        "ys": ";".join(f"{SIDE - y:.1f}" for y in z[:, 1]),
    }


def _points(x: np.ndarray, y: np.ndarray) -> str:
    return " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y, strict=True))


def run_rows(contents: Contents) -> Iterator[dict[str, object]]:
    """A row for each run: its trial, measures in SI units and stop; None where there is none."""
    for each in chain.from_iterable(contents.results.values()):
        trial = each.trial
        yield {
            "trial": trial.number,
            "robot": trial.robot,
            "guessed": " ".join(guessed_kinds(ROBOTS[trial.robot].guesses, quantities_of(MEASURE))),
            "path": trial.path,
            "obstruction": trial.obstruction,
            "condition": trial.condition,
            "law": each.law,
            "at_limit": _limit(each.row),
            **{name: getattr(each, name) for name in MEASURES},
            "stopped_at_s": each.stopped_at_s,
            "reason": str(each.reason),
            "command": command_of(each),
        }


def csv_rows(contents: Contents) -> Iterator[list[object]]:
    """The header and a row for each run; infinity is written as inf."""
    for number, row in enumerate(run_rows(contents)):
        if number == 0:
            yield list(row)
        yield [f"{each:.9g}" if isinstance(each, float) else each for each in row.values()]


def table_rows(contents: Contents) -> Iterator[dict[str, object]]:
    """A row for each robot, law and reaction at the limit: worst value, median and rank."""
    for robot, results in contents.results.items():
        for row, cells in table(contents.rows[robot], results).items():
            found: dict[str, object] = {"robot": robot, "law": row[0], "at_limit": _limit(row)}
            for name, cell in cells.items():
                found |= {
                    name: cell.worst,
                    f"{name}_median": cell.median,
                    f"{name}_rank": cell.rank,
                }
            yield {**found, "stops": stopped(row, results)}


def markdown(contents: Contents, words: Words) -> str:
    """A table for each robot: the worst value and, in parentheses, the rank."""
    blocks = list[str]()
    units = [f"{words(f'arena.{name}')} [{SHOWN[name][1]}]" for name in MEASURES]
    for robot, results in contents.results.items():
        cells = table(contents.rows[robot], results)
        lines = [[words("arena.law"), "", *units, words("arena.stops")]]
        for row in contents.rows[robot]:
            shown = [_plain(name, cells[row][name], words) for name in MEASURES]
            law = [f"`{row[0]}`", words(f"arena.{_limit(row)}")]
            lines.append([*law, *shown, str(stopped(row, results))])
        number = len({each.trial.number for each in results})
        title = f"{_plain_text(_marked_label(robot, words))}, {words('arena.trials', count=number)}"
        told = map(_plain_text, told_guesses(ROBOTS[robot].guesses, words.language))
        blocks.append("\n".join([title, "", *_aligned(lines), *(f"\n{each}" for each in told)]))
    return "\n\n".join(blocks)


def _plain_text(text: str) -> str:
    """A text with names from a file, in which nothing is a mark of Markdown."""
    return re.sub(r"([\\`*\[\]<>|&])", r"\\\1", text)


def _aligned(lines: Sequence[Sequence[str]]) -> Iterator[str]:
    """A table in Markdown whose columns are aligned in plain text, too."""
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    ruled = [lines[0], ["-" * width for width in widths], *lines[1:]]
    for line in ruled:
        cells = (cell.ljust(width) for cell, width in zip(line, widths, strict=True))
        yield f"| {' | '.join(cells)} |"


def _plain(name: str, cell: Cell, words: Words) -> str:
    return "–" if cell.worst is None else f"{_number(name, cell.worst, words)} ({cell.rank})"
