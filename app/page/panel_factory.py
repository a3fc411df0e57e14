"""The panels on the right: all of them, or only those that a lesson's step uses."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import viser

from onpath.app.common.background import Submit
from onpath.app.exports.exporter import Exporter
from onpath.app.exports.path_upload import PathReader
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.page.page_context import PageContext
from onpath.app.page.panels.compare_panel import ComparePanel
from onpath.app.page.panels.export_folder import add_exports
from onpath.app.page.panels.flexible_panel import FlexiblePanel
from onpath.app.page.panels.gains_panel import GainsPanel, add_identify
from onpath.app.page.panels.keep_panel import KeepPanel
from onpath.app.page.panels.law_panel import LawPanel
from onpath.app.page.panels.path_panel import PathChoice, PathPanel
from onpath.app.page.panels.robot_panel import RobotPanel
from onpath.app.page.panels.show_panel import ShowPanel
from onpath.app.page.panels.start_panel import StartPanel
from onpath.app.page.panels.wall_panel import WallPanel
from onpath.app.page.panels.widgets import ParameterWidgets, Post, on_press
from onpath.app.scene.build_queue import one_at_a_time
from onpath.app.scene.overlays import Overlays
from onpath.app.scene.scene import Scene
from onpath.lessons.action_schema import StepSetup
from onpath.lessons.vocabulary.names import CONTROLS
from onpath.lessons.words import Words
from onpath.models.systems.catalogue import ROBOTS

FREE = (
    "hold_direction",
    "robot",
    "laws",
    "path",
    "flexible",
    "gains",
    "editor",
    "wall",
    "start",
    "show",
    "compare",
    "export",
    "keep",
    "copy",
)
IN_STRIP = ("hold", "past", "plots")
"""Controls of a lesson's step that the strip has; see assets/web/pages/lab.ts."""


class Part(Protocol):
    """A part of the page that shows the state of a lab."""

    def follow(self, snapshot: PageSnapshot) -> None:
        """Show a snapshot."""
        ...


class PanelFactory:
    """Makes panels for one client.

    Args:
        submit: runs a function in another thread.
        scene: target of drawing, pulling and shading.
        overlays: the optional drawings in the scene.
        reset_view: resets the camera.
        draw: begins to draw a path with the mouse, or ends it.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        words: Words,
        post: Post,
        exporter: Exporter,
        files: PathReader,
        submit: Submit,
        scene: Scene,
        overlays: Overlays,
        context: PageContext,
        reset_view: Callable[[], None],
        draw: Callable[[], None],
    ) -> None:
        self._reset_view, self._overlays, self._draw = reset_view, overlays, draw
        self._gui, self._words, self._post = gui, words, post
        self._exporter, self._submit = exporter, submit
        self._scene, self._context = scene, context
        self._files = files

    def beside_strip(self, first: PageSnapshot) -> list[Part]:
        """Build all panels except those that the strip replaces; see assets/web/pages/lab.ts."""
        self._add_view()
        return [part for name in FREE for part in self._add(name, first)]

    def _add_view(self) -> None:
        text, icon = self._words("run.view"), viser.Icon.ZOOM_RESET
        on_press(self._gui.add_button(text, color="gray", icon=icon), self._reset_view)

    def of_step(self, scene: StepSetup, first: PageSnapshot) -> list[Part]:
        """Build the controls of a lesson's step."""
        return self._add_sliders(scene, first) + self._add_others(scene, first)

    def _add_sliders(self, scene: StepSetup, first: PageSnapshot) -> list[Part]:
        names = [name for name in scene.controls if name in first.values and name not in CONTROLS]
        return [self._settings(names, first)] if names else []

    def _settings(self, names: list[str], first: PageSnapshot) -> Part:
        return ParameterWidgets(self._gui, self._words, self._post, names=names, first=first)

    def _add_others(self, scene: StepSetup, first: PageSnapshot) -> list[Part]:
        names = [name for name in scene.controls if name in CONTROLS and name not in IN_STRIP]
        return [part for name in names for part in self._add(name, first, True)]

    def show(self) -> Part:
        """Build the folder "Show" alone, open."""
        return ShowPanel(self._gui, self._words, self._overlays, expanded=True)

    def _add(self, name: str, first: PageSnapshot, expanded: bool = False) -> list[Part]:
        """Build a panel.

        Args:
            expanded: whether its folder is open at first, as when a lesson's step names the panel.
        """
        gui, words, post, exporter = self._gui, self._words, self._post, self._exporter
        switches = self._overlays.switches
        make: dict[str, Callable[[], Part | None]] = {
            "path": lambda: PathChoice(gui, words, post, first),
            "editor": lambda: self._editor(first, expanded),
            "gains": lambda: GainsPanel(gui, words, post, first),
            "compare": lambda: ComparePanel(gui, words, first, exporter.compare),
            "export": lambda: _silent(add_exports(gui, words, exporter)),
            "keep": lambda: KeepPanel(gui, words, post, exporter=exporter, context=self._context),
            "robot": lambda: _silent(RobotPanel(gui, words, post, first.key.robot)),
            "laws": lambda: LawPanel(gui, words, post, first),
            "flexible": lambda: self._flexible(first),
            "show": lambda: ShowPanel(gui, words, self._overlays),
            "wall": lambda: WallPanel(gui, words, post, first),
            "start": lambda: StartPanel(gui, words, post, first=first, switches=switches),
            "identify": lambda: _silent(add_identify(gui, words, post)),
        }
        part = make[name]() if name in make else self._settings([name], first)
        one_at_a_time.rest()
        return [] if part is None else [part]

    def _editor(self, first: PageSnapshot, expanded: bool) -> Part:
        with self._gui.add_folder(self._words("controls.editor"), expand_by_default=expanded):
            return PathPanel(
                self._gui,
                self._words,
                self._post,
                first=first,
                draw=self._draw,
                switches=self._overlays.switches,
                files=self._files,
            )

    def _flexible(self, first: PageSnapshot) -> Part | None:
        link = ROBOTS[first.key.robot].flexible_link
        if link is None:
            return None

        def choose(name: str) -> None:
            self._scene.mouse.pull = name

        return FlexiblePanel(
            gui=self._gui,
            words=self._words,
            post=self._post,
            first=first,
            link=link,
            pulls=list(self._scene.stage.pulls),
            choose_pull=choose,
            submit=self._submit,
        )


def _silent(_: object) -> None:
    """A part that ignores snapshots."""
