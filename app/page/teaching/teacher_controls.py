"""The teacher's controls for all labs: freeze them, send them a set-up."""

from __future__ import annotations

import viser

from onpath.app.classroom.teaching.teacher_context import TeacherContext
from onpath.app.common.templates import render
from onpath.app.lab.commands import TakeSetup
from onpath.app.lab.setups.share_code import decode
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.page.panels.slow_presses import on_slow_press
from onpath.app.page.panels.widgets import note, on_press, put
from onpath.lessons.words import Words


class TeacherControls:
    """Controls above the teacher's own lab."""

    def __init__(self, gui: viser.GuiApi, words: Words, teaching: TeacherContext) -> None:
        self._class, self._words, self._teaching = teaching.classroom, words, teaching
        self._freezing = _add_freezing(gui, words, teaching)
        send = gui.add_button(words("class.push_setup"), icon=viser.Icon.SEND)
        with gui.add_folder(words("keep.paste"), expand_by_default=False):
            gui.add_html(render("panel/field.html", kind="code", required=False))
            code = gui.add_text(words("keep.paste"), "", hint=words("keep.paste_hint"))
            push = gui.add_button(words("class.push_code"), color="gray", icon=viser.Icon.SEND)
        self._message = gui.add_html("")
        stop = gui.add_button(words("class.stop_teaching"), color="gray", icon=viser.Icon.DOOR_EXIT)
        on_press(send, self._send_own)
        on_press(push, lambda: self._send_code(code.value))
        on_slow_press(stop, teaching.stop)  # builds the page anew

    def follow(self, snapshot: PageSnapshot) -> None:
        """Show whether all labs stand still."""
        _show_freezing(self._freezing, self._words, self._class.orders.frozen)

    def _send_own(self) -> None:
        self._teaching.send_setup()
        self._show_sent()

    def _send_code(self, text: str) -> None:
        try:
            self._class.push(TakeSetup(decode(text)))
        except ValueError as error:
            self._message.content = note(self._words.sentence(error))
            return
        self._show_sent()

    def _show_sent(self) -> None:
        self._message.content = note(self._words("class.sent", count=len(self._class.members())))


class FollowedStudent:
    """Controls above a student's lab."""

    def __init__(self, gui: viser.GuiApi, words: Words, teaching: TeacherContext) -> None:
        self._words, self._class, self._teaching = words, teaching.classroom, teaching
        self._freezing = _add_freezing(gui, words, teaching)
        self._who = gui.add_html("")
        self._show_who()
        back = gui.add_button(words("class.own_lab"), icon=viser.Icon.EYE)

        def stop() -> None:
            teaching.chosen.followed = ""

        on_press(back, stop)

    def follow(self, snapshot: PageSnapshot) -> None:
        """Show whose lab it is, and whether all labs stand still."""
        _show_freezing(self._freezing, self._words, self._class.orders.frozen)
        self._show_who()

    def _show_who(self) -> None:
        member = self._class.member(self._teaching.chosen.followed)
        name = member.name if member else ""
        put(self._who, content=note(self._words("class.following", name=name)))


def _add_freezing(
    gui: viser.GuiApi, words: Words, teaching: TeacherContext
) -> viser.GuiButtonHandle:
    classroom = teaching.classroom
    button = gui.add_button(words("class.freeze"), color="red", icon=viser.Icon.HAND_STOP)
    on_press(button, lambda: classroom.freeze(not classroom.orders.frozen))
    return button


def _show_freezing(button: viser.GuiButtonHandle, words: Words, frozen: bool) -> None:
    put(button, label=words("class.unfreeze" if frozen else "class.freeze"))
