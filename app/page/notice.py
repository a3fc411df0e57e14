"""A window for a browser that has no page yet: it says why, and what happens next."""

from __future__ import annotations

from collections.abc import Callable

import viser


def show_notice(client: viser.ClientHandle, title: str, text: str) -> Callable[[], None]:
    """Show a window. Returns what takes it away again."""
    client.gui.set_panel_label("OnPath")
    window = client.gui.add_modal(title)
    with window:
        client.gui.add_markdown(text)
    return window.close
