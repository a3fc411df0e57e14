"""Keep and share: the session's code, share codes, the record of the lessons."""

from __future__ import annotations

import html

import viser

from onpath.app.common.access_codes import shown
from onpath.app.exports.exporter import Exporter
from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.page.page_context import PageContext
from onpath.app.page.panels.widgets import Post, on_press, on_slow_press


class KeepPanel:
    """A folder with codes to note down, to send and to type in."""

    def __init__(
        self, gui: viser.GuiApi, lab: Lab, post: Post, exporter: Exporter, desk: PageContext
    ) -> None:
        words = lab.words
        self._desk, self._words, self._code = desk, words, ""
        with gui.add_folder(words("keep.title"), expand_by_default=False):
            if desk.keeps:
                gui.add_html(_code(words("keep.yours"), shown(desk.code)))
                self._typed = gui.add_text(words("keep.other"), "", hint=words("keep.other_hint"))
                go = gui.add_button(words("keep.go"), color="gray", icon=viser.Icon.LOGIN)
                self._said = gui.add_html("")
                on_slow_press(go, self._enter)
            share = gui.add_button(words("keep.share"), icon=viser.Icon.SHARE)
            self._share = gui.add_html("")
            pasted = gui.add_text(words("keep.paste"), "", hint=words("keep.paste_hint"))
            use = gui.add_button(words("keep.use"), color="gray", icon=viser.Icon.DOWNLOAD)
            report = gui.add_button(words("keep.report"), color="gray", icon=viser.Icon.REPORT)
        on_press(share, lambda: post(c.Share()))
        on_press(use, lambda: post(c.UseShared(pasted.value)))
        on_press(report, lambda: exporter.report(desk.code if desk.keeps else ""))

    def follow(self, lab: Lab) -> None:
        """Show the share code that was asked for."""
        if lab.shared != self._code:
            self._code = lab.shared
            self._share.content = _code(self._words("keep.shared"), lab.shared)

    def _enter(self) -> None:
        self._say(self._words("keep.moment"))
        try:
            self._desk.enter(self._typed.value)  # builds the page anew, without this panel
        except (ValueError, OSError) as error:
            self._say(self._words.sentence(str(error)))

    def _say(self, said: str) -> None:
        self._said.content = f'<div class="op-text">{html.escape(said)}</div>'


def _code(label: str, code: str) -> str:
    return (
        f'<div style="padding:0.3em 0.9em;font-size:0.85em;color:#445">{label}<br/>'
        '<code style="user-select:all;font-size:1.15em;color:#111;overflow-wrap:anywhere">'
        f"{html.escape(code)}</code></div>"
    )
