"""The class panel of the teacher's page: progress, predictions and exports."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from datetime import UTC, datetime

import viser

from onpath.app.classroom import class_html as page
from onpath.app.classroom.class_record import class_record
from onpath.app.classroom.concept_test_results import sheets_without_names
from onpath.app.classroom.teaching.lesson_labels import lesson_titles
from onpath.app.classroom.teaching.teacher_context import TeacherContext
from onpath.app.common.background import Submit
from onpath.app.lab.commands import TakeStep
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.page.panels.dialog import mark_closing
from onpath.app.page.panels.widgets import Post, note, on_press, on_user_update, put
from onpath.app.page.teaching.gains_tab import GainsTab
from onpath.app.page.teaching.member_controls import MemberControls
from onpath.app.page.teaching.pace_tab import PaceTab
from onpath.app.page.teaching.predictions_tab import PredictionsTab
from onpath.lessons.concept_test.concept_test import BEFORE
from onpath.lessons.course import Course
from onpath.lessons.kept.known_choices import of_today
from onpath.lessons.words import Words

WIDTH, WIDE = 480, 520  # [px]; wide for a projector
REFRESH_INTERVAL = 1.0  # [s], refresh period


class TeacherPanel:
    """Five tabs. Only "Class" shows names; it comes first and is open, except on a projection.

    Args:
        post: receives the commands for the teacher's own lab.
        submit: runs a function in another thread.
    """

    def __init__(
        self,
        client: viser.ClientHandle,
        words: Words,
        post: Post,
        course: Course,
        teaching: TeacherContext,
        submit: Submit,
    ) -> None:
        self._client, self._gui, self._submit = client, client.gui, submit
        self._teaching, self._class, self._chosen = teaching, teaching.classroom, teaching.chosen
        self._course, self._words, self._post = course, words, post
        self._next, self._busy = 0.0, False
        self._lessons = lesson_titles(course, words)
        self._codes: list[viser.GuiHtmlHandle] = []
        self._large = teaching.presents()
        self._for_lessons: list[PredictionsTab | PaceTab] = []
        panel = self._gui.add_panel(order=0)
        opened = [self._add_class, self._add_predictions]
        for add in reversed(opened) if self._large else opened:
            add(panel)
        if self._course.lessons:
            with panel.add_tab(words("pace.title"), viser.Icon.WALK):
                self._for_lessons.append(PaceTab(self._gui, words, course, self._class))
        with panel.add_tab(words("gains.title"), viser.Icon.CHART_DOTS):
            self._gains = GainsTab(self._gui, words, teaching)
        with panel.add_tab(words("class.record"), viser.Icon.FILE_TEXT):
            self._build_record()
        panel.dock_left()
        panel.set_width(WIDE if self._large else WIDTH)

    def follow(self, snapshot: PageSnapshot) -> None:
        """Refresh once a second in another thread, since the class may be large."""
        now = self._class.clock()
        if now >= self._next and not self._busy:
            self._next, self._busy = now + REFRESH_INTERVAL, True
            self._submit(self._refresh)

    def _refresh(self) -> None:
        try:
            members = self._class.members()
            now = self._class.clock()
            code = page.class_code(
                address=self._teaching.address,
                is_local=self._teaching.is_local,
                code=self._class.code,
                count=len(members),
                words=self._words,
                large=self._large,
            )
            for shown in self._codes:
                put(shown, content=code)
            table = page.table(members.values(), self._course, now, self._words)
            put(self._table, content=table)
            self._show_names()
            still = self._teaching.why_still(self._words)
            put(self._still, content=note(still) if still else "")
            self._member.look()
            self._show_standing()
            for tab in self._for_lessons:
                tab.look(self._large)
            self._gains.look(self._large)
        finally:
            self._busy = False

    def _add_predictions(self, panel: viser.PanelHandle) -> None:
        if not self._course.lessons:
            return
        with panel.add_tab(self._words("class.predictions"), viser.Icon.CHALKBOARD):
            tab = PredictionsTab(
                gui=self._gui,
                words=self._words,
                course=self._course,
                teaching=self._teaching,
                post=self._post,
                look_again=self._look_again,
            )
        self._codes.append(tab.code)
        self._for_lessons.append(tab)

    # Progress

    def _add_class(self, panel: viser.PanelHandle) -> None:
        with panel.add_tab(self._words("class.title"), viser.Icon.USERS):
            self._build_class()

    def _build_class(self) -> None:
        self._codes.append(self._gui.add_html(""))
        self._table = self._gui.add_html("")
        self._names = self._gui.add_dropdown(
            self._words("class.follow"), [self._words("class.own_lab")]
        )
        on_user_update(self._names, self._choose_followed)
        self._member = MemberControls(
            gui=self._gui,
            words=self._words,
            teaching=self._teaching,
            ask=self._ask,
            let_go=lambda: self._choose_followed(""),
            look_again=self._look_again,
        )
        self._still = self._gui.add_html("")
        self._standing = self._gui.add_html("")
        self._clear = self._gui.add_button(self._words("class.push_end"), color="gray")
        on_press(self._clear, lambda: self._class.push(None))
        self._show_names()
        self._show_standing()

    def _followable(self) -> dict[str, str]:
        """Lab code by displayed label."""
        members = self._class.members().items()
        return {f"{member.number}. {member.name}": code for code, member in members}

    def _show_names(self) -> None:
        names = self._followable()
        options = (self._words("class.own_lab"), *names)
        shown = next((n for n, c in names.items() if c == self._chosen.followed), options[0])
        put(self._names, options=options, value=shown)

    def _show_standing(self) -> None:
        """Show the set-up that new members receive and the button that clears it."""
        push = self._class.orders.push
        self._clear.visible = push is not None
        if push is None:
            message = ""
        elif isinstance(push, TakeStep):
            titles = {name: title for title, name in self._lessons.items()}
            title = titles.get(push.lesson, "")
            message = self._words("class.standing_step", lesson=title, step=push.step + 1)
        else:
            message = self._words("class.standing_setup")
        put(self._standing, content=note(message) if message else "")

    def _choose_followed(self, name: str) -> None:
        self._chosen.followed, self._chosen.message = self._followable().get(name, ""), ""
        self._look_again()

    def _look_again(self) -> None:
        self._next = 0.0

    # Export and deletion

    def _build_record(self) -> None:
        words, gui = self._words, self._gui
        gui.add_html(note(words("class.record_text")))
        export = gui.add_button(words("class.export"), icon=viser.Icon.FILE_EXPORT)
        end = gui.add_button(words("class.end"), color="gray", icon=viser.Icon.DOOR_EXIT)
        forget = gui.add_button(words("class.forget"), color="red", icon=viser.Icon.TRASH)
        self._outcome = gui.add_html("")
        on_press(export, lambda: self._submit(self._export))
        on_press(end, lambda: self._ask(words("class.end"), words("class.end_sure"), self._end))
        on_press(
            forget,
            lambda: self._ask(words("class.forget"), words("class.forget_sure"), self._forget),
        )

    def _export(self) -> None:
        course, language = self._course, self._words.language
        members = {
            lab: replace(member, progress=of_today(course, member.progress))
            for lab, member in self._class.members().items()
        }
        students = [(lab, member.progress) for lab, member in members.items()]
        test = course.lesson(BEFORE, language) if course.tests else None
        tests = sheets_without_names(test, students, self._class.code) if test else []
        made = datetime.now(UTC)
        data = class_record(members.values(), course, language, made, tests)
        name = f"onpath-class-{made:%Y-%m-%d}.xlsx"
        self._client.send_file_download(name, data, save_immediately=True)

    def _end(self) -> None:
        self._outcome.content = note(self._words("class.ended", count=self._class.end()))
        self._look_again()

    def _forget(self) -> None:
        try:
            message = self._words("class.forgotten", count=self._teaching.forget())
        except (OSError, ValueError) as error:
            message = self._words.sentence(error)
        self._outcome.content = note(message)
        self._look_again()

    def _ask(self, title: str, question: str, act: Callable[[], None]) -> None:
        """Run an action after confirmation."""
        with self._gui.add_modal(title) as modal:
            self._gui.add_html(note(question))
            yes = self._gui.add_button(self._words("class.yes"), color="red")
            mark_closing(self._gui, self._words)
            no = self._gui.add_button(self._words("class.no"), color="gray")

        def agreed() -> None:
            modal.close()
            self._submit(act)

        on_press(yes, agreed)
        on_press(no, modal.close)
