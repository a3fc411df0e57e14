"""The built-in course, whose lessons are read when first needed, not all before the first page."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from threading import RLock

from msgspec.structs import replace

from onpath.lessons.concept_test.concept_test import FOLDERS, SITTINGS, name_of
from onpath.lessons.course import BUILT_IN, Course
from onpath.lessons.lecture import LECTURE
from onpath.lessons.parse import read_lesson
from onpath.lessons.routes import read_routes
from onpath.lessons.schema import Lesson
from onpath.lessons.words import DEFAULT

_one_reader = RLock()
"""Held while a lesson is read; reading a translation also reads the first language."""


@dataclass(frozen=True, slots=True)
class Versions(Mapping[str, Lesson]):
    """The versions of a valid lesson; each language is read when first asked for. Thread-safe.

    Attributes:
        home: the folder of the lesson.
        name: of the lesson.
        languages: the others take over the keys of the first one.
    """

    home: Path
    name: str
    languages: tuple[str, ...]

    def __getitem__(self, language: str) -> Lesson:
        if language not in self.languages:
            raise KeyError(language)
        with _one_reader:
            return _read(self, language)

    def __iter__(self) -> Iterator[str]:
        return iter(self.languages)

    def __len__(self) -> int:
        return len(self.languages)


@cache
def _read(versions: Versions, language: str) -> Lesson:
    lesson = replace(read_lesson(versions.home / f"{language}.md"), name=versions.name)
    if language == versions.languages[0]:
        return lesson
    first = _read(versions, versions.languages[0])
    return replace(lesson, keys=first.keys, version=first.version)


@cache
def built_in_course() -> Course:
    """The built-in course. It is not checked here: tests check it."""

    def versions(home: Path, name: str) -> Mapping[str, Lesson]:
        languages = {file.stem for file in home.glob("??.md")} - {DEFAULT}
        return Versions(home, name, (DEFAULT, *sorted(languages)))

    homes = sorted(file.parent for file in BUILT_IN.glob(f"*/{DEFAULT}.md"))
    names = [home.name for home in homes if home.name not in (*FOLDERS, LECTURE)]
    lessons = {name: versions(BUILT_IN / name, name) for name in names}
    tests = {
        name: versions(BUILT_IN / folder, name)
        for form, folder in enumerate(FOLDERS)
        for name in (name_of(sitting, form) for sitting in SITTINGS)
    }
    lecture = versions(BUILT_IN / LECTURE, LECTURE)
    return Course(lessons, read_routes(BUILT_IN).routes, tests, lecture)
