"""A browser's preferences, which it keeps itself: speech and sound."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Literal

from onpath.app.channel.messages import StoredName

Switch = Literal["speaks", "sounds"]
DEFAULTS = {"speaks": True, "sounds": False}
"""Whether a screen reader speaks about the robots, and whether the distances are heard as tones."""


class Preferences(Mapping[str, bool]):
    """The switches of one browser, by name; see `DEFAULTS`.

    Args:
        kept: what the browser has kept, which is not trusted: an invalid value leaves the default.
        keep: has the browser keep the value of a name.
    """

    def __init__(
        self,
        kept: Mapping[str, str] = {},
        keep: Callable[[StoredName, str], None] = lambda *_: None,
    ) -> None:
        self._keep = keep
        known = {"yes": True, "no": False}
        self._values = {
            name: known.get(kept.get(name, ""), usual) for name, usual in DEFAULTS.items()
        }

    def __getitem__(self, name: str) -> bool:
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def set(self, name: Switch, on: bool) -> None:
        """Change a switch, and have the browser keep it."""
        self._values[name] = on
        self._keep(name, "yes" if on else "no")
