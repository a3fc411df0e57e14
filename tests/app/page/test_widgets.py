"""Detecting the release of a held button from repeated "held" messages alone."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.app.page.panels.widgets import PRESS_ENDS, on_hold


class Timer:
    """Something to be done at a time, [s]."""

    def __init__(self, at: float, act: Callable[[], None]) -> None:
        self.at, self.act, self.off = at, act, False

    def cancel(self) -> None:
        self.off = True


class Loop:
    """An event loop whose time passes only when it is told so."""

    def __init__(self) -> None:
        self.now, self.timers = 0.0, list[Timer]()

    def call_later(self, delay: float, act: Callable[[], None]) -> Timer:
        self.timers.append(Timer(self.now + delay, act))
        return self.timers[-1]

    def pass_time(self, until: float) -> None:
        while due := [timer for timer in self.timers if not timer.off and timer.at <= until]:
            first = min(due, key=lambda timer: timer.at)
            self.now = first.at
            first.cancel()
            first.act()
        self.now = until


class Button:
    """Takes what is to be done while it is held down."""

    def on_hold(self, act: Callable[[object], Coroutine[Any, Any, None]]) -> None:
        self.act = act

    def tell(self) -> None:
        """A message comes; nothing in it waits."""
        with pytest.raises(StopIteration):
            self.act(None).send(None)


gaps = st.lists(st.floats(0.01, 3 * PRESS_ENDS).filter(lambda gap: abs(gap - PRESS_ENDS) > 1e-3))


@given(gaps)
def test_a_press_lasts_as_long_as_messages_come(gaps: list[float]) -> None:
    loop, button = Loop(), Button()
    heard: list[tuple[str, float]] = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(asyncio, "get_running_loop", lambda: loop)
        on_hold(
            button,
            lambda: heard.append(("begin", loop.now)),
            lambda: heard.append(("end", loop.now)),
        )
        button.tell()
        for gap in gaps:
            loop.pass_time(loop.now + gap)
            button.tell()
        last = loop.now
        loop.pass_time(last + 10.0)
    kinds = [kind for kind, _ in heard]
    presses = 1 + sum(gap > PRESS_ENDS for gap in gaps)
    assert kinds == ["begin", "end"] * presses
    assert heard[-1][1] == pytest.approx(last + PRESS_ENDS)
