"""The controls that the open step speaks of; others are made when another step is opened."""

from __future__ import annotations

from collections.abc import Callable

import viser

from onpath.app.lab.lab import Lab
from onpath.app.page.panel_factory import PanelFactory, Part
from onpath.lessons.schema import StepSetup


class StepControls:
    """A folder that is filled anew for every step.

    Args:
        submit: runs something in another thread.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        tab: viser.GuiTabHandle,
        lab: Lab,
        controls: PanelFactory,
        submit: Callable[[Callable[[], None]], None],
    ) -> None:
        self._gui, self._controls, self._submit = gui, controls, submit
        self._tab, self._title = tab, lab.words("lesson.controls")
        self._folder: viser.GuiFolderHandle | None = None
        self._scene: StepSetup | None = None
        self._parts: list[Part] = []
        self._fill(_scene_of(lab))

    def follow(self, lab: Lab) -> None:
        """Show the open step's controls, and what they stand at."""
        scene = _scene_of(lab)
        if scene != self._scene:
            self._scene, self._parts = scene, []
            self._submit(lambda: self._fill(scene))
        for part in self._parts:
            part.follow(lab)

    def _fill(self, scene: StepSetup) -> None:
        if self._folder is not None:
            self._folder.remove()
        self._scene = scene
        with self._tab:
            self._folder = self._gui.add_folder(self._title)
        with self._folder:
            self._parts = self._controls.of_step(scene)


EMPTY = StepSetup()


def _scene_of(lab: Lab) -> StepSetup:
    """Of the open step."""
    run = lab.lessons
    return EMPTY if run.lesson is None else run.lesson.scene_at(run.index)
