"""Widgets to draw a prediction: a board in the scene, and sliders instead of the mouse."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import viser

from onpath.app.page import lesson_html as page
from onpath.app.page.lesson_view import LessonView
from onpath.app.page.panels.widgets import on_user_update
from onpath.app.scene.scene import Scene
from onpath.lessons.schema import Sketch
from onpath.lessons.sides import robot_names

NUMBERS = 6  # sliders that draw a sketch

Drawn = Callable[[np.ndarray, np.ndarray], None]
"""Receives the times [s] and the values of a sketch."""


class SketchAnswer:
    """The board and the sliders, added to the open container."""

    def __init__(
        self, client: viser.ClientHandle, scene: Scene, block: Sketch, run: LessonView, drawn: Drawn
    ) -> None:
        from onpath.app.scene.strokes.sketch_board import (
            SketchBoard,  # see app/server/warm_up.py
        )

        self._scene, words = scene, run.words
        robot = robot_names(run.laws_shown, words)[block.robot]
        title = f"{robot}: {words(f'quantity.{block.quantity}')}"
        scene.show_robots(False)
        self._board = SketchBoard(client.scene, scene.stage, block, title=title, on_drawn=drawn)
        self._folder = client.gui.add_folder(words("lesson.numbers"), expand_by_default=False)
        with self._folder:
            self._add_numbers(client.gui, block, run, drawn)

    def draw(self) -> None:
        """Show the part of the stroke that has been drawn."""
        self._board.draw()

    def remove(self) -> None:
        """Remove the board and the sliders."""
        self._board.remove()
        self._folder.remove()
        self._scene.show_robots(True)

    def _add_numbers(self, gui: viser.GuiApi, block: Sketch, run: LessonView, drawn: Drawn) -> None:
        times = np.linspace(0.0, block.seconds, NUMBERS)
        sliders: list[Any] = []

        def moved(_: object) -> None:
            values = np.array([slider.value for slider in sliders], dtype=float)
            self._board.show(times, values)
            drawn(times, values)

        for time in times:
            unit = page.QUANTITIES[block.quantity]
            label = run.words("lesson.at", time=f"{time:g}", unit=unit)
            step = (block.top - block.bottom) / 100
            slider = gui.add_slider(label, block.bottom, block.top, step, block.bottom)
            on_user_update(slider, moved)
            sliders.append(slider)
