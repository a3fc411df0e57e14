"""Cases of a law that are divided between `make test` and `make thorough`."""

from __future__ import annotations

from collections.abc import Container, Iterable
from typing import Any

import pytest


def some(cases: Iterable[Any], quick: Container[Any]) -> list[Any]:
    """All cases, for `parametrize`; those that are not quick are marked `thorough`.

    Args:
        cases: values, or tuples of values for several arguments.
    """
    return [case if case in quick else _thorough(case) for case in cases]


def _thorough(case: Any) -> Any:
    values = case if isinstance(case, tuple) else (case,)
    return pytest.param(*values, marks=pytest.mark.thorough)
