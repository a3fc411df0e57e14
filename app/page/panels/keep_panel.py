"""Saving and sharing: the lab code, share codes and the lesson report."""

from __future__ import annotations

import viser

from onpath.app.common.access_codes import shown
from onpath.app.common.templates import render
from onpath.app.exports.exporter import Exporter
from onpath.app.lab import commands as c
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.page.page_context import PageContext
from onpath.app.page.panels.slow_presses import on_slow_press
from onpath.app.page.panels.widgets import Post, note, on_press, refused
from onpath.lessons.words import Words


class KeepPanel:
    """A folder that shows the codes and accepts typed ones."""

    def __init__(
        self, gui: viser.GuiApi, words: Words, post: Post, exporter: Exporter, context: PageContext
    ) -> None:
        self._context, self._words, self._code = context, words, ""
        with gui.add_folder(words("keep.title"), expand_by_default=False):
            if context.keep_days:
                gui.add_html(_code(words("keep.yours"), shown(context.code), words))
                gui.add_html(note(words("keep.until", days=context.keep_days), small=True))
                gui.add_html(render("panel/field.html", kind="code", required=False))
                self._typed = gui.add_text(words("keep.other"), "", hint=words("keep.other_hint"))
                go = gui.add_button(words("keep.go"), color="gray", icon=viser.Icon.LOGIN)
                self._message = gui.add_html("")
                on_slow_press(go, self._enter)
            share = gui.add_button(words("keep.share"), color="gray", icon=viser.Icon.SHARE)
            self._share = gui.add_html("")
            gui.add_html(render("panel/field.html", kind="code", required=False))
            pasted = gui.add_text(words("keep.paste"), "", hint=words("keep.paste_hint"))
            use = gui.add_button(words("keep.use"), color="gray", icon=viser.Icon.DOWNLOAD)
            report = gui.add_button(words("keep.report"), color="gray", icon=viser.Icon.REPORT)
            if context.keep_days:
                self._with_code = gui.add_checkbox(words("keep.with_code"), initial_value=False)
                gui.add_html(note(words("keep.with_code_means"), small=True))
        on_press(share, lambda: post(c.Share()))
        on_press(use, lambda: post(c.UseShared(pasted.value)))
        on_press(report, lambda: exporter.report(self._code_in_report()))

    def follow(self, snapshot: PageSnapshot) -> None:
        """Show the requested share code."""
        if snapshot.shared != self._code:
            self._code = snapshot.shared
            self._share.content = _code(self._words("keep.shared"), self._code, self._words)

    def _code_in_report(self) -> str:
        """The lab code, if the user wants it in the report, where every reader can use it."""
        return self._context.code if self._context.keep_days and self._with_code.value else ""

    def _enter(self) -> None:
        self._message.content = render("lesson/text.html", content=self._words("keep.moment"))
        try:
            self._context.enter(self._typed.value)  # rebuilds the page without this panel
        except (ValueError, OSError) as error:
            self._message.content = refused(self._words.sentence(error))


def _code(label: str, code: str, words: Words) -> str:
    return render("panel/code.html", label=label, code=code, words=words)
