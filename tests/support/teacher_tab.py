"""A teacher's page, which has viser's widgets still."""

from __future__ import annotations

from typing import Any

from typing_extensions import override

from tests.support.student import Student


class TeacherTab(Student):
    """One tab with its widgets.

    Attributes:
        widgets: properties of the widgets on the page, by id.
    """

    def __init__(self, address: str, through: int | None = None, **headers: str) -> None:
        super().__init__(address, through, **headers)
        self.widgets: dict[str, dict[str, Any]] = {}

    @override
    def open(self) -> None:
        self.widgets.clear()
        super().open()

    def find(self, label: str) -> dict[str, Any]:
        """Wait for a widget whose label or option begins with `label`; the shortest is meant."""
        self.read(lambda: self.has_widget(label))
        labels = self._labels()
        return labels[min((text for text in labels if text.startswith(label)), key=len)]

    def change(self, label: str, value: Any = True) -> None:
        """Set the value of a widget, or press a button."""
        widget = self.find(label)
        self.send("GuiUpdateMessage", uuid=widget["uuid"], updates={"value": value})

    def has_widget(self, label: str) -> bool:
        """Whether the page has a widget whose label or option begins with `label`."""
        return any(text.startswith(label) for text in self._labels())

    @override
    def sees(self, text: str) -> bool:
        parts = ("content", "_markdown")
        shown = (str(w.get(part)) for w in self.widgets.values() for part in parts)
        return super().sees(text) or any(text in each for each in shown)

    def _labels(self) -> dict[str, dict[str, Any]]:
        shown = [w for w in self.widgets.values() if w["value"] is not None]
        options = {option: w for w in shown for option in w.get("options") or ()}
        return {**options, **{str(w["label"]): w for w in shown if w.get("label")}}

    @override
    def hear_scene(self, message: dict[str, Any]) -> None:
        kind = message["type"]
        if "props" in message and "uuid" in message:
            widget = {"uuid": message["uuid"], "value": message.get("value")}
            self.widgets[message["uuid"]] = {**widget, **message["props"]}
        elif kind in ("GuiUpdateMessage", "CommandUpdateMessage"):
            self.widgets.get(message["uuid"], {}).update(message["updates"])
        elif kind in ("GuiRemoveMessage", "RemoveCommandMessage"):
            self.widgets.pop(message["uuid"], None)
