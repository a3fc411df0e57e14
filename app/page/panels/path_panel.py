"""The path: presets, freehand drawing, control points by mouse or keyboard, undo and redo."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import viser

from onpath.app.channel.file_inbox import MOST_BYTES
from onpath.app.exports.path_upload import PathReader, Upload
from onpath.app.lab import commands as c
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot, parameters_of, robot_of
from onpath.app.page.panels.widgets import (
    LabValue,
    ParameterWidgets,
    Post,
    add_buttons,
    note,
    on_press,
    on_user_update,
    put,
    put_number,
    refused,
)
from onpath.app.view.paths import remark_on
from onpath.app.viser_adapter.file_uploads import take_files
from onpath.lessons.labels import parameter_heading, parameter_help, path_label
from onpath.lessons.words import Words
from onpath.models.control.rank_test import rank_map
from onpath.models.control.settable import specs
from onpath.models.errors import Message
from onpath.models.path_files.placing import RADIUS, ROUND, SMOOTH, Placing
from onpath.models.paths.frames import SlantedPlane
from onpath.models.paths.path_design import presets
from onpath.models.systems.catalogue import ROBOTS


class PathChoice:
    """Selects the preset path and, for robots that follow space curves, how far it rises."""

    def __init__(self, gui: viser.GuiApi, words: Words, post: Post, first: PageSnapshot) -> None:
        self._shown = {name: path_label(name, words) for name in presets()}
        if isinstance(robot_of(first).frame, SlantedPlane):
            self._shown["circle"] = words("design.slanted_circle")
        self._custom = words("design.own")
        for name in presets():
            if key := remark_on(name, robot_of(first)):
                self._shown[name] = words(key, path=self._shown[name])
        self._names = {shown: name for name, shown in self._shown.items()}
        self._choice = gui.add_dropdown(
            words("design.path"),
            self._options(first),
            initial_value=self._shown.get(first.edit.name, self._custom),
            hint=words("design.path_hint"),
        )
        self._name = LabValue(post)
        on_user_update(self._choice, self._choose)
        rises = ["rise"] if "rise" in first.parameters else []
        self._rise = ParameterWidgets(gui, words, post, names=rises, first=first)

    def follow(self, snapshot: PageSnapshot) -> None:
        """Show the current preset and rise."""
        self._rise.follow(snapshot)
        name = snapshot.edit.name
        if self._name.is_new(name):
            shown = self._shown.get(name, self._custom)
            put(self._choice, options=self._options(snapshot), value=shown)

    def _choose(self, shown: str) -> None:
        if shown in self._names:  # and not the user's own path, which is followed already
            self._name.change(c.ChoosePath(self._names[shown]))

    def _options(self, snapshot: PageSnapshot) -> tuple[str, ...]:
        """The presets, and an entry for the user's own path while there is one."""
        presets = tuple(self._shown.values())
        return presets if snapshot.edit.name in self._shown else (*presets, self._custom)


