"""Widgets built from parameter metadata, and helpers shared by all panels."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import cache
from typing import Any, TypeVar

import viser
from typing_extensions import override

from onpath.app.common.templates import render
from onpath.app.lab.commands import Command, Set
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.lessons.labels import option_label, parameter_heading, parameter_help, parameter_label
from onpath.lessons.words import Words
from onpath.models.closed_loop.lab_settings import lab_specs
from onpath.models.control.laws.registry import OWN_GAINS, law_named
from onpath.models.control.settable import specs
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameter_specs import Spec

Post = Callable[[Command], None]
Option = TypeVar("Option")


def on_user_update(handle: Any, act: Callable[[Any], None]) -> None:
    """Call `act(value)` when the browser changes the widget, not when Python does."""

    async def changed(event: viser.GuiEvent[Any]) -> None:
        if event.client is not None:
            act(handle.value)

    handle.on_update(changed)


def on_press(handle: Any, act: Callable[[], None]) -> None:
    """Call `act()` when the button is pressed."""

    async def pressed(_: viser.GuiEvent[Any]) -> None:
        act()

    handle.on_click(pressed)


def add_menu(
    gui: viser.GuiApi,
    label: str,
    options: Mapping[str, Option],
    act: Callable[[Option], None],
    *,
    shown: str | None = None,
    hint: str | None = None,
) -> viser.GuiDropdownHandle[str]:
    """Add a dropdown of options by label; call `act(option)` when the user chooses one."""
    menu = gui.add_dropdown(label, list(options), initial_value=shown, hint=hint)
    on_user_update(menu, lambda chosen: act(options[chosen]))
    return menu


def add_buttons(
    gui: viser.GuiApi, label: str, options: Mapping[str, Option], act: Callable[[Option], None]
) -> viser.GuiButtonGroupHandle:
    """Add a row of buttons, one for each option by label; call `act(option)` on a press."""
    group = gui.add_button_group(label, list(options))
    on_press(group, lambda: act(options[group.value]))
    return group


def close_once(window: Any) -> None:
    """Close a window, unless it is closed already."""
    if not window.closed:
        window.close()


def note(text: str, small: bool = False) -> str:
    """A line of text between widgets, as HTML."""
    return render("panel/note.html", text=text, small=small)


def refused(reason: str) -> str:
    """The reason why an input was refused, as HTML, to be shown below the button."""
    return render("panel/refusal.html", reason=reason)


def put(handle: Any, **properties: object) -> None:
    """Set those properties that differ: setting one takes 20 times as long as reading it."""
    for name, value in properties.items():
        if getattr(handle, name) != value:
            setattr(handle, name, value)


def put_number(handle: viser.GuiInputHandle[float], value: float) -> None:
    """Show a number in a box, to a tenth."""
    put(handle, value=round(value, 1) + 0.0)  # turns -0 into 0


class LabValue:
    """A value of the lab that a user changes with widgets, and that they show.

    The first snapshot after a change may be older than it, so it does not set the widgets back; the
    next one is right, and does so if the lab has refused the change.
    """

    def __init__(self, post: Post) -> None:
        self._post, self._just_changed = post, False
        self._shown: tuple[object, ...] = ()  # empty if the next value is to be shown anyway

    def change(self, command: Command) -> None:
        """Post a command that changes the value."""
        self._just_changed = True
        self._post(command)

    def is_new(self, value: object) -> bool:
        """Whether the widgets are to show a snapshot's value."""
        if self._just_changed:
            self._just_changed, self._shown = False, ()
            return False
        if self._shown == (value,):
            return False
        self._shown = (value,)
        return True


