"""A notice for a browser that has no page yet, with the reason and what happens next."""

from __future__ import annotations

from collections.abc import Callable

import viser


def show_notice(client: viser.ClientHandle, title: str, text: str) -> Callable[[], None]:
    """Show a notice. Returns a function that removes it."""
    client.gui.set_panel_label("OnPath")
    window = client.gui.add_modal(title)
    with window:
        client.gui.add_markdown(text)
    return window.close
