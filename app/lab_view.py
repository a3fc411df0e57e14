"""One browser tab: scene, panels and plots around one session."""

from __future__ import annotations

from collections.abc import Callable

import viser

from app import commands as c
from app.exports import Exporter
from app.loop_store import LoopStore
from app.node_update import Channel
from app.panels.flexible_panel import FlexiblePanel
from app.panels.gains_panel import GainsPanel
from app.panels.keys import add_keys, help_text
from app.panels.past_panel import PastPanel
from app.panels.path_panel import PathChoice, PathPanel
from app.panels.readout import Readout
from app.panels.robot_panel import RobotPanel
from app.panels.run_panel import RunPanel
from app.panels.widgets import on_press, on_user_update
from app.plots import DISTANCE, LivePlot, MorePlots
from app.scene import Hooks, Scene
from app.session import Session
from app.stage import Insets
from app.stages import stage_of
from app.take_snapshot import take_snapshot
from models.flexible_robot import FlexibleParameters

DISPLAY = 2  # frames of simulation per frame of display: 30 Hz
SLOW = 6  # frames per update of traces, plots and readouts: 10 Hz
CONTROL_WIDTH = 330  # [px]
NARROW = 0.75  # width to height: a telephone, where the panel lies over the lower part


class LabView:
    """What one client sees. Built in a thread of its own, then used by the simulation thread."""

    def __init__(self, client: viser.ClientHandle, session: Session, store: LoopStore) -> None:
        self._client = client
        self._channel = Channel(client)
        self._store = store
        self._offset = client.client_id  # spreads the clients' slow updates over the frames
        self._exporter = Exporter(client)
        self._framed = 0.0
        client.gui.configure_theme(
            show_logo=False, show_share_button=False, brand_color=(0, 114, 178)
        )
        client.gui.set_panel_label("OnPath")
        client.gui.main_panel.dock_right()
        client.gui.main_panel.set_width(CONTROL_WIDTH)
        self._build(session)

    def close(self) -> None:
        """The tab is gone."""
        self._exporter.close()

    def show(self, session: Session, achieved: float, frame: int) -> None:
        """See `app.loop.View`."""
        count = frame + self._offset
        if count % DISPLAY or self._robot is None or self._channel.closed:
            return
        if session.robot is not self._robot:
            self._robot = None  # nothing is shown until the new one stands
            self._exporter.submit(lambda: self._rebuild(session))
            return
        with self._channel.frame():
            self._show(session, achieved, slow=count % SLOW == 0)

    def send(self) -> None:
        """See `app.loop.View`."""
        self._channel.send()

    def _show(self, session: Session, achieved: float, slow: bool) -> None:
        snapshot = take_snapshot(session, achieved, traces=slow)
        self._scene.update(snapshot)
        self._scene.update_path(snapshot)
        if slow:
            self._scene.update_traces(snapshot)
            self._frame_camera()
            self._show_progress()
            for part in self._parts:
                part.follow(session)
            self._readout.follow(snapshot)
            self._exporter.serve(session)

    def _rebuild(self, session: Session) -> None:
        self._client.scene.reset()
        self._client.gui.reset()
        self._framed = 0.0
        robot = session.robot
        try:
            self._build(session)
        finally:
            if session.robot is not robot:  # another one meanwhile: build that
                self._robot = robot

    def _build(self, session: Session) -> None:
        robot, post = session.robot, session.post
        self._scene = Scene(self._client, _hooks(post), stage_of(robot))
        self._scene.build(take_snapshot(session, 1.0))
        self._build_panels(session, post)
        add_keys(self._client.gui, post)
        self._robot = robot

    def _build_panels(self, session: Session, post: Callable[[c.Command], None]) -> None:
        gui = self._client.gui
        self._progress = gui.add_progress_bar(0.0, visible=False, animated=True)
        self._readout = Readout(gui)
        RobotPanel(gui, session, post)
        self._parts = [
            LivePlot(gui, session, DISTANCE, height=190),
            RunPanel(gui, session, post),
            PathChoice(gui, session, post),
        ]
        if isinstance(session.parameters, FlexibleParameters):
            self._parts.append(self._flexible_panel(session, post))
        self._parts.append(GainsPanel(gui, session, post))
        with gui.add_folder("Path editor", expand_by_default=False):
            self._parts.append(PathPanel(gui, session, post, self._draw(post), self._show_zone))
        self._parts.append(MorePlots(gui, session))
        self._parts.append(PastPanel(gui, session, post, self._exporter))
        copy = gui.add_checkbox(
            "Copy to both", session.copy, hint="Hand and hold act on both robots alike"
        )
        on_user_update(copy, lambda on: post(c.SetCopy(on)))
        helping = gui.add_button("Help and keys", icon=viser.Icon.HELP)
        on_press(helping, self._help)

    def _flexible_panel(self, session: Session, post: Callable[[c.Command], None]) -> FlexiblePanel:
        pulls = list(stage_of(session.robot).pulls)

        def choose(name: str) -> None:
            self._scene.pull = name

        return FlexiblePanel(self._client.gui, session, post, pulls, choose, self._exporter.submit)

    def _draw(self, post: Callable[[c.Command], None]) -> Callable[[], None]:
        return lambda: self._scene.begin_freehand(lambda stroke: post(c.DrawPath(stroke)))

    def _show_zone(self, visible: bool) -> None:
        self._scene.show_singular_zone(0.0, 0.4, 0.02, visible)

    def _help(self) -> None:
        gui = self._client.gui
        escape = gui.add_command("Close the help window", hotkey="escape")
        with gui.add_modal("How to use the lab") as modal:
            gui.add_markdown(help_text())
            close = gui.add_button("Close")

        async def shut(_: object) -> None:
            escape.remove()
            modal.close()

        close.on_click(shut)
        escape.on_trigger(shut)

    def _show_progress(self) -> None:
        done, wanted = self._store.progress()
        busy = done < wanted
        if busy:
            self._progress.value = 100.0 * (done + 0.5) / wanted
        if self._progress.visible != busy:
            self._progress.visible = busy

    def _frame_camera(self) -> None:
        """Both robots fill the view again whenever its shape has changed.

        Not its size, in device pixels: a slow browser changes that all by itself.
        """
        camera = self._client.camera
        width, height = camera.image_width, camera.image_height
        shape = width / max(height, 1)
        if width > 0 and abs(shape - self._framed) > 0.02 * shape:
            self._framed = shape
            below = 0.6 * height if shape < NARROW else 0.0
            self._scene.frame_camera(Insets(bottom=below))


def _hooks(post: Callable[[c.Command], None]) -> Hooks:
    return Hooks(
        on_grab=lambda name, target: post(c.Grab(name, target)),
        on_release=lambda name: post(c.Release(name)),
        on_point_dragged=lambda index, at: post(c.MovePoint(index, at, finished=False)),
        on_point_drag_end=lambda _: post(c.EndMove()),
        on_point_selected=lambda index: post(c.SelectPoint(index)),
    )
