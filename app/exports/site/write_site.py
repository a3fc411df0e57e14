"""Writes the course as a folder of pages that need no server."""

from __future__ import annotations

import hashlib
import json
import shutil
import tempfile
from base64 import b64decode
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

from onpath.app.common.newcomer import NEWCOMER
from onpath.app.exports.site.pages import (
    Package,
    Picture,
    entry_of,
    lesson_page,
    site_style,
    start_page,
)
from onpath.app.exports.site.run_pictures import run_picture, run_truth
from onpath.app.exports.site.step_data import SiteStep, site_step
from onpath.app.exports.standalone.figure_choice import chosen
from onpath.app.exports.standalone.figure_data import figure_data
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.assets import asset_path
from onpath.lessons.course import REFERENCE, Course, read_references
from onpath.lessons.lecture import LECTURE
from onpath.lessons.progress import Truth
from onpath.lessons.words import DEFAULT, Words
from onpath.models.closed_loop.loops import InterpretedLoop
from onpath.models.paths.path_design import presets

SHARED = "site"
"""Folder of the files that pages share: script, style, kernels, pictures."""
PATHS = ("circle", "ellipse", "rounded square", "clover")


def write_site(
    folder: Path,
    course: Course,
    home: Path,
    languages: Iterable[str],
    begins: Callable[[str], object] = lambda _: None,
) -> None:
    """Write all pages; the folder is new or empty.

    Args:
        home: contains the lessons' own folders.
        languages: language codes; the pages of the first one have plain names.
        begins: is told what is done next, which takes seconds.

    Raises:
        ValueError: the folder holds something else, or a lesson cannot be shown.
    """
    with _whole_folder(folder) as scratch:
        _write_shared(scratch)
        truths = _truths(course, course.played, begins)
        writer = _SiteWriter(
            folder=scratch,
            course=course,
            home=home,
            languages=list(languages),
            truths=truths,
        )
        writer.write(begins)


def write_lesson(
    folder: Path, course: Course, home: Path, name: str, language: str, scorm: Package
) -> str:
    """Write one lesson into an empty folder, and return the address of its page in it.

    Args:
        scorm: the package to which it belongs.
    """
    _write_shared(folder)
    writer = _SiteWriter(
        folder=folder,
        course=course,
        home=home,
        languages=[language],
        truths=_truths(course, [name]),
        scorm=scorm,
    )
    return writer.lesson(name, Words(language))


def _write_shared(folder: Path) -> None:
    """Write the script and style of all pages, and make folders for the other shared files."""
    shared = folder / SHARED
    (shared / "kernels").mkdir(parents=True)
    (shared / "pictures").mkdir()
    for name in ("on.js", "site.js", "icon.svg", "math.woff2", "math-licence.txt"):
        shutil.copy(asset_path(f"web/{name}"), shared)
    (shared / "site.css").write_text(site_style(), "utf-8")


