"""Cases of a law of which not every run of the tests has all."""

from __future__ import annotations

import random
from collections.abc import Container, Iterable, Sequence
from datetime import date
from typing import Any, TypeVar

import pytest

T = TypeVar("T")


def drawn(cases: Sequence[T], count: int) -> list[T]:
    """Some cases, others every day. A test that is repeated has the same again."""
    return random.Random(date.today().isoformat()).sample(cases, count)


def some(cases: Iterable[Any], quick: Container[Any]) -> list[Any]:
    """All cases, for `parametrize`; those that are not quick are marked `thorough`.

    Args:
        cases: values, or tuples of values for several arguments.
    """
    return [case if case in quick else _thorough(case) for case in cases]


def _thorough(case: Any) -> Any:
    values = case if isinstance(case, tuple) else (case,)
    return pytest.param(*values, marks=pytest.mark.thorough)
