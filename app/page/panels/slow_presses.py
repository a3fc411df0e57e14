"""Button presses that may block or rebuild the page: each in its own thread, few for each tab."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

from onpath.app.common.allowance import Allowance
from onpath.app.common.error_log import log_error
from onpath.app.page.build_queue import in_turn

if TYPE_CHECKING:
    import viser

MOST, APART = 5, 0.25
"""Presses that a tab may make in quick succession, and the time until it may make one more, [s]."""


class Presses:
    """Limits the presses of one tab: one at a time, and few per second. Use it on one event loop.

    Args:
        clock: monotonic time, [s].
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._under_way = threading.Lock()
        self._allowance = Allowance(MOST, 1 / APART, clock)

    def begin(self) -> bool:
        """Whether one may be made now; it lasts until `end`, which any thread may call."""
        if not self._allowance.covers() or not self._under_way.acquire(blocking=False):
            return False
        return self._allowance.take()

    def end(self) -> None:
        """See `begin`."""
        self._under_way.release()


_presses: WeakKeyDictionary[Any, Presses] = WeakKeyDictionary()


def on_slow_press(handle: Any, act: Callable[[], None]) -> None:
    """Call `act()` in a separate thread when the button is pressed.

    It may block or rebuild the page. A press from the same tab is dropped while it runs, or if
    there are more of them than any user makes; see `MOST`.
    """

    def run(presses: Presses) -> None:
        try:
            act()
        except Exception as error:
            log_error(error)
        finally:
            presses.end()

    async def pressed(event: viser.GuiEvent[Any]) -> None:
        presses = _presses.setdefault(event.client or handle, Presses())
        if presses.begin():
            threading.Thread(target=run, args=[presses], name="press", daemon=True).start()

    handle.on_click(pressed)


def on_menu_press(handle: Any, open_menu: Callable[[], Callable[[], None]]) -> None:
    """Open a window when the button is pressed, in place of the one that it opened before.

    A browser does not say that its user has closed a window, and a press may come at any rate.

    Args:
        open_menu: opens the window, and returns what closes it; called in a separate thread.
    """
    opened: list[Callable[[], None]] = []

    def press() -> None:
        with in_turn():
            while opened:
                opened.pop()()
            opened.append(open_menu())

    on_slow_press(handle, press)
