"""Work of a page in another thread."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Generic, TypeVar

Submit = Callable[[Callable[[], None]], None]
Result = TypeVar("Result")


class Background(Generic[Result]):
    """The latest result of a computation in another thread.

    Args:
        submit: runs a function in another thread.

    Attributes:
        key, value: of the latest result; None before the first one.
    """

    def __init__(self, submit: Submit) -> None:
        self._submit, self._busy = submit, False
        self._asked: Hashable = None
        self.key: Hashable = None
        self.value: Result | None = None

    def ask(self, key: Hashable, compute: Callable[[], Result]) -> None:
        """Compute, unless this key was the last one asked for or a computation is under way."""
        if self._busy or key == self._asked:
            return
        self._asked, self._busy = key, True

        def work() -> None:
            try:
                self.value, self.key = compute(), key
            finally:
                self._busy = False

        self._submit(work)
