"""The concept test in the lesson overview, and how many of its questions are answered."""

from __future__ import annotations

from onpath.app.common.templates import render
from onpath.app.lab.lesson_state import LessonState
from onpath.lessons.concept_test.titles import titles_of_tests
from onpath.lessons.minutes import lesson_minutes
from onpath.lessons.progress import Notes


def entry_of_test(name: str, run: LessonState) -> str:
    """A test in the lesson overview, with the name of the button that follows."""
    lesson, words = run.course.lesson(name, run.words.language), run.words
    notes = run.progress.notes.get(name, Notes())
    minutes = words("lesson.minutes", minutes=lesson_minutes(lesson)[0])
    title = titles_of_tests(run.course, words)[name]
    return render(
        "lesson/test_entry.html",
        front=lesson.front,
        title=title,
        facts=[minutes, *([words("test.handed_in")] if notes.handed_in else [])],
        finished=notes.handed_in,
        name=words("test.open_name", title=title),
    )
