"""A page's widgets without a browser."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest


class Widget(SimpleNamespace):
    """A widget without a browser."""

    def on_update(self, act: Any) -> None:
        self.act = act

    on_click = on_update

    def set(self, value: Any) -> None:
        """Set the value as a user does, or press the button."""
        self.value = value
        with pytest.raises(StopIteration):  # nothing that follows from it waits
            self.act(SimpleNamespace(client="somebody")).send(None)


class Gui:
    """Notes the widgets, by label; `html` has those without one."""

    def __init__(self) -> None:
        self.named: dict[str, list[Widget]] = {}
        self.html: list[Widget] = []

    def add_checkbox(self, label: str, initial_value: bool, hint: str) -> Widget:
        return self._add(label, value=initial_value)

    def add_dropdown(self, label: str, options: list[str], initial_value: str, hint: str) -> Widget:
        return self._add(label, options=options, value=initial_value)

    def add_slider(self, label: str, initial_value: float, **values: Any) -> Widget:
        return self._add(label, value=initial_value, visible=True, **values)

    def add_text(self, label: str, value: str, **values: Any) -> Widget:
        return self._add(label, value=value, visible=values["visible"])

    def add_button(self, label: str, visible: bool = True, **_: Any) -> Widget:
        return self._add(label, visible=visible)

    def add_html(self, content: str, visible: bool = True) -> Widget:
        self.html.append(Widget(content=content, visible=visible))
        return self.html[-1]

    def _add(self, label: str, **values: Any) -> Widget:
        self.named.setdefault(label, []).append(Widget(**values))
        return self.named[label][-1]
