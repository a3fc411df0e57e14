"""One browser tab: the scene, panels and plots of one lab."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import viser

from onpath.app.common.palette import AZURE
from onpath.app.common.templates import render
from onpath.app.common.work_thread import WorkThread
from onpath.app.exports.exporter import Exporter, ViserDelivery
from onpath.app.exports.path_upload import PathReader
from onpath.app.lab import commands as c
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot, robot_of
from onpath.app.lab.snapshots.snapshot import Motion
from onpath.app.page.build_queue import in_turn, one_at_a_time
from onpath.app.page.lesson_menu import LessonMenu
from onpath.app.page.overlays import Overlays, Switches
from onpath.app.page.page_context import PageContext
from onpath.app.page.page_menus import PageMenus
from onpath.app.page.panel_factory import PanelFactory, Part
from onpath.app.page.panels.class_panel import ClassPanel
from onpath.app.page.panels.keys import Keys
from onpath.app.page.panels.widgets import Post
from onpath.app.page.step_controls import Build, StepControls
from onpath.app.page.step_drawings import StepDrawings
from onpath.app.scene.mouse import SceneCallbacks
from onpath.app.scene.pointer_projection import plane_coordinates
from onpath.app.scene.projection import seen_by, seen_from
from onpath.app.scene.scene import Scene
from onpath.app.scene.stage import NARROW, Insets, view_of
from onpath.app.scene.stage_catalogue import stage_of
from onpath.app.scene.tones import DARK, LIGHT
from onpath.app.view.state_message import Projection
from onpath.app.viser_adapter.frame_channel import FrameChannel
from onpath.app.viser_adapter.local_storage import ask_item
from onpath.app.viser_adapter.page_release import clear_widgets
from onpath.lessons.words import Words
from onpath.models.arrays import Array
from onpath.models.systems.robots import Robot

SETTLING = 30  # slow updates after the page is built
STANDS = 5  # of them, until the panel can be folded
CONTROL_WIDTH, LARGE_WIDTH = 330, 560  # [px], the latter for a plot on a projector
TITLES = 44.0  # [px], of the scene, that the titles of the robots take
MOST_TITLES = 0.1  # of its height
NEAR = 1e-3  # of its distance from the robots, to where a camera is put
SHAPE_KEY = "shape"
"""Where a browser keeps its window's shape; see assets/page/portrait.js."""


