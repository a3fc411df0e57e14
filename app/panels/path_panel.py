"""The path: presets, freehand, control points with their keyboard twins, undo and redo."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import viser

from app import commands as c
from app.panels.widgets import Post, on_press, on_user_update
from app.session import Session
from models.rank_test import rank_map

EDITED = "(own)"


class PathChoice:
    """The preset in use; one of the first controls a user sees."""

    def __init__(self, gui: viser.GuiApi, session: Session, post: Post) -> None:
        self._choice = gui.add_dropdown(
            "Path",
            [*session.presets, EDITED],
            initial_value="circle",
            hint="Both robots follow it. Drag its points in the scene to bend it.",
        )
        on_user_update(
            self._choice, lambda name: post(c.ChoosePath(name)) if name != EDITED else None
        )

    def follow(self, session: Session) -> None:
        """Show which one it is."""
        name = session.editor.design.name
        shown = name if name in session.presets else EDITED
        if self._choice.value != shown:
            self._choice.value = shown


class PathPanel:
    """Everything else about the path."""

    def __init__(
        self,
        gui: viser.GuiApi,
        session: Session,
        post: Post,
        draw: Callable[[], None],
        show_zone: Callable[[bool], None],
    ) -> None:
        self._version = -1
        planar = session.robot.frame.p == 2
        first, second = ("y1", "y2") if planar else ("y2", "y3")
        drawing = gui.add_button(
            "Draw freehand",
            icon=viser.Icon.PENCIL,
            hint="Then draw one stroke around a robot with the mouse.",
        )
        on_press(drawing, draw)
        edit = gui.add_button_group("Edit", ["Undo", "Redo"])
        on_press(edit, lambda: post(c.Undo() if edit.value == "Undo" else c.Redo()))
        points = gui.add_button_group("Point", ["Add", "Remove"])
        on_press(points, lambda: post(c.AddPoint() if points.value == "Add" else c.RemovePoint()))
        self._which = gui.add_number(
            "Selected", 0.0, min=0, max=24, step=1, hint="Number of the control point; 0: none"
        )
        self._first = gui.add_number(f"{first} [mm]", 0.0, min=-200.0, max=200.0, step=0.5)
        self._second = gui.add_number(f"{second} [mm]", 0.0, min=-200.0, max=200.0, step=0.5)
        on_user_update(self._which, lambda n: post(c.SelectPoint(int(n) - 1 if n else None)))
        on_user_update(self._first, lambda mm: post(c.PlacePoint(first=mm / 1e3)))
        on_user_update(self._second, lambda mm: post(c.PlacePoint(second=mm / 1e3)))
        gui.add_markdown("Arrow keys move the selected point by 1 mm; N selects the next.")
        self._design: object = None
        self._rank = gui.add_markdown("")
        zone = gui.add_checkbox(
            "Show singular zone", False, hint="Where the arm is stretched or folded, eq. (14)"
        )
        zone.visible = planar  # it is drawn about the base pivot, in the robot's own plane
        on_user_update(zone, show_zone)

    def follow(self, session: Session) -> None:
        """Show the selected point's coordinates."""
        editor = session.editor
        if editor.version == self._version:
            return
        self._version = editor.version
        if editor.design is not self._design:
            self._design = editor.design
            z = editor.design.curve.at(editor.design.curve.sample(32))
            number = float(np.min(rank_map(session.robot, session.parameters, z)))
            self._rank.content = f"Rank test (11) along the path: at least **{number:.2f}** of 1."
        selected = editor.selected
        self._set(self._which, 0 if selected is None else selected + 1)
        if selected is not None and selected < len(editor.points()):
            z = editor.points()[selected] * 1e3
            self._set(self._first, round(float(z[0]), 1))
            self._set(self._second, round(float(z[1]), 1))

    @staticmethod
    def _set(handle: viser.GuiInputHandle[float], value: float) -> None:
        if handle.value != value:
            handle.value = value