class ParameterWidgets:
    """Widgets for settings that post changes and follow the lab's values.

    Args:
        gui: parent of the widgets.
        post: receives the commands.
        names: of parameters, gains and the lab's own settings, in order.
    """

    def __init__(
        self, gui: viser.GuiApi, words: Words, post: Post, names: list[str], first: PageSnapshot
    ) -> None:
        self._handles: dict[str, Any] = {}
        self._values = {name: LabValue(post) for name in names}
        self._post, self._words = post, words
        self._specs, values = lab_specs(ROBOTS[first.key.robot].parameters), first.values
        make = {"number": self._add_slider, "choice": self._add_choice, "switch": self._add_switch}
        for name in names:
            add = make[self._specs[name].kind]
            self._handles[name] = add(gui, name, self._shown(name, values))

    def follow(self, snapshot: PageSnapshot) -> None:
        """Show the lab's values where they differ."""
        values = snapshot.values
        for name, handle in self._handles.items():
            if self._values[name].is_new(values[name]):
                put(handle, value=self._shown(name, values))

    def _change(self, name: str, value: Any) -> None:
        self._values[name].change(Set(name, value))

    def _add_choice(self, gui: viser.GuiApi, name: str, shown: Any) -> Any:
        spec, words = self._specs[name], self._words
        options = {option_label(name, option, words): option for option in spec.options}
        label, hint = parameter_label(name, spec, words), parameter_help(name, spec, words)
        return add_menu(
            gui, label, options, lambda new: self._change(name, new), shown=shown, hint=hint
        )

    def _add_switch(self, gui: viser.GuiApi, name: str, shown: Any) -> Any:
        spec, words = self._specs[name], self._words
        label, hint = parameter_label(name, spec, words), parameter_help(name, spec, words)
        handle = gui.add_checkbox(label, shown, hint=hint)
        on_user_update(handle, lambda new: self._change(name, new))
        return handle

    def _add_slider(self, gui: viser.GuiApi, name: str, shown: Any) -> Any:
        spec, words = self._specs[name], self._words
        low, high = _ends(spec)
        handle = gui.add_slider(
            parameter_heading(name, spec, words),
            min=low,
            max=high,
            step=spec.step,
            initial_value=shown,
            hint=parameter_help(name, spec, words),
        )
        on_user_update(handle, lambda new: self._change(name, new))
        return handle

    def _shown(self, name: str, values: Mapping[str, Any]) -> Any:
        """Value for the widget: the option's name, or a number rounded to the step or finer."""
        spec, value = self._specs[name], values[name]
        if spec.kind == "switch":
            return value
        if spec.options:
            return option_label(name, value, self._words)
        low, high = _ends(spec)
        return min(max(round(float(value), _digits(spec.step)), low), high)


@cache
def _ends(spec: Spec) -> tuple[float, float]:
    """The outermost multiples of the step between the limits; a slider counts its steps from them.

    A slider from −π would stop at 3.0784 and never at 0.
    """
    first, last = math.ceil(spec.low / spec.step - 1e-9), math.floor(spec.high / spec.step + 1e-9)
    digits = _digits(spec.step)
    return round(first * spec.step, digits), round(last * spec.step, digits)


@cache
def _digits(step: float) -> int:
    """Decimals that show multiples of a tenth of the step."""
    return max(0, 2 - math.floor(math.log10(step) + 1e-9)) - 1


class OwnGainWidgets(ParameterWidgets):
    """Sliders for the gains of single laws, shown while a side has such a law."""

    def __init__(self, gui: viser.GuiApi, words: Words, post: Post, first: PageSnapshot) -> None:
        super().__init__(gui, words, post, names=list(OWN_GAINS), first=first)
        self._show(first)

    @override
    def follow(self, snapshot: PageSnapshot) -> None:
        """Show the lab's values, and only the sliders that its laws use."""
        super().follow(snapshot)
        self._show(snapshot)

    def _show(self, snapshot: PageSnapshot) -> None:
        used = {name for law in snapshot.run.laws.values() for name in law_named(law).gain_names}
        for name, handle in self._handles.items():
            put(handle, visible=name in used)


class SwitchedParameter(ParameterWidgets):
    """A parameter that 0 switches off: a checkbox that shows a slider while checked."""

    def __init__(
        self, gui: viser.GuiApi, words: Words, post: Post, name: str, first: PageSnapshot
    ) -> None:
        spec = specs(ROBOTS[first.key.robot].parameters)[name]
        self._name, self._on = name, spec.on
        on = first.parameters[name] != 0
        self._switch = gui.add_checkbox(
            parameter_label(name, spec, words),
            initial_value=on,
            hint=parameter_help(name, spec, words),
        )
        super().__init__(gui, words, post, names=[name], first=first)
        self._slider = self._handles[name]
        self._slider.visible = on
        on_user_update(self._switch, self._turn)

    @override
    def follow(self, snapshot: PageSnapshot) -> None:
        """Show the lab's value, and the slider only while checked."""
        super().follow(snapshot)
        on = snapshot.parameters[self._name] != 0
        put(self._switch, value=on)
        put(self._slider, visible=on)

    def _turn(self, on: bool) -> None:
        self._post(Set(self._name, self._on if on else 0.0))
