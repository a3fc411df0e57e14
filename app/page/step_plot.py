"""The plot of the open lesson step, in a window over the lower part of the scene."""

from __future__ import annotations

from collections.abc import Callable

import viser

from onpath.app.common.templates import render
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.page.lesson_view import LessonView
from onpath.app.page.panel_factory import Part
from onpath.lessons.action_schema import StepSetup
from onpath.lessons.course import Course
from onpath.lessons.words import Words

GAP = 12  # to the edges of the scene, [px]
WIDTH, HEIGHT, PLOT = 440, 240, 160  # of the window, and height of its plot, [px]
SHARE = 0.31
"""Of the scene's height, which is left to the window."""


class StepPlot:
    """A window that is there while the open step has a plot; it is seen together with the text.

    Args:
        build: adds the plot of a set-up, if it has one, of a height [px].
        change: changes widgets in another thread; see `RebuildThread.change`.
        on_change: is told when the window comes or goes.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        words: Words,
        course: Course,
        build: Callable[[StepSetup, PageSnapshot, int], list[Part]],
        change: Callable[[Callable[[], None]], None],
        first: PageSnapshot,
        on_change: Callable[[], None],
    ) -> None:
        self._gui, self._words, self._course = gui, words, course
        self._build, self._change, self._on_change = build, change, on_change
        self._panel: viser.PanelHandle | None = None
        self._parts: list[Part] = []
        self._setup = self._setup_of(first)
        self._open(first)

    @property
    def share(self) -> float:
        """Of the scene's height, from below, that the window takes."""
        return 0.0 if self._panel is None else SHARE

    def follow(self, snapshot: PageSnapshot) -> None:
        """Show the open step's plot."""
        setup = self._setup_of(snapshot)
        if setup != self._setup:
            self._setup, self._parts = setup, []
            self._change(lambda: self._open(snapshot))
        for part in self._parts:
            part.follow(snapshot)

    def _open(self, first: PageSnapshot) -> None:
        """Close the window, and open another one if the step has a plot."""
        was_open, self._parts = self._panel is not None, []
        if self._panel is not None:
            self._panel.remove()
            self._panel = None
        if self._setup.plot:
            panel = self._gui.add_panel()
            with panel.add_tab(self._words("lesson.plot"), viser.Icon.CHART_LINE):
                self._gui.add_html(render("panel/step_plot.html"))
                self._parts = self._build(self._setup, first, PLOT)
            panel.float(x=GAP, y=-GAP, width=WIDTH, height=HEIGHT)
            self._panel = panel
        if was_open != (self._panel is not None):
            self._on_change()

    def _setup_of(self, snapshot: PageSnapshot) -> StepSetup:
        view = LessonView(self._course, self._words, snapshot.lesson)
        return StepSetup() if view.ended else view.setup
