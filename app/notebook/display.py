"""What a notebook shows of runs, identifications, laws and lists: HTML, and pictures for paper."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import Any

from onpath.app.common.own_laws import compiled_law
from onpath.app.exports.standalone.figure import Figure, check_language
from onpath.app.exports.standalone.figure_choice import chosen
from onpath.app.exports.summary_text import rows_of
from onpath.lessons.words import ENGLISH
from onpath.models.closed_loop.trajectory import Trajectory
from onpath.models.control.laws.own import is_text, law_title
from onpath.models.control.laws.registry import LAWS
from onpath.models.control.settable import values_of
from onpath.models.control.sides import SIDES
from onpath.models.studies.experiments import Experiment, summary
from onpath.models.studies.log_identification import FileEstimate
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.robot_sketch import html_table


class Table(dict[str, str]):
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
        self._table = html_table(head, rows)

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
        said = paragraphs(law.text, law.good, law.limits, law.objection)
        more = paragraphs(f"Gains: {gains}", f"Source: {law.source}" if law.source else "")
        return f"<div><b>{escape(law.label)}</b>{said}{more}</div>"


def run_figure(
    first: Experiment, runs: Sequence[Trajectory], alike: bool, title: str, language: str
) -> Figure:
    """The figure of one or two recorded runs of a robot on a path.

    Its page has their robot, path, laws and settings, if a page can have them.

    Args:
        alike: whether they have the same settings.

    Raises:
        ValueError: more than two runs, or an unknown language.
    """
    check_language(language)
    if len(runs) > len(SIDES):
        raise ValueError(f"figure: expected one or two runs, got {len(runs)}")
    robot, curve = first.robot(), first.curve()
    choice, reason = None, ""
    try:
        if not alike:
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
        reason=reason,
        title=title,
        language=language,
    )


def run_bundle(text: str, experiment: Experiment, run: Trajectory, reason: str) -> dict[str, Any]:
    """A run's numbers and picture."""
    from onpath.app.exports.standalone.still import still  # slow to import

    picture = still(experiment.robot(), experiment.curve(), [run], ENGLISH)
    head = (f"{law_title(run.law)}, {experiment.title}", f"{len(run.t)} ms")
    table = html_table(head, rows_of(summary(experiment, [run])["laws"][run.law]))
    return bundle(text, table + paragraphs(reason), picture)


def identification_bundle(text: str, found: FileEstimate) -> dict[str, Any]:
    """The table of an identification, its remarks and its residuals."""
    from onpath.app.exports.identification import parameter_rows, remarks, residual_figure

    title, *others = remarks(found)
    table = html_table(("parameter (SI)", "value", "± (95 %)"), parameter_rows(found))
    picture = residual_figure(found).png()
    return bundle(text, paragraphs(title) + table + paragraphs(*others), picture)


def paragraphs(*texts: str) -> str:
    """Texts as HTML; those that are empty are left out."""
    return "".join(f"<p>{escape(each)}</p>" for each in texts if each)


def bundle(text: str, html: str, picture: bytes) -> dict[str, Any]:
    """Text, HTML with a picture, and the picture alone, which a PDF takes.

    Args:
        picture: a PNG file.
    """
    data = b64encode(picture).decode()
    image = f'<img alt="" style="max-width: 100%" src="data:image/png;base64,{data}">'
    return {"text/html": f"<div>{html}{image}</div>", "image/png": data, "text/plain": text}
