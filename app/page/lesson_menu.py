"""The lesson menu: an overview with progress, the language, and large type for a projector."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import viser

from onpath.app.lab import commands as c
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.page import lesson_html as page
from onpath.app.page.lesson_view import LessonView
from onpath.app.page.panels.widgets import Post, close_once, on_menu_press, on_press, on_user_update
from onpath.lessons.course import Course
from onpath.lessons.words import Words, languages


class LessonMenu:
    """The button near the top and the window that it opens."""

    def __init__(
        self, gui: viser.GuiApi, words: Words, post: Post, course: Course, first: PageSnapshot
    ) -> None:
        self._gui, self._words, self._post, self._course = gui, words, post, course
        self.follow(first)
        button = gui.add_button(words("lesson.lessons"), icon=viser.Icon.SCHOOL, color="green")
        on_menu_press(button, self._open)

    def follow(self, snapshot: PageSnapshot) -> None:
        """Store the student's progress for the window."""
        self._run = LessonView(self._course, self._words, snapshot.lesson)

    def _open(self) -> Callable[[], None]:
        run, gui = self._run, self._gui
        with gui.add_modal(run.words("lesson.choose")) as modal:
            close = partial(close_once, modal)
            for number, name in enumerate(run.course.lessons, start=1):
                lesson = run.course.lesson(name, run.words.language)
                gui.add_html(page.entry(lesson, run, number))
                begun = name in run.progress.notes
                open_it = gui.add_button(
                    run.words("lesson.continue" if begun else "lesson.open"),
                    color=None if begun else "gray",
                    hint=lesson.front.title,
                )
                on_press(open_it, self._then(close, c.OpenLesson(name)))
            self._add_choices(close)
        return close

    def _add_choices(self, close: Callable[[], None]) -> None:
        run, gui = self._run, self._gui
        names = {run.words(f"language.{code}"): code for code in languages()}
        language = gui.add_dropdown(
            run.words("lesson.language"),
            list(names),
            initial_value=run.words(f"language.{run.words.language}"),
        )
        on_user_update(language, lambda name: self._chosen(close, c.SetLanguage(names[name])))
        large = gui.add_checkbox(run.words("lesson.presenting"), run.progress.presenting)
        on_user_update(large, lambda on: self._chosen(close, c.SetPresenting(on)))

    def _chosen(self, close: Callable[[], None], command: c.Command) -> None:
        close()
        self._post(command)

    def _then(self, close: Callable[[], None], command: c.Command) -> Callable[[], None]:
        return lambda: self._chosen(close, command)
