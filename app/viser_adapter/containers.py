"""Chooses the container of new widgets."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import viser


@contextmanager
def beside(gui: viser.GuiApi, handle: Any) -> Iterator[None]:
    """Add widgets to the folder, tab or panel that contains a widget."""
    before = gui._snapshot_container_context()
    gui._set_container_uuid(handle._impl.parent_container_id)
    try:
        yield
    finally:
        gui._restore_container_context(before)
