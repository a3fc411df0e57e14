"""The latest result of another thread."""

from __future__ import annotations

from typing import Any

import pytest

from onpath.app.common.background import Background


def test_a_computation_that_fails_can_be_asked_for_again() -> None:
    waiting: list[Any] = []
    found: Background[int] = Background(waiting.append)
    found.ask("a", lambda: 1 // 0)
    found.ask("b", lambda: 2)
    assert len(waiting) == 1 and found.value is None
    with pytest.raises(ZeroDivisionError):
        waiting.pop()()
    found.ask("b", lambda: 2)
    waiting.pop()()
    assert (found.key, found.value) == ("b", 2)