class PathPanel:
    """All other controls of the path."""

    def __init__(
        self,
        gui: viser.GuiApi,
        words: Words,
        post: Post,
        first: PageSnapshot,
        draw: Callable[[], None],
        switches: set[str],
        files: PathReader,
    ) -> None:
        self._version, self._words, self._latest = -1, words, first
        self._plane: dict[str, viser.GuiInputHandle[float]] = {}
        frame = robot_of(first).frame
        planar = frame.p == 2
        if isinstance(frame, SlantedPlane):
            self._add_plane(gui, post, first)
        drawing = gui.add_button(
            words("design.draw"),
            color="gray",
            icon=viser.Icon.PENCIL,
            hint=words("design.draw_hint"),
        )
        on_press(drawing, draw)
        self._add_files(gui, post, files, first)
        undoing = {words("design.undo"): c.Undo(), words("design.redo"): c.Redo()}
        add_buttons(gui, words("design.edit"), undoing, post)
        adding = {words("design.add"): c.AddPoint(), words("design.remove"): c.RemovePoint()}
        add_buttons(gui, words("design.point"), adding, post)
        first_axis, second_axis = robot_of(first).frame.axes
        self._add_coordinates(gui, post, (f"y{first_axis}", f"y{second_axis}"))
        gui.add_markdown(words("design.arrows"))
        self._sampled: np.ndarray | None = None
        self._rank = gui.add_markdown("")
        zone = gui.add_checkbox(
            words("design.zone"), "zone" in switches, hint=words("design.zone_hint")
        )
        zone.visible = planar  # the zone is drawn about the base pivot in the robot's plane
        on_user_update(zone, lambda on: (switches.add if on else switches.discard)("zone"))

    def _add_plane(self, gui: viser.GuiApi, post: Post, first: PageSnapshot) -> None:
        """Add number inputs for the plane of eq. (23); a change of the plane rebuilds the page."""
        known, words = specs(ROBOTS[first.key.robot].parameters), self._words
        gui.add_markdown(words("design.slanted"))
        for name in ("b", "d", "centre"):
            spec = known[name]
            box = gui.add_number(
                parameter_heading(name, spec, words),
                float(first.parameters[name]),
                min=spec.low,
                max=spec.high,
                step=spec.step,
                hint=parameter_help(name, spec, words),
            )
            on_user_update(box, lambda value, name=name: post(c.Set(name, value)))
            self._plane[name] = box

    def _add_files(
        self, gui: viser.GuiApi, post: Post, files: PathReader, first: PageSnapshot
    ) -> None:
        """Add a button that takes a file with a path, and how the path is made of it."""
        words, key = self._words, first.key
        with gui.add_folder(words("design.files"), expand_by_default=False):
            size = gui.add_number(
                words("design.size"), 100.0, min=0, max=400, step=5, hint=words("design.size_hint")
            )
            radius = gui.add_number(
                words("design.radius"),
                0.0,
                min=0,
                max=100,
                step=1,
                hint=words("design.radius_hint"),
            )
            opened = gui.add_checkbox(words("design.open"), False, hint=words("design.open_hint"))
            button = gui.add_upload_button(
                words("design.upload"),
                color="gray",
                icon=viser.Icon.UPLOAD,
                hint=words("design.upload_hint", most=f"{MOST_BYTES / 1e6:g}"),
            )
            said = gui.add_html("")

        def refuse(reason: Exception | Message) -> None:
            said.content = refused(words.sentence(reason))

        def follow(command: c.FollowCurve) -> None:
            said.content = ""
            post(command)

        def take(name: str, content: bytes) -> None:
            said.content = note(words("design.reading"))
            placing = Placing(
                fit=size.value / 1e3 or None,
                corners=ROUND if radius.value else SMOOTH,
                radius=radius.value / 1e3 or RADIUS,
                closed=False if opened.value else None,
            )
            upload = Upload(
                name=name,
                content=content,
                placing=placing,
                robot=key.robot,
                parameters=parameters_of(self._latest),
            )
            files.read(upload, words.language, follow, refuse)

        take_files(button, take, refuse)

    def _add_coordinates(self, gui: viser.GuiApi, post: Post, names: tuple[str, str]) -> None:
        """Add number inputs for the selected point's coordinates."""
        words = self._words
        self._which = gui.add_number(
            words("design.selected"), 0.0, min=0, max=24, step=1, hint=words("design.selected_hint")
        )
        self._first, self._second = (
            gui.add_number(
                words("design.coordinate", name=name),
                0.0,
                min=-200.0,
                max=200.0,
                step=0.5,
                visible=False,
            )
            for name in names
        )
        on_user_update(self._which, lambda n: post(c.SelectPoint(int(n) - 1 if n else None)))
        on_user_update(self._first, lambda mm: post(c.PlacePoint(first=mm / 1e3)))
        on_user_update(self._second, lambda mm: post(c.PlacePoint(second=mm / 1e3)))

    def follow(self, snapshot: PageSnapshot) -> None:
        """Show the selected point's coordinates, if one is selected."""
        self._latest = snapshot
        for name, box in self._plane.items():  # a refused value goes back
            put(box, value=float(snapshot.parameters[name]))
        edit = snapshot.edit
        if edit.version == self._version:
            return
        self._version = edit.version
        if edit.sampled is not self._sampled:
            self._sampled = edit.sampled
            ranks = rank_map(robot_of(snapshot), parameters_of(snapshot), edit.sampled)
            self._rank.content = self._words("design.rank", number=f"{float(np.min(ranks)):.2f}")
        selected = edit.selected
        put(self._which, value=0 if selected is None else selected + 1)
        for coordinate in (self._first, self._second):
            put(coordinate, visible=selected is not None)
        if selected is not None and selected < len(edit.points):
            z = edit.points[selected] * 1e3
            put_number(self._first, float(z[0]))
            put_number(self._second, float(z[1]))
