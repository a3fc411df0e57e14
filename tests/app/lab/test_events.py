"""The events of a lab: the latest ones are kept as they were noted."""

from __future__ import annotations

from collections import deque

import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.app.lab.events import FIRST, MOST, EventLog, LabEvent
from onpath.models.control.sides import SIDES
from tests.support.kept_blocks import blocks_kept

NAMES, DETAILS = ("set", "path", "hold", "release"), ("K1", "speed", "")
EVENTS = st.builds(
    LabEvent,
    run=st.integers(0, 2),
    time=st.floats(0, 9).map(lambda time: round(time, 1)),
    name=st.sampled_from(NAMES),
    detail=st.sampled_from(DETAILS),
    sides=st.sampled_from([SIDES, SIDES[:1]]),
)


@given(st.lists(EVENTS, max_size=2 * FIRST), st.lists(EVENTS, max_size=2 * FIRST))
def test_events_are_kept_in_their_order_but_for_repetitions(
    first: list[LabEvent], noted: list[LabEvent]
) -> None:
    log, expected = EventLog(first), list(first)
    for event in noted:
        log.append(event)
        if not expected or not event.repeats(expected[-1]):
            expected.append(event)
    assert list(log) == expected and len(log) == len(expected)
    assert log.last == (expected[-1] if expected else None)
    log.clear()
    assert not log and log.last is None


def test_the_latest_events_are_kept() -> None:
    log, expected = EventLog(), deque[LabEvent](maxlen=MOST)
    for number in range(2 * MOST + 7):
        event = LabEvent(0, float(number), "set", "K1", SIDES)
        log.append(event)
        expected.append(event)
    assert list(log) == list(expected)


@pytest.mark.thorough
def test_events_are_no_objects_of_their_own() -> None:
    log = EventLog()

    def note_events() -> None:
        for number in range(MOST):
            log.append(LabEvent(0, 2.0 * number, "set", "K1", SIDES))

    assert blocks_kept(note_events, "*/lab/events.py", __file__) < 20
