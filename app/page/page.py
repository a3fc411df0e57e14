"""One browser tab: scene, panels and plots around one session."""

from __future__ import annotations

from collections.abc import Callable

import viser

from onpath.app.exports.exporter import Exporter
from onpath.app.lab import commands as c
from onpath.app.lab.session import Session
from onpath.app.lab.take_snapshot import take_snapshot
from onpath.app.page.build_queue import one_at_a_time
from onpath.app.page.lesson_menu import LessonMenu
from onpath.app.page.lesson_panel import LessonPanel
from onpath.app.page.page_context import PageContext
from onpath.app.page.panel_factory import PanelFactory, Part
from onpath.app.page.panels.class_panel import ClassPanel
from onpath.app.page.panels.keys import add_keys
from onpath.app.page.panels.readout import Readout
from onpath.app.page.plots import DISTANCE, LivePlot
from onpath.app.page.rebuild_thread import RebuildThread
from onpath.app.page.step_controls import StepControls
from onpath.app.scene.scene import Scene, SceneCallbacks
from onpath.app.scene.stage import NARROW, Insets
from onpath.app.scene.stage_catalogue import stage_of
from onpath.app.simulation.display_rate import STRIDES, is_turn
from onpath.app.viser_adapter.frame_channel import FrameChannel

WIDE_SHEET = """<style>@media (max-width:36em){
.mantine-Paper-root[style*="bottom: 0"],
.mantine-Paper-root[style*="bottom: 0"] [style*="width: 20em"]{width:100%!important}}</style>"""
"""On a telephone viser's sheet is no wider than on a desk, and leaves a gap beside it."""
AT_EASE = STRIDES[0]  # the stride of a thread that has time
SLOW, SLOWER = 6, 12  # frames or so per update of traces, plots, readouts: 10 Hz, 5 of many labs
SETTLING = 30  # slow updates after the page is built
CONTROL_WIDTH = 330  # [px]


