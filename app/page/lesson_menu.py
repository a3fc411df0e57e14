"""The lesson menu: an overview with progress."""

from __future__ import annotations

from collections.abc import Callable

import viser

from onpath.app.lab import commands as c
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.page import lesson_html as page
from onpath.app.page.concept_test.entry import entry_of_test
from onpath.app.page.panels.dialog import dialog
from onpath.app.page.panels.slow_presses import on_menu_press
from onpath.app.page.panels.widgets import Post, on_press
from onpath.app.view.lesson_view import LessonView
from onpath.lessons.concept_test.concept_test import AFTER, BEFORE
from onpath.lessons.concept_test.titles import titles_of_tests
from onpath.lessons.course import Course
from onpath.lessons.words import Words


class LessonMenu:
    """The button near the top and the window that it opens."""

    def __init__(
        self, gui: viser.GuiApi, words: Words, post: Post, course: Course, first: PageSnapshot
    ) -> None:
        self._gui, self._words, self._post, self._course = gui, words, post, course
        self.follow(first)
        button = gui.add_button(words("lesson.lessons"), icon=viser.Icon.SCHOOL, color="gray")
        on_menu_press(button, self._open)

    def follow(self, snapshot: PageSnapshot) -> None:
        """Store the student's progress for the window."""
        self._run = LessonView(self._course, self._words, snapshot.lesson)

    def _open(self) -> Callable[[], None]:
        run, gui = self._run, self._gui
        with dialog(gui, self._words, run.words("lesson.choose")) as close:
            self._add_test(BEFORE, close)
            for name, number in run.course.numbers().items():
                lesson = run.course.lesson(name, run.words.language)
                begun = name in run.progress.notes
                gui.add_html(page.entry(lesson, run, number))
                button = gui.add_button(
                    run.words("lesson.continue" if begun else "lesson.open", number=number),
                    color=None if begun else "gray",
                    hint=lesson.front.title,
                )
                on_press(button, self._close_and_post(close, c.OpenLesson(name)))
            self._add_test(AFTER, close)
            for name, route in run.course.routes.items():
                gui.add_html(page.route_entry(route, run))
                title = route.text(route.title, run.words.language)
                follow = gui.add_button(run.words("route.follow"), color="gray", hint=title)
                on_press(follow, self._close_and_post(close, c.FollowRoute(name)))
        return close

    def _add_test(self, name: str, close: Callable[[], None]) -> None:
        """The concept test before or after the course, if there is one."""
        if name not in self._course.tests:
            return
        run, gui = self._run, self._gui
        gui.add_html(entry_of_test(name, run))
        button = gui.add_button(
            run.words("test.open"), color="gray", hint=titles_of_tests(run.course, run.words)[name]
        )
        on_press(button, self._close_and_post(close, c.OpenLesson(name)))

    def _close_and_post(self, close: Callable[[], None], command: c.Command) -> Callable[[], None]:
        def act() -> None:
            close()
            self._post(command)

        return act
