"""Whatever happens when, an allowance permits its burst and its rate, and no more."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from onpath.app.common.allowance import Allowance


@given(
    st.lists(st.tuples(st.floats(0, 3), st.floats(0.1, 3)), max_size=60),
    st.floats(3, 10),
    st.floats(0.1, 5),
)
def test_no_more_than_the_burst_and_the_rate(
    asked: list[tuple[float, float]], burst: float, rate: float
) -> None:
    """Each asked for some time after the one before. One that comes late enough is permitted."""
    now, taken = 0.0, list[tuple[float, float]]()
    allowance = Allowance(burst, rate, lambda: now)
    for pause, times in asked:
        now += pause
        covered = allowance.covers(times)
        assert covered == allowance.take(times)
        assert covered or pause * rate < times
        taken += [(now, times)] * covered
    for first in range(len(taken)):
        total = sum(times for _, times in taken[first:])
        assert total <= burst + (taken[-1][0] - taken[first][0]) * rate + 1e-6
