"""The control laws of the two sides: a menu and a box to type a law for each, and a help page."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import viser

from onpath.app.common.palette import OF_SIDE
from onpath.app.common.templates import render
from onpath.app.lab.commands import ChooseLaw, Command, TypeLaw
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot, robot_of
from onpath.app.page.panels.dialog import dialog
from onpath.app.page.panels.law_help import law_help
from onpath.app.page.panels.own_law_box import OwnLawBox
from onpath.app.page.panels.slow_presses import on_menu_press
from onpath.app.page.panels.widgets import LabValue, Post, add_menu, put
from onpath.lessons.sides import law_label, law_text
from onpath.lessons.words import Words
from onpath.models.control.laws.own import OWN, is_text, tidy
from onpath.models.control.laws.registry import LAWS
from onpath.models.control.sides import SIDES

MOST_ASKED = 8  # requested laws that are remembered until they come
Menu = viser.GuiDropdownHandle[str]


class LawPanel:
    """Two menus with the laws that suit the robot; their last entry opens a box to type one."""

    def __init__(self, gui: viser.GuiApi, words: Words, post: Post, first: PageSnapshot) -> None:
        self._gui, self._words = gui, words
        system = robot_of(first).system
        self._names = {law_label(n, words): n for n, law in LAWS.items() if law.suits(system)}
        self._names[words("laws.own")] = OWN
        self._laws, self._spatial = first.run.laws, system.p == 3
        self._typing: set[str] = set()  # sides whose box is open before a law has been typed
        self._asked: dict[str, list[str]] = {side: [] for side in SIDES}  # laws still to come
        self._values = {side: LabValue(post) for side in SIDES}  # law and refusal
        self._menus = dict[str, Menu]()
        self._boxes = dict[str, OwnLawBox]()
        for side in SIDES:
            self._menus[side] = self._add(gui, side)
            use = partial(self._use, side)
            law = self._laws[side]
            self._boxes[side] = OwnLawBox(gui, words, side=side, law=law, use=use)
        self._sentences = gui.add_html(self._descriptions())
        about = gui.add_button(words("laws.about"), color="gray", icon=viser.Icon.HELP)
        on_menu_press(about, self._open_help)

    def follow(self, snapshot: PageSnapshot) -> None:
        """Show the lab's laws.

        A law that was asked for here may come while the user goes on typing; only a law from
        elsewhere changes the box.
        """
        run = snapshot.run
        for side, menu in self._menus.items():
            law, refusal = run.laws[side], snapshot.refused.get(side, "")
            if law != self._laws[side] and not self._was_asked(side, law):
                self._typing.discard(side)
                if is_text(law):
                    self._boxes[side].take(law)
            if self._values[side].is_new((law, refusal)):
                put(menu, value=self._label(side, law))
                self._boxes[side].show(is_text(law) or side in self._typing)
                self._boxes[side].follow(refusal)
        if run.laws != self._laws:
            self._laws = run.laws
            self._sentences.content = self._descriptions()

    def _label(self, side: str, law: str) -> str:
        """The menu's entry for a law."""
        typed = is_text(law) or side in self._typing
        return self._words("laws.own") if typed else law_label(law, self._words)

    def _add(self, gui: viser.GuiApi, side: str) -> Menu:
        words = self._words
        return add_menu(
            gui,
            words(f"laws.{side}"),
            self._names,
            partial(self._choose, side),
            shown=self._label(side, self._laws[side]),
            hint=words("laws.hint"),
        )

    def _choose(self, side: str, law: str) -> None:
        self._boxes[side].show(law == OWN)
        if law == OWN:
            self._typing.add(side)
        else:
            self._typing.discard(side)
            self._ask(side, law, ChooseLaw(side, law))

    def _use(self, side: str, text: str) -> None:
        self._ask(side, tidy(text), TypeLaw(side, text))

    def _ask(self, side: str, law: str, command: Command) -> None:
        if law != self._laws[side]:
            self._asked[side] = [*self._asked[side][-MOST_ASKED:], law]
        self._values[side].change(command)

    def _was_asked(self, side: str, law: str) -> bool:
        """Whether a new law was asked for here; forgets it and the requests before it."""
        asked = self._asked[side]
        if law not in asked:
            return False
        self._asked[side] = asked[asked.index(law) + 1 :]
        return True

    def _descriptions(self) -> str:
        """What the laws do, each once, in the colour of its side."""
        colours = {law: OF_SIDE[side].hex for side, law in reversed(self._laws.items())}
        laws = [
            (colours[law], law_label(law, self._words), law_text(law, self._words), is_text(law))
            for law in dict.fromkeys(self._laws.values())
        ]
        return render("panel/laws.html", laws=laws)

    def _open_help(self) -> Callable[[], None]:
        laws = [name for name in self._names.values() if name != OWN]
        typing = bool(self._typing) or any(map(is_text, self._laws.values()))
        with dialog(self._gui, self._words, self._words("laws.about")) as close:
            self._gui.add_html(law_help(laws, self._spatial, typing, self._words))
        return close
