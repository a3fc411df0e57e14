"""Lessons that are read as they are needed are the same as those that are read at once."""

from __future__ import annotations

import pickle
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from onpath.app.server import built_in_course as module
from onpath.app.server.built_in_course import built_in_course
from onpath.lessons.concept_test.concept_test import BEFORE
from onpath.lessons.parse import read_lesson
from tests.support import built_in

COURSE = built_in.built_in_course()[0]
NAME = list(COURSE.lessons)[2]


@pytest.fixture
def read(monkeypatch: pytest.MonkeyPatch) -> list[Path]:
    """The files that have been read; nothing has been before."""
    files = list[Path]()
    monkeypatch.setattr(module, "read_lesson", lambda file: files.append(file) or read_lesson(file))
    module._read.cache_clear()
    return files


@pytest.mark.thorough
def test_lessons_tests_and_routes_are_the_same() -> None:
    found = built_in_course()
    for same, own in ((COURSE.lessons, found.lessons), (COURSE.tests, found.tests)):
        assert [(name, dict(own[name])) for name in own] == list(same.items())
    assert found.routes == COURSE.routes and found.languages() == COURSE.languages()
    assert "xx" not in found.lessons[NAME] and len(found.lessons[NAME]) == 2


def test_no_lesson_is_read_before_it_is_needed_and_none_twice(read: list[Path]) -> None:
    found = built_in_course.__wrapped__()
    assert found.numbers() and found.languages() and found.has(BEFORE) and not read
    with ThreadPoolExecutor(8) as threads:
        lessons = list(threads.map(lambda _: found.lesson(NAME, "de"), range(40)))
    assert all(lesson is lessons[0] for lesson in lessons)
    assert [file.name for file in read] == ["de.md", "en.md"]


def test_another_process_reads_them_itself() -> None:
    course = pickle.loads(pickle.dumps(built_in_course()))
    assert course.lesson(NAME, "de") == COURSE.lesson(NAME, "de")
