"""Fingers on a page in Chromium, as the operating system tells of them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from playwright.sync_api import Page

Kind = Literal["touchStart", "touchMove", "touchEnd", "touchCancel"]


class Fingers:
    """Tells a page where it is touched; from `fingers`."""

    def __init__(self, page: Page) -> None:
        self.session = page.context.new_cdp_session(page)

    def tell(self, kind: Kind, *places: Sequence[float]) -> None:
        """Tell the page that something has changed.

        Args:
            places: of all fingers that touch the page from now on, each (x, y) in the window.
        """
        points = [{"x": place[0], "y": place[1], "id": i} for i, place in enumerate(places)]
        self.session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})


@contextmanager
def fingers(page: Page) -> Iterator[Fingers]:
    """Fingers for a page, as long as the context lasts."""
    found = Fingers(page)
    yield found
    found.session.detach()
