"""Touches a page in Chromium with one finger or several."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from playwright.sync_api import Page


@contextmanager
def fingers(page: Page) -> Iterator[Callable[..., None]]:
    """With what a page is touched: called with a kind of touch event, such as `touchMove`.

    After the kind come the places, each (x, y) in the window, of all fingers that touch the page
    from then on.
    """
    session = page.context.new_cdp_session(page)

    def tell(kind: str, *places: Sequence[float]) -> None:
        points = [{"x": place[0], "y": place[1], "id": i} for i, place in enumerate(places)]
        session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    yield tell
    session.detach()
