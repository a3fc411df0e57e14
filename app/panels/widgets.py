"""Widgets built from parameter metadata, and small helpers that every panel uses."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import viser

from app.commands import Command, SetParameter
from models.parameters import Parameters, Spec, specs

Post = Callable[[Command], None]


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


class ParameterWidgets:
    """Widgets of some parameters: they post changes and follow the session's values.

    Args:
        gui: where to put them.
        names: fields of `parameters`, in order.
        post: takes the commands.
    """

    def __init__(
        self, gui: viser.GuiApi, parameters: Parameters, names: list[str], post: Post
    ) -> None:
        self._handles: dict[str, Any] = {}
        self._post = post
        self._specs = specs(parameters)
        for name in names:
            self._add(gui, name, self._specs[name], getattr(parameters, name))

    def follow(self, parameters: Parameters) -> None:
        """Show the session's values where they differ."""
        for name, handle in self._handles.items():
            value = getattr(parameters, name)
            shown = _shown(self._specs[name], value)
            if handle.value != shown:
                handle.value = shown

    def _add(self, gui: viser.GuiApi, name: str, spec: Spec, value: Any) -> None:
        unit = f" [{spec.unit}]" if spec.unit else ""
        if spec.options:
            options = [str(option) for option in spec.options]
            handle: Any = gui.add_dropdown(
                spec.label, options, initial_value=_shown(spec, value), hint=spec.help
            )
        else:
            handle = gui.add_slider(
                spec.label + unit,
                min=spec.low,
                max=spec.high,
                step=spec.step,
                initial_value=_shown(spec, value),
                hint=spec.help,
            )
        self._handles[name] = handle
        on_user_update(handle, lambda new: self._post(SetParameter(name, new)))


def _shown(spec: Spec, value: Any) -> Any:
    """A value as its widget holds it: options as text, numbers to the slider's step or finer."""
    if spec.options:
        return str(value)
    digits = max(0, 2 - math.floor(math.log10(spec.step) + 1e-9)) - 1
    return round(float(value), digits)


class SwitchedParameter(ParameterWidgets):
    """A parameter that is off at 0: a checkbox that shows its slider while on."""

    def __init__(self, gui: viser.GuiApi, parameters: Parameters, name: str, post: Post) -> None:
        self._spec = specs(parameters)[name]
        self._name = name
        value = getattr(parameters, name)
        self._switch = gui.add_checkbox(
            self._spec.label, initial_value=value != 0, hint=self._spec.help
        )
        super().__init__(gui, parameters, [name], post)
        self._slider = self._handles[name]
        self._slider.visible = value != 0
        on_user_update(self._switch, self._turn)

    def follow(self, parameters: Parameters) -> None:
        """Show the session's value, and the slider only while on."""
        super().follow(parameters)
        on = getattr(parameters, self._name) != 0
        if self._switch.value != on:
            self._switch.value = on
        if self._slider.visible != on:
            self._slider.visible = on

    def _turn(self, on: bool) -> None:
        self._post(SetParameter(self._name, self._spec.on if on else 0.0))
