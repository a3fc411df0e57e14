"""A browser's preferences, which it stores itself: speech and sound."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import partial

import viser

from onpath.app.viser_adapter.local_storage import ask_item

DEFAULTS = {"speaks": True, "sounds": False}
"""Whether a screen reader speaks about the robots, and whether the distances are heard as tones."""


class Preferences(Mapping[str, bool]):
    """The switches of one browser, by name; see `DEFAULTS`."""

    def __init__(self, client: viser.ClientHandle) -> None:
        self._client, self._values = client, dict(DEFAULTS)
        for name in DEFAULTS:
            ask_item(client, name, partial(self._heard, name))

    def __getitem__(self, name: str) -> bool:
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def set(self, name: str, on: bool) -> None:
        """Change a switch and store it in the browser."""
        self._values[name] = on
        self._client.local_storage.set_item(name, "yes" if on else "no")

    def _heard(self, name: str, kept: str) -> None:
        """Take a browser's value, which is not trusted: an invalid one leaves the default."""
        self._values[name] = {"yes": True, "no": False}.get(kept, DEFAULTS[name])
