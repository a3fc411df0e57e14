"""`onpath.figure`: one or two robots that can be held back, as a picture and a page."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from onpath.app.common.announced import announced
from onpath.app.common.newcomer import NEWCOMER
from onpath.app.common.own_laws import compiled_law
from onpath.app.common.user_files import user_file
from onpath.app.exports.standalone.figure import ENDINGS, Figure, check_language
from onpath.app.exports.standalone.figure_choice import chosen
from onpath.app.lab.shown_log import read_shown_log
from onpath.app.notebook.arguments import curve_of, looked_up, path_name
from onpath.app.notebook.simulate import check_names, entry_named
from onpath.models.closed_loop.simulation import raised
from onpath.models.control.settable import with_values
from onpath.models.control.sides import DEFAULT_LAWS
from onpath.models.paths.curves import Curve
from onpath.models.studies.experiments import forecast_text, on_path, path_remark
from onpath.models.studies.unused import unused_text
from onpath.models.systems.robots import RobotEntry

LAWS = tuple(DEFAULT_LAWS.values())
PATHS = ("circle", "ellipse", "rounded square", "clover")
GivenPath = str | Path | Curve
OLD = {"file": "figure(...).save(file)", "laws": "law", "paths": "path"}
"""Former arguments -> what is written instead."""


def figure(
    robot: str | Path | RobotEntry = "five_bar",
    path: GivenPath | Sequence[GivenPath] | Mapping[str, GivenPath] = PATHS,
    law: Any = LAWS,
    *,
    sliders: str | Sequence[str] | None = None,
    controls: str | Sequence[str] | None = None,
    choices: Any = (),
    title: str = "",
    language: str = "en",
    log: str | Path | None = None,
    columns: Mapping[str, str | int] | None = None,
    units: Mapping[str, str | float] | None = None,
    **settings: Any,
) -> Figure:
    """One or two robots that can be held back, pulled, paused and reset.

    As the last line of a notebook's cell, the figure shows itself. `save` writes it as one file
    of about 0.3 MB, which makes no network request and opens from anywhere: a folder, a web server,
    an iframe. Its loops are those of `onpath.simulate`, as WebAssembly. Where no scripts run, it is
    a picture of a run in which the robots are held back for a second.

    Args:
        robot: as for `onpath.simulate`.
        path: a path as for `onpath.simulate`, or several to choose from, beginning with the first:
            a list of them, or a mapping from names to them.
        law: one or two laws as for `onpath.simulate`, but no functions that are called.
        sliders: names of `onpath.parameters(robot)` that readers may change; None: the speed and
            the gains of the laws.
        controls: what else readers may do or see: some of hold, pull, drag (points of the path),
            run, step, reset, path, plot, poles; None: all that are possible with this robot and
            laws.
        choices: further laws, which readers may choose for each robot.
        title: title above the figure.
        language: language of the page.
        log: what a real arm of this kind has logged, drawn over the plots from the beginning of
            each run on; of a long log, 1200 rows.
        columns, units: of the log, as for `onpath.identify`.
        settings: as in `onpath.simulate`. If neither `speed` nor `ramp` is among them, the robots
            move as slowly as in a new lab, with **onpath.NEWCOMER.

    Raises:
        ValueError: an unknown name or an invalid value, or a log that is refused.
        OSError: the log cannot be read.
        TypeError: an argument of earlier versions, which wrote the file at once.

    Warns:
        UserWarning: as in `onpath.simulate`.

    >>> import onpath, tempfile, pathlib
    >>> held = onpath.figure(path="circle", K1=900)
    >>> held
    <figure of Trajectory tracking / Path following, five_bar: .save(file)>
    >>> page = held.save(pathlib.Path(tempfile.mkdtemp(), "held.html"))
    >>> 1e5 < page.stat().st_size < 1.5e6
    True
    """
    _check_old(robot, settings)
    check_language(language)
    check_names(settings, entry := entry_named(robot), figure)
    made = entry.make(with_values(entry.parameters(), settings))
    named = path if isinstance(path, Mapping) else {_name(each): each for each in _several(path)}
    with looked_up("onpath.paths()"):
        curves = {name: curve_of("path", each, made) for name, each in named.items()}
    laws, others = ([compiled_law(each) for each in _several(given)] for given in (law, choices))
    values = settings if settings.keys() & NEWCOMER.keys() else {**NEWCOMER, **settings}
    with announced("OnPath: checking a figure …"):
        choice = chosen(
            entry.name,
            laws,
            paths=curves,
            values=values,
            sliders=None if sliders is None else _several(sliders),
            controls=None if controls is None else _several(controls),
            choices=others,
        )
    if log is not None:
        read = read_shown_log(user_file(log), entry, columns or {}, units or {})
        choice = replace(choice, logged=read)
    curve = next(iter(curves.values()))
    first = on_path(choice.entry, choice.parameters, curve)
    laws = choice.every_law
    remarks = [path_remark(raised(each, choice.parameters)) for each in curves.values()]
    for text in (*remarks, unused_text(first, laws, settings), forecast_text(first, laws)):
        if text:
            warnings.warn(text, UserWarning, stacklevel=2)
    return Figure(
        robot=choice.machine,
        curve=raised(curve, choice.parameters),
        choice=choice,
        title=title,
        language=language,
    )


def _name(path: GivenPath) -> str:
    """The name of a path among those to choose from."""
    return path_name(f"@{path}" if isinstance(path, Path) else str(path))


def _several(given: Any) -> list[Any]:
    """One thing as a list of one."""
    return [*given] if isinstance(given, list | tuple) else [given]


def _check_old(robot: Any, settings: Mapping[str, Any]) -> None:
    """Answer the arguments of earlier versions with those of this one.

    Raises:
        TypeError: there is one of them.
    """
    file = isinstance(robot, str | Path) and Path(robot).suffix.lower() in ENDINGS
    for name in [*(["file"] if file else []), *settings]:
        if name in OLD:
            raise TypeError(f"figure: {name} is not an argument any more: write {OLD[name]}")
