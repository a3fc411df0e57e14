"""A figure: the picture of a run, and the page on which it can be tried."""

from __future__ import annotations

import gzip
from base64 import b64encode
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from onpath.app.common.announced import announced
from onpath.app.common.atomic_file import check_writable, whole_file
from onpath.app.common.templates import render
from onpath.app.exports.standalone.figure_choice import FigureChoice
from onpath.app.exports.standalone.figure_data import figure_numbers
from onpath.app.exports.standalone.figure_page import figure_page, picture_page
from onpath.app.exports.standalone.figure_words import run_titles
from onpath.assets.messages import languages
from onpath.lessons.words import Words
from onpath.models.closed_loop.trajectory import Trajectory
from onpath.models.paths.curves import Curve
from onpath.models.studies import experiments
from onpath.models.systems.robots import Robot

ENDINGS = (".html", ".htm")
HEIGHT = 900
"""Of the frame in a notebook until its page says how high it is, [px]."""
HOLD, END = (0.5, 1.5), 2.0
"""The interval in which a brake holds the robots of a picture back, and the end of the run, [s]."""


@dataclass(frozen=True, eq=False, repr=False)
class Figure:
    """A picture of one or two runs, and a page on which the robots can be held back and pulled.

    As the last line of a notebook's cell it shows itself: the page where scripts run, else the
    picture, as on GitHub, in nbviewer or in a PDF. Make it with `onpath.figure` or `Run.figure`.

    Attributes:
        robot: the robot.
        curve: the path of the picture.
        choice: what the page shows; None: there is only the picture.
        recorded: the runs of the picture; None: the robots of the page are held for a second.
        reason: why there is only the picture.
        without: what the recorded runs have and the page has not: see `figure_page`.
        title: title above the figure; may be empty.
        language: language of its words.
    """

    robot: Robot
    curve: Curve
    choice: FigureChoice | None
    recorded: tuple[Trajectory, ...] | None = None
    reason: str = ""
    without: tuple[str, ...] = ()
    title: str = ""
    language: str = "en"
    _pages: dict[str, str] = field(default_factory=dict[str, str])
    _pictures: dict[str, bytes] = field(default_factory=dict[str, bytes])

    @property
    def html(self) -> str:
        """The page: one file that needs no server, network or other file."""
        return self._page(self.language)

    @property
    def png(self) -> bytes:
        """The picture, as a PNG file."""
        return self._picture(self.language)

    def save(self, file: str | Path, *, language: str = "") -> Path:
        """Write the page to a file.

        Args:
            file: with a name ending in .html.
            language: of the page, if it is another one; costs only its words.

        Returns:
            The file.

        Raises:
            ValueError: another ending, an unknown language, or the file cannot be written.
        """
        path = Path(file).expanduser()
        if path.suffix.lower() not in ENDINGS:
            raise ValueError(f"{file}: expected a name ending in .html")
        check_writable(path)
        page = self._page(language or self.language)
        with whole_file(path) as scratch:
            scratch.write_text(page, encoding="utf-8")
        return path

    def _page(self, language: str) -> str:
        check_language(language)
        if language not in self._pages:
            words, picture = Words(language), self._picture(language)
            with announced("OnPath: making a figure …"):
                self._pages[language] = (
                    picture_page(self._laws(words), words, self.title, picture, self.reason)
                    if self.choice is None
                    else self._live(self.choice, words, picture)
                )
        return self._pages[language]

    def _live(self, choice: FigureChoice, words: Words, picture: bytes = b"") -> str:
        return figure_page(
            choice,
            words,
            self.title,
            numbers=self._numbers,
            picture=picture,
            without=self.without,
        )

    def _picture(self, language: str) -> bytes:
        from onpath.app.exports.standalone.still import still  # slow to import

        if language not in self._pictures:
            with announced("OnPath: drawing a figure …"):
                self._pictures[language] = still(
                    self.robot, self.curve, self._runs, Words(language)
                )
        return self._pictures[language]

    @cached_property
    def _runs(self) -> tuple[Trajectory, ...]:
        if self.recorded is not None:
            return self.recorded
        assert self.choice is not None
        return tuple(held_runs(self.choice))

    @cached_property
    def _numbers(self) -> Mapping[str, Any]:
        assert self.choice is not None
        return figure_numbers(self.choice)

    def _laws(self, words: Words) -> str:
        return " / ".join(run_titles(self._runs, words))

    def __repr__(self) -> str:
        kind = "figure" if self.choice else "picture"
        return f"<{kind} of {self._laws(Words(self.language))}, {self.robot.name}: .save(file)>"

    def _repr_mimebundle_(self, **_: Any) -> dict[str, Any]:
        """Picture and page for a notebook, which shows the first kind that it can."""
        words, picture, page = Words(self.language), b64encode(self.png).decode(), ""
        if self.choice is not None:
            with announced("OnPath: making a figure …"):
                page = self._live(self.choice, words)
        html = render(
            "notebook/figure.html",
            picture=picture,
            described=words("standalone.still", laws=self._laws(words)),
            named=self.title or self._laws(words),
            height=HEIGHT,
            page=b64encode(gzip.compress(page.encode(), mtime=0)).decode() if page else "",
            text=words("standalone.only_picture", reason=self.reason),
        )
        return {"text/html": html, "image/png": picture, "text/plain": repr(self)}


def held_runs(figure: FigureChoice) -> list[Trajectory]:
    """A run of each of a figure's laws on its first path, in which the robot is held back."""
    path = next(iter(figure.paths.values()))
    held = {"duration": END, "hold_from": HOLD[0], "hold_to": HOLD[1]}
    experiment = experiments.on_path(figure.entry, figure.parameters, path).with_values(held)
    return [experiments.run(experiment, law) for law in figure.laws]


def check_language(language: str) -> None:
    """Check that there are words in a language.

    Raises:
        ValueError: there are none.
    """
    if language not in languages():
        raise ValueError(f"language {language}: there are {', '.join(languages())}")
