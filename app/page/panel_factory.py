"""The panels on the right: all of them, or only those that a lesson's step speaks of."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import viser

from onpath.app.exports.exporter import Exporter
from onpath.app.lab import commands as c
from onpath.app.lab.session import Session
from onpath.app.page.page_context import PageContext
from onpath.app.page.panels.flexible_panel import FlexiblePanel
from onpath.app.page.panels.gains_panel import GainsPanel, add_identify
from onpath.app.page.panels.keep_panel import KeepPanel
from onpath.app.page.panels.keys import help_text
from onpath.app.page.panels.past_panel import PastPanel
from onpath.app.page.panels.path_panel import PathChoice, PathPanel
from onpath.app.page.panels.robot_panel import RobotPanel
from onpath.app.page.panels.run_panel import RunPanel
from onpath.app.page.panels.widgets import ParameterWidgets, Post, on_press, on_user_update
from onpath.app.page.plots import MORE, LivePlot, MorePlots
from onpath.app.scene.scene import Scene
from onpath.app.scene.stage_catalogue import stage_of
from onpath.lessons.schema import StepSetup
from onpath.models.systems.flexible_robot import FlexibleParameters
from onpath.models.systems.parameters import specs

ALL = (
    *("robot", "hold", "path", "flexible", "gains", "editor", "plots", "past", "keep"),
    "copy",
)


class Part(Protocol):
    """Something on the page that follows the session."""

    def follow(self, session: Session) -> None:
        """Show what is."""
        ...


class PanelFactory:
    """Makes panels for one client.

    Args:
        submit: runs something in another thread.
        scene: what drawing, pulling and shading act on.
        reset_view: puts the camera back.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        session: Session,
        post: Post,
        exporter: Exporter,
        submit: Callable[[Callable[[], None]], None],
        scene: Scene,
        desk: PageContext,
        reset_view: Callable[[], None],
    ) -> None:
        self._reset_view = reset_view
        self._gui, self._session, self._post = gui, session, post
        self._words = session.lessons.words
        self._exporter, self._submit = exporter, submit
        self._scene, self._desk = scene, desk

    def everything(self) -> list[Part]:
        """All there is."""
        parts = [part for name in ALL for part in self._add(name)]
        helping = self._gui.add_button(self._words("controls.help"), icon=viser.Icon.HELP)
        on_press(helping, self._help)
        return parts

    def of_step(self, scene: StepSetup) -> list[Part]:
        """Run and hold, and what a lesson's scene names."""
        self._scene.path_first = "editor" in scene.controls
        parts = list(self._add("hold"))
        known = specs(self._session.parameters)
        parameters = [name for name in scene.controls if name in known]
        if parameters:
            parts.append(_Numbers(self._gui, self._session, parameters, self._post))
        for name in scene.controls:
            if name not in known and name != "hold":
                parts += self._add(name)
        if scene.plot:
            plot = MORE[scene.plot]
            if plot.field in dict(self._session.sample_layout.fields):
                parts.append(LivePlot(self._gui, self._session, plot, height=200))
        return parts

    def _add(self, name: str) -> list[Part]:
        gui, session, post = self._gui, self._session, self._post
        make: dict[str, Callable[[], Part | None]] = {
            "hold": lambda: RunPanel(gui, session, post, self._reset_view),
            "path": lambda: PathChoice(gui, session, post),
            "editor": self._editor,
            "gains": lambda: GainsPanel(gui, session, post),
            "plots": lambda: MorePlots(gui, session),
            "past": lambda: PastPanel(gui, session, post, self._exporter),
            "keep": lambda: KeepPanel(gui, session, post, self._exporter, self._desk),
            "robot": lambda: _silent(RobotPanel(gui, session, post)),
            "copy": self._copy,
            "flexible": self._flexible,
            "identify": lambda: _silent(add_identify(gui, session, post)),
        }
        part = make[name]()
        return [] if part is None else [part]

    def _editor(self) -> Part:
        def draw() -> None:
            self._scene.begin_freehand(lambda stroke: self._post(c.DrawPath(stroke)))

        def shade(visible: bool) -> None:
            self._scene.show_singular_zone(0.0, 0.4, 0.02, visible)

        with self._gui.add_folder(self._words("controls.editor"), expand_by_default=False):
            return PathPanel(self._gui, self._session, self._post, draw, shade)

    def _flexible(self) -> Part | None:
        if not isinstance(self._session.parameters, FlexibleParameters):
            return None

        def choose(name: str) -> None:
            self._scene.pull = name

        pulls = list(stage_of(self._session.robot).pulls)
        return FlexiblePanel(self._gui, self._session, self._post, pulls, choose, self._submit)

    def _copy(self) -> None:
        copy = self._gui.add_checkbox(
            self._words("controls.copy"),
            self._session.copy,
            hint=self._words("controls.copy_hint"),
        )
        on_user_update(copy, lambda on: self._post(c.SetCopy(on)))

    def _help(self) -> None:
        gui, words = self._gui, self._words
        escape = gui.add_command(words("help.escape"), hotkey="escape")
        with gui.add_modal(words("help.title")) as modal:
            gui.add_markdown(help_text(words))
            close = gui.add_button(words("help.close"))

        async def shut(_: object) -> None:
            escape.remove()
            modal.close()

        close.on_click(shut)
        escape.on_trigger(shut)


class _Numbers(ParameterWidgets):
    """Some parameters, as a part of the page."""

    def follow(self, session: Session) -> None:  # type: ignore[override]
        """Show the session's values."""
        super().follow(session.parameters)


def _silent(_: object) -> None:
    """A part that never changes."""