class _SiteWriter:
    """Writes the pages of one site."""

    def __init__(
        self,
        folder: Path,
        course: Course,
        home: Path,
        languages: list[str],
        truths: Mapping[tuple[str, int], Truth],
        scorm: Package | None = None,
    ) -> None:
        """Pages of a SCORM package have no links to others."""
        self._folder, self._course, self._home = folder, course, home
        self._languages, self._truths, self._scorm = languages, truths, scorm

    def write(self, begins: Callable[[str], object]) -> None:
        for language in self._languages:
            words = Words(language)
            self._start(words)
            for name in self._course.played:
                begins(f"writing {self._address(name, language)}")
                self.lesson(name, words)

    def _address(self, name: str, language: str) -> str:
        return f"{name}.html" if language == self._languages[0] else f"{name}.{language}.html"

    def _around(self, name: str, words: Words) -> dict[str, Any]:
        languages = {language: self._address(name, language) for language in self._languages}
        start = None if self._scorm else self._address("index", words.language)
        return {"start": start, "languages": languages}

    def _start(self, words: Words) -> None:
        curves = {name: presets()[name].curve for name in PATHS}
        choice = chosen("five_bar", paths=curves, values=NEWCOMER)
        figure = self._shared_kernels(figure_data(choice, words))
        entries = [
            entry_of(
                self._course.lesson(name, words.language),
                number,
                self._address(name, words.language),
                words,
            )
            for name, number in self._course.numbers().items()
        ]
        lecture = self._address(LECTURE, words.language) if self._course.lecture else ""
        page = start_page(
            words=words,
            figure=figure,
            entries=entries,
            lecture=lecture,
            around=self._around("index", words),
        )
        self._write("index", words, page)

    def lesson(self, name: str, words: Words) -> str:
        """Write a lesson's page, and return its address."""
        lesson = self._course.lesson(name, words.language)
        references, problems = read_references(lesson, self._home / name / REFERENCE)
        if problems:
            raise ValueError(str(problems[0]))
        steps = [site_step(lesson, i, references, words) for i in range(len(lesson.steps))]
        steps = [self._completed(name, step) for step in steps]
        pictures = dict(self._pictures(name, steps, words))
        page = lesson_page(
            lesson=lesson,
            number=self._course.numbers().get(name, ""),
            steps=steps,
            pictures=pictures,
            following=self._following(name, words),
            words=words,
            around=self._around(name, words),
            scorm=self._scorm,
        )
        self._write(name, words, page)
        return self._address(name, words.language)

    def _completed(self, name: str, step: SiteStep) -> SiteStep:
        """A step with shared kernels, and with the true curves if only the lab can play it."""
        truth = self._truths.get((name, step.number - 1)) if step.lab_only else None
        curves = ("times", "tracker", "follower")
        more = {"truth": {each: getattr(truth, each) for each in curves}} if truth else {}
        figure = self._shared_kernels(step.figure)
        remade = {
            name: {value: self._shared_kernels(each) for value, each in figures.items()}
            for name, figures in step.remade.items()
        }
        return replace(step, figure=figure, remade=remade, data=step.data | more)

    def _following(self, name: str, words: Words) -> dict[str, str] | None:
        names = list(self._course.lessons)
        if name not in names:
            return None
        after = names[names.index(name) + 1 :]
        if not after or self._scorm:
            return None
        title = self._course.lesson(after[0], words.language).front.title
        return {"address": self._address(after[0], words.language), "title": title}

    def _pictures(
        self, name: str, steps: list[SiteStep], words: Words
    ) -> Iterator[tuple[int, Picture]]:
        lesson = self._course.lesson(name, words.language)
        for step in steps:
            truth = self._truths.get((name, step.number - 1))
            if truth is None:
                continue
            picture = run_picture(lesson, step.number - 1, truth, words)
            address = f"{SHARED}/pictures/{name}-{step.number}-{words.language}.svg"
            (self._folder / address).write_bytes(picture.svg)
            yield step.number, Picture(address, picture.text)

    def _shared_kernels(self, figure: dict[str, Any]) -> dict[str, Any]:
        """The figure, with its module moved to a script that pages share, and named by it."""
        module = figure["module"]
        name = hashlib.sha256(module.encode()).hexdigest()[:16]
        file = self._folder / SHARED / "kernels" / f"{name}.js"
        if not file.exists():
            file.write_text(f"onpathKernels[{json.dumps(name)}]={json.dumps(module)}\n", "utf-8")
        return {**figure, "module": name, "drawings": self._shared_images(figure["drawings"])}

    def _shared_images(self, drawings: dict[str, Any]) -> dict[str, Any]:
        """The drawings, with their pictures moved to files that pages share."""
        shared = dict(drawings)
        for kind in ("rank", "zone"):
            if kind in drawings:
                png = b64decode(drawings[kind]["src"].partition(",")[2])
                address = f"{SHARED}/pictures/{hashlib.sha256(png).hexdigest()[:16]}.png"
                (self._folder / address).write_bytes(png)
                shared[kind] = drawings[kind] | {"src": address}
        return shared

    def _write(self, name: str, words: Words, page: str) -> None:
        (self._folder / self._address(name, words.language)).write_text(page, "utf-8")


def _truths(
    course: Course, names: Iterable[str], begins: Callable[[str], object] = lambda _: None
) -> dict[tuple[str, int], Truth]:
    """The results of all steps with a script, by lesson and index of the step."""
    loop_cache = LoopCache(at_once=True, translate=InterpretedLoop)  # compiling is not worth it
    found = dict[tuple[str, int], Truth]()
    for name in names:
        begins(f"playing {name}")
        lesson = course.lesson(name, DEFAULT)
        for index in range(len(lesson.steps)):
            truth = run_truth(lesson, index, loop_cache)
            if truth is not None:
                found[name, index] = truth
    return found


@contextmanager
def _whole_folder(folder: Path) -> Iterator[Path]:
    """A temporary folder, which replaces `folder` once everything is written.

    Raises:
        ValueError: `folder` cannot be written, or contains something other than a site.
    """
    if folder.exists() and not folder.is_dir():
        raise ValueError(f"{folder}: that is a file")
    if folder.is_dir() and any(folder.iterdir()) and not (folder / SHARED / "on.js").exists():
        raise ValueError(f"{folder}: not empty, and no site of an earlier export")
    if not folder.parent.is_dir():
        raise ValueError(f"{folder}: no folder {folder.parent}")
    try:
        scratch = Path(tempfile.mkdtemp(dir=folder.parent, prefix=f".{folder.name}-"))
    except OSError as error:
        raise ValueError(f"{folder}: {error.strerror}") from None
    try:
        scratch.chmod(0o755)
        yield scratch
        if folder.exists():
            shutil.rmtree(folder)
        scratch.rename(folder)
    finally:
        shutil.rmtree(scratch, ignore_errors=True)
