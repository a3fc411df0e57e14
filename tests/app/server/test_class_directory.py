"""Which class a page belongs to, and what somebody under the prefix of another one is told."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any
from urllib.parse import urljoin

import pytest

from onpath.app.classroom.class_opening import open_classes
from onpath.app.classroom.classroom import Classroom
from onpath.app.common.access_codes import shown
from onpath.app.common.throttle import TRIES
from onpath.app.server.class_directory import ClassDirectory

KEYS = ["k7mf2xqa9tzr", "bn4ws8cd3vyp"]


def directory(rooms: list[Classroom]) -> ClassDirectory:
    def serve(room: Classroom, prefix: str) -> Any:
        return SimpleNamespace(room=room, prefix=prefix)

    return ClassDirectory(rooms, serve)


def test_each_class_is_at_its_place_only() -> None:
    rooms = open_classes(KEYS)
    found = directory(rooms)
    for room in rooms:
        service: Any = found.at(f"c/{room.code}")
        assert service.room is room and service.prefix == f"c/{room.code}"
    for prefix in ("", "l/abc", "c/nobody", f"l/{rooms[0].code}"):
        assert found.at(prefix) is None
    assert directory([]).at("") is None and directory([]).seat_elsewhere("", "lab") is None


def test_who_is_elsewhere_is_told_the_address() -> None:
    rooms = open_classes(KEYS)
    for prefix, code in (("c/nobody", "nobody"), ("l/abc", ""), ("", "")):
        seat = directory(rooms).seat_elsewhere(prefix, "lab")
        assert seat is not None and seat.code == code
        page = f"https://school.example/folder/{f'{prefix}/' if prefix else ''}"
        for room, key in zip(rooms, KEYS, strict=True):
            led = [seat.join(f" {room.code.upper()}", ""), seat.teach(shown(key))]
            there = f"https://school.example/folder/c/{room.code}/"
            assert [urljoin(page, address) for address in led] == [there, there]
            assert not room.members()


def test_whoever_tries_codes_elsewhere_waits_and_nobody_else_does() -> None:
    rooms = open_classes(KEYS)
    found = directory(rooms)
    thief, student = (found.seat_elsewhere("", lab) for lab in ("thief", "student"))
    assert thief is not None and student is not None
    for attempt, right in ((lambda t: thief.join(t, "x"), rooms[0].code), (thief.teach, KEYS[0])):
        for _ in range(TRIES):
            with pytest.raises(ValueError, match="not the"):
                attempt("2222-2222-2222")
        with pytest.raises(ValueError, match="too many"):
            attempt(right)
    assert student.join(rooms[0].code, "x") and student.teach(KEYS[0])
