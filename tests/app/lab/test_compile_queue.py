"""What somebody still asks for comes before what nobody asks for any more; few wait."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from onpath.app.lab.loops.compile_queue import LATELY, MOST, CompileQueue

asked = st.lists(
    st.tuples(st.integers(0, 2 * MOST), st.floats(0, 2 * LATELY)), min_size=1, max_size=4 * MOST
)


@given(asked)
def test_recent_requests_are_served_in_order(
    pauses: list[tuple[int, float]],
) -> None:
    now, came, last = 0.0, dict[int, int](), dict[int, float]()
    queue = CompileQueue[int](lambda: now)
    for number, (key, pause) in enumerate(pauses):
        now += pause
        assert queue.ask(key) is (key not in came)
        came.setdefault(key, number)
        last[key] = now
        if len(came) > MOST:
            longest_ago = min(last, key=last.__getitem__)
            del came[longest_ago], last[longest_ago]
        assert len(queue) == len(came)
    while came:
        lately = [key for key in came if last[key] >= max(last.values()) - LATELY]
        key = min(lately, key=came.__getitem__)
        assert queue.next() == key and key not in queue
        del came[key], last[key]
    assert queue.next() is None
