"""The control laws of the two benches: a menu for each, and what they do in a sentence."""

from __future__ import annotations

from functools import partial

import viser

from onpath.app.common.palette import OF_BENCH
from onpath.app.common.templates import render
from onpath.app.lab.commands import ChooseLaw
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot, robot_of
from onpath.app.page.panels.widgets import Post, on_user_update
from onpath.lessons.benches import law_label, law_text
from onpath.lessons.words import Words
from onpath.models.control.benches import BENCHES
from onpath.models.control.laws.registry import LAWS

Menu = viser.GuiDropdownHandle[str]


class LawPanel:
    """Two menus with the laws that suit the robot."""

    def __init__(self, gui: viser.GuiApi, words: Words, post: Post, first: PageSnapshot) -> None:
        self._words, self._post = words, post
        system = robot_of(first).system
        self._names = {law_label(n, words): n for n, law in LAWS.items() if law.suits(system)}
        self._laws = first.run.laws
        self._menus = {bench: self._add(gui, bench) for bench in BENCHES}
        self._just_changed: set[str] = set()
        self._help = gui.add_html(self._sentences())

    def follow(self, snapshot: PageSnapshot) -> None:
        """Show the lab's laws.

        A snapshot that is shown right after a change may have been taken before it, so it does not
        set the changed menu back; the next one is right.
        """
        laws, late, self._just_changed = snapshot.run.laws, self._just_changed, set[str]()
        for bench, menu in self._menus.items():
            label = law_label(laws[bench], self._words)
            if bench not in late and menu.value != label:
                menu.value = label
        if laws != self._laws:
            self._laws = laws
            self._help.content = self._sentences()

    def _add(self, gui: viser.GuiApi, bench: str) -> Menu:
        words = self._words
        menu = gui.add_dropdown(
            words(f"laws.{bench}"),
            list(self._names),
            initial_value=law_label(self._laws[bench], words),
            hint=words("laws.hint"),
        )
        on_user_update(menu, partial(self._choose, bench))
        return menu

    def _choose(self, bench: str, label: str) -> None:
        self._just_changed.add(bench)
        self._post(ChooseLaw(bench, self._names[label]))

    def _sentences(self) -> str:
        """What the laws do, each once, in the colour of its bench."""
        said = {law: OF_BENCH[bench].hex for bench, law in reversed(self._laws.items())}
        laws = [
            (said[law], law_label(law, self._words), law_text(law, self._words))
            for law in dict.fromkeys(self._laws.values())
        ]
        return render("panel/laws.html", laws=laws)
