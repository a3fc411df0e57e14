"""The end of the concept test: thanks, and after the second test the right answers and why."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import viser

from onpath.app.common.palette import AZURE
from onpath.app.common.templates import render
from onpath.app.exports.concept_test_facts import results_of
from onpath.app.lab import commands as c
from onpath.app.page.panels.widgets import Post, add_buttons
from onpath.lessons.concept_test.concept_test import BEFORE
from onpath.lessons.concept_test.titles import titles_of_tests

if TYPE_CHECKING:
    from onpath.app.page.lesson_view import LessonView


def add_test_end(
    gui: viser.GuiApi, run: LessonView, post: Post, report: Callable[[], None]
) -> list[Any]:
    """Add the widgets of the end of a test; returns them.

    Args:
        report: requests the record of all lessons.
    """
    words = run.words
    content = render(
        "lesson/test_end.html",
        words=words,
        run=run,
        title=titles_of_tests(run.course, words)[run.progress.lesson],
        results=results_of(run),
        colour=AZURE.hex,
    )
    text = gui.add_html(content)
    actions: dict[str, Callable[[], None]] = {}
    route = run.progress.route
    if run.progress.lesson == BEFORE and route in run.course.routes:
        actions[words("route.follow")] = lambda: post(c.FollowRoute(route))
    actions |= {
        words("end.record"): report,
        words("lesson.close"): lambda: post(c.CloseLesson()),
    }
    return [text, add_buttons(gui, "", actions, lambda act: act())]