class Page:
    """The page of one client. Built in a separate thread, then updated by the simulation thread.

    Args:
        first: the initial snapshot.

    Attributes:
        is_outdated: whether the page must be rebuilt, for which it needs a complete snapshot.
        exporter: creates the files requested on this page.
    """

    def __init__(
        self, client: viser.ClientHandle, first: PageSnapshot, context: PageContext
    ) -> None:
        self._client = client
        self._context = context
        self._channel = FrameChannel(client)
        self.exporter, self._files = Exporter(ViserDelivery(client)), PathReader()
        self._rebuilds, self._keys = WorkThread("rebuild"), Keys(client.gui)
        self._framed, self._settling = 0.0, SETTLING
        self._switches, self._switched = Switches(), set[str]()
        self._building, self.is_outdated = True, False
        client.gui.set_panel_label("OnPath")
        self._narrow: bool | None = None  # not laid out yet
        self._low = False
        self._folded = True  # perhaps by the page before, in the same browser
        self._wants_folded = False
        self._step: StepControls | None = None
        self._wanted_narrow = self._is_narrow()
        with in_turn(), client.atomic():  # the browser gets no widget without its callbacks
            self._build(first)

    def close(self) -> None:
        """Release resources after the tab has closed."""
        self.exporter.close()
        self._rebuilds.close()
        self._keys.close()

    @property
    def is_ready(self) -> bool:
        """Whether the page is built and its client is connected."""
        return not self._building and not self._channel.closed

    def show(self, snapshot: PageSnapshot | Motion) -> None:
        """Show a snapshot. Called on the simulation thread while the page is ready."""
        is_other = self._key(snapshot) != self._built or self._dark != self._context.look.dark
        if is_other or self._wanted_narrow != self._narrow:
            self._renew(snapshot)
            return
        with self._channel:
            if isinstance(snapshot, Motion):
                self._scene.update(snapshot)
                self._overlays.update(snapshot)
                return
            motion = snapshot.motion
            self._scene.update(motion)
            self._scene.update_traces(snapshot)
            self._overlays.update(motion)
            self._overlays.follow(snapshot)
            self._scene.show_singular_zone(self._switches.zone and self._robot.frame.p == 2)
            self._scene.show_start(self._switches.start)
            self._frame_camera()
            self._follow_fold()
            for part in self._parts:
                part.follow(snapshot)

    @property
    def client(self) -> viser.ClientHandle:
        """Whose page it is."""
        return self._client

    def draw(self) -> None:
        """Take the next stroke around a robot as the path; called again, take none."""
        if self._scene.is_drawing:
            self._scene.end_freehand()
            return
        robot, post = self._robot, self._post
        self._scene.begin_freehand(
            lambda stroke: post(c.DrawPath(plane_coordinates(robot, stroke)))
        )

    @property
    def switches(self) -> Switches:
        """What the page draws besides the robots."""
        return self._switches

    def settle(self) -> None:
        """Refit the camera now and for a while, because the canvas has changed its size."""
        self._framed, self._settling = 0.0, SETTLING

    def reset_view(self) -> None:
        """Schedule a reset of the camera to its initial pose. Thread-safe."""
        self._framed = 0.0

    def send(self) -> None:
        """Send the frame to the browser."""
        self._channel.send()

    def seen(self, snapshot: PageSnapshot) -> Projection:
        """How the picture shows the robots, or how it will as soon as its camera is in place."""
        camera = self._client.camera
        if self._stands and not self.is_outdated:
            return seen_by(camera, self._scene.stage, self._robot)
        robot = robot_of(snapshot)
        stage = stage_of(robot)
        width, height = max(camera.image_width, 1), max(camera.image_height, 1)
        pose = view_of(stage, (width, height), self._insets(height))
        off, away = (np.linalg.norm(x - pose.position) for x in (camera.position, pose.look_at))
        self._stands = bool(off < NEAR * away) or not self._settling
        return seen_from(pose, stage, robot)

    def _renew(self, snapshot: PageSnapshot | Motion) -> None:
        """Rebuild the page; nothing is shown until it is complete."""
        self.is_outdated, self._stands = True, False
        if isinstance(snapshot, PageSnapshot):
            self._building = True
            self._rebuilds.submit(lambda: self._rebuild(snapshot))

    def _rebuild(self, first: PageSnapshot) -> None:
        with in_turn(), self._client.atomic():
            clear_widgets(self._client)
            self._framed, self._settling = 0.0, SETTLING
            self._build(first)

    def _change(self, work: Callable[[], None]) -> None:
        """Change widgets in another thread; the browser receives the change as a whole.

        Otherwise a user could press a widget before its callbacks are set, in vain.
        """

        def atomically() -> None:
            with self._client.atomic():
                work()

        self._rebuilds.submit(atomically)

    def _key(self, snapshot: PageSnapshot | Motion) -> tuple[object, ...]:
        """Key of everything the page layout depends on; a change triggers a rebuild."""
        return (snapshot.key,)

    def _is_folded(self, snapshot: PageSnapshot) -> bool:
        """Whether the panel makes room for the stage, as for a projector."""
        return snapshot.key.presenting

    def _words_for(self, snapshot: PageSnapshot) -> Words:
        """The page's texts."""
        return Words(snapshot.key.language)

    def _post_for(self, snapshot: PageSnapshot) -> Post:
        """The function that receives the commands of this page."""
        return self._context.post

    def _build(self, first: PageSnapshot) -> None:
        post, words, robot = self._post_for(first), self._words_for(first), robot_of(first)
        self._dark, text = self._context.look.dark, self._context.text
        self._built, self._step = self._key(first), None
        self._stands = False
        self._client.gui.configure_theme(
            show_logo=False,
            show_share_button=False,
            brand_color=AZURE.rgb,
            dark_mode=self._dark,
        )
        self._post = post
        self._lay_out(first)
        tones = DARK if self._dark else LIGHT
        stage = stage_of(robot, tones, self._context.look.plain)
        self._robot = robot
        self._scene = Scene(self._client, stage, _hooks(post, robot), words, titled=False)
        self._scene.build(first)
        one_at_a_time.rest()
        self._overlays = Overlays(
            scene=self._client.scene,
            stage=self._scene.stage,
            robot=robot,
            switches=self._switches,
            submit=self._rebuilds.submit,
            is_narrow=bool(self._narrow),
        )
        self._parts: list[Part] = []
        self._client.gui.add_html(
            render("panel/page.html", words=words, client=self._client.client_id)
        )
        self._parts.append(
            StepDrawings(self._overlays, self._context.course, words, self._switched)
        )
        self._build_panels(first, words, post)
        page_actions = {
            "view": self.reset_view,
            "summary": lambda: text.narration.ask_summary(),
            "lesson": lambda: self._open_first_lesson(post),
        }
        self._keys.renew(words, post, page_actions)
        self._building = self.is_outdated = False

    def _open_first_lesson(self, post: Post) -> None:
        """Open the first lesson, to which the invitations of the first minute lead."""
        self._context.text.end_introduction()
        post(c.OpenLesson(next(iter(self._context.course.lessons), "")))

    def _build_panels(self, first: PageSnapshot, words: Words, post: Post) -> None:
        gui = self._client.gui
        controls = self._controls(words, post)
        if not first.key.in_lesson:
            self._build_free_lab(controls, first, words, post)
            return
        self._build_navigation(first, words, post)
        tabs = gui.add_tab_group()
        step_tab = tabs.add_tab(words("lesson.this_step"), viser.Icon.ADJUSTMENTS)
        self._step = self._step_controls(step_tab, words, controls.of_step, first)
        self._parts.append(self._step)
        if not first.key.presenting:
            with tabs.add_tab(words("lesson.all_controls"), viser.Icon.ADJUSTMENTS_HORIZONTAL):
                self._parts += controls.beside_strip(first)
        else:
            with tabs.add_tab(words("show.title"), viser.Icon.EYE):
                self._parts.append(controls.show())

    def _step_controls(
        self,
        tab: viser.GuiTabHandle,
        words: Words,
        build: Build,
        first: PageSnapshot,
    ) -> StepControls:
        return StepControls(
            gui=self._client.gui,
            tab=tab,
            words=words,
            course=self._context.course,
            build=build,
            change=self._change,
            first=first,
        )

    def _build_free_lab(
        self, controls: PanelFactory, first: PageSnapshot, words: Words, post: Post
    ) -> None:
        """Build all panels; numbers, chart and the buttons for time are in the strip."""
        self._build_navigation(first, words, post)
        self._parts += controls.beside_strip(first)

    def _controls(self, words: Words, post: Post) -> PanelFactory:
        return PanelFactory(
            gui=self._client.gui,
            words=words,
            post=post,
            exporter=self.exporter,
            files=self._files,
            submit=self._rebuilds.submit,
            scene=self._scene,
            overlays=self._overlays,
            context=self._context,
            reset_view=self.reset_view,
            draw=self.draw,
        )

    def _build_navigation(self, first: PageSnapshot, words: Words, post: Post) -> None:
        """Build the menus, the lesson menu and the class panel."""
        gui = self._client.gui
        self._build_menus(first, words, post)
        if self._context.course.lessons:
            menu = LessonMenu(gui, words, post, course=self._context.course, first=first)
            self._parts.append(menu)
        if self._context.seat is not None:
            self._parts.append(ClassPanel(gui, words, self._context, first))

    def _build_menus(self, first: PageSnapshot, words: Words, post: Post) -> None:
        """Build the buttons for language, display and help."""
        preferences = self._context.text.preferences
        PageMenus(self._client.gui, words, post, first=first, preferences=preferences)

    def _lay_out(self, first: PageSnapshot) -> None:
        """Put the panel beside the scene unless the window is narrow: it is below it then."""
        panel, folds = self._client.gui.main_panel, self._is_folded(first)
        if not self._wanted_narrow:
            if self._narrow is not False:
                panel.dock_right()
            panel.set_width(LARGE_WIDTH if folds else CONTROL_WIDTH)
        self._narrow = self._wanted_narrow
        if self._folded:
            panel.expand()
        self._folded, self._wants_folded = False, folds

    def _follow_fold(self) -> None:
        """Fold the panel, or show it, once the page's script has read in it what it needs.

        It then stays until another step is opened, unless the user does otherwise; in a low window,
        where it takes the place of a lesson's text, it waits until the user opens it. A folded
        panel is not in the document; see panel/page.html.
        """
        folds = self._wants_folded
        if (step := self._step) is not None:
            folds = folds or self._low or step.is_empty
        stands = self._settling < SETTLING - STANDS
        if folds != self._folded and stands:
            self._folded = folds
            panel = self._client.gui.main_panel
            (panel.minimize if self._folded else panel.expand)()

    def _is_narrow(self) -> bool:
        camera = self._client.camera
        return camera.image_width < NARROW * camera.image_height

    def _heard_shape(self, kept: str) -> None:
        """Note the window's shape now. A browser's value is not trusted."""
        known = kept in ("upright", "wide", "low")
        self._wanted_narrow = kept == "upright" if known else self._is_narrow()
        self._low = kept == "low"

    def _frame_camera(self) -> None:
        """Refit the camera to both robots when the aspect ratio of the view changes.

        The size in device pixels is ignored, because slow browsers change it on their own. While
        panels settle, a browser may not report its final shape until it is sent a camera again.
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
            ask_item(self._client, SHAPE_KEY, self._heard_shape)
            self._scene.frame_camera(self._insets(height))

    def _insets(self, height: float) -> Insets:
        """Margins of the canvas, for our titles."""
        return Insets(top=min(TITLES, MOST_TITLES * height))


def _hooks(post: Post, robot: Robot) -> SceneCallbacks:
    def move(index: int, at: Array) -> None:
        post(c.MovePoint(index, plane_coordinates(robot, at), finished=False))

    return SceneCallbacks(
        on_grab=lambda name, at: post(c.Grab(name, robot.output_at(at))),
        on_release=lambda name: post(c.Release(name)),
        on_point_dragged=move,
        on_point_drag_end=lambda _: post(c.EndMove()),
        on_point_selected=lambda index: post(c.SelectPoint(index)),
        on_wall_moved=lambda at: post(c.MoveWall(plane_coordinates(robot, at))),
        on_wall_turned=lambda end, at: post(c.SwingWall(end, plane_coordinates(robot, at))),
        on_start_moved=lambda at: post(c.MoveStart(plane_coordinates(robot, at))),
    )
