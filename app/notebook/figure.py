"""`onpath.figure`: one or two robots on a page that needs no server."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from onpath.app.common.atomic_file import check_writable, whole_file
from onpath.app.common.newcomer import NEWCOMER
from onpath.app.common.own_laws import compiled_law
from onpath.app.exports.standalone.figure_choice import chosen
from onpath.app.exports.standalone.figure_page import figure_page
from onpath.app.notebook.arguments import curve_of
from onpath.app.notebook.simulate import check_names, entry_named
from onpath.assets.messages import languages
from onpath.lessons.words import Words
from onpath.models.closed_loop.simulation import raised
from onpath.models.control.sides import DEFAULT_LAWS
from onpath.models.paths.curves import Curve
from onpath.models.studies.experiments import forecast_text, on_path, path_remark
from onpath.models.studies.unused import unused_text
from onpath.models.systems.robots import RobotEntry

PATHS = ("circle", "ellipse", "rounded square", "clover")


def figure(
    file: str | Path,
    robot: str | RobotEntry = "five_bar",
    laws: Sequence[Any] = tuple(DEFAULT_LAWS.values()),
    paths: Sequence[Curve | str] | Mapping[str, Curve | str] = PATHS,
    *,
    sliders: Sequence[str] | None = None,
    controls: Sequence[str] | None = None,
    choices: Sequence[Any] = (),
    title: str = "",
    language: str = "en",
    **parameters: Any,
) -> Path:
    """Write a page with one or two robots that can be held back, pulled, paused and reset.

    It is one file of about 0.2 MB, makes no network request, and opens from anywhere: a folder, a
    web server, an iframe. Its loops are those of `onpath.simulate`, as WebAssembly.

    Args:
        file: the file to write, such as "figure.html".
        robot: one of `onpath.robots()`, or what `onpath.robot` returns.
        laws: one or two of `onpath.laws()`, or laws of one's own, as for `onpath.simulate`, but no
            functions that are called.
        paths: paths to choose from, beginning with the first: names of `onpath.paths()`, texts or
            curves as for `onpath.simulate`, or a mapping from names to them.
        sliders: names of `onpath.parameters(robot)` that readers may change; None: the speed and
            the gains of the laws.
        controls: what else readers may do or see: some of hold, pull, drag (points of the path),
            run, step, reset, path, plot, poles; None: all that are possible with this robot and
            laws.
        choices: further laws, which readers may choose for each robot.
        title: title above the figure.
        language: language of the page.
        parameters: as in `onpath.simulate`. If neither `speed` nor `ramp` is among them, the robots
            move as slowly as in a new lab, with **onpath.NEWCOMER.

    Returns:
        The file.

    Raises:
        ValueError: an unknown name or an invalid value, or the file cannot be written.

    Warns:
        UserWarning: as in `onpath.simulate`.

    >>> import onpath, tempfile, pathlib
    >>> folder = pathlib.Path(tempfile.mkdtemp())
    >>> page = onpath.figure(folder / "held.html", paths=["circle"], K1=900)
    >>> 1e5 < page.stat().st_size < 1.5e6
    True
    """
    path = Path(file)
    check_writable(path)
    if language not in languages():
        raise ValueError(f"language {language}: there are {', '.join(languages())}")
    laws = [laws] if isinstance(laws, str) else laws
    if isinstance(paths, str):
        paths = [paths]
    choices = [choices] if isinstance(choices, str) else choices
    laws, choices = ([compiled_law(law) for law in each] for each in (laws, choices))
    named = paths if isinstance(paths, Mapping) else {str(each): each for each in paths}
    curves = {name: curve_of("paths", each) for name, each in named.items()}
    check_names(parameters, entry := entry_named(robot), figure)
    values = parameters if parameters.keys() & NEWCOMER.keys() else {**NEWCOMER, **parameters}
    choice = chosen(
        entry.name,
        laws,
        paths=curves,
        values=values,
        sliders=sliders,
        controls=controls,
        choices=choices,
    )
    first = on_path(choice.entry, choice.parameters, next(iter(curves.values())))
    laws = choice.every_law
    remarks = [path_remark(raised(each, choice.parameters)) for each in curves.values()]
    for text in (*remarks, unused_text(first, laws, parameters), forecast_text(first, laws)):
        if text:
            warnings.warn(text, UserWarning, stacklevel=2)
    with whole_file(path) as scratch:
        scratch.write_text(figure_page(choice, Words(language), title), encoding="utf-8")
    return path
