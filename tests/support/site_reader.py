"""A browser on a page of the static site, used by mouse, finger or keys."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from tests.support.browser import THREE_FRAMES
from tests.support.fingers import fingers
from tests.support.waiting import wait_for

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Locator, Page

WAIT = 60.0  # [s]
OPEN = "Boolean(window.site?.stage) && !document.querySelector('.step.open .stage:empty')"
MOST_TABS = 80  # presses of Tab, until something must have the focus
PHONE = {"viewport": {"width": 390, "height": 844}, "has_touch": True}


class SiteReader:
    """A browser on a page, what it asks for, and what it complains of."""

    def __init__(self, browser: Browser, address: str, **more: Any) -> None:
        self.context = browser.new_context(**{"viewport": {"width": 1200, "height": 800}, **more})
        self.page: Page = self.context.new_page()
        self.requests, self.complaints = list[str](), list[str]()
        self.page.on("request", lambda request: self.requests.append(request.url))
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.on("console", lambda message: self.complaints.append(message.text))
        self.page.goto(address)

    def ready(self) -> None:
        """Wait for the figure of the open step."""
        wait_for(lambda: self.page.evaluate(OPEN), WAIT)

    def button(self, name: str) -> Locator:
        return self.page.get_by_role("button", name=name, exact=True)

    def press(self, name: str) -> None:
        self.button(name).click()

    def step(self) -> str:
        return self.page.locator(".step.open .words h2").inner_text()

    def advance(self, seconds: float) -> None:
        """Let simulated time pass at once, as the figure's clock would."""
        self.page.evaluate(
            "seconds => site.stage.figure.advance(Math.round(1000 * seconds))", seconds
        )

    def played(self, seconds: float) -> None:
        """Let a script that has been begun play to its end."""
        self.advance(seconds)
        wait_for(lambda: self.button("Let it happen again").count() == 1, WAIT)

    def passed(self) -> bool:
        return "Passed" in self.page.locator(".step.open .task .verdicts").first.inner_text()

    def enter(self, name: str, value: float) -> None:
        """Type a number into the box of a setting."""
        box = self.box(name)
        box.fill(str(value))
        box.press("Enter")

    def box(self, name: str) -> Locator:
        return self.page.locator(".step.open").get_by_role("textbox", name=name)

    def focus(self, what: Locator) -> None:
        """Press Tab until something has the focus."""
        for _ in range(MOST_TABS):
            if what.evaluate("each => each === document.activeElement"):
                return
            self.page.keyboard.press("Tab")
        raise AssertionError(f"no way by Tab to {what}")

    def swipe(self, *way: Sequence[float]) -> None:
        """Touch the first place with a finger, move it through the others, and lift it."""
        with fingers(self.page) as tell:
            tell("touchStart", way[0])
            self.page.evaluate(THREE_FRAMES)
            for place in way[1:]:
                tell("touchMove", place)
                self.page.evaluate(THREE_FRAMES)
            tell("touchEnd")
            self.page.evaluate(THREE_FRAMES)

    def place(self, what: Locator) -> tuple[float, float]:
        """Upper left corner in the window, once it is scrolled into view."""
        what.evaluate("each => each.scrollIntoView({block: 'center'})")
        self.page.evaluate(THREE_FRAMES)
        box = what.bounding_box()
        assert box
        return box["x"], box["y"]
