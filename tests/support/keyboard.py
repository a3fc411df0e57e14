"""A student who has a keyboard only: Tab, arrows, Enter, Space, and the lab's own keys.

Wherever the focus goes, it must be seen: on the screen, and with a ring that stands out.
"""

from __future__ import annotations

from collections.abc import Callable

from playwright.sync_api import Locator

from tests.support.browser import Tab

MOST = 150
"""Controls on a page, more or less: after so many presses of Tab nothing new comes."""

FOCUS = """() => {
    const control = document.activeElement
    if (control === document.body) return null
    const { x, y, width, height } = control.getBoundingClientRect()
    const style = getComputedStyle(control)
    const channels = (colour) => colour.match(/[\\d.]+/g).map(Number)
    const fill = (box) => getComputedStyle(box).backgroundColor
    const light = (colour) => channels(colour).slice(0, 3)
        .map((c) => c / 255).map((c) => c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4)
        .reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0)
    let behind = control.parentElement  // a ring is drawn around its control
    while (behind !== null && (channels(fill(behind))[3] ?? 1) < 0.5)
        behind = behind.parentElement
    const ground = light(behind === null ? "rgb(255, 255, 255)" : fill(behind))
    const inside = /^(rgb.*?\\)) ([3-9]|\\d\\d)px .* inset$/.exec(style.boxShadow)  // a bar
    const ring = light(inside?.[1] ?? style.outlineColor)
    const drawn = inside || (style.outlineStyle !== "none" && parseFloat(style.outlineWidth) >= 2)
    return {
        told: control.outerHTML.slice(0, 200),
        ring: drawn ? (Math.max(ring, ground) + 0.05) / (Math.min(ring, ground) + 0.05) : 0,
        seen: width > 0 && height > 0 && x < innerWidth && x + width > 0
            && y < innerHeight && y + height > 0,
    }
}"""
"""What has the focus, the contrast of its ring, and whether it is on the screen."""


class Keyboard:
    """Presses keys, and never touches a mouse.

    Attributes:
        unseen: what has had the focus without being seen, or without a ring.
    """

    def __init__(self, tab: Tab) -> None:
        self._tab, self.unseen = tab, dict[str, object]()

    def press(self, key: str, times: int = 1) -> None:
        """Press a key."""
        for _ in range(times):
            self._tab.page.keyboard.press(key)

    def reach(self, what: Locator, back: bool = False) -> None:
        """Press Tab, or Shift and Tab, until a control has the focus."""
        what.wait_for()
        has_focus = "control => control === document.activeElement"
        for _ in range(MOST):
            if what.count() == 1 and what.evaluate(has_focus):
                return
            self.press("Shift+Tab" if back else "Tab")
            self._look()
        raise AssertionError(f"{what} is not reached by Tab")

    def act(self, name: str, key: str = "Enter", back: bool = False) -> None:
        """Go to a button and press it."""
        self.reach(self._tab.button(name), back)
        self.press(key)

    def until(self, done: Callable[[], bool], *keys: str) -> None:
        """Press keys again and again until something is so."""
        for _ in range(MOST):
            if done():
                return
            for key in keys:
                self.press(key)
        raise AssertionError(f"{keys} do not help")

    def _look(self) -> None:
        found = self._tab.page.evaluate(FOCUS)
        if found is not None and (found["ring"] < 3 or not found["seen"]):
            self.unseen[found["told"]] = found
