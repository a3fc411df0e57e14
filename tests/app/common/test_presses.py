"""However fast a tab presses, few of its presses begin, and none after a pause is lost."""

from __future__ import annotations

from itertools import accumulate

from hypothesis import given
from hypothesis import strategies as st

from onpath.app.common.presses import APART, MOST, Presses


@given(st.lists(st.tuples(st.floats(0.0, 1.0), st.booleans()), min_size=1, max_size=60))
def test_a_tab_may_press_a_few_times_at_once_and_then_now_and_then(
    pressed: list[tuple[float, bool]],
) -> None:
    """Each press some time after the one before; it has ended by the next one, or not."""
    now, begun, busy = 0.0, list[float](), False
    presses = Presses(lambda: now)
    times = accumulate(pause for pause, _ in pressed)
    for at, (pause, ends) in zip(times, pressed, strict=True):
        now = at
        begins = presses.begin()
        assert not (begins and busy)
        assert begins or busy or pause < APART
        begun += [at] * begins
        if (busy := busy or begins) and ends:
            presses.end()
            busy = False
    for first in range(len(begun)):
        within = begun[-1] - begun[first]
        assert len(begun) - first <= MOST + within / APART + 1e-6
