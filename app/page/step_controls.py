"""The controls of the open lesson step, rebuilt whenever another step is opened."""

from __future__ import annotations

from collections.abc import Callable

import viser

from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.page.panel_factory import IN_STRIP, Part
from onpath.app.view.lesson_view import NO_SETUP, LessonView
from onpath.lessons.action_schema import StepSetup
from onpath.lessons.course import Course
from onpath.lessons.words import Words

Build = Callable[[StepSetup, PageSnapshot], list[Part]]
"""Adds the widgets of a set-up."""


class StepControls:
    """A folder whose contents are rebuilt for every step.

    Args:
        change: changes widgets in another thread; see `Page`.

    Attributes:
        is_empty: whether the open step has no controls.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        tab: viser.GuiTabHandle,
        words: Words,
        course: Course,
        build: Build,
        change: Callable[[Callable[[], None]], None],
        first: PageSnapshot,
    ) -> None:
        self._gui, self._build, self._change = gui, build, change
        self._tab, self._words, self._course = tab, words, course
        self._folder: viser.GuiFolderHandle | None = None
        self._scene: StepSetup | None = None
        self._parts: list[Part] = []
        self._fill(self._setup_of(first), first)

    def follow(self, snapshot: PageSnapshot) -> None:
        """Show the open step's controls and their current values."""
        scene = self._setup_of(snapshot)
        if scene != self._scene:
            self._scene, self._parts = scene, []
            self._change(lambda: self._fill(scene, snapshot))
        for part in self._parts:
            part.follow(snapshot)

    def _fill(self, scene: StepSetup, first: PageSnapshot) -> None:
        if self._folder is not None:
            self._folder.remove()
            self._folder = None
        self._scene = scene
        self.is_empty = not set(scene.controls) - set(IN_STRIP)
        with self._tab:
            self._folder = self._gui.add_folder(self._words("lesson.controls"))
        with self._folder:
            self._parts = self._build(scene, first)

    def _setup_of(self, snapshot: PageSnapshot) -> StepSetup:
        """Set-up of the open step."""
        view = LessonView(self._course, self._words, snapshot.lesson)
        return NO_SETUP if view.ended else view.setup
