"""Places are shared between addresses: none of them can shut out the others."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.app.server import admission_queue
from onpath.app.server.admission_queue import RESERVED, AdmissionQueue

PLACES = 32


class Notices:
    """Stands in for the notices that waiting clients see."""

    def __init__(self) -> None:
        self.shown: dict[int, str] = {}

    def show(self, client: Any, title: str, text: str) -> Any:
        self.shown[client.client_id] = text
        return lambda: self.shown.pop(client.client_id)


@pytest.fixture
def notices(monkeypatch: pytest.MonkeyPatch) -> Notices:
    notices = Notices()
    monkeypatch.setattr(admission_queue, "show_notice", notices.show)
    return notices


def come(queue: AdmissionQueue, number: int, address: str, inside: list[int]) -> None:
    client: Any = SimpleNamespace(client_id=number)
    queue.admit(client, lambda: inside.append(number), address, always=False)


def test_one_address_leaves_places_for_others(notices: Notices) -> None:
    queue, inside = AdmissionQueue(PLACES), list[int]()
    for number in range(2 * PLACES):
        come(queue, number, "203.0.113.1", inside)
    assert len(inside) == PLACES - PLACES // RESERVED
    assert "for one network" in notices.shown[2 * PLACES - 1]
    come(queue, 1000, "198.51.100.1", inside)
    assert inside[-1] == 1000


def test_a_free_place_goes_to_the_address_that_has_fewest(notices: Notices) -> None:
    queue, inside = AdmissionQueue(2), list[int]()
    for number in range(4):  # 2 and 3 wait
        come(queue, number, "203.0.113.1", inside)
    come(queue, 4, "198.51.100.1", inside)
    assert inside == [0, 1] and "All 2 places" in notices.shown[4]
    queue.leave(0)
    assert inside == [0, 1, 4] and set(notices.shown) == {2, 3}
    queue.leave(1)
    assert inside == [0, 1, 4, 2]


@given(st.lists(st.tuples(st.integers(0, 9), st.sampled_from("abc"), st.booleans()), max_size=60))
def test_nobody_waits_while_a_place_is_free(steps: list[tuple[int, str, bool]]) -> None:
    """After any sequence of arrivals and departures nobody waits for a place that is free."""
    notices = Notices()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(admission_queue, "show_notice", notices.show)
        queue, inside = AdmissionQueue(3), list[int]()
        for step, (number, address, arrives) in enumerate(steps):
            if arrives:
                come(queue, 100 + step, address, inside)
            else:
                queue.leave(100 + number)
            count = len(queue._inside)
            assert count <= 3 and not (queue._waiting and count < 3)
