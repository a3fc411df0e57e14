"""Button presses that may block or rebuild the page: each runs in a thread, few for each tab."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

from onpath.app.common.error_log import log_error
from onpath.app.common.presses import Presses
from onpath.app.scene.build_queue import in_turn

if TYPE_CHECKING:
    import viser

_presses: WeakKeyDictionary[Any, Presses] = WeakKeyDictionary()


def on_slow_press(handle: Any, act: Callable[[], None]) -> None:
    """Call `act()` in a separate thread when the button is pressed.

    `act` may block or rebuild the page. Further presses from the same tab are dropped while it
    runs, and when there are more of them than any user makes; see `Presses`.
    """
    _on_press(handle, lambda _: act())


def on_menu_press(handle: Any, open_menu: Callable[[], Callable[[], None]]) -> None:
    """Open a window when the button is pressed, in place of the one that it opened before.

    A browser does not report that its user has closed a window, and it may send presses at any
    rate. It receives the window as a whole, since a button in it may close it.

    Args:
        open_menu: opens the window and returns a function that closes it; called in a separate
            thread.
    """
    opened: list[Callable[[], None]] = []

    def press(client: viser.ClientHandle) -> None:
        with in_turn(), client.atomic():
            while opened:
                opened.pop()()
            opened.append(open_menu())

    _on_press(handle, press)


def _on_press(handle: Any, act: Callable[[viser.ClientHandle], None]) -> None:
    def run(presses: Presses, client: viser.ClientHandle) -> None:
        try:
            act(client)
        except Exception as error:
            log_error(error)
        finally:
            presses.end()

    async def pressed(event: viser.GuiEvent[Any]) -> None:
        client: Any = event.client  # None only for changes by Python
        presses = _presses.setdefault(client, Presses())
        if presses.begin():
            thread = threading.Thread(target=run, args=[presses, client], name="press", daemon=True)
            thread.start()

    handle.on_click(pressed)
