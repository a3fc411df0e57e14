"""The wall: a switch, its position and angle as numbers, and the forces on it."""

from __future__ import annotations

import math

import viser

from onpath.app.common.palette import OF_SIDE
from onpath.app.common.templates import render
from onpath.app.lab import commands as c
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot, robot_of
from onpath.app.page.panels.widgets import LabValue, Post, on_user_update, put, put_number
from onpath.lessons.sides import side_titles
from onpath.lessons.words import Words

FARTHEST = 400.0  # [mm]


class WallPanel:
    """A folder for the wall; its numbers are visible while there is one."""

    def __init__(self, gui: viser.GuiApi, words: Words, post: Post, first: PageSnapshot) -> None:
        self._words, self._wall = words, LabValue(post)
        wall = robot_of(first).grip.wall
        hint = words(
            "wall.hint",
            stiffness=words.number(wall.stiffness / 1e3),
            most=words.number(wall.largest),
        )
        with gui.add_folder(words("wall.title"), expand_by_default=False):
            self._switch = gui.add_checkbox(words("wall.switch"), first.settings.wall, hint=hint)
            names = [f"y{axis}" for axis in robot_of(first).frame.axes]
            self._first, self._second = (
                gui.add_number(
                    words("wall.place", name=name), 0.0, min=-FARTHEST, max=FARTHEST, step=1.0
                )
                for name in names
            )
            self._angle = gui.add_number(
                words("wall.angle"),
                0.0,
                min=-180.0,
                max=180.0,
                step=5.0,
                hint=words("wall.angle_hint"),
            )
            self._forces = gui.add_html("")
        self._numbers = self._first, self._second, self._angle
        change = self._wall.change
        on_user_update(self._switch, lambda on: change(c.Set("wall", on)))
        on_user_update(self._first, lambda mm: change(c.Set("wall_z1", mm / 1e3)))
        on_user_update(self._second, lambda mm: change(c.Set("wall_z2", mm / 1e3)))
        on_user_update(self._angle, lambda d: change(c.Set("wall_angle", math.radians(d))))
        self._show_rest(first.settings.wall)
        self.follow(first)

    def follow(self, snapshot: PageSnapshot) -> None:
        """Show the lab's wall."""
        wall, forces = snapshot.settings.obstacle, snapshot.wall_forces
        if not self._wall.is_new((wall, forces)):
            return
        put(self._switch, value=wall is not None)
        self._show_rest(wall is not None)
        if wall is None:
            return
        put_number(self._first, wall.z1 * 1e3)
        put_number(self._second, wall.z2 * 1e3)
        put_number(self._angle, math.degrees(wall.angle))
        titles = side_titles(snapshot.laws, self._words)
        rows = [
            (OF_SIDE[side].hex, titles[side], self._words.written(f"{force:.1f}"))
            for side, force in forces.items()
        ]
        content = render("panel/forces.html", title=self._words("wall.forces"), forces=rows)
        put(self._forces, content=content)

    def _show_rest(self, visible: bool) -> None:
        for handle in (*self._numbers, self._forces):
            put(handle, visible=visible)
