"""Places are shared between addresses: none of them can shut out the others."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.app.cli.serve import Serve
from onpath.app.server.admission_queue import RESERVED, AdmissionQueue
from onpath.app.server.server_options import MOST_CLIENTS

PLACES = 32


class Notices(dict[int, tuple[str, int, int]]):
    """Why pages wait, for how many places, and how many have waited longer, by number."""

    def come(self, queue: AdmissionQueue, number: int, address: str, inside: list[int]) -> None:
        """A page that is let in, or waits."""

        def enter() -> None:
            self.pop(number, None)
            inside.append(number)

        def wait(key: str, places: int, before: int) -> None:
            self[number] = key, places, before

        queue.admit(number, enter=enter, wait=wait, address=address, always=False)


@pytest.fixture
def notices() -> Notices:
    return Notices()


def test_one_address_leaves_places_for_others(notices: Notices) -> None:
    queue, inside = AdmissionQueue(PLACES), list[int]()
    for number in range(2 * PLACES):
        notices.come(queue, number, "203.0.113.1", inside)
    assert len(inside) == PLACES - PLACES // RESERVED
    assert notices[2 * PLACES - 1] == (
        "full.network",
        PLACES - PLACES // RESERVED,
        PLACES + PLACES // RESERVED - 1,
    )
    notices.come(queue, 1000, "198.51.100.1", inside)
    assert inside[-1] == 1000


def test_a_class_of_sixty_and_its_teacher_fit_in_behind_one_router(notices: Notices) -> None:
    assert Serve().most_clients == MOST_CLIENTS
    queue, inside = AdmissionQueue(MOST_CLIENTS), list[int]()
    for number in range(61):
        notices.come(queue, number, "203.0.113.1", inside)
    assert len(inside) == 61 and not notices


def test_a_free_place_goes_to_the_address_that_has_fewest(notices: Notices) -> None:
    queue, inside = AdmissionQueue(2), list[int]()
    for number in range(4):  # 2 and 3 wait
        notices.come(queue, number, "203.0.113.1", inside)
    notices.come(queue, 4, "198.51.100.1", inside)
    assert inside == [0, 1] and notices[4] == ("full.text", 2, 2)
    queue.leave(0)
    assert inside == [0, 1, 4] and set(notices) == {2, 3}
    queue.leave(1)
    assert inside == [0, 1, 4, 2]


@given(st.lists(st.tuples(st.integers(0, 9), st.sampled_from("abc"), st.booleans()), max_size=60))
def test_nobody_waits_while_a_place_is_free(steps: list[tuple[int, str, bool]]) -> None:
    """After any sequence of arrivals and departures nobody waits for a place that is free."""
    notices, queue, inside = Notices(), AdmissionQueue(3), list[int]()
    for step, (number, address, arrives) in enumerate(steps):
        if arrives:
            notices.come(queue, 100 + step, address, inside)
        else:
            queue.leave(100 + number)
        count = len(queue._inside)
        assert count <= 3 and not (queue._waiting and count < 3)
        waiting = [waits for waits in notices if waits in queue._waiting]
        assert [notices[waits][2] for waits in waiting] == list(range(len(waiting)))
