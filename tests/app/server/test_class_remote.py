"""The remote control of a class: who is let in, what it shows, and what it may do."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any
from urllib.request import urlopen

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec.json import encode

from onpath.app.classroom.classroom import MOST_ASKING, NUMBER_LASTS, Classroom
from onpath.app.server.lab_server import LabServer
from onpath.app.viser_adapter.addresses import class_address
from tests.support import waiting
from tests.support.own_socket import OwnSocket
from tests.support.student import Student

MOST_BYTES = 150_000  # of the page, and of what it is told until it can be used
wait_for = partial(waiting.wait_for, seconds=60.0)
MOVES = st.one_of(
    st.just(("ask",)),
    st.tuples(st.just("wait"), st.sampled_from([1.0, 50.0, NUMBER_LASTS])),
    st.tuples(st.sampled_from(["let in", "let in again", "guess", "throw out"]), st.integers(0, 9)),
)


@given(st.lists(MOVES, max_size=30))
@settings(max_examples=25, deadline=None)
def test_a_number_lets_one_page_in_once_within_two_minutes(moves: list[tuple[Any, ...]]) -> None:
    time = 0.0
    room = Classroom(lambda: time)
    asked, used = dict[int, float](), list[int]()
    inside = list[str]()
    for move, *how in moves:
        waiting = [number for number, since in asked.items() if time < since + NUMBER_LASTS]
        if move == "ask":
            number = room.ask_in(inside.append)
            assert bool(number) == (len(waiting) < MOST_ASKING) and number not in waiting
            asked |= {number: time} if number else {}
        elif move == "wait":
            time += how[0]
        elif move == "let in" and waiting:
            number = waiting[how[0] % len(waiting)]
            room.let_in(number)
            del asked[number]
            used.append(number)
        elif move == "throw out" and inside:
            place = how[0] % len(inside)
            gone = inside.pop(place)
            room.throw_out(place + 1)
            assert not room.is_pass(gone)
        elif move in ("let in again", "guess"):
            number = used[-1] if used and move == "let in again" else how[0]
            if number not in asked:
                with pytest.raises(ValueError):
                    room.let_in(number)
        assert all(room.is_pass(each) for each in inside) and len(room.state.phones) == len(inside)


def address(server: LabServer, room: Classroom) -> str:
    return f"ws://127.0.0.1:{server.server.get_port()}{class_address(room.code)}"


@pytest.fixture
def remote(server: LabServer, room: Classroom) -> Iterator[OwnSocket]:
    with OwnSocket(
        f"ws://127.0.0.1:{server.server.get_port()}{class_address(room.code)}remote"
    ) as page:
        yield page
    wait_for(lambda: not room.asking)


def last(page: OwnSocket, kind: str) -> dict[str, Any]:
    return next((each for each in reversed(list(page.told)) if each["is"] == kind), {})


def number_on(page: OwnSocket) -> int:
    return int(wait_for(lambda: last(page, "remote").get("number")))


def buttons(page: OwnSocket) -> dict[str, dict[str, Any]]:
    groups = last(page, "form").get("groups", [])
    return {
        each["name"]: each["act"] for group in groups for each in group["fields"] if each.get("act")
    }


def test_a_phone_is_let_in_from_a_teachers_page_and_thrown_out_again(
    server: LabServer, room: Classroom, remote: OwnSocket
) -> None:
    shown = room.admit(room.key, "lab")
    with Student(address(server, room), scene=False) as teacher:
        teacher.kept["onpath_teacher"] = shown
        teacher.open()
        number = number_on(remote)
        press(teacher, f"class.let_in{number}")
        teacher.read(lambda: "class.freeze" in buttons(remote))
        assert last(remote, "remote")["number"] == "" and last(remote, "store")["value"]
        page = urlopen(f"http://{address(server, room).removeprefix('ws://')}remote").read()
        assert len(page) + sum(len(encode(each)) for each in list(remote.told)) <= MOST_BYTES
        remote.tell(buttons(remote)["class.freeze"])
        wait_for(lambda: room.orders.frozen)
        remote.tell(wait_for(lambda: buttons(remote).get("class.thaw")))
        wait_for(lambda: not room.orders.frozen)
        press(teacher, "class.throw_out1")
        assert number_on(remote) != number and last(remote, "store")["value"] == ""
        refuses(remote, room)


def press(teacher: Student, name: str) -> None:
    teacher.read(lambda: name in teacher.fields)
    teacher.tell(teacher.fields[name]["act"])


def refusals(page: OwnSocket) -> int:
    return sum(each["is"] == "refused" for each in list(page.told))


def refuses(remote: OwnSocket, room: Classroom) -> None:
    before, mark = room.state, refusals(remote)
    remote.tell({"is": "lead", "do": "freeze"})
    remote.tell({"is": "lead", "do": "let_in", "member": number_on(remote)})
    wait_for(lambda: refusals(remote) == mark + 2)
    assert room.state == before


def test_a_page_that_shows_a_number_cannot_let_itself_in(
    remote: OwnSocket, room: Classroom
) -> None:
    number_on(remote)
    refuses(remote, room)
    assert "form" not in remote.kinds()