class Page:
    """What one client sees. Built in a thread of its own, then used by the simulation thread."""

    def __init__(self, client: viser.ClientHandle, session: Session, desk: PageContext) -> None:
        self._client = client
        self._desk = desk
        self._channel = FrameChannel(client)
        self._offset = client.client_id  # spreads the clients' slow updates over the frames
        self._exporter, self._rebuilds = Exporter(client), RebuildThread()
        self._framed, self._settling = 0.0, SETTLING
        self._shown: tuple[object, ...] = ()
        client.gui.configure_theme(
            show_logo=False, show_share_button=False, brand_color=(0, 114, 178)
        )
        client.gui.set_panel_label("OnPath")
        if not self._is_narrow():
            client.gui.main_panel.dock_right()
            client.gui.main_panel.set_width(CONTROL_WIDTH)
        with one_at_a_time:
            self._build(session)

    def close(self) -> None:
        """The tab is gone."""
        self._exporter.close()
        self._rebuilds.close()

    def show(self, session: Session, achieved: float, frame: int, stride: float) -> None:
        """See `app.simulation.simulation_thread.Display`."""
        count = frame + self._offset
        if session.grips.grabbed and stride == AT_EASE:
            stride = 1.0  # the hand feels every frame of delay
        if not is_turn(count, stride) or self._robot is None or self._channel.closed:
            return
        if self._page(session) != self._built:
            self._robot = None  # nothing is shown until the new one stands
            self._rebuilds.submit(lambda: self._rebuild(session))
            return
        with self._channel:
            every = stride * round((SLOW if stride <= AT_EASE else SLOWER) / stride)
            self._show(session, achieved, slow=is_turn(count, every))

    def reset_view(self) -> None:
        """Put the camera back where it was at first, soon; from any thread."""
        self._framed = 0.0

    def send(self) -> None:
        """See `app.simulation.simulation_thread.Display`."""
        self._channel.send()

    @property
    def told(self) -> int:
        """See `app.server.tab_visibility.CountingDisplay`."""
        return self._channel.frames

    def _show(self, session: Session, achieved: float, slow: bool) -> None:
        shown = session.instant(), session.viewing, session.editor.version, session.exaggeration
        if shown == self._shown and not slow:
            return
        self._shown = shown
        snapshot = take_snapshot(session, achieved, traces=slow)
        self._scene.update(snapshot)
        self._scene.update_path(snapshot)
        if slow:
            self._scene.update_traces(snapshot)
            self._frame_camera()
            for part in self._parts:
                part.follow(session)
            self._readout.follow(snapshot)
            self._exporter.serve(session)

    def _rebuild(self, session: Session) -> None:
        with one_at_a_time:
            self._client.scene.reset()
            self._client.gui.reset()
            self._framed, self._settling = 0.0, SETTLING
            self._build(session)

    def _page(self, session: Session) -> tuple[object, ...]:
        """What the whole page depends on: when it is another, all is built anew."""
        run = session.lessons
        return session.robot, run.lesson is not None, run.words.language, run.progress.presenting

    def _poster(self, session: Session) -> Callable[[c.Command], None]:
        """What takes the commands of this page."""
        return session.post

    def _build(self, session: Session) -> None:
        robot, post = session.robot, self._poster(session)
        self._built = self._page(session)
        words = session.lessons.words
        self._scene = Scene(self._client, _hooks(post), stage_of(robot), words)
        self._scene.build(take_snapshot(session, 1.0))
        self._build_panels(session, post)
        add_keys(self._client.gui, words, post, self.reset_view)
        self._robot = robot

    def _build_panels(self, session: Session, post: Callable[[c.Command], None]) -> None:
        gui, run = self._client.gui, session.lessons
        self._client.gui.add_html(WIDE_SHEET)
        self._parts: list[Part] = []
        controls = self._controls(session, post)
        if run.lesson is None:
            self._build_head(session, post)
            self._parts += controls.everything()
            return
        submit, words = self._rebuilds.submit, run.words
        tab = None
        if self._is_narrow():  # one panel for all: the lesson first, the lab behind its tab
            tabs = gui.add_tab_group()
            tab = tabs.add_tab(words("lesson.lessons"), viser.Icon.SCHOOL)
            own = tabs.add_tab(words("lesson.lab"), viser.Icon.ROBOT)
            with own:
                self._build_head(session, post)
        else:
            self._build_head(session, post)
            tabs = gui.add_tab_group()
            own = tabs.add_tab(words("lesson.this_step"), viser.Icon.ADJUSTMENTS)
        self._parts.append(StepControls(gui, own, session, controls, submit))
        if not run.progress.presenting:
            with tabs.add_tab(words("lesson.all_controls"), viser.Icon.ADJUSTMENTS_HORIZONTAL):
                self._parts += controls.everything()
        self._parts.append(LessonPanel(self._client, session, post, self._scene, submit, tab))

    def _controls(self, session: Session, post: Callable[[c.Command], None]) -> PanelFactory:
        return PanelFactory(
            self._client.gui,
            session,
            post,
            self._exporter,
            self._rebuilds.submit,
            self._scene,
            self._desk,
            self.reset_view,
        )

    def _build_head(self, session: Session, post: Callable[[c.Command], None]) -> None:
        """What is always there: numbers, the way to the lessons, the distance."""
        gui = self._client.gui
        self._build_numbers(session)
        if session.lessons.course.lessons:
            LessonMenu(gui, session, post)
        if self._desk.seat is not None:
            self._parts.append(ClassPanel(gui, session, self._desk.seat))
        self._build_distance(session)

    def _build_numbers(self, session: Session) -> None:
        self._readout = Readout(self._client.gui, session)

    def _build_distance(self, session: Session) -> None:
        """The plot that tells the story."""
        self._parts.append(LivePlot(self._client.gui, session, DISTANCE, height=190))

    def _is_narrow(self) -> bool:
        camera = self._client.camera
        return camera.image_width < NARROW * camera.image_height

    def _frame_camera(self) -> None:
        """Both robots fill the view again whenever its shape has changed.

        Not its size, in device pixels: a slow browser changes that all by itself. While panels
        settle, a browser may not tell its last shape before it is given a camera again.
        """
        if self._settling:
            self._settling -= 1
            if self._settling % 10 == 0:
                self._framed = 0.0
        camera = self._client.camera
        width, height = camera.image_width, camera.image_height
        shape = width / max(height, 1)
        if width > 0 and abs(shape - self._framed) > 0.02 * shape:
            self._framed = shape
            below = 0.6 * height if shape < NARROW else 0.0
            self._scene.frame_camera(Insets(bottom=below))


def _hooks(post: Callable[[c.Command], None]) -> SceneCallbacks:
    return SceneCallbacks(
        on_grab=lambda name, target: post(c.Grab(name, target)),
        on_release=lambda name: post(c.Release(name)),
        on_point_dragged=lambda index, at: post(c.MovePoint(index, at, finished=False)),
        on_point_drag_end=lambda _: post(c.EndMove()),
        on_point_selected=lambda index: post(c.SelectPoint(index)),
    )
