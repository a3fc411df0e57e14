"""The controls and the plot of the open lesson step, rebuilt whenever another step is opened."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import viser

from onpath.app.common.templates import render
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.page.lesson_view import NO_SETUP, LessonView
from onpath.app.page.panel_factory import IN_STRIP, Part, has_window
from onpath.lessons.action_schema import StepSetup
from onpath.lessons.course import Course
from onpath.lessons.words import Words

Build = Callable[[StepSetup, PageSnapshot], list[Part]]
"""Adds the widgets of a set-up."""

GAP = 12  # to the edges of the scene, [px]


@dataclass(frozen=True, slots=True)
class WindowSize:
    """Size of the window with a step's plot.

    Attributes:
        width, height: [px].
        plot: height of the plot, [px].
        share: of the scene's height that the window covers.
    """

    width: int
    height: int
    plot: int
    share: float


WINDOW, LARGE_WINDOW = WindowSize(440, 240, 160, 0.31), WindowSize(680, 380, 285, 0.37)
"""The large window is for a projector."""


class StepControls:
    """A folder whose contents are rebuilt for every step.

    Args:
        change: changes widgets in another thread; see `RebuildThread.change`.

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
        self.is_empty = not has_controls(scene)
        with self._tab:
            self._folder = self._gui.add_folder(self._words("lesson.controls"))
        with self._folder:
            self._parts = self._build(scene, first)

    def _setup_of(self, snapshot: PageSnapshot) -> StepSetup:
        """Set-up of the open step."""
        view = LessonView(self._course, self._words, snapshot.lesson)
        return NO_SETUP if view.ended else view.setup


class StepPlot:
    """A window over the scene with the open step's plot, in view together with the step's text.

    Args:
        build: adds the plot of a set-up, if it has one; the last argument is its height, [px].
        change: changes widgets in another thread; see `RebuildThread.change`.
        on_change: called when the window appears or disappears.
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
        self._size = LARGE_WINDOW if first.key.presenting else WINDOW
        self._setup = self._setup_of(first)
        self._open(first)

    @property
    def share(self) -> float:
        """Share of the scene's height that the window covers, from below."""
        return 0.0 if self._panel is None else self._size.share

    def follow(self, snapshot: PageSnapshot) -> None:
        """Show the open step's plot."""
        setup = self._setup_of(snapshot)
        if setup != self._setup:
            self._setup, self._parts = setup, []
            self._change(lambda: self._open(snapshot))
        for part in self._parts:
            part.follow(snapshot)

    def _open(self, first: PageSnapshot) -> None:
        """Close the window, and open a new one if the step has a plot."""
        was_open, self._parts = self._panel is not None, []
        if self._panel is not None:
            self._panel.remove()
            self._panel = None
        if has_window(self._setup):
            panel = self._gui.add_panel()
            with panel.add_tab(self._words("lesson.plot"), viser.Icon.CHART_LINE):
                self._gui.add_html(render("panel/step_plot.html"))
                self._parts = self._build(self._setup, first, self._size.plot)
            panel.float(x=GAP, y=-GAP, width=self._size.width, height=self._size.height)
            self._panel = panel
        if was_open != (self._panel is not None):
            self._on_change()

    def _setup_of(self, snapshot: PageSnapshot) -> StepSetup:
        view = LessonView(self._course, self._words, snapshot.lesson)
        return StepSetup() if view.ended else view.setup


def has_controls(setup: StepSetup) -> bool:
    """Whether a step has controls besides those of the strip."""
    return bool(set(setup.controls) - set(IN_STRIP))
