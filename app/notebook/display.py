"""What a notebook shows of runs, identifications, laws and lists: HTML, and pictures for paper."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from onpath.app.common.own_laws import compiled_law
from onpath.app.common.templates import render
from onpath.app.exports.standalone.figure import Figure, check_language
from onpath.app.exports.standalone.figure_choice import chosen
from onpath.app.exports.summary_text import rows_of
from onpath.lessons.words import ENGLISH
from onpath.models.closed_loop.trajectory import Trajectory
from onpath.models.control.laws.own import is_text, law_title
from onpath.models.control.laws.registry import LAWS
from onpath.models.control.settable import values_of
from onpath.models.control.sides import SIDES
from onpath.models.studies.experiments import Experiment, on_path, summary
from onpath.models.studies.log_identification import FileEstimate
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.guessed_numbers import told_guesses
from onpath.models.systems.parameters import time_step


class NamesTable(dict[str, str]):
    """Names and their texts: a mapping that a notebook shows as a table."""

    def __init__(
        self, texts: Mapping[str, str], head: Sequence[str], rows: Iterable[Sequence[str]]
    ) -> None:
        """Make the mapping.

        Args:
            texts: what it maps.
            head: titles of the table's columns.
            rows: its rows.
        """
        super().__init__(texts)
        self._table = cell(head=head, rows=rows)

    def _repr_html_(self) -> str:
        return self._table


class LawText(str):
    """A law's description; a notebook shows all that is said of the law."""

    __slots__ = ("name",)

    def __new__(cls, name: str) -> LawText:
        made = super().__new__(cls, LAWS[name].text)
        made.name = name
        return made

    def _repr_html_(self) -> str:
        law = LAWS[self.name]
        gains = ", ".join((*law.gains, *(gain.name for gain in law.own_gains)))
        source = f"Source: {law.source}" if law.source else ""
        said = (law.text, law.good, law.limits, law.objection, f"Gains: {gains}", source)
        return cell(title=law.label, before=said)


def run_figure(
    experiments: Sequence[Experiment], runs: Sequence[Trajectory], title: str, language: str
) -> Figure:
    """The figure of one or two recorded runs of a robot on a path.

    Its page has their robot, path, laws and settings, if a page can have them.

    Args:
        experiments: of each run.

    Raises:
        ValueError: more than two runs, or an unknown language.
    """
    check_language(language)
    if len(runs) > len(SIDES):
        raise ValueError(f"figure: expected one or two runs, got {len(runs)}")
    first = experiments[0]
    robot, curve = first.robot(), first.curve()
    choice, reason = None, ""
    try:
        if any(each.parameters != first.parameters for each in experiments):
            raise ValueError("the runs have different settings")
        if ROBOTS.get(first.entry.name) != first.entry:
            raise ValueError(f"there is another robot named {first.entry.name} here")
        for run in runs:
            if not (is_text(run.law) or run.law in LAWS):
                raise ValueError(f"the law {run.law} is not known here")
        choice = chosen(
            robot.name,
            [compiled_law(run.law) for run in runs],
            paths={"path": curve.plan},
            values=values_of(first.parameters),
        )
    except ValueError as error:
        reason = str(error)
    return Figure(
        robot=robot,
        curve=curve,
        choice=choice,
        recorded=tuple(runs),
        without=tuple(dict.fromkeys(part for each in experiments for part in _parts(each))),
        reason=reason,
        title=title,
        language=language,
    )


def _parts(experiment: Experiment) -> Iterator[str]:
    """What a run has that a page has not: keys of standalone-recorded_… in the catalogues."""
    schedule = experiment.schedule
    usual = on_path(experiment.entry, experiment.parameters, experiment.curve().plan).begin()
    moving = schedule.start_along or schedule.start_across or schedule.clock_offset
    if moving or not np.allclose(experiment.begin(), usual):
        yield "start"
    if schedule.profile is not None:
        yield "profile"
    if schedule.reverse_at:
        yield "reverse"
    for force in ("hold", "push", "wall"):
        if len(schedule.ticks(force, time_step(experiment.parameters))):
            yield force


def run_bundle(text: str, experiment: Experiment, run: Trajectory, reason: str) -> dict[str, Any]:
    """A run's numbers and picture."""
    from onpath.app.exports.standalone.still import still  # slow to import

    picture = still(experiment.robot(), experiment.curve(), [run], ENGLISH)
    return bundle(
        text,
        picture,
        head=(f"{law_title(run.law)}, {experiment.title}", f"{len(run.t)} ms"),
        rows=rows_of(summary(experiment, [run])["laws"][run.law], experiment.entry.guesses),
        after=(reason, *told_guesses(experiment.entry.guesses)),
    )


def identification_bundle(text: str, found: FileEstimate) -> dict[str, Any]:
    """The table of an identification, its remarks and its residuals."""
    from onpath.app.exports.identification import parameter_rows, remarks, residual_figure

    title, *others = remarks(found)
    return bundle(
        text,
        residual_figure(found).png(),
        before=(title,),
        head=("parameter (SI)", "value", "± (95 %)"),
        rows=parameter_rows(found),
        after=others,
    )


def bundle(text: str, picture: bytes, **shown: Any) -> dict[str, Any]:
    """Text, HTML with a picture, and the picture alone, which a PDF takes.

    Args:
        picture: a PNG file.
        shown: as for `cell`.
    """
    data = b64encode(picture).decode()
    return {"text/html": cell(picture=data, **shown), "image/png": data, "text/plain": text}


def cell(
    *,
    title: str = "",
    before: Iterable[str] = (),
    head: Sequence[str] = (),
    rows: Iterable[Sequence[str]] = (),
    caption: str = "",
    after: Iterable[str] = (),
    picture: str = "",
    drawing: str = "",
) -> str:
    """What a cell shows, as HTML: a title, texts, a table, more texts and a picture.

    Args:
        before, after: texts above and below the table; empty ones are left out.
        head: titles of the table's columns; without them, there is no table.
        rows: its rows.
        picture: a PNG file in base64.
        drawing: an SVG image of ours, shown first.
    """
    return render(
        "notebook/cell.html",
        title=title,
        before=before,
        head=head,
        rows=rows,
        caption=caption,
        after=after,
        picture=picture,
        drawing=b64encode(drawing.encode()).decode(),
    )
