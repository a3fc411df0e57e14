"""One browser tab: the scene, panels and plots of one lab."""

from __future__ import annotations

from collections.abc import Callable

import viser
from typing_extensions import override

from onpath.app.common.templates import render
from onpath.app.exports.exporter import Exporter, ViserDelivery
from onpath.app.exports.path_upload import PathReader
from onpath.app.lab import commands as c
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.lab.snapshots.snapshot import PageKey
from onpath.app.page.lesson_menu import LessonMenu
from onpath.app.page.page_context import PageContext
from onpath.app.page.page_menus import PageMenus
from onpath.app.page.panel_factory import PanelFactory, Part
from onpath.app.page.panels.class_panel import ClassPanel
from onpath.app.page.panels.keys import Keys
from onpath.app.page.panels.widgets import Post
from onpath.app.page.step_controls import Build, StepControls
from onpath.app.scene.client_scene import SETTLING, ClientScene
from onpath.app.scene.stage import NARROW
from onpath.app.viser_adapter.local_storage import ask_item
from onpath.app.viser_adapter.page_release import clear_widgets
from onpath.lessons.words import Words

STANDS = 5  # slow updates until the panel can be folded
CONTROL_WIDTH, LARGE_WIDTH = 330, 560  # [px], the latter for a plot on a projector
SHAPE_KEY = "shape"
"""Where a browser keeps its window's shape; see assets/page/portrait.js."""


class Page(ClientScene):
    """The page of one client.

    Attributes:
        exporter: creates the files requested on this page.
    """

    def __init__(
        self, client: viser.ClientHandle, first: PageSnapshot, context: PageContext
    ) -> None:
        self._client = client
        self._context = context
        self.exporter, self._files = Exporter(ViserDelivery(client)), PathReader()
        self._keys = Keys(client.gui)
        client.gui.set_panel_label("OnPath")
        self._narrow: bool | None = None  # not laid out yet
        self._low = False
        self._folded = True  # perhaps by the page before, in the same browser
        self._wants_folded = False
        self._step: StepControls | None = None
        self._wanted_narrow = self._is_narrow()
        self._parts: list[Part] = []
        super().__init__(client, first, context.look, context.course, context.post, set())

    @override
    def close(self) -> None:
        super().close()
        self.exporter.close()
        self._keys.close()

    @override
    def _show_all(self, snapshot: PageSnapshot) -> None:
        super()._show_all(snapshot)
        self._follow_fold()
        for part in self._parts:
            part.follow(snapshot)

    @override
    def _clear(self) -> None:
        clear_widgets(self._client)

    def _change(self, work: Callable[[], None]) -> None:
        """Change widgets in another thread; the browser receives the change as a whole.

        Otherwise a user could press a widget before its callbacks are set, in vain.
        """

        def atomically() -> None:
            with self._client.atomic():
                work()

        self._rebuilds.submit(atomically)

    @override
    def _key(self, key: PageKey) -> tuple[object, ...]:
        return key, self._look.dark, self._wanted_narrow

    def _is_folded(self, snapshot: PageSnapshot) -> bool:
        """Whether the panel makes room for the stage, as for a projector."""
        return snapshot.key.presenting

    def _words_for(self, snapshot: PageSnapshot) -> Words:
        """The page's texts."""
        return Words(snapshot.key.language)

    def _post_for(self, snapshot: PageSnapshot) -> Post:
        """The function that receives the commands of this page."""
        return self._context.post

    @override
    def _build(self, first: PageSnapshot) -> None:
        post, words = self._post_for(first), self._words_for(first)
        self._step = None
        self._look.upright = self._wanted_narrow
        self._lay_out(first)
        self._parts = []
        super()._build(first)
        self._building = True
        self._client.gui.add_html(
            render("panel/page.html", words=words, client=self._client.client_id)
        )
        self._build_panels(first, words, post)
        text = self._context.text
        page_actions = {
            "view": self.reset_view,
            "summary": lambda: text.narration.ask_summary(),
            "lesson": lambda: self._open_first_lesson(post),
        }
        self._keys.renew(words, post, page_actions)
        self._building = False

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

    @override
    def _frame_camera(self) -> None:
        before = self._framed
        super()._frame_camera()
        if self._framed != before:
            ask_item(self._client, SHAPE_KEY, self._heard_shape)
